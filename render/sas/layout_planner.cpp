#include "render/sas/layout_planner.h"

#include "render/atlas_gpu/device_allocator.h"
#include "render/atlas_gpu/device_selector.h"
#include "render/gpu/barriers.h"
#include "render/gpu/gpu_timer.h"

namespace atlaswire::render {
namespace {

class HostPlanner final : public LayoutPlanner {
 public:
  HostPlanner(const VisibilityPass& visibility, const LevelSettings& settings, std::uint32_t patch_count)
      : visibility_(&visibility),
        selector_(settings, patch_count),
        allocator_(make_sequential_allocator(settings.allocator, patch_count)) {}

  void record(const vk::raii::CommandBuffer&, bool) override {}
  const LayoutChange& finish(bool may_reset) override {
    stats_ = selector_.select(visibility_->levels(), requests_);
    return allocator_->update(requests_, may_reset);
  }
  [[nodiscard]] LevelStats levels() const override { return stats_; }
  [[nodiscard]] Duration device_time() const override { return Duration::zero(); }
  [[nodiscard]] const AtlasAllocator& allocator() const override { return *allocator_; }

 private:
  const VisibilityPass* visibility_;
  LevelSelector selector_;
  std::unique_ptr<AtlasAllocator> allocator_;
  std::vector<BlockRequest> requests_;
  LevelStats stats_;
};

class DevicePlanner final : public LayoutPlanner {
 public:
  DevicePlanner(Device& device, const VisibilityPass& visibility, const LevelSettings& settings,
                std::uint32_t patch_count)
      : allocator_(device, settings.allocator, patch_count, SlotOrder::kRanked, Residence::kDevice),
        selector_(device, settings, patch_count, visibility.level_words(), allocator_.wants()),
        timer_(device, "layout timer", 1) {}

  void record(const vk::raii::CommandBuffer& commands, bool may_reset) override {
    compute_to_compute(commands);
    timer_.reset(commands);
    timer_.begin(commands, "layout");
    selector_.record(commands);
    allocator_.record(commands, may_reset);
    timer_.end(commands);
  }
  const LayoutChange& finish(bool) override {
    device_time_ = Duration::zero();
    for (const auto& [stage, took] : timer_.collect()) device_time_ += took;
    return allocator_.collect();
  }
  [[nodiscard]] LevelStats levels() const override { return selector_.stats(); }
  [[nodiscard]] Duration device_time() const override { return device_time_; }
  [[nodiscard]] const AtlasAllocator& allocator() const override { return allocator_; }

 private:
  DeviceAllocator allocator_;
  DeviceSelector selector_;
  GpuTimer timer_;
  Duration device_time_{};
};

}  // namespace

std::unique_ptr<LayoutPlanner> make_layout_planner(Device& device, const VisibilityPass& visibility,
                                                   const LevelSettings& settings, std::uint32_t patch_count,
                                                   AllocatorKind kind) {
  const bool on_device = kind == AllocatorKind::kDevice || (kind == AllocatorKind::kAuto && !device.is_cpu());
  if (on_device) return std::make_unique<DevicePlanner>(device, visibility, settings, patch_count);
  return std::make_unique<HostPlanner>(visibility, settings, patch_count);
}

}  // namespace atlaswire::render
