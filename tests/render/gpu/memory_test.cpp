#include "base/program.h"
#include "render/gpu/barriers.h"
#include "render/gpu/gpu_timer.h"
#include "render/gpu/image.h"
#include "render/gpu/submit_context.h"
#include "tests/render/gpu/gpu_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace atlaswire::render {
namespace {

using Usage = vk::BufferUsageFlagBits;

class Memory : public test::GpuTest {};

TEST_F(Memory, BufferRoundTripKeepsEveryByte) {
  constexpr std::size_t kBytes = 100'003;
  SubmitContext context(device(), "round trip");
  const Buffer up(
      device(),
      {.name = "up", .size = kBytes, .usage = Usage::eTransferSrc, .residence = Residence::kUpload});
  const Buffer local(device(),
                     {.name = "local", .size = kBytes, .usage = Usage::eTransferSrc | Usage::eTransferDst});
  const Buffer down(
      device(),
      {.name = "down", .size = kBytes, .usage = Usage::eTransferDst, .residence = Residence::kReadback});
  for (std::size_t i = 0; i < kBytes; ++i) up.mapped<std::uint8_t>()[i] = static_cast<std::uint8_t>(i * 7);
  up.flush();
  context.run([&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(up.handle(), local.handle(), vk::BufferCopy{.size = kBytes});
    shaders_to_transfer(commands);
    commands.copyBuffer(local.handle(), down.handle(), vk::BufferCopy{.size = kBytes});
    writes_to_host(commands);
  });
  down.invalidate();
  EXPECT_TRUE(std::ranges::equal(up.mapped(), down.mapped()));
  EXPECT_TRUE(local.mapped().empty());
}

TEST_F(Memory, ImageRoundTripThroughLinearImage) {
  const Extent2D extent{37, 19};
  SubmitContext context(device(), "image");
  using ImageUsage = vk::ImageUsageFlagBits;
  Image image(
      device(),
      {.name = "optimal", .extent = extent, .usage = ImageUsage::eTransferSrc | ImageUsage::eTransferDst});
  Image linear(device(), {.name = "linear",
                          .extent = extent,
                          .usage = ImageUsage::eTransferDst,
                          .residence = Residence::kReadback});
  const Buffer up(device(), {.name = "texels",
                             .size = extent.area() * 4,
                             .usage = Usage::eTransferSrc,
                             .residence = Residence::kUpload});
  std::iota(up.mapped<std::uint32_t>().begin(), up.mapped<std::uint32_t>().end(), 0x01020300U);
  up.flush();
  const vk::ImageSubresourceLayers layers{.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1};
  const vk::Extent3D size{extent.width, extent.height, 1};
  context.run([&](const vk::raii::CommandBuffer& commands) {
    use_image(commands, image, ImageUse::kTransferTarget);
    commands.copyBufferToImage(up.handle(), image.handle(), image.layout(),
                               vk::BufferImageCopy{.imageSubresource = layers, .imageExtent = size});
    use_image(commands, image, ImageUse::kTransferSource);
    use_image(commands, linear, ImageUse::kTransferTarget);
    commands.copyImage(image.handle(), image.layout(), linear.handle(), linear.layout(),
                       vk::ImageCopy{.srcSubresource = layers, .dstSubresource = layers, .extent = size});
    use_image(commands, linear, ImageUse::kHostRead);
  });
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    EXPECT_EQ(std::memcmp(linear.mapped() + y * linear.row_pitch(), up.mapped().data() + y * extent.width * 4,
                          extent.width * 4),
              0)
        << "row " << y;
  }
}

TEST_F(Memory, SubmissionsFinishInOrderAndReuseCommandBuffers) {
  SubmitContext context(device(), "many", 2);
  const Buffer counter(
      device(),
      {.name = "words", .size = 4 * 64, .usage = Usage::eTransferDst, .residence = Residence::kReadback});
  Ticket last{};
  for (std::uint32_t i = 0; i < 64; ++i) {
    const auto& commands = context.begin();
    commands.fillBuffer(counter.handle(), 4 * i, 4, i + 1);
    writes_to_host(commands);
    last = context.submit();
  }
  context.wait(last);
  EXPECT_TRUE(context.done(last));
  counter.invalidate();
  for (std::uint32_t i = 0; i < 64; ++i) EXPECT_EQ(counter.mapped<std::uint32_t>()[i], i + 1);
}

TEST_F(Memory, WaitingForWhatNeverComesIsAnError) {
  SubmitContext context(device(), "late");
  EXPECT_THROW(context.wait(Ticket{1}, std::chrono::milliseconds(1)), ProgramError);
}

TEST_F(Memory, TimerNamesItsStagesInOrder) {
  SubmitContext context(device(), "timed");
  GpuTimer timer(device(), "timer", 4);
  const Buffer big(device(), {.name = "big", .size = 1 << 22, .usage = Usage::eTransferDst});
  context.run([&](const vk::raii::CommandBuffer& commands) {
    timer.reset(commands);
    timer.begin(commands, "nothing");
    timer.end(commands);
    timer.begin(commands, "fill");
    commands.fillBuffer(big.handle(), 0, VK_WHOLE_SIZE, 42);
    timer.end(commands);
  });
  const auto times = timer.collect();
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0].first, "nothing");
  EXPECT_EQ(times[1].first, "fill");
  EXPECT_GE(times[0].second.count(), 0);
  EXPECT_GT(times[1].second.count(), 0);
}

}  // namespace
}  // namespace atlaswire::render
