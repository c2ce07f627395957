#pragma once

#include "base/error_enum.h"
#include "base/grid.h"
#include "base/ids.h"
#include "base/patch_layout.h"
#include "base/result.h"
#include "codec/meta_update.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::client {

/// A patch the client can draw now.
struct ReplicaPatch {
  PatchId id{};
  std::uint8_t triangles = 1;  ///< 1..3
  PatchClass draw;
  std::array<VertexId, kMaxPatchCorners> corners{};  ///< the first corner_count(triangles) count; all known
  Block block;
};

/// The client's copy of the scene structure ([SAS] 3.3): vertices it was sent, patches in the atlas now.
/// Safe on hostile updates that any decoder let through: `apply` checks every id and block, and either
/// does all of an update or nothing of it. No allocation per patch; arrays grow to the largest id used.
class Replica {
 public:
  explicit Replica(const codec::MetaLimits& limits) : limits_(limits) {}

  /// Applies one update, in the order codec::MetaUpdate states. On an error nothing changed.
  Result<void> apply(const codec::MetaUpdate& update);

  /// Live patches, packed. Deterministic order, which changes when patches are removed.
  [[nodiscard]] std::span<const ReplicaPatch> patches() const { return patches_; }
  /// Grid positions by VertexId; those of unknown vertices are zero.
  [[nodiscard]] std::span<const GridPosition> positions() const { return positions_; }
  /// Vertices known.
  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }
  /// Triangles of all live patches.
  [[nodiscard]] std::size_t triangle_count() const { return triangle_count_; }

 private:
  enum class Mark : std::uint32_t { kRemoved = 0, kAdded = 1 };

  Result<void> check(const codec::MetaUpdate& update);
  Result<void> check_added(const codec::AddedPatch& patch, bool reset);
  [[nodiscard]] bool block_fits(const Block& block) const;
  [[nodiscard]] bool is_live(PatchId id) const;
  [[nodiscard]] bool is_known(VertexId id) const;
  [[nodiscard]] bool is_marked(PatchId id, Mark mark) const;
  void mark(PatchId id, Mark mark);
  void begin_marks();
  void remove(PatchId id);
  void forget_all();

  codec::MetaLimits limits_;
  std::vector<ReplicaPatch> patches_;
  std::vector<std::uint32_t> slot_;  ///< by PatchId: index into patches_ + 1; 0: not live
  std::vector<GridPosition> positions_;
  std::vector<std::uint8_t> known_;  ///< by VertexId
  std::size_t vertex_count_ = 0;
  std::size_t triangle_count_ = 0;
  // What the update under check has touched so far: stamps, so that nothing needs clearing.
  std::vector<std::uint32_t> patch_stamp_;
  std::vector<std::uint32_t> vertex_stamp_;
  std::uint32_t epoch_ = 0;
};

/// Why an update contradicts the replica.
enum class ReplicaError {
  kPatchUnknown = 1,
  kPatchKnown,
  kPatchOutOfRange,
  kVertexUnknown,
  kVertexKnown,
  kVertexOutOfRange,
  kBadPosition,
  kBadBlock,
  kBadTriangleCount,
  kRemovalAfterReset
};
const char* error_text(ReplicaError e);

}  // namespace atlaswire::client
ATLASWIRE_ERROR_ENUM(client, ReplicaError);
