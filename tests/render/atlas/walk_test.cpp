// What a viewer's walk and turns ask of the atlas: levels chosen and blocks given as a stream does it, with
// the default settings.
#include "base/random.h"
#include "render/atlas/level_selection.h"
#include "render/atlas/strategy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace atlaswire::render {
namespace {

struct Walk {
  std::uint32_t side;       ///< of the atlas, texels
  std::uint32_t patches;    ///< in the scene
  double turn;              ///< radians a frame while turning
  double largest_area = 0;  ///< of a patch seen from a metre, pixels
};

/// Patches scattered over a plane of 40 by 40 metres, a few of them large, seen by somebody who walks in a
/// circle and turns by 180 degrees now and then.
class Plane {
 public:
  explicit Plane(const Walk& walk) : walk_(walk) {
    Random random(11);
    for (std::uint32_t i = 0; i < walk.patches; ++i) {
      places_.push_back({40 * random.uniform() - 20, 40 * random.uniform() - 20});
      areas_.push_back(walk.largest_area * std::exp2(-10 * random.uniform()));
      aspects_.push_back(std::exp2(4 * random.uniform() - 2));
    }
  }

  /// Level words of one frame.
  const std::vector<std::uint32_t>& frame(int number) {
    words_.assign(walk_.patches, 0);
    const double at = number * 0.003;
    const double x = 8 * std::cos(at);
    const double z = 8 * std::sin(at);
    const int turning = number % 150;  // a turn of half a circle begins each five seconds
    heading_ += turning * walk_.turn < std::numbers::pi ? walk_.turn : 0.003;
    for (std::uint32_t i = 0; i < walk_.patches; ++i) {
      const double dx = places_[i].first - x;
      const double dz = places_[i].second - z;
      const double distance = std::max(0.3, std::hypot(dx, dz));
      if ((dx * std::cos(heading_) + dz * std::sin(heading_)) / distance < 0.6) continue;
      words_[i] = pack_projection(areas_[i] / (distance * distance), aspects_[i]);
    }
    return words_;
  }

 private:
  Walk walk_;
  std::vector<std::pair<double, double>> places_;
  std::vector<double> areas_;
  std::vector<double> aspects_;
  std::vector<std::uint32_t> words_;
  double heading_ = 0;
};

class AtlasWalk : public testing::TestWithParam<Walk> {};

TEST_P(AtlasWalk, GivesEveryVisiblePatchTheSizeItAskedForInEveryFrame) {
  const Walk& walk = GetParam();
  LevelSettings settings;
  const Extent2D atlas{walk.side, walk.side};
  settings.allocator = {.atlas = atlas,
                        .superblock_log2 = suited_superblock_log2(atlas),
                        .min_block_log2 = suited_min_block_log2(atlas, walk.patches)};
  LevelSelector selector(settings, walk.patches);
  const auto allocator = make_allocator(Strategy::kS0, settings.allocator, walk.patches);
  Plane plane(walk);
  std::vector<BlockRequest> requests;
  bool pressed = false;
  for (int frame = 0; frame < 350; ++frame) {
    pressed = selector.select(plane.frame(frame), requests).bias > 0 || pressed;
    const LayoutChange& change = allocator->update(requests, frame % 5 == 0);
    ASSERT_TRUE(change.refused.empty()) << "frame " << frame;
    const auto blocks = allocator->blocks();
    ASSERT_EQ(blocks.size(), requests.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      ASSERT_EQ(blocks[i].block.width_log2, requests[i].width_log2) << "frame " << frame;
      ASSERT_EQ(blocks[i].block.height_log2, requests[i].height_log2) << "frame " << frame;
    }
  }
  EXPECT_TRUE(pressed) << "the atlas was never short: the walk proves nothing";
}

// A turn of 0.2 radians a frame is 180 degrees in half a second.
INSTANTIATE_TEST_SUITE_P(Atlases, AtlasWalk,
                         testing::Values(Walk{256, 66'000, 0.2, 4e3}, Walk{256, 8'000, 0.02, 4e4},
                                         Walk{512, 40'000, 0.2, 2e4}, Walk{1024, 40'000, 0.2, 1e5},
                                         Walk{1024, 10'000, 0.02, 1e6}, Walk{2048, 20'000, 0.2, 1e6}),
                         [](const auto& walk) {
                           return std::to_string(walk.param.side) + "_" + std::to_string(walk.index);
                         });

TEST(SuitedMinBlock, IsOneTexelOnlyWhereTheAtlasHasFewerTexelsThanTheScenePatches) {
  EXPECT_EQ(suited_min_block_log2({256, 256}, 65'536), 1U);
  EXPECT_EQ(suited_min_block_log2({256, 256}, 65'537), 0U);
  EXPECT_EQ(suited_min_block_log2({1024, 1024}, 140'000), 1U);
}

TEST(SuitedSuperblock, IsAnEighthOfTheSideWithinLimits) {
  EXPECT_EQ(suited_superblock_log2({256, 256}), 5U);
  EXPECT_EQ(suited_superblock_log2({1024, 1024}), 7U);
  EXPECT_EQ(suited_superblock_log2({1024, 512}), 6U);
  EXPECT_EQ(suited_superblock_log2({4096, 4096}), 8U);
  EXPECT_EQ(suited_superblock_log2({1088, 1088}), 6U) << "must divide the sides";
  EXPECT_EQ(suited_superblock_log2({64, 64}), 5U);
}

}  // namespace
}  // namespace atlaswire::render
