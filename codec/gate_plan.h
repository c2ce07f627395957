#pragma once

#include "codec/gate_state.h"
#include "codec/meta_update.h"
#include "codec/shape_script.h"

#include <span>
#include <vector>

namespace atlaswire::codec {

/// What an encoder is to say in one update, in the order of the gate form: which known patches are forgotten,
/// what becomes of the others, which are new.
class GatePlan {
 public:
  /// A plan for `update`, which it borrows; `residents` and `vertices` as before it. Lists need not ascend.
  void begin(const MetaUpdate& update, const GateState& state);

  [[nodiscard]] FrameId frame() const { return update_->frame; }
  /// One mark for each resident; empty: none is forgotten. Forgotten is what was hidden for long, once too
  /// much is known, and what comes back in another shape.
  [[nodiscard]] const std::vector<bool>& drops() const { return drops_; }
  /// For each resident that is left, the block that it is to have; null: hidden. Borrowed until the next
  /// call.
  std::span<const Block* const> targets(const ResidentSet& left);
  /// Ascending.
  [[nodiscard]] std::span<const WantedPatch> arrivals() const { return arrivals_; }

 private:
  [[nodiscard]] WantedPatch wanted(const AddedPatch& patch) const;
  void drop_hidden(const ResidentSet& residents);

  const MetaUpdate* update_ = nullptr;
  std::vector<GridPosition> positions_;  ///< by VertexId
  std::vector<bool> drops_;
  std::vector<const AddedPatch*> returns_;
  std::vector<WantedPatch> arrivals_;
  std::vector<const Block*> targets_;
};

}  // namespace atlaswire::codec
