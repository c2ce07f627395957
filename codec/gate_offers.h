#pragma once

#include "codec/gate_models.h"
#include "codec/gate_table.h"
#include "codec/resident_set.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace atlaswire::codec {

/// A patch near in number to a new one.
struct NearPatch {
  PatchShape shape;
  Block block;
  bool known = false;
};
using NearPatches = std::array<NearPatch, GateModels::kNear>;

inline Outline outline_of(const PatchShape& shape) { return {shape.corners, corner_count(shape.triangles)}; }

/// An open gate that a new patch may be attached to.
struct GateOffer {
  std::uint32_t gate = GateTable::kNone;  ///< number
  std::uint32_t nearness = 0;             ///< of its patch: index among the near, kNear for those further off
  std::uint32_t triangles = 1;            ///< its patch's
  std::uint32_t edge = 0;                 ///< of its patch
};

/// Walks through the open gates for one new patch: those of patches near in number, then those of new patches
/// before them, the latest first. docs/PROTOCOL.md, "Shapes".
class GateOffers {
 public:
  /// Borrows all; `before` are the new patches so far.
  GateOffers(const GateTable& gates, const NearPatches& near, std::span<const NewResident> before)
      : gates_(&gates), near_(&near), before_(before) {}

  /// False: there are no more.
  bool next(GateOffer& offer);

 private:
  static constexpr std::uint32_t kMostBack = 128;                    ///< new patches looked back at
  static constexpr std::uint32_t kMostOffered = 64;                  ///< about
  static constexpr std::size_t kNearAndNew = GateModels::kNear / 2;  ///< new patches that may be near ones

  bool next_patch();

  const GateTable* gates_;
  const NearPatches* near_;
  std::span<const NewResident> before_;
  const PatchShape* shape_ = nullptr;  ///< whose edges are on offer
  std::uint32_t edge_ = 0;
  std::uint32_t nearness_ = 0;
  std::uint32_t looked_ = 0;  ///< near patches and, behind them, new ones
  std::uint32_t offered_ = 0;
};

inline bool GateOffers::next(GateOffer& offer) {
  for (;; shape_ = nullptr) {
    if (shape_ == nullptr && !next_patch()) return false;
    const Outline outline = outline_of(*shape_);
    while (edge_ < outline.count) {
      const std::uint32_t edge = edge_++;
      const std::uint32_t gate = gates_->find(outline.at(edge + 1), outline.at(edge));
      if (gate == GateTable::kNone) continue;
      ++offered_;
      offer = {gate, nearness_, shape_->triangles, edge};
      return true;
    }
  }
}

inline bool GateOffers::next_patch() {
  edge_ = 0;
  for (; looked_ < GateModels::kNear; ++looked_) {
    const NearPatch& near = (*near_)[looked_];
    if (!near.known) continue;
    nearness_ = looked_++;
    shape_ = &near.shape;
    return true;
  }
  const std::size_t back = looked_ - GateModels::kNear + kNearAndNew;
  if (back >= before_.size() || looked_ - GateModels::kNear >= kMostBack || offered_ >= kMostOffered)
    return false;
  nearness_ = GateModels::kNear;
  shape_ = &before_[before_.size() - 1 - back].shape;
  ++looked_;
  return true;
}

}  // namespace atlaswire::codec
