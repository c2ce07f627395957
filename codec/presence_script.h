#pragma once

#include "codec/gate_state.h"
#include "codec/level_script.h"

#include <algorithm>
#include <array>
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
  static constexpr std::uint32_t kGroup = 8;
  static constexpr std::uint8_t kCalm = 32;

  void code_flips(std::uint32_t first, std::uint32_t end);
  bool code_changes(std::uint32_t first, std::uint32_t end);
  bool place(std::uint32_t resident, Placement::Why why);
  [[nodiscard]] const Block* target(std::uint32_t resident) const {
    return targets_.empty() ? nullptr : targets_[resident];
  }
  [[nodiscard]] bool wants_flip(std::uint32_t resident) const {
    return !targets_.empty() &&
           (targets_[resident] != nullptr) != state_->residents.presence(resident).visible;
  }
  [[nodiscard]] bool wants_change(std::uint32_t resident) const {
    return target(resident) != nullptr && *target(resident) != state_->residents.block(resident);
  }

  Coder* coder_;
  GateState* state_;
  GateModels* models_;
  std::span<const Block* const> targets_;
  std::vector<std::uint32_t>* hidden_ = nullptr;
  std::vector<Placement>* placements_ = nullptr;
  std::array<bool, kGroup> was_visible_{};
  std::array<bool, kGroup> flips_{};
  std::uint32_t before_ = 0;  ///< the patch before: visible, and twice whether it came or went
  std::uint32_t calm_flow_ = 0;
  std::uint32_t change_flow_ = 0;
};

template <class Coder>
bool PresenceScript<Coder>::code(std::vector<std::uint32_t>& hidden, std::vector<Placement>& placements) {
  hidden_ = &hidden;
  placements_ = &placements;
  const std::uint32_t size = state_->residents.size();
  for (std::uint32_t first = 0; first < size; first += kGroup) {
    const std::uint32_t end = std::min(size, first + kGroup);
    code_flips(first, end);
    if (!code_changes(first, end)) return false;
  }
  return true;
}

template <class Coder>
void PresenceScript<Coder>::code_flips(std::uint32_t first, std::uint32_t end) {
  ResidentSet& residents = state_->residents;
  bool is_calm = true;
  bool wanted = false;
  for (std::uint32_t i = first; i < end; ++i) {
    is_calm = is_calm && residents.presence(i).calm >= kCalm;
    wanted = wanted || wants_flip(i);
    was_visible_[i - first] = residents.presence(i).visible;
    flips_[i - first] = false;
  }
  bool any = true;
  if (is_calm) {
    any = coder_->code(models_->calm_group[calm_flow_], wanted);
    calm_flow_ = any ? 2 : calm_flow_ == 2 ? 1 : 0;
  }
  for (std::uint32_t i = first; i < end; ++i) {
    const Presence& p = residents.presence(i);
    bool flip = false;
    if (any) {
      const std::uint32_t calm = p.calm < 16 ? 0 : p.calm < kCalm ? 1 : 2;
      flip = coder_->code(models_->flip[(std::uint32_t{p.history} * 4 + before_) * 3 + calm], wants_flip(i));
    }
    const bool visible = p.visible != flip;
    before_ = 2 * static_cast<std::uint32_t>(flip) + static_cast<std::uint32_t>(visible);
    flips_[i - first] = flip;
    residents.note(i, visible);
  }
}

template <class Coder>
bool PresenceScript<Coder>::code_changes(std::uint32_t first, std::uint32_t end) {
  bool stays = false;
  bool wanted = false;
  for (std::uint32_t i = first; i < end; ++i) {
    if (!was_visible_[i - first] || flips_[i - first]) continue;
    stays = true;
    wanted = wanted || wants_change(i);
  }
  bool any = false;
  if (stays) {
    any = coder_->code(models_->change_group[change_flow_], wanted);
    change_flow_ = any ? 2 : change_flow_ == 2 ? 1 : 0;
  }
  std::uint32_t flow = 0;
  for (std::uint32_t i = first; i < end; ++i) {
    if (flips_[i - first]) {
      if (was_visible_[i - first]) {
        hidden_->push_back(i);
      } else if (!place(i, Placement::Why::kShown)) {
        return false;
      }
      continue;
    }
    if (!any || !was_visible_[i - first]) continue;
    const std::uint8_t calm = state_->residents.presence(i).calm;
    const std::uint32_t age = calm < 16 ? 0 : calm < kCalm ? 1 : 2;
    const bool changes = coder_->code(models_->change[age * 3 + flow], wants_change(i));
    flow = changes ? 2 : flow == 2 ? 1 : 0;
    if (changes && !place(i, Placement::Why::kChanged)) return false;
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
