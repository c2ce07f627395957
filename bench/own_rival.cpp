// The stream's own forms as rivals in the comparison.
#include "bench/codec_rival.h"
#include "bench/gate_profile.h"
#include "bench/update_check.h"
#include "client/layout_mirror.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace atlaswire::bench {

namespace {

class OwnRival final : public CodecRival {
 public:
  OwnRival(codec::MetaCodecKind kind, const MetaRecording& recording)
      : kind_(kind),
        encoder_(make_meta_encoder(kind, recording.limits)),
        decoder_(make_meta_decoder(kind, recording.limits)) {
    if (codec::keeps_state(kind)) profile_.emplace(recording.limits);
    if (codec::leaves_positions(kind)) {
      mirror_.emplace(recording.memory, recording.limits.atlas, recording.limits.max_patches);
    }
  }
  [[nodiscard]] std::string name() const override { return codec::name(kind_); }
  void encode(const Increment& increment) override {
    update_ = increment.update;
    bytes_.clear();
    encoder_->encode(*update_, bytes_);
    counted_ = false;
  }
  [[nodiscard]] UpdateCost cost() const override {
    if (!profile_) return {bytes_.size(), 0};
    if (!counted_) mesh_ = static_cast<std::size_t>(mesh_octets(profile_->encode(*update_)) + 0.5);
    counted_ = true;
    return {std::min(mesh_, bytes_.size()), bytes_.size() - std::min(mesh_, bytes_.size())};
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
  std::unique_ptr<codec::MetaEncoder> encoder_;
  std::unique_ptr<codec::MetaDecoder> decoder_;
  std::optional<client::LayoutMirror> mirror_;
  mutable std::optional<GateProfile> profile_;  // outside the timed calls
  mutable bool counted_ = false;
  mutable std::size_t mesh_ = 0;
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
