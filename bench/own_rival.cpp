// The stream's own forms as rivals in the comparison.
#include "bench/codec_rival.h"
#include "bench/gate_profile.h"
#include "bench/update_check.h"
#include "client/layout_mirror.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

namespace atlaswire::bench {

namespace {

class OwnRival final : public CodecRival {
 public:
  OwnRival(codec::MetaCodecKind kind, const MetaRecording& recording)
      : kind_(kind),
        limits_(recording.limits),
        encoder_(make_meta_encoder(kind, recording.limits)),
        decoder_(make_meta_decoder(kind, recording.limits)) {
    if (codec::leaves_positions(kind)) {
      mirror_.emplace(recording.memory, recording.limits.atlas, recording.limits.max_patches);
    }
  }
  [[nodiscard]] std::string name() const override { return codec::name(kind_); }
  void encode(const Increment& increment) override {
    update_ = increment.update;
    bytes_.clear();
    encoder_->encode(*update_, bytes_);
  }
  [[nodiscard]] UpdateCost cost() const override { return {bytes_.size(), 0}; }
  void split(const std::vector<codec::MetaUpdate>& updates, std::vector<UpdateCost>& costs) const override {
    if (!codec::keeps_state(kind_)) return;
    GateProfile profile(limits_);
    for (std::size_t i = 0; i < updates.size(); ++i) {
      const std::size_t all = costs[i].mesh;
      const auto mesh = static_cast<std::size_t>(mesh_octets(profile.encode(updates[i])) + 0.5);
      costs[i] = {std::min(mesh, all), all - std::min(mesh, all)};
    }
  }
  void decode() override {
    auto heard = decoder_->decode(bytes_);
    if (!heard) throw std::runtime_error(name() + " would not decode: " + heard.error().message());
    heard_ = std::move(*heard);
  }
  [[nodiscard]] const codec::MetaUpdate& heard() const override { return heard_; }
  void check() override { check_.compare(*update_, heard_); }
  void place() override {
    if (!mirror_) return;
    auto placed = mirror_->place(std::move(heard_));
    if (!placed) throw std::runtime_error(name() + " would not place: " + placed.error().message());
    heard_ = std::move(*placed);
  }
  [[nodiscard]] MotionRivals motions(const RecordedMotion& motion) const override {
    MotionRivals rivals;
    rivals.push_back(kind_ == codec::MetaCodecKind::kPaper ? make_paper_motion(motion)
                                                           : make_own_motion(motion));
    return rivals;
  }

 private:
  codec::MetaCodecKind kind_;
  codec::MetaLimits limits_;
  std::unique_ptr<codec::MetaEncoder> encoder_;
  std::unique_ptr<codec::MetaDecoder> decoder_;
  std::optional<client::LayoutMirror> mirror_;
  const codec::MetaUpdate* update_ = nullptr;
  ByteBuffer bytes_;
  codec::MetaUpdate heard_;
  UpdateCheck check_;
};

}  // namespace

std::unique_ptr<CodecRival> make_own_rival(codec::MetaCodecKind kind, const MetaRecording& recording) {
  return std::make_unique<OwnRival>(kind, recording);
}

}  // namespace atlaswire::bench
