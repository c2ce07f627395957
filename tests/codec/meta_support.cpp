#include "tests/codec/meta_support.h"

#include <algorithm>

namespace atlaswire::codec {

namespace {

Block random_block(Random& random) {
  Block block;
  block.width_log2 = static_cast<std::uint8_t>(random.below(7));
  block.height_log2 = static_cast<std::uint8_t>(random.below(block.width_log2 + 1U));
  block.transposed = random.below(2) == 1;
  block.x = static_cast<std::uint16_t>(random.below(test_limits().atlas.width - block.width() + 1));
  block.y = static_cast<std::uint16_t>(random.below(test_limits().atlas.height - block.height() + 1));
  return block;
}

AddedPatch random_patch(Random& random, PatchId id) {
  AddedPatch patch;
  patch.id = id;
  patch.triangles = static_cast<std::uint8_t>(1 + random.below(kMaxPatchTriangles));
  patch.draw.alpha = static_cast<PatchClass::Alpha>(random.below(3));
  patch.draw.double_sided = random.below(2) == 1;
  patch.block = random_block(random);
  for (std::uint32_t corner = 0; corner < corner_count(patch.triangles); ++corner) {
    patch.corners[corner] = VertexId{static_cast<std::uint32_t>(random.below(test_limits().max_vertices))};
  }
  return patch;
}

}  // namespace

MetaLimits test_limits() {
  return {.max_vertices = 40'000, .max_patches = 20'000, .grid_bits = 16, .atlas = {1024, 512}};
}

MetaUpdate random_update(Random& random, std::size_t size) {
  MetaUpdate update;
  update.frame = FrameId{static_cast<std::uint32_t>(random.bits())};
  update.reset = random.below(8) == 0;
  const MetaLimits limits = test_limits();
  const double share = static_cast<double>(size) / limits.max_patches;
  for (std::uint32_t id = 0; id < limits.max_patches; ++id) {
    const double draw = random.uniform();
    if (draw < share) update.removed.push_back(PatchId{id});
    if (draw > share / 2 && draw < 1.5 * share) update.added.push_back(random_patch(random, PatchId{id}));
    if (draw > 1 - share) update.moved.push_back({PatchId{id}, random_block(random)});
  }
  for (std::uint32_t id = 0; id < limits.max_vertices; ++id) {
    if (random.uniform() >= share) continue;
    const auto axis = [&] { return static_cast<std::uint32_t>(random.below(1U << limits.grid_bits)); };
    update.vertices.push_back({VertexId{id}, GridPosition(axis(), axis(), axis())});
  }
  return update;
}

bool same(const MetaUpdate& a, const MetaUpdate& b) {
  const auto vertex = [](const NewVertex& x, const NewVertex& y) {
    return x.id == y.id && x.position == y.position;
  };
  const auto added = [](const AddedPatch& x, const AddedPatch& y) {
    return x.id == y.id && x.triangles == y.triangles && x.draw == y.draw && x.block == y.block &&
           std::equal(x.corners.begin(), x.corners.begin() + corner_count(x.triangles), y.corners.begin());
  };
  const auto moved = [](const MovedPatch& x, const MovedPatch& y) {
    return x.id == y.id && x.block == y.block;
  };
  return a.frame == b.frame && a.reset == b.reset && a.removed == b.removed &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(), vertex) &&
         std::equal(a.added.begin(), a.added.end(), b.added.begin(), b.added.end(), added) &&
         std::equal(a.moved.begin(), a.moved.end(), b.moved.begin(), b.moved.end(), moved);
}

}  // namespace atlaswire::codec
