#include "render/atlas/layout_hash.h"

namespace atlaswire::render {

void LayoutHash::follow(const LayoutChange& change) {
  for (const PatchId patch : change.removed) hash_.take_in(value(patch));
  take_in(change.added);
  take_in(change.moved);
}

void LayoutHash::begin(std::span<const PlacedPatch> live) {
  hash_ = {};
  take_in(live);
}

void LayoutHash::take_in(std::span<const PlacedPatch> placed) {
  for (const PlacedPatch& p : placed) {
    hash_.take_in(value(p.patch));
    hash_.take_in(p.block);
  }
}

}  // namespace atlaswire::render
