#pragma once

#include "proto/wire_error.h"
#include "server/stream_source.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>

namespace atlaswire::server {

/// Frames without pixels: one NAL unit and a few meta octets, I-frames when asked. Watches the order that
/// FrameMaker demands.
class FakeStream final : public FrameMaker {
 public:
  struct Watch {
    std::atomic<std::uint32_t> rendered{0};
    std::atomic<std::uint32_t> encoded{0};
    std::atomic<std::uint32_t> intra{0};
    std::atomic<std::uint32_t> restarts{0};
    std::atomic<bool> order_broken{false};
    std::atomic<double> eye_separation{0};  ///< that the last frame was asked for
    std::atomic<double> scene_seconds{-1};  ///< likewise; -1: at rest
    std::atomic<double> foveation{-1};      ///< that the last emphasis asked for; -2: it did not say
    std::atomic<std::size_t> priorities{0};
    std::atomic<std::uint32_t> emphases{0};
    std::atomic<std::uint32_t> fail_render_at{~0U};
    std::atomic<std::uint32_t> fail_encode_at{~0U};
  };

  explicit FakeStream(Watch& watch, std::size_t octets = 20'000) : watch_(watch), octets_(octets) {}

  PreparedFrame render(const ViewRequest& request) override {
    const std::uint32_t n = count_++;
    if (n >= 2 && encoded_ < n - 1) watch_.order_broken = true;
    if (n == watch_.fail_render_at) throw std::runtime_error("device lost");
    PreparedFrame prepared;
    prepared.pose = request.pose;
    prepared.stamps.pose_received = request.pose_received;
    prepared.intra = request.restart || request.refresh || n % 5 == 0;
    prepared.rendered.frame = FrameId{n};
    watch_.eye_separation = request.hints.eye_separation;
    watch_.scene_seconds = scene_seconds(request).value_or(-1);
    if (request.emphasis) {
      watch_.foveation = request.emphasis->foveation.value_or(-2);
      watch_.priorities = request.emphasis->priorities.size();
      ++watch_.emphases;
    }
    if (request.layout) prepared.layout.emplace(Extent2D{8, 8}, render::Rgba8{1, 2, 3, 255});
    ++watch_.rendered;
    if (prepared.intra) ++watch_.intra;
    if (request.restart) ++watch_.restarts;
    return prepared;
  }

  Result<EncodedFrame> encode(PreparedFrame prepared) override {
    const std::uint32_t n = value(prepared.rendered.frame);
    if (n != encoded_) watch_.order_broken = true;
    ++encoded_;
    ++watch_.encoded;
    if (n == watch_.fail_encode_at) return Error(proto::WireError::kMalformed);
    EncodedFrame frame;
    frame.frame = prepared.rendered.frame;
    frame.pose = prepared.pose;
    frame.idr = prepared.intra;
    frame.stamps = prepared.stamps;
    frame.video.assign(octets_, std::byte{0x33});
    for (std::size_t i = 0; i < 3; ++i) frame.video[i] = std::byte{0};
    frame.video[3] = std::byte{1};
    frame.video[4] = std::byte{frame.idr ? std::uint8_t{0x65} : std::uint8_t{0x41}};
    frame.meta.assign(100, std::byte{7});
    return frame;
  }

 private:
  Watch& watch_;
  std::size_t octets_;
  std::uint32_t count_ = 0;
  std::atomic<std::uint32_t> encoded_{0};
};

/// Hands out fake streams.
class FakeSource final : public StreamSource {
 public:
  FakeSource() {
    description_.scene = "fake";
    description_.picture = description_.atlas = {256, 256};
  }
  std::unique_ptr<FrameMaker> make() override {
    ++made;
    if (fail_to_make) throw std::runtime_error("no memory on the device");
    return std::make_unique<FakeStream>(watch, octets);
  }
  void give_back(std::unique_ptr<FrameMaker> /*maker*/) override { ++given_back; }
  [[nodiscard]] const proto::StreamDescription& description() const override { return description_; }
  [[nodiscard]] ByteBuffer parameter_sets() const override { return {}; }

  FakeStream::Watch watch;
  std::size_t octets = 20'000;
  std::atomic<bool> fail_to_make{false};
  std::atomic<unsigned> made{0};
  std::atomic<unsigned> given_back{0};

 private:
  proto::StreamDescription description_;
};

}  // namespace atlaswire::server
