#include "render/atlas_gpu/device_allocator.h"

#include "base/program.h"
#include "render/atlas/admission.h"
#include "tests/render/atlas/layout_checker.h"
#include "tests/render/gpu/gpu_fixture.h"

#include <algorithm>

namespace atlaswire::render {
namespace {

bool operator==(const PlacedPatch& a, const PlacedPatch& b) {
  return a.patch == b.patch && a.block == b.block;
}

/// Where two frames differ; empty if they are the same to the last block.
std::string difference(const AtlasAllocator& device, const LayoutChange& on_device,
                       const AtlasAllocator& model, const LayoutChange& modelled) {
  const auto same = [](const auto& a, const auto& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return x == y; });
  };
  if (on_device.reset != modelled.reset) return "reset";
  if (!same(on_device.removed, modelled.removed)) return "removed";
  if (!same(on_device.refused, modelled.refused)) return "refused";
  if (!same(on_device.added, modelled.added)) return "added";
  if (!same(on_device.moved, modelled.moved)) return "moved";
  if (!same(device.blocks(), model.blocks())) return "blocks";
  const AtlasUsage a = device.usage();
  const AtlasUsage b = model.usage();
  if (a.allocated != b.allocated) return "allocated texels";
  if (a.partial_tail != b.partial_tail) return "texels in tails";
  if (a.on_stacks != b.on_stacks) return "texels on stacks";
  if (a.free != b.free) return "free texels";
  if (device.wants_reset() != model.wants_reset()) return "wants_reset";
  return {};
}

using Load = DriftLoad;

class DeviceAllocatorDrift : public test::GpuTest, public testing::WithParamInterface<Load> {};

TEST_P(DeviceAllocatorDrift, EqualsTheSequentialModelBlockForBlock) {
  const Load& run = GetParam();
  DeviceAllocator allocator(device(), run.settings, run.patches);
  const auto model = make_sequential_allocator(run.settings, run.patches);
  LayoutChecker checker(run.settings);
  DriftingScene scene(7, run.patches, run.settings);
  for (int frame = 0; frame < run.frames; ++frame) {
    const auto& visible = scene.step(frame == 0 ? 1.0 : run.churn, run.visible, run.largest_log2);
    const LayoutChange& on_device = allocator.update(visible, frame % 5 == 0);
    const LayoutChange& modelled = model->update(visible, frame % 5 == 0);
    ASSERT_EQ(difference(allocator, on_device, *model, modelled), "") << "frame " << frame;
    ASSERT_EQ(checker.check(allocator, visible, on_device), "") << "frame " << frame;
  }
  allocator.update({}, false);
  EXPECT_EQ(allocator.usage().free, run.settings.atlas.area());
}

INSTANTIATE_TEST_SUITE_P(
    Loads, DeviceAllocatorDrift,
    testing::Values(Load{"comfortable", small_atlas(), 600, 0.05, 0.4, 4, 1500},
                    Load{"overload", small_atlas(), 3000, 0.05, 0.5, 4, 300},
                    Load{"all_new_every_frame", small_atlas(), 400, 1.0, 0.5, 5, 300},
                    Load{"one_superblock", small_atlas(32, 5, 1), 40, 0.2, 0.5, 5, 1000},
                    Load{"one_texel_blocks", small_atlas(64, 4, 0), 3000, 0.1, 0.7, 1, 200},
                    Load{"one_legal_size", small_atlas(64, 3, 3), 100, 0.3, 0.8, 3, 300},
                    Load{"oblong", {.atlas = {512, 64}, .superblock_log2 = 6}, 300, 0.1, 0.5, 6, 500},
                    Load{"many_patches", small_atlas(512, 6, 1), 40000, 0.02, 0.3, 3, 60}),
    [](const auto& load) { return std::string(load.param.name); });

class DeviceAllocatorTest : public test::GpuTest {
 protected:
  /// Both allocators through the same frames; every frame may reset.
  void expect_equal(const AllocatorSettings& settings, std::uint32_t patches,
                    const std::vector<std::vector<BlockRequest>>& frames) {
    DeviceAllocator allocator(device(), settings, patches);
    const auto model = make_sequential_allocator(settings, patches);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const LayoutChange& on_device = allocator.update(frames[i], true);
      ASSERT_EQ(difference(allocator, on_device, *model, model->update(frames[i], true)), "")
          << "frame " << i;
    }
  }

  static std::vector<BlockRequest> uniform(std::uint32_t count, std::uint32_t w, std::uint32_t h,
                                           std::uint32_t stride = 1) {
    std::vector<BlockRequest> all;
    for (std::uint32_t i = 0; i < count; ++i) all.push_back(request(i * stride, w, h));
    return all;
  }
};

TEST_F(DeviceAllocatorTest, AgreesOnSawteethOfOneSizeAndTheNext) {
  // The atlas is full of one size, then of every other patch, then of another size in between.
  std::vector<std::vector<BlockRequest>> frames;
  for (std::uint32_t turn = 0; turn < 60; ++turn) {
    const std::uint32_t h = 1 + turn % 4;
    frames.push_back(uniform(4096 >> (4 + h), 4, h));
    frames.push_back(uniform(4096 >> (5 + h), 4, h, 2));
    frames.push_back(uniform(1024, 1, 1));
    frames.push_back({});
  }
  expect_equal(small_atlas(64, 4, 1), 1024, frames);
}

TEST_F(DeviceAllocatorTest, AgreesWhereRequestsExceedTheAtlasAThousandfold) {
  expect_equal(small_atlas(64, 6, 1), 5000,
               {uniform(5000, 6, 6),
                uniform(5000, 6, 5),
                uniform(100, 6, 6),
                uniform(10, 2, 2),
                uniform(5000, 1, 1),
                {}});
}

TEST_F(DeviceAllocatorTest, AgreesOnRequestsThatFlipEveryFrame) {
  std::vector<std::vector<BlockRequest>> frames;
  for (std::uint32_t f = 0; f < 80; ++f) {
    std::vector<BlockRequest> visible;
    for (std::uint32_t i = 0; i < 300; ++i) {
      if ((i + f) % 7 != 0) visible.push_back(request(i, 2 + (i + f) % 3, 1 + (i * f) % 2, (i ^ f) % 2 == 0));
    }
    frames.push_back(visible);
  }
  expect_equal(small_atlas(128, 5, 1), 300, frames);
}

TEST_F(DeviceAllocatorTest, ClampsWantsToLegalBlocks) {
  expect_equal(small_atlas(256, 5, 1), 4,
               {{request(0, 0, 0), request(1, 9, 9), request(2, 9, 0), request(3, 1, 3)}});
}

TEST_F(DeviceAllocatorTest, RestartsAsTheModelDoes) {
  const auto settings = small_atlas();
  DeviceAllocator allocator(device(), settings, 600);
  auto model = make_sequential_allocator(settings, 600);
  DriftingScene scene(7, 600, settings);
  for (int frame = 0; frame < 120; ++frame) {
    const auto& visible = scene.step(frame == 0 ? 1.0 : 0.1, 0.6, 4);
    if (frame % 30 == 29) {
      allocator.restart();
      // A new one, which knows nothing of what was.
      model = make_sequential_allocator(settings, 600);
      model->restart();
      allocator.update(visible, false);
      model->update(visible, false);
      ASSERT_EQ(difference(allocator, {}, *model, {}), "") << "frame " << frame;
      continue;
    }
    const LayoutChange& on_device = allocator.update(visible, frame % 5 == 0);
    ASSERT_EQ(difference(allocator, on_device, *model, model->update(visible, frame % 5 == 0)), "")
        << "frame " << frame;
  }
}

TEST_F(DeviceAllocatorTest, AdmitsAsTheHostDoes) {
  const auto settings = small_atlas();
  for (const std::uint32_t most_new : {1U, 16U, 100U}) {
    DeviceAllocator allocator(device(), settings, 600, SlotOrder::kRanked, Residence::kUpload, most_new);
    Admission admission(most_new, 600);
    const auto model = make_sequential_allocator(settings, 600);
    DriftingScene scene(9, 600, settings);
    for (int frame = 0; frame < 60; ++frame) {
      auto visible = scene.step(frame == 0 ? 1.0 : 0.1, 0.6, 4);
      if (frame == 30) {
        allocator.restart();
        model->restart();
        admission.restart();
      }
      const LayoutChange& on_device = allocator.update(visible, frame % 5 == 0);
      const std::uint32_t waiting = admission.admit(visible);
      EXPECT_EQ(allocator.waiting(), waiting);
      ASSERT_EQ(difference(allocator, on_device, *model, model->update(visible, frame % 5 == 0)), "")
          << most_new << ", frame " << frame;
    }
  }
}

TEST_F(DeviceAllocatorTest, DrawnSlotsKeepEveryPromiseToo) {
  const auto settings = small_atlas();
  DeviceAllocator allocator(device(), settings, 600, SlotOrder::kDrawn);
  LayoutChecker checker(settings);
  DriftingScene scene(7, 600, settings);
  for (int frame = 0; frame < 300; ++frame) {
    const auto& visible = scene.step(frame == 0 ? 1.0 : 0.1, 0.6, 4);
    ASSERT_EQ(checker.check(allocator, visible, allocator.update(visible, frame % 5 == 0)), "")
        << "frame " << frame;
  }
  allocator.update({}, false);
  EXPECT_EQ(allocator.usage().free, settings.atlas.area());
}

TEST_F(DeviceAllocatorTest, RejectsWhatSuperblocksDoNotTileOrBuffersDoNotHold) {
  EXPECT_THROW(DeviceAllocator(device(), {.atlas = {100, 64}}, 1), ProgramError);
  const AllocatorSettings huge{.atlas = {32768, 32768}, .superblock_log2 = 6, .min_block_log2 = 0};
  EXPECT_THROW(DeviceAllocator(device(), huge, 1), ProgramError);
}

}  // namespace
}  // namespace atlaswire::render
