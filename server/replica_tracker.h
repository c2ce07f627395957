#pragma once

#include "base/grid.h"
#include "codec/meta_update.h"
#include "render/atlas/layout_hash.h"
#include "render/scene/scene.h"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace atlaswire::server {

/// Knows what the clients of a stream know, and turns each frame's layout change into the update that keeps
/// them level: vertices once, when a patch first needs them; patches added, moved and removed. A grid point
/// is a vertex's identity, so of points that one mover moves apart and that rest at one grid point all but
/// the first are told at the next free one.
class ReplicaTracker {
 public:
  ReplicaTracker(std::shared_ptr<const render::Scene> scene, std::uint32_t grid_bits);

  /// The update for `frame`; lists ascend.
  codec::MetaUpdate update(FrameId frame, const render::LayoutChange& change);
  /// An update that forgets everything and tells `blocks` (every live one, ascending) from nothing: what a
  /// new client needs. Stands in for `update` of that frame.
  codec::MetaUpdate restart(FrameId frame, std::span<const render::PlacedPatch> blocks);

  /// What one frame's layout follows from, and the layout.
  struct Asked {
    std::span<const render::BlockRequest> requests;  ///< ascending
    const render::LayoutChange* change = nullptr;
    std::span<const render::PlacedPatch> live;  ///< every block, ascending; only looked at if `change` resets
  };
  /// The same two for clients that derive the layout: what patches ask for instead of the blocks they got.
  /// `change` must be a reset where clients start from nothing.
  codec::MetaUpdate update(FrameId frame, const Asked& asked);
  codec::MetaUpdate restart(FrameId frame, const Asked& asked);

  [[nodiscard]] const std::shared_ptr<const render::Scene>& scene() const { return scene_; }
  [[nodiscard]] const PositionGrid& grid() const { return grid_; }
  /// What decoders must be prepared for.
  [[nodiscard]] codec::MetaLimits limits(const Extent2D& atlas) const;

 private:
  void forget();
  void add(PatchId patch, const Block& block, codec::MetaUpdate& update);
  void compare(const Asked& asked, codec::MetaUpdate& update);
  void add_vertices(codec::MetaUpdate& update);

  std::shared_ptr<const render::Scene> scene_;
  PositionGrid grid_;
  std::map<std::uint32_t, GridPosition> nudged_;  ///< by VertexId, the few that are told elsewhere
  std::vector<bool> known_;                       ///< by VertexId
  std::vector<std::uint32_t> new_ones_;           ///< of the update being made
  std::vector<render::BlockRequest> asked_;       ///< as clients know it, ascending
  render::LayoutHash layout_;                     ///< as clients that derive it must have it
};

/// The grid that clients of a scene share: over its bounding box, in scene coordinates.
/// `bits` 0: PositionGrid::suited_bits.
PositionGrid scene_grid(const render::Scene& scene, std::uint32_t bits);

}  // namespace atlaswire::server
