#include "render/sas/layout_planner.h"

#include "render/atlas/admission.h"
#include "render/atlas_gpu/device_allocator.h"
#include "render/atlas_gpu/device_selector.h"
#include "render/gpu/barriers.h"
#include "render/gpu/gpu_timer.h"

namespace atlaswire::render {
namespace {

class HostPlanner final : public LayoutPlanner {
 public:
  HostPlanner(const VisibilityPass& visibility, const LevelSettings& settings, std::uint32_t patch_count,
              Strategy strategy, std::uint32_t most_new)
      : visibility_(&visibility),
        selector_(settings, patch_count),
        admission_(most_new, patch_count),
        allocator_(make_allocator(strategy, settings.allocator, patch_count)) {}

  void record(const vk::raii::CommandBuffer&, bool) override {}
  const LayoutChange& finish(bool may_reset) override {
    stats_ = selector_.select(visibility_->levels(), requests_);
    waiting_ = admission_.admit(requests_);
    return allocator_->update(requests_, may_reset);
  }
  void restart() override {
    admission_.restart();
    allocator_->restart();
  }
  [[nodiscard]] std::uint32_t waiting() const override { return waiting_; }
  [[nodiscard]] std::span<const BlockRequest> requests() const override { return requests_; }
  [[nodiscard]] LevelStats levels() const override { return stats_; }
  [[nodiscard]] Duration device_time() const override { return Duration::zero(); }
  [[nodiscard]] const AtlasAllocator& allocator() const override { return *allocator_; }

 private:
  const VisibilityPass* visibility_;
  LevelSelector selector_;
  Admission admission_;
  std::uint32_t waiting_ = 0;
  std::unique_ptr<AtlasAllocator> allocator_;
  std::vector<BlockRequest> requests_;
  LevelStats stats_;
};

class DevicePlanner final : public LayoutPlanner {
 public:
  DevicePlanner(Device& device, const VisibilityPass& visibility, const LevelSettings& settings,
                std::uint32_t patch_count, std::uint32_t most_new)
      : allocator_(device, settings.allocator, patch_count, SlotOrder::kRanked, Residence::kDevice, most_new),
        selector_(device, settings, patch_count, visibility.level_words(), allocator_.wants()),
        wants_(device, {.name = "wants, read back",
                        .size = allocator_.wants().size(),
                        .usage = vk::BufferUsageFlagBits::eTransferDst,
                        .residence = Residence::kReadback}),
        timer_(device, "layout timer", 1) {}

  void record(const vk::raii::CommandBuffer& commands, bool may_reset) override {
    compute_to_compute(commands);
    timer_.reset(commands);
    timer_.begin(commands, "layout");
    selector_.record(commands);
    allocator_.record(commands, may_reset);
    shaders_to_transfer(commands);
    const vk::BufferCopy all{.size = wants_.size()};
    commands.copyBuffer(allocator_.wants().handle(), wants_.handle(), all);
    writes_to_host(commands);
    timer_.end(commands);
  }
  const LayoutChange& finish(bool) override {
    device_time_ = Duration::zero();
    for (const auto& [stage, took] : timer_.collect()) device_time_ += took;
    read_wants();
    return allocator_.collect();
  }
  void restart() override { allocator_.restart(); }
  [[nodiscard]] std::uint32_t waiting() const override { return allocator_.waiting(); }
  [[nodiscard]] std::span<const BlockRequest> requests() const override { return requests_; }
  [[nodiscard]] LevelStats levels() const override { return selector_.stats(); }
  [[nodiscard]] Duration device_time() const override { return device_time_; }
  [[nodiscard]] const AtlasAllocator& allocator() const override { return allocator_; }

 private:
  void read_wants() {
    wants_.invalidate();
    requests_.clear();
    const auto words = wants_.mapped<const std::uint32_t>();
    for (std::uint32_t patch = 0; patch < words.size(); ++patch) {
      const std::uint32_t want = words[patch];
      if (want == 0) continue;
      requests_.push_back({.patch = PatchId{patch},
                           .width_log2 = static_cast<std::uint8_t>((want & alloc::kSidesMask) >> 4),
                           .height_log2 = static_cast<std::uint8_t>(want & 15),
                           .transposed = (want & alloc::kTransposed) != 0});
    }
  }

  DeviceAllocator allocator_;
  DeviceSelector selector_;
  Buffer wants_;  ///< the frame's, for the host
  std::vector<BlockRequest> requests_;
  GpuTimer timer_;
  Duration device_time_{};
};

}  // namespace

std::unique_ptr<LayoutPlanner> make_layout_planner(Device& device, const VisibilityPass& visibility,
                                                   const LevelSettings& settings, std::uint32_t patch_count,
                                                   AllocatorKind kind, Strategy strategy,
                                                   std::uint32_t most_new) {
  const bool on_device = kind == AllocatorKind::kDevice || (kind == AllocatorKind::kAuto && !device.is_cpu());
  if (on_device && strategy == Strategy::kS0)
    return std::make_unique<DevicePlanner>(device, visibility, settings, patch_count, most_new);
  return std::make_unique<HostPlanner>(visibility, settings, patch_count, strategy, most_new);
}

}  // namespace atlaswire::render
