#include "render/gpu/submit_context.h"

#include "base/assert.h"
#include "base/program.h"

#include <algorithm>

namespace atlaswire::render {
namespace {

vk::raii::Semaphore make_timeline(const Device& device) {
  const vk::SemaphoreTypeCreateInfo type{.semaphoreType = vk::SemaphoreType::eTimeline, .initialValue = 0};
  return {device.vk(), {.pNext = &type}};
}

}  // namespace

SubmitContext::SubmitContext(Device& device, const std::string& name, std::uint32_t in_flight)
    : device_(&device),
      name_(name),
      pool_(device.vk(), {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                          .queueFamilyIndex = device.queue_family()}),
      buffers_(device.vk(),
               {.commandPool = *pool_, .commandBufferCount = std::max<std::uint32_t>(in_flight, 1)}),
      timeline_(make_timeline(device)),
      last_use_(buffers_.size(), 0) {
  device.set_name(pool_, name + " commands");
  device.set_name(timeline_, name + " timeline");
}

SubmitContext::~SubmitContext() {
  try {
    wait(Ticket{submitted_});
  } catch (const std::exception&) {
    // The device is lost: nothing of it can still use what dies here.
  }
}

const vk::raii::CommandBuffer& SubmitContext::begin() {
  AW_ASSERT(!recording_);
  current_ = (current_ + 1) % buffers_.size();
  wait(Ticket{last_use_[current_]});
  buffers_[current_].reset();
  buffers_[current_].begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  recording_ = true;
  return buffers_[current_];
}

Ticket SubmitContext::submit() {
  AW_ASSERT(recording_);
  recording_ = false;
  buffers_[current_].end();
  const vk::CommandBufferSubmitInfo commands{.commandBuffer = *buffers_[current_]};
  const vk::SemaphoreSubmitInfo signal{.semaphore = *timeline_,
                                       .value = submitted_ + 1,
                                       .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
  device_->submit({.commandBufferInfoCount = 1,
                   .pCommandBufferInfos = &commands,
                   .signalSemaphoreInfoCount = 1,
                   .pSignalSemaphoreInfos = &signal});
  last_use_[current_] = ++submitted_;
  return Ticket{submitted_};
}

void SubmitContext::wait(Ticket ticket, Duration timeout) const {
  const auto target = static_cast<std::uint64_t>(ticket);
  const vk::SemaphoreWaitInfo info{.semaphoreCount = 1, .pSemaphores = &*timeline_, .pValues = &target};
  if (device_->vk().waitSemaphores(info, static_cast<std::uint64_t>(timeout.count())) !=
      vk::Result::eSuccess) {
    throw ProgramError(ExitCode::kInternal, "Vulkan device '" + device_->name() + "' did not finish " +
                                                name_ + " in " + std::to_string(to_seconds(timeout)) +
                                                " s: it hangs or is overloaded");
  }
}

bool SubmitContext::done(Ticket ticket) const {
  return timeline_.getCounterValue() >= static_cast<std::uint64_t>(ticket);
}

void SubmitContext::run(const std::function<void(const vk::raii::CommandBuffer&)>& record) {
  record(begin());
  wait(submit());
}

}  // namespace atlaswire::render
