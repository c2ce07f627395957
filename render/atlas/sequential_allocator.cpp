#include "render/atlas/atlas_demand.h"
#include "render/atlas/patch_ledger.h"
#include "render/atlas/superblock_store.h"

#include <algorithm>
#include <utility>

namespace atlaswire::render {

namespace {

/// [SAS] 4.2 in patch order, on one thread. A slot is the number of a patch among those that request its
/// level in a frame, ascending; the layout follows from that alone (superblock_store.h).
///
/// It differs from the paper where the paper leaves a patch without memory, or resets for nothing:
/// - New requests that together exceed the free texels are first capped at one area, the largest that
///   fits; then the large are placed before the small.
/// - A request whose level cannot be had splits the smallest larger free block, and failing that is halved
///   until it fits. So a patch is refused only if the free texels cannot give every newcomer a smallest
///   block. A shrunken block is replaced, in later frames, once memory below the high-water mark allows.
/// - A reset happens only if it would help (AtlasDemand).
class SequentialAllocator final : public IncrementalAllocator {
 public:
  SequentialAllocator(const AllocatorSettings& settings, std::uint32_t patch_count)
      : ledger_(settings, patch_count),
        store_(settings.atlas, settings.superblock_log2, settings.min_block_log2),
        demand_(settings),
        regrow_limit_(high_water_texels(settings)) {}

  const LayoutChange& update(std::span<const BlockRequest> visible, bool may_reset) override {
    begin(may_reset);
    ledger_.advance(visible, change_.reset);
    return finish();
  }
  const LayoutChange& update_by(const RequestChange& change, bool may_reset) override {
    begin(may_reset);
    ledger_.advance(change, change_.reset);
    return finish();
  }
  void restart() override { restarts_ = true; }
  [[nodiscard]] std::vector<PlacedPatch> blocks() const override { return ledger_.blocks(); }
  [[nodiscard]] AtlasUsage usage() const override { return store_.usage(); }
  [[nodiscard]] bool wants_reset() const override { return wants_reset_; }

 private:
  void begin(bool may_reset) {
    change_.reset = std::exchange(restarts_, false) || (may_reset && wants_reset_);
  }
  const LayoutChange& finish();
  void provision();
  void limit_regrowing();
  void assign();
  void regrow();

  PatchLedger ledger_;
  SuperblockStore store_;
  AtlasDemand demand_;
  std::uint64_t regrow_limit_;  ///< texels
  Provision provision_;
  PerLevel regrowing_{};  ///< slots: shrunken patches by level, as many as may grow
  Provision regrow_;
  std::vector<Block> outgrown_;
  LayoutChange change_;
  bool wants_reset_ = false;
  bool restarts_ = false;
};

/// All that follows once the ledger knows the frame's requests.
const LayoutChange& SequentialAllocator::finish() {
  if (change_.reset) {
    store_.clear();
  } else {
    store_.release(ledger_.released());
  }
  provision();
  assign();
  regrow();
  store_.settle();
  AtlasOutcome outcome = ledger_.report(change_);
  outcome.used_superblocks = store_.superblocks() - store_.free_superblocks();
  wants_reset_ = demand_.reset_helps(ledger_.wanted(), outcome);
  return change_;
}

/// Memory for new requests, and then, below the high-water mark, for shrunken patches.
void SequentialAllocator::provision() {
  const std::uint32_t cap = demand_.area_cap(ledger_.requested(), store_.area() - store_.allocated());
  store_.provision(ledger_.requested(), cap, true, provision_);
  limit_regrowing();
  store_.provision(regrowing_, 2 * store_.numbers().max_log2(), false, regrow_);
}

/// Lets as many shrunken patches grow as stay below the high-water mark, the largest first.
void SequentialAllocator::limit_regrowing() {
  regrowing_.fill(0);
  for (const PatchId patch : ledger_.shrunken()) {
    ++regrowing_[store_.numbers().number(ledger_.entry(patch).want)];
  }
  std::uint64_t room = regrow_limit_ - std::min(regrow_limit_, store_.allocated());
  for (std::uint32_t i = store_.numbers().count(); i-- > 0;) {
    const std::uint32_t area_log2 = store_.numbers().level(i).area_log2();
    regrowing_[i] = static_cast<std::uint32_t>(std::min<std::uint64_t>(regrowing_[i], room >> area_log2));
    room -= std::uint64_t{regrowing_[i]} << area_log2;
  }
}

void SequentialAllocator::assign() {
  PerLevel slot{};
  for (const PatchId patch : ledger_.pending()) {
    const Level want = ledger_.entry(patch).want;
    const auto placed = store_.place(provision_, want, slot[store_.numbers().number(want)]++);
    if (placed) ledger_.place(patch, *placed);
  }
}

/// Moves shrunken patches to what they wanted. Their old blocks are in use until the next frame's request
/// phase, so that within a frame memory is freed before it is taken, never after.
void SequentialAllocator::regrow() {
  PerLevel first{};
  std::uint32_t grown = 0;
  for (std::uint32_t i = store_.numbers().count(); i-- > 0;) {
    first[i] = grown;
    grown += regrow_.served[i];
  }
  outgrown_.resize(grown);
  PerLevel slot{};
  for (const PatchId patch : ledger_.shrunken()) {
    const PatchLedger::Entry& entry = ledger_.entry(patch);
    const std::uint32_t number = store_.numbers().number(entry.want);
    const std::uint32_t my_slot = slot[number]++;
    const auto placed = store_.place(regrow_, entry.want, my_slot);
    if (!placed) continue;
    outgrown_[first[number] + my_slot] = entry.block;
    ledger_.place(patch, *placed);
  }
  for (const Block& block : outgrown_) store_.defer(block);
}

}  // namespace

std::unique_ptr<IncrementalAllocator> make_sequential_allocator(const AllocatorSettings& settings,
                                                                std::uint32_t patch_count) {
  check_allocator_settings(settings);
  return std::make_unique<SequentialAllocator>(settings, patch_count);
}

}  // namespace atlaswire::render
