#include "render/atlas/live_blocks.h"

namespace atlaswire::render {

void LiveBlocks::apply(const LayoutChange& change) {
  if (change.added.empty() && change.moved.empty() && change.removed.empty()) return;
  next_.clear();
  auto added = change.added.begin();
  auto moved = change.moved.begin();
  auto removed = change.removed.begin();
  for (const PlacedPatch& held : blocks_) {
    while (added != change.added.end() && added->patch < held.patch) next_.push_back(*added++);
    if (removed != change.removed.end() && *removed == held.patch) {
      ++removed;
    } else if (moved != change.moved.end() && moved->patch == held.patch) {
      next_.push_back(*moved++);
    } else {
      next_.push_back(held);
    }
  }
  next_.insert(next_.end(), added, change.added.end());
  blocks_.swap(next_);
}

}  // namespace atlaswire::render
