#pragma once

#include "render/atlas/allocator.h"
#include "render/atlas/atlas_demand.h"
#include "render/atlas/block_level.h"
#include "render/atlas/superblock_store.h"

#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Who holds which block and who wants one: the request phase of [SAS] 4.2 on the host, whatever memory lies
/// below. A frame goes `advance`, `place` for what is pending or shrunken, `report`.
class PatchLedger {
 public:
  PatchLedger(const AllocatorSettings& settings, std::uint32_t patch_count)
      : numbers_(settings.min_block_log2, settings.superblock_log2), patch_count_(patch_count) {}

  /// A visible patch, in the frame it was last seen.
  struct Entry {
    PatchId patch{};
    Block block;
    Level want;
    bool placed = false;
  };

  /// Merges the frame before with this one, whose patches ascend. With `reset` nobody keeps a block.
  void advance(std::span<const BlockRequest> visible, bool reset);

  /// Blocks of patches that went or want another size, ascending by patch.
  [[nodiscard]] const std::vector<Block>& released() const { return released_; }
  /// Patches without a block, ascending: indices for `entry` and `place`.
  [[nodiscard]] const std::vector<std::uint32_t>& pending() const { return pending_; }
  /// Patches that keep a block smaller than they want, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& shrunken() const { return shrunken_; }
  /// Visible patches, and pending ones, by the level that they want.
  [[nodiscard]] const PerLevel& wanted() const { return wanted_; }
  [[nodiscard]] const PerLevel& requested() const { return requested_; }

  [[nodiscard]] const Entry& entry(std::uint32_t index) const { return next_[index]; }
  void place(std::uint32_t index, const SuperblockStore::Placed& placed);

  /// Turns placements into the differences that matter, and ends the frame. `change.reset` is the caller's.
  AtlasOutcome report(LayoutChange& change);

  /// Ascending by patch.
  [[nodiscard]] std::vector<PlacedPatch> blocks() const;
  [[nodiscard]] const LevelNumbers& numbers() const { return numbers_; }

 private:
  static constexpr std::uint32_t kNone = ~0U;

  void meet(const BlockRequest& request, std::uint32_t old, bool reset);
  void report_changed(LayoutChange& change);
  [[nodiscard]] Level clamped(Level level) const;

  LevelNumbers numbers_;
  std::uint32_t patch_count_;
  std::vector<Entry> previous_;  ///< ascending by patch
  std::vector<Entry> next_;      ///< ascending by patch
  std::vector<Block> released_;
  std::vector<PatchId> removed_;
  std::vector<std::uint32_t> pending_;
  std::vector<std::uint32_t> old_;  ///< beside pending_: index in previous_, if it held a block there
  std::vector<std::uint32_t> shrunken_;
  std::vector<std::uint32_t> changed_;  ///< indices into next_: kept, but mirrored, or regrown
  PerLevel wanted_{};
  PerLevel requested_{};
};

}  // namespace atlaswire::render
