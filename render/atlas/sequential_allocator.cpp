#include "base/assert.h"
#include "render/atlas/allocator.h"
#include "render/atlas/atlas_demand.h"
#include "render/atlas/superblock_store.h"

#include <algorithm>

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
class SequentialAllocator final : public AtlasAllocator {
 public:
  SequentialAllocator(const AllocatorSettings& settings, std::uint32_t patch_count)
      : patch_count_(patch_count),
        store_(settings.atlas, settings.superblock_log2, settings.min_block_log2),
        demand_(settings),
        regrow_limit_(high_water_texels(settings)) {}

  const LayoutChange& update(std::span<const BlockRequest> visible, bool may_reset) override;
  [[nodiscard]] std::vector<PlacedPatch> blocks() const override;
  [[nodiscard]] AtlasUsage usage() const override { return store_.usage(); }
  [[nodiscard]] bool wants_reset() const override { return wants_reset_; }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  /// A visible patch, in the frame it was last seen.
  struct Entry {
    PatchId patch{};
    Block block;
    Level want;
    bool placed = false;
  };
  /// A patch to be placed in this frame.
  struct Pending {
    std::uint32_t entry = 0;    ///< in next_
    std::uint32_t old = kNone;  ///< in previous_, if it held a block
  };

  void request_phase(std::span<const BlockRequest> visible, bool reset);
  void meet(const BlockRequest& request, std::uint32_t old, bool reset);
  void provision();
  void assign();
  void regrow();
  static void set_block(Entry& entry, const SuperblockStore::Placed& placed);
  void report();
  void judge(bool reset);
  [[nodiscard]] static Level level_of(const Block& block) { return {block.width_log2, block.height_log2}; }
  [[nodiscard]] Level clamped(Level level) const;

  std::uint32_t patch_count_;
  SuperblockStore store_;
  AtlasDemand demand_;
  std::uint64_t regrow_limit_;               ///< texels
  std::vector<Entry> previous_;              ///< ascending by patch
  std::vector<Entry> next_;                  ///< ascending by patch
  std::vector<Block> released_;              ///< ascending by patch
  std::vector<Pending> pending_;             ///< ascending by patch
  std::vector<std::uint32_t> shrunken_;      ///< indices into next_: blocks smaller than wanted, kept so far
  std::vector<std::uint32_t> kept_changed_;  ///< indices into next_: same memory mirrored, or regrown
  PerLevel wanted_{};                        ///< visible patches by the level they want
  PerLevel requested_{};                     ///< slots: pending_ by level
  PerLevel regrowing_{};                     ///< slots: shrunken_ by level, as many as may grow
  Provision provision_;
  Provision regrow_;
  std::vector<Block> outgrown_;
  LayoutChange change_;
  bool wants_reset_ = false;
};

const LayoutChange& SequentialAllocator::update(std::span<const BlockRequest> visible, bool may_reset) {
  const bool reset = may_reset && wants_reset_;
  change_.reset = reset;
  change_.added.clear();
  change_.moved.clear();
  change_.removed.clear();
  change_.refused.clear();

  request_phase(visible, reset);
  provision();
  assign();
  regrow();
  store_.settle();
  report();
  judge(reset);
  std::swap(previous_, next_);
  return change_;
}

/// Merges the frame before with this one. Blocks of patches that went, or want another size, are freed.
void SequentialAllocator::request_phase(std::span<const BlockRequest> visible, bool reset) {
  next_.clear();
  released_.clear();
  pending_.clear();
  shrunken_.clear();
  kept_changed_.clear();
  wanted_.fill(0);
  requested_.fill(0);
  const auto drop = [&](const Entry& gone) {
    if (!gone.placed) return;
    released_.push_back(gone.block);
    change_.removed.push_back(gone.patch);
  };
  std::uint32_t old = 0;
  for (const BlockRequest& request : visible) {
    AW_ASSERT(value(request.patch) < patch_count_);
    AW_ASSERT(next_.empty() || next_.back().patch < request.patch);
    while (old < previous_.size() && previous_[old].patch < request.patch) drop(previous_[old++]);
    const bool known = old < previous_.size() && previous_[old].patch == request.patch;
    meet(request, known ? old : kNone, reset);
    if (known) ++old;
  }
  while (old < previous_.size()) drop(previous_[old++]);
  if (reset) {
    store_.clear();
  } else {
    store_.release(released_);
  }
}

void SequentialAllocator::meet(const BlockRequest& request, std::uint32_t old, bool reset) {
  const Level want = clamped({request.width_log2, request.height_log2});
  ++wanted_[store_.numbers().number(want)];
  const auto at = static_cast<std::uint32_t>(next_.size());
  Entry entry{.patch = request.patch, .want = want};
  const bool held = old != kNone && previous_[old].placed;
  if (held) {
    entry.block = previous_[old].block;
    const Level has = level_of(entry.block);
    // A shrunken block is kept too: `regrow` looks for a better one without giving this one up.
    entry.placed = !reset && (previous_[old].want == want || has == want);
    if (entry.placed && has != want) shrunken_.push_back(at);
    if (!entry.placed) released_.push_back(entry.block);
    if (entry.placed && entry.block.transposed != request.transposed) kept_changed_.push_back(at);
  }
  entry.block.transposed = request.transposed;
  if (!entry.placed) {
    pending_.push_back({at, held ? old : kNone});
    ++requested_[store_.numbers().number(want)];
  }
  next_.push_back(entry);
}

/// Memory for new requests, and then, below the high-water mark, for shrunken patches.
void SequentialAllocator::provision() {
  const std::uint32_t cap = demand_.area_cap(requested_, store_.area() - store_.allocated());
  store_.provision(requested_, cap, true, provision_);
  regrowing_.fill(0);
  for (const std::uint32_t i : shrunken_) ++regrowing_[store_.numbers().number(next_[i].want)];
  std::uint64_t room = regrow_limit_ - std::min(regrow_limit_, store_.allocated());
  for (std::uint32_t i = store_.numbers().count(); i-- > 0;) {
    const std::uint32_t area_log2 = store_.numbers().level(i).area_log2();
    regrowing_[i] = static_cast<std::uint32_t>(std::min<std::uint64_t>(regrowing_[i], room >> area_log2));
    room -= std::uint64_t{regrowing_[i]} << area_log2;
  }
  store_.provision(regrowing_, 2 * store_.numbers().max_log2(), false, regrow_);
}

void SequentialAllocator::assign() {
  PerLevel slot{};
  for (const Pending& p : pending_) {
    Entry& entry = next_[p.entry];
    const auto placed = store_.place(provision_, entry.want, slot[store_.numbers().number(entry.want)]++);
    if (placed) set_block(entry, *placed);
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
  for (const std::uint32_t i : shrunken_) {
    Entry& entry = next_[i];
    const std::uint32_t number = store_.numbers().number(entry.want);
    const std::uint32_t my_slot = slot[number]++;
    const auto placed = store_.place(regrow_, entry.want, my_slot);
    if (!placed) continue;
    outgrown_[first[number] + my_slot] = entry.block;
    set_block(entry, *placed);
    kept_changed_.push_back(i);
  }
  for (const Block& block : outgrown_) store_.defer(block);
}

void SequentialAllocator::set_block(Entry& entry, const SuperblockStore::Placed& placed) {
  entry.block.x = placed.at.x;
  entry.block.y = placed.at.y;
  entry.block.width_log2 = placed.level.width_log2;
  entry.block.height_log2 = placed.level.height_log2;
  entry.placed = true;
}

/// Turns placements into the differences that matter, ascending by patch.
void SequentialAllocator::report() {
  bool lost = false;
  for (const Pending& p : pending_) {
    const Entry& entry = next_[p.entry];
    if (!entry.placed) {
      change_.refused.push_back(entry.patch);
      if (p.old != kNone) change_.removed.push_back(entry.patch);
      lost = lost || p.old != kNone;
    } else if (p.old == kNone) {
      change_.added.push_back({entry.patch, entry.block});
    } else if (previous_[p.old].block != entry.block) {
      change_.moved.push_back({entry.patch, entry.block});
    }
  }
  if (lost) std::ranges::sort(change_.removed);
  if (kept_changed_.empty()) return;
  std::ranges::sort(kept_changed_);
  const auto twice = std::ranges::unique(kept_changed_);
  kept_changed_.erase(twice.begin(), twice.end());
  for (const std::uint32_t i : kept_changed_) change_.moved.push_back({next_[i].patch, next_[i].block});
  std::ranges::sort(change_.moved, {}, &PlacedPatch::patch);
}

void SequentialAllocator::judge(bool reset) {
  AtlasOutcome outcome{.reset = reset,
                       .visible = static_cast<std::uint32_t>(next_.size()),
                       .refused = static_cast<std::uint32_t>(change_.refused.size()),
                       .used_superblocks = store_.superblocks() - store_.free_superblocks()};
  const auto smaller = [&](const Entry& e) { return e.placed && level_of(e.block) != e.want; };
  for (const Pending& p : pending_) outcome.shrunken += smaller(next_[p.entry]) ? 1 : 0;
  for (const std::uint32_t i : shrunken_) outcome.shrunken += smaller(next_[i]) ? 1 : 0;
  wants_reset_ = demand_.reset_helps(wanted_, outcome);
}

Level SequentialAllocator::clamped(Level level) const {
  const auto low = static_cast<std::uint8_t>(store_.numbers().min_log2());
  const auto high = static_cast<std::uint8_t>(store_.numbers().max_log2());
  const auto width = std::clamp(std::max(level.width_log2, level.height_log2), low, high);
  return {width, std::clamp(std::min(level.width_log2, level.height_log2), low, width)};
}

std::vector<PlacedPatch> SequentialAllocator::blocks() const {
  std::vector<PlacedPatch> live;
  live.reserve(previous_.size());
  for (const Entry& entry : previous_) {
    if (entry.placed) live.push_back({entry.patch, entry.block});
  }
  return live;
}

}  // namespace

std::unique_ptr<AtlasAllocator> make_sequential_allocator(const AllocatorSettings& settings,
                                                          std::uint32_t patch_count) {
  check_allocator_settings(settings);
  return std::make_unique<SequentialAllocator>(settings, patch_count);
}

}  // namespace atlaswire::render
