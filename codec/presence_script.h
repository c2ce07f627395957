#pragma once

#include "codec/gate_state.h"
#include "codec/level_script.h"
#include "codec/resident_outlook.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// A known patch that comes back, or gets another block.
struct Placement {
  enum class Why : std::uint8_t { kShown, kChanged };
  std::uint32_t resident = 0;  ///< index
  Why why = Why::kShown;
  Block block;  ///< size and mirroring, until the position is coded
};

/// Which known patches come, go, and change their block, decision by decision, the same for both directions.
/// docs/PROTOCOL.md, "Presence". Patches are taken in groups of eight, so that a group where nothing has
/// happened for long costs one decision.
template <class Coder>
class PresenceScript {
 public:
  /// `targets`, only when encoding: what block each resident is to have, null where it is to be hidden.
  PresenceScript(Coder& coder, GateState& state, std::span<const Block* const> targets)
      : coder_(&coder), state_(&state), models_(&state.models), targets_(targets) {}

  /// Appends, ascending, indices of residents that go, and those that come or change. False: nonsense was
  /// decoded.
  bool code(std::vector<std::uint32_t>& hidden, std::vector<Placement>& placements);

 private:
  /// Of one group, a bit each: visible before, and coming or going now.
  struct Flips {
    std::uint32_t was_visible = 0;
    std::uint32_t flip = 0;
    [[nodiscard]] std::uint32_t stay() const { return was_visible & ~flip; }
  };

  Flips code_flips(std::uint32_t first, std::uint32_t count);
  bool code_changes(std::uint32_t first, const Flips& flips);
  bool place(std::uint32_t resident, Placement::Why why);
  [[nodiscard]] const Block* target(std::uint32_t resident) const {
    return Coder::kEncodes ? targets_[resident] : nullptr;
  }
  [[nodiscard]] bool wants_flip(std::uint32_t resident) const {
    return Coder::kEncodes && (target(resident) != nullptr) != state_->residents.visible(resident);
  }
  [[nodiscard]] bool wants_change(std::uint32_t resident) const {
    const Block* const wanted = target(resident);
    const Block* const has = &state_->residents.block(resident);
    return wanted != nullptr && wanted != has && *wanted != *has;
  }
  /// Whether an encoder wants `what` of any resident whose bit is set.
  template <class Want>
  [[nodiscard]] bool wants_any(std::uint32_t bits, Want what) const {
    if (!Coder::kEncodes) return false;
    for (; bits != 0; bits &= bits - 1) {
      if (what(static_cast<std::uint32_t>(std::countr_zero(bits)))) return true;
    }
    return false;
  }
  static std::uint32_t age_of(std::uint8_t calm) {
    return static_cast<std::uint32_t>(calm >= 16) + static_cast<std::uint32_t>(calm >= 32);
  }
  static std::uint32_t next_flow(std::uint32_t flow, bool yes) { return yes ? 2 : flow == 2 ? 1 : 0; }

  Coder* coder_;
  GateState* state_;
  GateModels* models_;
  std::span<const Block* const> targets_;
  std::vector<std::uint32_t>* hidden_ = nullptr;
  std::vector<Placement>* placements_ = nullptr;
  std::uint32_t before_ = 0;  ///< the patch before: visible, and twice whether it came or went
  std::uint32_t calm_flow_ = 0;
  std::uint32_t change_flow_ = 0;
};

template <class Coder>
bool PresenceScript<Coder>::code(std::vector<std::uint32_t>& hidden, std::vector<Placement>& placements) {
  hidden_ = &hidden;
  placements_ = &placements;
  const std::uint32_t size = state_->residents.size();
  for (std::uint32_t first = 0; first < size; first += ResidentSet::kGroup) {
    const std::uint32_t count = std::min(size - first, ResidentSet::kGroup);
    const Flips flips = code_flips(first, count);
    state_->residents.note(first, count, flips.flip);
    if (!code_changes(first, flips)) return false;
  }
  return true;
}

template <class Coder>
typename PresenceScript<Coder>::Flips PresenceScript<Coder>::code_flips(std::uint32_t first,
                                                                        std::uint32_t count) {
  const ResidentSet& residents = state_->residents;
  Flips flips{.was_visible = residents.visible_in(first, count)};
  if (const std::uint32_t calm = residents.calm_in(first, count); calm > 0) {
    const std::uint32_t all = (1U << count) - 1;
    const std::uint32_t seen = flips.was_visible == 0 ? 0 : flips.was_visible == all ? 2 : 1;
    const bool any = coder_->code(models_->calm_group[((calm_flow_ * 3 + calm - 1) * 3 + seen) * 4 + before_],
                                  wants_any(all, [&](auto i) { return wants_flip(first + i); }));
    calm_flow_ = next_flow(calm_flow_, any);
    if (!any) {
      before_ = flips.was_visible >> (count - 1);
      return flips;
    }
  }
  const bool follows = first + count < residents.size() && residents.visible(first + count);
  std::uint32_t visible = flips.was_visible | static_cast<std::uint32_t>(follows) << count;
  for (std::uint32_t i = 0; i < count; ++i, visible >>= 1U) {
    const std::uint32_t context = ResidentOutlook::of(residents, first + i, visible >> 1U & 1U) * 4 + before_;
    before_ = visible & 1U;
    // A branch, so that processors guess it and go on with the next context.
    if (coder_->code(models_->flip[context], wants_flip(first + i))) [[unlikely]] {
      before_ = 3 - before_;
      flips.flip |= 1U << i;
    }
  }
  return flips;
}

template <class Coder>
bool PresenceScript<Coder>::code_changes(std::uint32_t first, const Flips& flips) {
  std::uint32_t asked = flips.stay();
  if (asked != 0) {
    const bool any = coder_->code(models_->change_group[change_flow_],
                                  wants_any(asked, [&](auto i) { return wants_change(first + i); }));
    change_flow_ = next_flow(change_flow_, any);
    if (!any) asked = 0;
  }
  std::uint32_t flow = 0;
  bool found = false;
  for (std::uint32_t left = flips.flip | asked; left != 0; left &= left - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
    const std::uint32_t resident = first + i;
    if ((asked >> i & 1U) != 0) {
      const auto behind = static_cast<std::uint32_t>(std::popcount(asked >> i)) - 1;
      const std::uint32_t context =
          ((age_of(state_->residents.calm(resident)) * 3 + flow) * 2 + static_cast<std::uint32_t>(found)) *
              8 +
          behind;
      // Of those that are asked one changes, if only the last.
      const bool changes =
          (behind == 0 && !found) || coder_->code(models_->change[context], wants_change(resident));
      found = found || changes;
      flow = next_flow(flow, changes);
      if (changes && !place(resident, Placement::Why::kChanged)) return false;
    } else if ((flips.was_visible >> i & 1U) != 0) {
      hidden_->push_back(resident);
    } else if (!place(resident, Placement::Why::kShown)) {
      return false;
    }
  }
  return true;
}

template <class Coder>
bool PresenceScript<Coder>::place(std::uint32_t resident, Placement::Why why) {
  LevelModels& models = why == Placement::Why::kShown ? models_->shown_level : models_->changed_level;
  const auto block = code_level(*coder_, models, state_->residents.block(resident), target(resident));
  if (!block) return false;
  placements_->push_back({resident, why, *block});
  return true;
}

}  // namespace atlaswire::codec
