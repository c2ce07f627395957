#include "render/atlas/usage_overlay.h"

#include "tests/render/atlas/layout_checker.h"

#include <gtest/gtest.h>

namespace atlaswire::render {
namespace {

TEST(UsageOverlay, ColoursExactlyTheTexelsOfLiveBlocks) {
  const AllocatorSettings settings{.atlas = {64, 64}, .superblock_log2 = 4};
  const auto allocator = make_sequential_allocator(settings, 60);
  UsageOverlay overlay(settings.atlas, settings.superblock_log2);
  const Picture empty = overlay.by_level();
  DriftingScene scene(2, 60, settings);
  for (int frame = 0; frame < 50; ++frame) {
    overlay.observe(allocator->update(scene.step(frame == 0 ? 1 : 0.1, 0.5, 3), frame % 5 == 0));
  }
  for (const Picture& picture : {overlay.by_level(), overlay.by_age()}) {
    std::uint64_t changed = 0;
    for (std::uint32_t y = 0; y < 64; ++y) {
      for (std::uint32_t x = 0; x < 64; ++x) changed += picture.at(x, y) != empty.at(x, y) ? 1 : 0;
    }
    EXPECT_EQ(changed, allocator->usage().allocated);
  }
}

TEST(UsageOverlay, AgesFromTheFrameOfPlacement) {
  UsageOverlay overlay({64, 64}, 4);
  EXPECT_EQ(overlay.mean_age(), 0);
  LayoutChange change;
  change.added = {{PatchId{1}, {0, 0, 3, 3, false}}, {PatchId{2}, {16, 0, 3, 3, false}}};
  overlay.observe(change);
  EXPECT_EQ(overlay.by_age().at(0, 0), (Rgba8{255, 255, 255, 255}));
  overlay.observe({});
  LayoutChange move;
  move.moved = {{PatchId{2}, {32, 0, 3, 3, false}}};
  overlay.observe(move);
  EXPECT_DOUBLE_EQ(overlay.mean_age(), 1);  // 2 and 0
  EXPECT_EQ(overlay.by_age(2).at(0, 0), (Rgba8{40, 60, 140, 255}));
  EXPECT_EQ(overlay.by_age(2).at(32, 0), (Rgba8{255, 255, 255, 255}));
}

TEST(UsageOverlay, TellsFreeSuperblocksFromHolesInThoseInUse) {
  UsageOverlay overlay({64, 64}, 4);
  LayoutChange change;
  change.added = {{PatchId{1}, {16, 0, 3, 3, false}}};
  overlay.observe(change);
  const Picture picture = overlay.by_class();
  EXPECT_EQ(picture.at(17, 1), (Rgba8{70, 180, 90, 255}));
  EXPECT_EQ(picture.at(25, 1), (Rgba8{235, 150, 50, 255}));
  EXPECT_EQ(picture.at(1, 1), (Rgba8{110, 80, 150, 255}));
}

}  // namespace
}  // namespace atlaswire::render
