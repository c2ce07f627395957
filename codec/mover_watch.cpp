#include "codec/mover_watch.h"

#include <algorithm>

namespace atlaswire::codec {

const Mover* find_mover(std::span<const Mover> movers, PatchId patch) {
  const auto after = std::ranges::upper_bound(movers, value(patch), {}, &Mover::first_patch);
  if (after == movers.begin()) return nullptr;
  const Mover& mover = *std::prev(after);
  return value(patch) < mover.end() ? &mover : nullptr;
}

MoverChange MoverWatch::take(const MetaUpdate& update) {
  MoverChange change;
  change.reset = update.reset;
  if (update.reset) rest_.clear();
  for (const NewVertex& vertex : update.vertices) {
    const std::size_t id = value(vertex.id);
    if (id >= rest_.size()) rest_.resize(std::max(id + 1, rest_.size() * 3 / 2));
    rest_[id] = vertex.position;
  }
  for (const PatchId id : update.removed) {
    if (find_mover(movers_, id) != nullptr) change.gone.push_back(id);
  }
  for (const AddedPatch& patch : update.added) {
    const Mover* mover = find_mover(movers_, patch.id);
    if (mover == nullptr) continue;
    MoverPatch& come = change.come.emplace_back();
    come.id = patch.id;
    come.mover = static_cast<std::uint32_t>(mover - movers_.data());
    if (!mover->deforms) continue;
    come.count = std::min(corner_count(patch.triangles), kMaxPatchCorners);
    for (std::uint32_t c = 0; c < come.count; ++c) {
      come.vertices[c] = patch.corners[c];
      const std::size_t id = value(patch.corners[c]);
      // A replica will refuse a vertex that was never told.
      if (id < rest_.size()) come.rest[c] = rest_[id];
    }
  }
  std::ranges::sort(change.gone);
  std::ranges::sort(change.come, {}, &MoverPatch::id);
  return change;
}

}  // namespace atlaswire::codec
