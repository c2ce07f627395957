#include "render/atlas_gpu/device_selector.h"

#include "base/program.h"
#include "base/random.h"
#include "render/atlas_gpu/device_allocator.h"
#include "shaders/alloc_layout.h"
#include "tests/render/gpu/gpu_fixture.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace atlaswire::render {
namespace {

struct Walk {
  const char* name;
  LevelSettings settings;
  std::uint32_t patches;
  double mean_log2;  ///< of areas in pixels
  int frames;
};

void PrintTo(const Walk& walk, std::ostream* out) { *out << walk.name; }

LevelSettings level_settings(std::uint32_t side, double hysteresis, std::uint32_t least = 1) {
  LevelSettings s;
  s.allocator = {.atlas = {side, side}, .superblock_log2 = 5, .min_block_log2 = least};
  s.hysteresis = hysteresis;
  return s;
}

/// Projections that drift, as on a walk: areas and aspects wander, patches come and go.
class DriftingProjections {
 public:
  DriftingProjections(std::uint32_t patches, double mean_log2)
      : mean_log2_(mean_log2), area_(patches), aspect_(patches), words_(patches) {
    for (std::size_t i = 0; i < area_.size(); ++i) {
      area_[i] = mean_log2 + 3 * random_.normal();
      aspect_[i] = 2 * random_.normal();
    }
  }
  const std::vector<std::uint32_t>& step(double zoom) {
    for (std::size_t i = 0; i < area_.size(); ++i) {
      area_[i] += 0.1 * random_.normal() + zoom;
      aspect_[i] += 0.05 * random_.normal();
      const bool was = words_[i] != 0;
      const bool shown = random_.uniform() < 0.05 ? random_.uniform() < 0.4 : was;
      words_[i] = shown ? pack_projection(std::exp2(area_[i]), std::exp2(aspect_[i])) : 0;
    }
    return words_;
  }

 private:
  Random random_{17};
  double mean_log2_;
  std::vector<double> area_;
  std::vector<double> aspect_;
  std::vector<std::uint32_t> words_;
};

class DeviceSelectorTest : public test::GpuTest {
 protected:
  Buffer words(std::uint32_t count) {
    Buffer buffer(device(), {.name = "levels",
                             .size = count * sizeof(std::uint32_t),
                             .usage = vk::BufferUsageFlagBits::eStorageBuffer,
                             .residence = Residence::kReadback});
    std::ranges::fill(buffer.mapped<std::uint32_t>(), 0U);
    return buffer;
  }

  static std::uint32_t want_of(const BlockRequest& r) {
    return alloc::kWantVisible | (r.transposed ? alloc::kTransposed : 0) |
           static_cast<std::uint32_t>(r.width_log2) << 4 | r.height_log2;
  }
};

class DeviceSelectorWalk : public DeviceSelectorTest, public testing::WithParamInterface<Walk> {};

TEST_P(DeviceSelectorWalk, EqualsTheHostsSelection) {
  const Walk& walk = GetParam();
  const Buffer levels = words(walk.patches);
  const Buffer wants = words(walk.patches);
  const DeviceSelector on_device(device(), walk.settings, walk.patches, levels, wants);
  LevelSelector model(walk.settings, walk.patches);
  DriftingProjections scene(walk.patches, walk.mean_log2);
  SubmitContext context(device(), "selector");
  std::vector<BlockRequest> requests;
  std::uint32_t demoted = 0;
  for (int frame = 0; frame < walk.frames; ++frame) {
    // There and back again: memory gets short, and eases.
    const auto& packed = scene.step(frame / 25 % 2 == 0 ? 0.04 : -0.04);
    std::ranges::copy(packed, levels.mapped<std::uint32_t>().begin());
    levels.flush();
    context.run([&](const vk::raii::CommandBuffer& commands) { on_device.record(commands); });
    const LevelStats& modelled = model.select(packed, requests);
    std::vector<std::uint32_t> expected(walk.patches);
    for (const BlockRequest& r : requests) expected[value(r.patch)] = want_of(r);
    wants.invalidate();
    const auto got = wants.mapped<std::uint32_t>();
    ASSERT_TRUE(std::ranges::equal(got.first(walk.patches), expected)) << "frame " << frame;
    const LevelStats stats = on_device.stats();
    ASSERT_EQ(stats.bias, modelled.bias) << "frame " << frame;
    ASSERT_EQ(stats.texels, modelled.texels) << "frame " << frame;
    ASSERT_EQ(stats.visible, modelled.visible) << "frame " << frame;
    ASSERT_EQ(stats.demoted, modelled.demoted) << "frame " << frame;
    demoted += stats.demoted;
  }
  EXPECT_EQ(demoted != 0, walk.settings.hysteresis > 0 && walk.mean_log2 > 3);
}

INSTANTIATE_TEST_SUITE_P(Walks, DeviceSelectorWalk,
                         testing::Values(Walk{"pressed", level_settings(256, 0.25), 700, 9, 150},
                                         Walk{"without_hysteresis", level_settings(256, 0), 700, 9, 60},
                                         Walk{"strong_hysteresis", level_settings(128, 1), 2000, 6, 100},
                                         Walk{"room_to_spare", level_settings(512, 0.25), 500, 2, 60},
                                         Walk{"smallest_does_not_fit", level_settings(64, 0.25), 5000, 5, 60},
                                         Walk{"one_texel_blocks", level_settings(64, 0.5, 0), 3000, 4, 80}),
                         [](const auto& walk) { return std::string(walk.param.name); });

TEST_F(DeviceSelectorTest, FeedsTheDevicesMemoryInOneSubmission) {
  const LevelSettings settings = level_settings(256, 0.25);
  constexpr std::uint32_t kPatches = 700;
  const Buffer levels = words(kPatches);
  DeviceAllocator memory(device(), settings.allocator, kPatches, SlotOrder::kRanked, Residence::kDevice);
  const DeviceSelector on_device(device(), settings, kPatches, levels, memory.wants());
  LevelSelector model(settings, kPatches);
  const auto model_memory = make_sequential_allocator(settings.allocator, kPatches);
  DriftingProjections scene(kPatches, 9);
  SubmitContext context(device(), "both");
  std::vector<BlockRequest> requests;
  for (int frame = 0; frame < 100; ++frame) {
    const auto& packed = scene.step(frame / 25 % 2 == 0 ? 0.04 : -0.04);
    std::ranges::copy(packed, levels.mapped<std::uint32_t>().begin());
    levels.flush();
    context.run([&](const vk::raii::CommandBuffer& commands) {
      on_device.record(commands);
      memory.record(commands, frame % 5 == 0);
    });
    memory.collect();
    model.select(packed, requests);
    model_memory->update(requests, frame % 5 == 0);
    const auto got = memory.blocks();
    const auto expected = model_memory->blocks();
    ASSERT_TRUE(std::ranges::equal(
        got, expected, [](const auto& a, const auto& b) { return a.patch == b.patch && a.block == b.block; }))
        << "frame " << frame;
  }
}

TEST_F(DeviceSelectorTest, RejectsSettingsOutOfRange) {
  const Buffer levels = words(1);
  const Buffer wants = words(1);
  EXPECT_THROW(DeviceSelector(device(), level_settings(256, 2), 1, levels, wants), ProgramError);
}

}  // namespace
}  // namespace atlaswire::render
