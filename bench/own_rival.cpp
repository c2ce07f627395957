// The stream's own forms as rivals in the comparison.
#include "bench/codec_rival.h"
#include "bench/gate_profile.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace atlaswire::bench {

namespace {

class OwnRival final : public CodecRival {
 public:
  OwnRival(codec::MetaCodecKind kind, const codec::MetaLimits& limits)
      : kind_(kind), encoder_(make_meta_encoder(kind, limits)), decoder_(make_meta_decoder(kind, limits)) {
    if (kind == codec::MetaCodecKind::kGate || kind == codec::MetaCodecKind::kMirror) {
      profile_.emplace(limits);
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
    if (!decoder_->decode(bytes_)) throw std::runtime_error(name() + " would not decode");
  }

 private:
  codec::MetaCodecKind kind_;
  std::unique_ptr<codec::MetaEncoder> encoder_;
  std::unique_ptr<codec::MetaDecoder> decoder_;
  mutable std::optional<GateProfile> profile_;  // outside the timed calls
  mutable bool counted_ = false;
  mutable std::size_t mesh_ = 0;
  const codec::MetaUpdate* update_ = nullptr;
  ByteBuffer bytes_;
};

}  // namespace

std::unique_ptr<CodecRival> make_own_rival(codec::MetaCodecKind kind, const codec::MetaLimits& limits) {
  return std::make_unique<OwnRival>(kind, limits);
}

}  // namespace atlaswire::bench
