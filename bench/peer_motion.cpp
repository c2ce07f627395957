#include "bench/peer_motion.h"

#include <stdexcept>

namespace atlaswire::bench {

namespace {

/// Both ends of numbers in rows.
class Side {
 public:
  Side(MotionPacking packing, int order, std::uint32_t width)
      : packing_(packing), order_(order), width_(width) {}
  void encode(const std::vector<std::int32_t>& numbers, bool reset) {
    if (reset || !peer_) peer_ = make_motion_peer(packing_, order_, width_);
    bytes_.clear();
    heard_.resize(numbers.size());
    if (!numbers.empty()) peer_->encode(numbers, bytes_);
  }
  void decode() {
    if (!heard_.empty()) peer_->decode(bytes_, heard_);
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] const std::vector<std::int32_t>& heard() const { return heard_; }

 private:
  MotionPacking packing_;
  int order_;
  std::uint32_t width_;
  std::unique_ptr<MotionPeer> peer_;  ///< since the last reset
  ByteBuffer bytes_;
  std::vector<std::int32_t> heard_;
};

class PeerMotion final : public MotionRival {
 public:
  PeerMotion(MotionPacking packing, int order)
      : vertices_(packing, order, 3), objects_(MotionPacking::kZstd, order, 7) {}
  void encode(const MotionStep& step) override {
    vertices_.encode(step.vertices, step.update->reset);
    objects_.encode(step.objects, step.update->reset);
  }
  [[nodiscard]] std::size_t size() const override { return vertices_.size() + objects_.size(); }
  void decode(const codec::MetaUpdate&) override {
    vertices_.decode();
    objects_.decode();
  }
  void check(const MotionStep& step) const override {
    if (vertices_.heard() != step.vertices || objects_.heard() != step.objects)
      throw std::runtime_error("a peer's motion differs");
  }

 private:
  Side vertices_;
  Side objects_;
};

}  // namespace

std::unique_ptr<MotionRival> make_peer_motion(MotionPacking packing, int order) {
  return std::make_unique<PeerMotion>(packing, order);
}

}  // namespace atlaswire::bench
