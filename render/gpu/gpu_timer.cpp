#include "render/gpu/gpu_timer.h"

#include "base/assert.h"

#include <cmath>

namespace atlaswire::render {

GpuTimer::GpuTimer(const Device& device, const std::string& name, std::uint32_t max_stages)
    : max_stages_(max_stages),
      nanos_per_tick_(device.limits().timestampComputeAndGraphics == VK_TRUE
                          ? static_cast<double>(device.limits().timestampPeriod)
                          : 0.0),
      pool_(device.vk(), {.queryType = vk::QueryType::eTimestamp, .queryCount = 2 * max_stages}) {
  device.set_name(pool_, name);
}

void GpuTimer::reset(const vk::raii::CommandBuffer& commands) {
  commands.resetQueryPool(*pool_, 0, 2 * max_stages_);
  stages_.clear();
}

void GpuTimer::begin(const vk::raii::CommandBuffer& commands, const std::string& stage) {
  AW_ASSERT(stages_.size() < max_stages_);
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_,
                           static_cast<std::uint32_t>(2 * stages_.size()));
  stages_.push_back(stage);
}

void GpuTimer::end(const vk::raii::CommandBuffer& commands) {
  AW_ASSERT(!stages_.empty());
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_,
                           static_cast<std::uint32_t>(2 * stages_.size() - 1));
}

std::vector<std::pair<std::string, Duration>> GpuTimer::collect() const {
  std::vector<std::pair<std::string, Duration>> times;
  if (nanos_per_tick_ == 0.0 || stages_.empty()) return times;
  const std::size_t count = 2 * stages_.size();
  const auto [result, ticks] = pool_.getResults<std::uint64_t>(
      0, static_cast<std::uint32_t>(count), count * sizeof(std::uint64_t), sizeof(std::uint64_t),
      vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  if (result != vk::Result::eSuccess) return times;
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    const auto elapsed = static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]) * nanos_per_tick_;
    times.emplace_back(stages_[i], Duration{std::llround(elapsed)});
  }
  return times;
}

}  // namespace atlaswire::render
