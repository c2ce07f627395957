#include "tests/codec/shown_patches.h"

#include <gtest/gtest.h>

#include <utility>

namespace atlaswire::codec {

void ShownPatches::apply(const MetaUpdate& update) {
  if (update.reset) {
    patches_.clear();
    vertices_.clear();
  }
  for (const PatchId id : update.removed) EXPECT_EQ(patches_.erase(id), 1U) << value(id);
  for (const NewVertex& v : update.vertices) {
    EXPECT_TRUE(vertices_.emplace(v.id, std::array{v.position.x, v.position.y, v.position.z}).second);
  }
  for (const AddedPatch& added : update.added) {
    Patch patch{.triangles = added.triangles, .draw = added.draw, .positions = {}, .block = added.block};
    for (std::uint32_t i = 0; i < corner_count(added.triangles); ++i) {
      EXPECT_TRUE(vertices_.contains(added.corners[i]));
      patch.positions.push_back(vertices_[added.corners[i]]);
    }
    EXPECT_TRUE(patches_.emplace(added.id, std::move(patch)).second) << value(added.id);
  }
  for (const MovedPatch& moved : update.moved) {
    EXPECT_TRUE(patches_.contains(moved.id));
    patches_[moved.id].block = moved.block;
  }
}

}  // namespace atlaswire::codec
