#include "bench/gate_profile.h"

#include "codec/gate_script.h"

#include <cmath>
#include <optional>

namespace atlaswire::bench {

namespace {

using codec::AdaptiveBit;
using codec::GateModels;

/// Counts where a RangeEncoder would write. A decision's topic is told by where its model lies; raw bits go
/// with the decision before them.
class CountingCoder {
 public:
  static constexpr bool kEncodes = true;

  CountingCoder(const GateModels& models, GateProfile::Bits& bits) : models_(&models), bits_(&bits) {}

  bool code(AdaptiveBit& model, bool bit) {
    topic_ = topic_of(model);
    const double no = model.probability_of_false() / double{AdaptiveBit::kOne};
    add(-std::log2(bit ? 1 - no : no));
    model.update(bit);
    return bit;
  }
  std::uint32_t code_raw(std::uint32_t value, std::uint32_t count) {
    if (count == 32 || count == 16) topic_ = GateTopic::kHead;  // frame, hash
    add(count);
    return value;
  }

 private:
  void add(double bits) { (*bits_)[static_cast<std::size_t>(topic_)] += bits; }
  template <class Member>
  static bool lies_in(const Member& member, const AdaptiveBit& model) {
    const auto* begin = reinterpret_cast<const std::byte*>(&member);
    const auto* at = reinterpret_cast<const std::byte*>(&model);
    return at >= begin && at < begin + sizeof(Member);
  }
  [[nodiscard]] GateTopic topic_of(const AdaptiveBit& model) const {
    const GateModels& m = *models_;
    const auto in = [&](const auto&... members) { return (lies_in(members, model) || ...); };
    if (in(m.calm_group, m.flip)) return GateTopic::kPresence;
    if (in(m.gap, m.new_patches)) return GateTopic::kIds;
    if (in(m.triangles, m.turn)) return GateTopic::kGrouping;
    if (in(m.gate, m.attached)) return GateTopic::kGates;
    if (in(m.corner)) return GateTopic::kCorners;
    if (in(m.position)) return GateTopic::kResiduals;
    if (in(m.draw)) return GateTopic::kClasses;
    if (in(m.change_group, m.change, m.changed_level, m.shown_level, m.new_level)) return GateTopic::kLevels;
    if (in(m.aligned, m.block_x, m.block_y)) return GateTopic::kPositions;
    return GateTopic::kHead;
  }

  const GateModels* models_;
  GateProfile::Bits* bits_;
  GateTopic topic_ = GateTopic::kHead;
};

}  // namespace

GateProfile::GateProfile(const codec::MetaLimits& limits) : limits_(limits), state_(0) {}

GateProfile::Bits GateProfile::encode(const codec::MetaUpdate& update) {
  Bits bits{};
  if (update.reset) state_.clear();
  plan_.begin(update, state_);
  CountingCoder coder(state_.models, bits);
  std::optional<codec::LayoutCue> cue = update.cue;
  codec::GateScript<CountingCoder>(coder, state_, limits_, ~0U, cue ? &*cue : nullptr, &plan_)
      .code(update.reset, nullptr);
  return bits;
}

double mesh_octets(const GateProfile::Bits& bits) {
  double sum = 1;  // the form's octet
  for (std::size_t i = 0; i < static_cast<std::size_t>(GateTopic::kClasses); ++i) sum += bits[i] / 8;
  return sum;
}

}  // namespace atlaswire::bench
