#pragma once

#include "base/grid.h"
#include "base/mover.h"
#include "base/units.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace atlaswire::proto {

/// The atlas's memory, for clients that derive where blocks lie. docs/PROTOCOL.md, "Atlas memory".
struct AtlasMemory {
  std::uint32_t superblock_log2 = 6;  ///< side; divides the atlas's; 4..12
  std::uint32_t min_block_log2 = 1;   ///< side of the smallest block; not above the superblock's
  double high_water = 0.95;           ///< share of texels in use, 0..1
  bool operator==(const AtlasMemory&) const = default;
};

/// What moves in a stream's scene, and how finely that is told. docs/PROTOCOL.md, "Motion in a stream".
struct MotionDescription {
  std::vector<Mover> movers;         ///< 1..kMostMovers, within the stream's patches
  std::vector<GridPosition> pivots;  ///< by object: what it turns about; at most one a mover
  double translation_step = 1e-3;    ///< metres, > 0, at most 1e6
  std::uint32_t rotation_bits = 14;  ///< 8..20
  bool operator==(const MotionDescription&) const = default;
};

/// What a client must know of a stream before its first frame; StreamInfo on the wire.
struct StreamDescription {
  std::string scene;          ///< for people, at most 256 octets
  Extent2D picture;           ///< what the decoder gives: the atlas, the coverage plane below it
  Extent2D atlas;             ///< colour texels, at the picture's top; sides 1..16384, inside the picture
  bool has_coverage = false;  ///< picture height is then at least twice the atlas's
  PositionGrid grid;
  std::uint32_t meta_codec = 1;              ///< codec::MetaCodecKind
  std::optional<AtlasMemory> memory;         ///< nullopt: blocks' places cannot be derived
  std::uint32_t max_vertices = 1U << 22U;    ///< vertex ids are below this; 1..2^26
  std::uint32_t max_patches = 1U << 22U;     ///< patch ids are below this; 1..2^26
  std::uint32_t ssrc = 0;                    ///< of the media stream
  std::uint8_t payload_type = 96;            ///< 96..127
  double frame_rate = 15;                    ///< Hz, nominal; 0.1..1000
  double near_plane = 0.05;                  ///< metres, > 0, at most 1000
  std::array<float, 3> background{0, 0, 0};  ///< linear colour where nothing is drawn, each 0..65504
  /// Which draw classes the scene has; the client makes pipelines for these only.
  bool alpha_mask = false;
  bool alpha_blend = false;
  bool double_sided = false;
  std::optional<MotionDescription> motion;  ///< nullopt: nothing moves, and no frame tells motion
};

}  // namespace atlaswire::proto
