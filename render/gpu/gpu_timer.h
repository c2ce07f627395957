#pragma once

#include "base/time.h"
#include "render/gpu/device.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace atlaswire::render {

/// Times named stages of one submission on the device. Use one per frame in flight: reset() first in the
/// recording, begin/end around stages (not nested), collect() after the wait.
class GpuTimer {
 public:
  GpuTimer(const Device& device, const std::string& name, std::uint32_t max_stages);

  void reset(const vk::raii::CommandBuffer& commands);
  void begin(const vk::raii::CommandBuffer& commands, const std::string& stage);
  void end(const vk::raii::CommandBuffer& commands);
  /// Stages in the order of begin(); empty where the device has no timestamps.
  [[nodiscard]] std::vector<std::pair<std::string, Duration>> collect() const;

 private:
  std::uint32_t max_stages_;
  double nanos_per_tick_;
  vk::raii::QueryPool pool_;
  std::vector<std::string> stages_;
};

}  // namespace atlaswire::render
