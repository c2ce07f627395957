#pragma once

#include "base/grid.h"
#include "base/ids.h"
#include "base/mover.h"
#include "base/patch_layout.h"
#include "codec/meta_update.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// A patch of a mover that becomes visible.
struct MoverPatch {
  PatchId id{};
  std::uint32_t mover = 0;  ///< into the list of movers
  std::uint32_t count = 0;  ///< corners; 0 of a mover that does not deform
  std::array<VertexId, kMaxPatchCorners> vertices{};
  std::array<GridPosition, kMaxPatchCorners> rest{};  ///< where they are at rest
};

/// What a meta update says of movers: in this order forget all, who goes, who comes; ids ascend.
struct MoverChange {
  bool reset = false;
  std::vector<PatchId> gone;
  std::vector<MoverPatch> come;
};

/// The mover of a patch; null: it has none. `movers` ascend.
const Mover* find_mover(std::span<const Mover> movers, PatchId patch);

/// Picks out of a stream's meta updates what concerns movers: both ends of a motion stream see the same, in
/// whatever numbers vertices come. Every update, in order. Safe on any update that a decoder gives: memory
/// grows to the largest vertex id told.
class MoverWatch {
 public:
  explicit MoverWatch(std::span<const Mover> movers) : movers_(movers.begin(), movers.end()) {}

  MoverChange take(const MetaUpdate& update);

 private:
  std::vector<Mover> movers_;
  std::vector<GridPosition> rest_;  ///< by vertex id
};

}  // namespace atlaswire::codec
