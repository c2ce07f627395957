#include "base/assert.h"
#include "base/program.h"
#include "render/atlas/allocator.h"
#include "render/atlas/superblock_store.h"

#include <algorithm>
#include <string>

namespace atlaswire::render {

namespace {

/// Levels as one number that descends in the order of provisioning: widths, then heights.
constexpr std::uint32_t kSideLevels = 13;
constexpr std::uint32_t kLevels = kSideLevels * kSideLevels;
constexpr std::uint32_t slot_of(Level level) { return level.width_log2 * kSideLevels + level.height_log2; }

/// [SAS] 4.2 in patch order, on one thread. It differs from the paper where the paper leaves a patch
/// without memory, or resets for nothing:
/// - New requests that together exceed the free texels are first capped at one area, the largest that
///   fits; then the large are placed before the small.
/// - A request whose level cannot be had splits the smallest larger free block, and failing that is halved
///   until it fits. So a patch is refused only if the free texels cannot give every newcomer a smallest
///   block. A shrunken block is replaced, in later frames, once memory below the high-water mark allows.
/// - A reset happens only if it would help: see `reset_helps`.
class SequentialAllocator final : public AtlasAllocator {
 public:
  SequentialAllocator(const AllocatorSettings& settings, std::uint32_t patch_count)
      : settings_(settings),
        patch_count_(patch_count),
        store_(settings.atlas, settings.superblock_log2, settings.min_block_log2) {}

  const LayoutChange& update(std::span<const BlockRequest> visible, bool may_reset) override;
  [[nodiscard]] std::vector<PlacedPatch> blocks() const override;
  [[nodiscard]] AtlasUsage usage() const override { return store_.usage(); }
  [[nodiscard]] bool wants_reset() const override { return reset_helps(); }

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
    Level level;                ///< what it wants, capped
  };

  void request_phase(std::span<const BlockRequest> visible, bool reset);
  void meet(const BlockRequest& request, std::uint32_t old, bool reset);
  void cap_requests();
  void provision_and_assign();
  void place_level(Level level, std::span<const std::uint32_t> pending);
  void place_smaller(const Pending& pending);
  static void set_block(Entry& entry, Level level, TexelPosition at);
  void regrow();
  void report();
  [[nodiscard]] bool reset_helps() const;
  [[nodiscard]] Level clamped(Level level) const;

  AllocatorSettings settings_;
  std::uint32_t patch_count_;
  SuperblockStore store_;
  std::vector<Entry> previous_;              ///< ascending by patch
  std::vector<Entry> next_;                  ///< ascending by patch
  std::vector<Pending> pending_;             ///< ascending by patch
  std::vector<std::uint32_t> order_;         ///< indices into pending_, by level
  std::vector<std::uint32_t> shrunken_;      ///< indices into next_: blocks smaller than wanted, kept so far
  std::vector<std::uint32_t> kept_changed_;  ///< indices into next_: same memory mirrored, or regrown
  LayoutChange change_;
  std::vector<std::uint64_t> wanted_by_width_ = std::vector<std::uint64_t>(kSideLevels);  ///< texels
  std::uint64_t wanted_ = 0;             ///< texels, all visible patches
  std::uint64_t futile_wanted_ = ~0ULL;  ///< a reset at no less than this would leave blocks shrunken
};

const LayoutChange& SequentialAllocator::update(std::span<const BlockRequest> visible, bool may_reset) {
  const bool reset = may_reset && reset_helps();
  change_.reset = reset;
  change_.added.clear();
  change_.moved.clear();
  change_.removed.clear();
  change_.refused.clear();

  request_phase(visible, reset);
  cap_requests();
  provision_and_assign();
  if (reset) {
    const bool shrunken = std::ranges::any_of(pending_, [&](const Pending& p) {
      const Entry& e = next_[p.entry];
      return !e.placed || Level{e.block.width_log2, e.block.height_log2} != e.want;
    });
    futile_wanted_ = shrunken ? wanted_ - wanted_ / 16 : ~0ULL;
  }
  regrow();
  report();
  std::swap(previous_, next_);
  return change_;
}

/// Merges the frame before with this one. Blocks of patches that went, or want another size, are freed.
void SequentialAllocator::request_phase(std::span<const BlockRequest> visible, bool reset) {
  if (reset) store_.clear();
  next_.clear();
  pending_.clear();
  shrunken_.clear();
  kept_changed_.clear();
  std::ranges::fill(wanted_by_width_, 0U);
  const auto drop = [&](const Entry& gone) {
    if (!gone.placed) return;
    if (!reset) store_.release(gone.block);
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
  wanted_ = 0;
  for (const auto texels : wanted_by_width_) wanted_ += texels;
}

void SequentialAllocator::meet(const BlockRequest& request, std::uint32_t old, bool reset) {
  const Level want = clamped({request.width_log2, request.height_log2});
  wanted_by_width_[want.width_log2] += want.area();
  const auto at = static_cast<std::uint32_t>(next_.size());
  Entry entry{.patch = request.patch, .want = want};
  const bool held = old != kNone && previous_[old].placed;
  if (held) {
    entry.block = previous_[old].block;
    const Level has{entry.block.width_log2, entry.block.height_log2};
    // A shrunken block is kept too: `regrow` looks for a better one without giving this one up.
    entry.placed = !reset && (previous_[old].want == want || has == want);
    if (entry.placed && has != want) shrunken_.push_back(at);
    if (!entry.placed && !reset) store_.release(entry.block);
    if (entry.placed && entry.block.transposed != request.transposed) kept_changed_.push_back(at);
  }
  entry.block.transposed = request.transposed;
  if (!entry.placed) pending_.push_back({at, held ? old : kNone, want});
  next_.push_back(entry);
}

/// Caps the areas of new requests so that together they fit into the free texels.
void SequentialAllocator::cap_requests() {
  std::uint64_t count[2 * kSideLevels] = {};
  std::uint64_t texels = 0;
  for (const Pending& p : pending_) {
    ++count[p.level.area_log2()];
    texels += p.level.area();
  }
  const std::uint64_t room = store_.area() - store_.allocated();
  std::uint32_t cap = 2 * settings_.superblock_log2;
  for (; texels > room && cap > 2 * settings_.min_block_log2; --cap) {
    texels -= count[cap] << (cap - 1);
    count[cap - 1] += count[cap];
  }
  if (cap == 2 * settings_.superblock_log2) return;
  for (Pending& p : pending_) {
    while (p.level.area_log2() > cap) p.level = halved(p.level);
  }
}

/// Counting sort by level, patches ascending within; then each level from the widest and highest down.
void SequentialAllocator::provision_and_assign() {
  std::uint32_t first[kLevels + 1] = {};
  for (const Pending& p : pending_) ++first[slot_of(p.level) + 1];
  for (std::uint32_t slot = 0; slot < kLevels; ++slot) first[slot + 1] += first[slot];
  std::uint32_t cursor[kLevels];
  std::copy(first, first + kLevels, cursor);
  order_.resize(pending_.size());
  for (std::uint32_t i = 0; i < pending_.size(); ++i) order_[cursor[slot_of(pending_[i].level)]++] = i;

  for (std::uint32_t w = settings_.superblock_log2 + 1; w-- > settings_.min_block_log2;) {
    for (std::uint32_t h = w + 1; h-- > settings_.min_block_log2;) {
      const Level level{static_cast<std::uint8_t>(w), static_cast<std::uint8_t>(h)};
      const std::uint32_t slot = slot_of(level);
      place_level(level, std::span(order_).subspan(first[slot], first[slot + 1] - first[slot]));
    }
    store_.align_tail(w);
    for (std::uint32_t i = first[w * kSideLevels]; i < first[(w + 1) * kSideLevels]; ++i) {
      if (!next_[pending_[order_[i]].entry].placed) place_smaller(pending_[order_[i]]);
    }
  }
}

/// The first slots get new memory, as many as the level's stack cannot serve; the rest draw from the stack.
void SequentialAllocator::place_level(Level level, std::span<const std::uint32_t> pending) {
  const auto requested = static_cast<std::uint32_t>(pending.size());
  const std::uint32_t required = requested - std::min(requested, store_.stacked(level));
  for (std::uint32_t slot = 0; slot < requested; ++slot) {
    const auto at = slot < required ? store_.bump(level) : store_.pop(level);
    if (at) set_block(next_[pending_[pending[slot]].entry], level, *at);
  }
}

/// No superblock is free: splits what is, or takes less.
void SequentialAllocator::place_smaller(const Pending& pending) {
  if (store_.allocated() == store_.area()) return;
  for (Level level = pending.level;; level = halved(level)) {
    if (const auto at = store_.take_best_fit(level)) return set_block(next_[pending.entry], level, *at);
    if (level.height_log2 == settings_.min_block_log2 && level.width_log2 == level.height_log2) return;
  }
}

void SequentialAllocator::set_block(Entry& entry, Level level, TexelPosition at) {
  entry.block.x = at.x;
  entry.block.y = at.y;
  entry.block.width_log2 = level.width_log2;
  entry.block.height_log2 = level.height_log2;
  entry.placed = true;
}

/// Gives shrunken patches what they want, in patch order, while memory stays below the high-water mark.
void SequentialAllocator::regrow() {
  const auto limit = static_cast<std::uint64_t>(settings_.high_water * static_cast<double>(store_.area()));
  for (const std::uint32_t i : shrunken_) {
    Entry& entry = next_[i];
    if (store_.allocated() + entry.want.area() > limit) continue;
    auto at = store_.pop(entry.want);
    if (!at) {
      at = store_.bump(entry.want);
      store_.align_tail(entry.want.width_log2);
    }
    if (!at) at = store_.take_best_fit(entry.want);
    if (!at) continue;
    store_.release(entry.block);
    set_block(entry, entry.want, *at);
    kept_changed_.push_back(i);
  }
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

/// Whether a reset is asked for and would change anything. Asked for: the share outside free superblocks is
/// above the high-water mark and packing anew would free a thirty-second of the atlas; or a block is
/// smaller than wanted although everything wanted fits, unless the last reset failed at about as much; or
/// a patch is refused although the atlas has a smallest block for it.
bool SequentialAllocator::reset_helps() const {
  std::uint64_t packed = 0;
  const std::uint32_t superblock_area_log2 = 2 * settings_.superblock_log2;
  const std::uint64_t superblock_area = std::uint64_t{1} << superblock_area_log2;
  for (const auto texels : wanted_by_width_) packed += (texels + superblock_area - 1) >> superblock_area_log2;
  const std::uint64_t used = store_.superblocks() - store_.free_superblocks();
  const bool high = static_cast<double>(used) > settings_.high_water * store_.superblocks();
  if (high && packed + std::max(1U, store_.superblocks() / 32) <= used) return true;

  std::uint64_t served = 0;
  bool shrunken = false;
  for (const Entry& e : previous_) {
    served += e.placed ? 1 : 0;
    shrunken = shrunken || (e.placed && Level{e.block.width_log2, e.block.height_log2} != e.want);
  }
  if (shrunken && wanted_ <= store_.area() && wanted_ < futile_wanted_) return true;
  const std::uint64_t most = store_.area() >> (2 * settings_.min_block_log2);
  return served < std::min<std::uint64_t>(previous_.size(), most);
}

Level SequentialAllocator::clamped(Level level) const {
  const auto low = static_cast<std::uint8_t>(settings_.min_block_log2);
  const auto high = static_cast<std::uint8_t>(settings_.superblock_log2);
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
  if (settings.superblock_log2 > 12 || settings.min_block_log2 > settings.superblock_log2) {
    throw ProgramError(ExitCode::kUsage, "atlas memory: superblock side 2^" +
                                             std::to_string(settings.superblock_log2) +
                                             " must be at most 4096 and no smaller than the smallest block");
  }
  const std::uint32_t side = 1U << settings.superblock_log2;
  const Extent2D atlas = settings.atlas;
  if (atlas.area() == 0 || atlas.width % side != 0 || atlas.height % side != 0 || atlas.width > 32768 ||
      atlas.height > 32768) {
    throw ProgramError(ExitCode::kUsage, "atlas memory: the atlas is " + std::to_string(atlas.width) + "x" +
                                             std::to_string(atlas.height) +
                                             "; its sides must be multiples of " + std::to_string(side) +
                                             " up to 32768");
  }
  return std::make_unique<SequentialAllocator>(settings, patch_count);
}

}  // namespace atlaswire::render
