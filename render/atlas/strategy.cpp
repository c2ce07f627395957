#include "render/atlas/strategy.h"

#include "render/atlas/atlas_demand.h"
#include "render/atlas/block_memory.h"
#include "render/atlas/patch_ledger.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace atlaswire::render {
namespace {

/// When memory is cleared and every block placed anew.
enum class Resets : std::uint8_t { kNever, kOnIntra, kAlways };

/// Requests in order of level, the largest first, then of patch, straight to the memory.
class DirectAllocator final : public AtlasAllocator {
 public:
  DirectAllocator(const AllocatorSettings& settings, std::uint32_t patch_count,
                  std::unique_ptr<BlockMemory> memory, Resets resets)
      : superblock_area_(std::uint64_t{1} << (2 * settings.superblock_log2)),
        area_(settings.atlas.area()),
        ledger_(settings, patch_count),
        demand_(settings),
        memory_(std::move(memory)),
        resets_(resets) {}

  const LayoutChange& update(std::span<const BlockRequest> visible, bool may_reset) override;
  void restart() override { restarts_ = true; }
  [[nodiscard]] std::vector<PlacedPatch> blocks() const override { return ledger_.blocks(); }
  [[nodiscard]] AtlasUsage usage() const override { return memory_->usage(); }
  [[nodiscard]] bool wants_reset() const override { return wants_reset_; }

 private:
  void place_pending();

  std::uint64_t superblock_area_;
  std::uint64_t area_;
  PatchLedger ledger_;
  AtlasDemand demand_;
  std::unique_ptr<BlockMemory> memory_;
  Resets resets_;
  std::vector<PatchId> order_;
  LayoutChange change_;
  bool wants_reset_ = false;
  bool restarts_ = false;
};

const LayoutChange& DirectAllocator::update(std::span<const BlockRequest> visible, bool may_reset) {
  change_.reset =
      std::exchange(restarts_, false) || resets_ == Resets::kAlways || (may_reset && wants_reset_);
  ledger_.advance(visible, change_.reset);
  if (change_.reset) {
    memory_->clear();
  } else {
    for (const Block& block : ledger_.released()) memory_->release(block);
  }
  place_pending();
  AtlasOutcome outcome = ledger_.report(change_);
  outcome.used_superblocks = static_cast<std::uint32_t>((area_ - memory_->usage().free) / superblock_area_);
  wants_reset_ = demand_.reset_helps(ledger_.wanted(), outcome) && resets_ == Resets::kOnIntra;
  return change_;
}

void DirectAllocator::place_pending() {
  const LevelNumbers& numbers = ledger_.numbers();
  PerLevel cursor{};
  std::uint32_t count = 0;
  for (std::uint32_t i = numbers.count(); i-- > 0;) {
    cursor[i] = count;
    count += ledger_.requested()[i];
  }
  order_.resize(count);
  for (const PatchId patch : ledger_.pending()) {
    order_[cursor[numbers.number(ledger_.entry(patch).want)]++] = patch;
  }
  for (const PatchId patch : order_) {
    const Level want = ledger_.entry(patch).want;
    if (const auto at = memory_->take(want)) ledger_.place(patch, {want, *at});
  }
}

constexpr std::array kAll{Strategy::kS0, Strategy::kS1,       Strategy::kS2,
                          Strategy::kS3, Strategy::kQuadtree, Strategy::kRepack};
constexpr std::array<std::string_view, kAll.size()> kNames{"S0", "S1", "S2", "S3", "quadtree", "repack"};

}  // namespace

std::span<const Strategy> strategies() { return kAll; }

std::string_view name_of(Strategy strategy) { return kNames[static_cast<std::size_t>(strategy)]; }

std::optional<Strategy> find_strategy(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return kAll[static_cast<std::size_t>(found - kNames.begin())];
}

std::unique_ptr<AtlasAllocator> make_allocator(Strategy strategy, const AllocatorSettings& settings,
                                               std::uint32_t patch_count) {
  check_allocator_settings(settings);
  const auto direct = [&](std::unique_ptr<BlockMemory> memory, Resets resets) {
    return std::make_unique<DirectAllocator>(settings, patch_count, std::move(memory), resets);
  };
  switch (strategy) {
    case Strategy::kS1:
      return direct(make_level_superblocks(settings, true), Resets::kOnIntra);
    case Strategy::kS2:
      return direct(make_level_superblocks(settings, false), Resets::kOnIntra);
    case Strategy::kS3:
      return direct(make_level_superblocks(settings, false), Resets::kNever);
    case Strategy::kQuadtree:
      return direct(make_quadtree(settings), Resets::kOnIntra);
    case Strategy::kRepack:
      return direct(make_quadtree(settings), Resets::kAlways);
    case Strategy::kS0:
      break;
  }
  return make_sequential_allocator(settings, patch_count);
}

}  // namespace atlaswire::render
