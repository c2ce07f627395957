#pragma once

#include "render/atlas/allocator.h"
#include "render/atlas/atlas_demand.h"
#include "render/atlas/block_level.h"
#include "render/atlas/patch_set.h"
#include "render/atlas/superblock_store.h"

#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Who holds which block and who wants one: the request phase of [SAS] 4.2 on the host, whatever memory lies
/// below. A frame goes `advance`, `place` for what is pending or shrunken, `report`. Work follows from what
/// changes and from who has not got what it wants; but for resets, which are about everybody. No allocation
/// per patch; arrays grow to the largest id used.
class PatchLedger {
 public:
  PatchLedger(const AllocatorSettings& settings, std::uint32_t patch_count)
      : numbers_(settings.min_block_log2, settings.superblock_log2), patch_count_(patch_count) {}

  /// A patch that asks.
  struct Entry {
    Block block;  ///< `transposed` as asked for; the rest only if placed
    Level want;
    bool placed = false;
  };

  /// Begins a frame. With `reset` nobody keeps a block.
  void advance(const RequestChange& change, bool reset);
  /// The same from all who ask, ascending: finds out what changed.
  void advance(std::span<const BlockRequest> visible, bool reset);

  /// Blocks of patches that went or want another size, ascending by patch; with a reset none, all are.
  [[nodiscard]] const std::vector<Block>& released() const { return released_; }
  /// Patches without a block, ascending.
  [[nodiscard]] const std::vector<PatchId>& pending() const { return pending_; }
  /// Patches that keep a block smaller than they want, ascending.
  [[nodiscard]] const std::vector<PatchId>& shrunken() const { return shrunken_; }
  /// Patches that ask, and pending ones, by the level that they want.
  [[nodiscard]] const PerLevel& wanted() const { return wanted_; }
  [[nodiscard]] const PerLevel& requested() const { return requested_; }

  /// Of a patch that asks.
  [[nodiscard]] const Entry& entry(PatchId patch) const { return entries_[value(patch)]; }
  void place(PatchId patch, const SuperblockStore::Placed& placed);

  /// Turns placements into the differences that matter, and ends the frame. `change.reset` is the caller's.
  AtlasOutcome report(LayoutChange& change);

  /// Ascending by patch.
  [[nodiscard]] std::vector<PlacedPatch> blocks() const;
  [[nodiscard]] const LevelNumbers& numbers() const { return numbers_; }

 private:
  void begin_frame();
  void drop(PatchId patch);
  void meet(const BlockRequest& request, bool reset);
  void unplace_all();
  void retry_refused();
  void forget_grown();
  void report_pending(LayoutChange& change);
  void report_changed(LayoutChange& change);
  [[nodiscard]] bool stands(const BlockRequest& request) const;
  [[nodiscard]] Level wanted_by(const BlockRequest& request) const;

  LevelNumbers numbers_;
  std::uint32_t patch_count_;
  std::vector<Entry> entries_;  ///< by PatchId; who does not ask is not placed
  PatchSet asking_;
  std::uint32_t asking_count_ = 0;
  PerLevel wanted_{};
  std::vector<PatchId> refused_;   ///< in the frame before, ascending
  std::vector<PatchId> shrunken_;  ///< between frames all that are, ascending
  // Of one frame.
  std::vector<Block> released_;
  std::vector<PatchId> removed_;
  std::vector<PatchId> pending_;
  PerLevel requested_{};
  std::vector<PlacedPatch> outdated_;  ///< blocks that pending patches held, ascending by patch
  std::vector<PatchId> changed_;       ///< kept, but mirrored, or regrown
  std::vector<PatchId> merged_;        ///< scratch
  PatchSet listed_;                    ///< of a full list: all in it
  std::vector<PatchId> gone_;          ///< of a full list: its change
  std::vector<BlockRequest> asked_;    ///< of a full list: its change
};

}  // namespace atlaswire::render
