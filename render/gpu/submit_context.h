#pragma once

#include "base/time.h"
#include "render/gpu/device.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace atlaswire::render {

/// A point on a submitter's timeline.
enum class Ticket : std::uint64_t {};

/// Records and submits command buffers, and waits for them: a command pool, a timeline semaphore and a few
/// command buffers in rotation. One thread at a time; several contexts may share a device.
class SubmitContext {
 public:
  /// `in_flight`: command buffers that may be pending at once, >= 1.
  SubmitContext(Device& device, const std::string& name, std::uint32_t in_flight = 3);
  /// Waits for all that was submitted.
  ~SubmitContext();
  SubmitContext(const SubmitContext&) = delete;
  SubmitContext& operator=(const SubmitContext&) = delete;

  /// Starts recording; waits if every command buffer is pending. End with submit().
  const vk::raii::CommandBuffer& begin();
  /// Submits what begin() started.
  Ticket submit();
  /// Blocks until the ticket's work is done. Throws ProgramError(kInternal) when `timeout` passes first
  /// or the device is lost.
  void wait(Ticket ticket, Duration timeout = std::chrono::seconds(30)) const;
  [[nodiscard]] bool done(Ticket ticket) const;

  /// Records, submits and waits: for set-up and tests.
  void run(const std::function<void(const vk::raii::CommandBuffer&)>& record);

  [[nodiscard]] Device& device() const { return *device_; }

 private:
  Device* device_;
  std::string name_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers buffers_;
  vk::raii::Semaphore timeline_;
  std::vector<std::uint64_t> last_use_;  ///< ticket of each command buffer
  std::uint64_t submitted_ = 0;
  std::size_t current_ = 0;
  bool recording_ = false;
};

}  // namespace atlaswire::render
