#pragma once

#include "base/block.h"
#include "base/bytes.h"
#include "base/error_enum.h"
#include "base/grid.h"
#include "base/ids.h"
#include "base/patch_layout.h"
#include "base/result.h"
#include "base/units.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace atlaswire::codec {

/// A position vertex the client has not seen yet.
struct NewVertex {
  VertexId id{};
  GridPosition position{0};
};

/// A patch that enters the atlas: its triangles' corners (all sent before or in this update) and block.
struct AddedPatch {
  PatchId id{};
  std::uint8_t triangles = 1;  ///< 1..3
  PatchClass draw;
  std::array<VertexId, kMaxPatchCorners> corners{};  ///< the first corner_count(triangles) count
  Block block;
};

/// A patch whose block changed.
struct MovedPatch {
  PatchId id{};
  Block block;
};

/// What a receiver must know that derives where blocks lie, besides what each patch asks for.
struct LayoutCue {
  bool reset = false;       ///< the atlas's memory begins anew: every block is placed afresh
  std::uint16_t check = 0;  ///< of the layout that comes about (render::LayoutHash)
};

/// Everything that changes a client's replica from frame to frame ([SAS] 3.3). Apply in this order: reset,
/// removed, vertices, added, moved. Vertices stay known after their last patch is removed.
struct MetaUpdate {
  FrameId frame{};
  bool reset = false;  ///< forget every vertex and patch first
  std::vector<PatchId> removed;
  std::vector<NewVertex> vertices;
  std::vector<AddedPatch> added;
  std::vector<MovedPatch> moved;
  /// Only of codecs that leave positions to the receiver: then all blocks are sizes that patches ask for, at
  /// the origin, and who is removed asks no longer.
  std::optional<LayoutCue> cue;
};

/// What limits a decoder: agreed in StreamInfo, checked before memory is allocated.
struct MetaLimits {
  std::uint32_t max_vertices = 1U << 22U;  ///< ids below this
  std::uint32_t max_patches = 1U << 22U;   ///< ids below this
  std::uint32_t grid_bits = 16;            ///< coordinates below 2^bits
  Extent2D atlas;                          ///< blocks lie inside
};

/// No codec takes or gives an update of more octets than this before compression; an encoder's caller sees to
/// it.
inline constexpr std::size_t kMaxMetaBody = std::size_t{32} << 20U;

/// Turns updates into bytes; one per client stream, may keep state between updates: then the other end must
/// get every one, in order. An update with `reset` starts anew. Not thread-safe.
class MetaEncoder {
 public:
  virtual ~MetaEncoder() = default;
  /// Appends the update's bytes to `out`. Ids within each list should ascend: other orders cost bytes.
  virtual void encode(const MetaUpdate& update, ByteBuffer& out) = 0;
};

/// The other end. Safe on hostile bytes: bounded memory and time. After an Error, one that keeps state
/// refuses everything until an update with `reset` comes; others go on.
class MetaDecoder {
 public:
  virtual ~MetaDecoder() = default;
  virtual Result<MetaUpdate> decode(ByteView bytes) = 0;
};

/// Which meta codec both ends use; a number on the wire.
enum class MetaCodecKind : std::uint8_t {
  kPlain = 1,   ///< every update alone, zstd: simple, large
  kGate = 2,    ///< incremental: a quarter of the bytes, or less
  kPaper = 3,   ///< every update alone, octree and exponential-Golomb codes, as [SAS] 6.5: to compare with
  kMirror = 4,  ///< kGate without the positions of blocks: the receiver runs the atlas's memory itself
};

/// All of them, those that a server prefers first.
inline constexpr std::array kMetaCodecs{MetaCodecKind::kMirror, MetaCodecKind::kGate, MetaCodecKind::kPlain,
                                        MetaCodecKind::kPaper};

/// Each of its updates continues those before: after an error only one with `reset` can be read.
constexpr bool keeps_state(MetaCodecKind kind) {
  return kind == MetaCodecKind::kGate || kind == MetaCodecKind::kMirror;
}
/// Its updates carry a LayoutCue.
constexpr bool leaves_positions(MetaCodecKind kind) { return kind == MetaCodecKind::kMirror; }

/// "plain", "gate", "paper", "mirror": as settings and reports call it.
const char* name(MetaCodecKind kind);
std::optional<MetaCodecKind> find_meta_codec(std::string_view name);

std::unique_ptr<MetaEncoder> make_meta_encoder(MetaCodecKind kind, const MetaLimits& limits);
std::unique_ptr<MetaDecoder> make_meta_decoder(MetaCodecKind kind, const MetaLimits& limits);

/// Why bytes are no meta update.
enum class MetaError {
  kTruncated = 1,
  kTrailingBytes,
  kBadVersion,
  kTooLarge,
  kIdOutOfRange,
  kBadPosition,
  kBadBlock,
  kBadPatch,
  kBadOrder,
  kOutOfStep
};
const char* error_text(MetaError e);

}  // namespace atlaswire::codec
ATLASWIRE_ERROR_ENUM(codec, MetaError);
