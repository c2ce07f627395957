#include "tests/render/atlas/layout_checker.h"

#include <algorithm>

namespace atlaswire::render {

namespace {

std::string about(PatchId patch, const std::string& what) {
  return "patch " + std::to_string(value(patch)) + ": " + what;
}

template <class List, class Key>
bool ascends(const List& list, Key key) {
  return std::ranges::adjacent_find(list, std::greater_equal{}, key) == list.end();
}

}  // namespace

std::string LayoutChecker::check(const AtlasAllocator& allocator, std::span<const BlockRequest> visible,
                                 const LayoutChange& change) {
  const auto before = live_;
  if (auto wrong = apply(change); !wrong.empty()) return wrong;
  if (auto wrong = check_visible(visible, change); !wrong.empty()) return wrong;
  if (auto wrong = check_geometry(); !wrong.empty()) return wrong;
  if (auto wrong = check_usage(allocator); !wrong.empty()) return wrong;

  const auto blocks = allocator.blocks();
  if (!ascends(blocks, &PlacedPatch::patch)) return "blocks() does not ascend";
  if (blocks.size() != live_.size()) return "blocks() and the sum of changes differ in number";
  for (const PlacedPatch& placed : blocks) {
    const auto found = live_.find(placed.patch);
    if (found == live_.end() || found->second != placed.block) return about(placed.patch, "blocks() differs");
  }
  // Stability: whoever asks the same again and has what it asked for keeps it.
  if (!change.reset) {
    for (const BlockRequest& r : visible) {
      const auto had = before.find(r.patch);
      const auto asked = requests_.find(r.patch);
      if (had == before.end() || asked == requests_.end()) continue;
      const bool same = asked->second.width_log2 == r.width_log2 &&
                        asked->second.height_log2 == r.height_log2 &&
                        asked->second.transposed == r.transposed;
      const bool satisfied =
          had->second.width_log2 == r.width_log2 && had->second.height_log2 == r.height_log2;
      if (same && satisfied && live_.at(r.patch) != had->second) return about(r.patch, "moved without cause");
    }
  }
  requests_.clear();
  for (const BlockRequest& r : visible) requests_[r.patch] = r;
  return {};
}

std::string LayoutChecker::apply(const LayoutChange& change) {
  if (!ascends(change.added, &PlacedPatch::patch) || !ascends(change.moved, &PlacedPatch::patch) ||
      !ascends(change.removed, std::identity{}) || !ascends(change.refused, std::identity{})) {
    return "a list does not ascend";
  }
  for (const PatchId patch : change.removed) {
    if (live_.erase(patch) == 0) return about(patch, "removed without a block");
  }
  for (const PlacedPatch& placed : change.moved) {
    const auto found = live_.find(placed.patch);
    if (found == live_.end()) return about(placed.patch, "moved without a block");
    if (found->second == placed.block) return about(placed.patch, "moved to where it is");
    found->second = placed.block;
  }
  for (const PlacedPatch& placed : change.added) {
    if (!live_.emplace(placed.patch, placed.block).second) return about(placed.patch, "added twice");
  }
  return {};
}

std::string LayoutChecker::check_visible(std::span<const BlockRequest> visible,
                                         const LayoutChange& change) const {
  for (const BlockRequest& r : visible) {
    const bool refused = std::ranges::binary_search(change.refused, r.patch);
    const auto found = live_.find(r.patch);
    if (refused == (found != live_.end())) return about(r.patch, "neither placed nor refused, or both");
    if (refused) continue;
    const Block& b = found->second;
    if (b.transposed != r.transposed) return about(r.patch, "transposed against its request");
    const auto limit = [&](std::uint32_t side) {
      return std::clamp(side, settings_.min_block_log2, settings_.superblock_log2);
    };
    if (b.width_log2 > limit(r.width_log2) || b.height_log2 > limit(r.height_log2)) {
      return about(r.patch, "larger than wanted");
    }
  }
  if (live_.size() + change.refused.size() != visible.size()) return "a hidden patch holds a block";
  return {};
}

std::string LayoutChecker::check_geometry() const {
  const std::uint32_t unit = settings_.min_block_log2;
  const std::uint32_t columns = settings_.atlas.width >> unit;
  std::vector<bool> taken(std::size_t{columns} * (settings_.atlas.height >> unit));
  for (const auto& [patch, b] : live_) {
    if (b.width_log2 < b.height_log2) return about(patch, "not landscape");
    if (b.height_log2 < settings_.min_block_log2 || b.width_log2 > settings_.superblock_log2) {
      return about(patch, "size out of range");
    }
    if (b.x % b.width() != 0 || b.y % b.height() != 0) return about(patch, "not aligned");
    if (b.x + b.width() > settings_.atlas.width || b.y + b.height() > settings_.atlas.height) {
      return about(patch, "leaves the atlas");
    }
    for (std::uint32_t y = b.y >> unit; y < (b.y + b.height()) >> unit; ++y) {
      for (std::uint32_t x = b.x >> unit; x < (b.x + b.width()) >> unit; ++x) {
        if (taken[std::size_t{y} * columns + x]) return about(patch, "overlaps another");
        taken[std::size_t{y} * columns + x] = true;
      }
    }
  }
  return {};
}

std::string LayoutChecker::check_usage(const AtlasAllocator& allocator) const {
  std::uint64_t texels = 0;
  for (const auto& [patch, block] : live_) texels += block.area();
  const AtlasUsage u = allocator.usage();
  if (u.allocated != texels) return "usage counts other texels as allocated than the blocks cover";
  if (u.allocated + u.partial_tail + u.on_stacks + u.inaccessible + u.free != settings_.atlas.area()) {
    return "usage does not sum to the atlas";
  }
  return {};
}

DriftingScene::DriftingScene(std::uint64_t seed, std::uint32_t patches, const AllocatorSettings& settings)
    : random_(seed), settings_(settings), wish_(patches), shown_(patches) {}

const std::vector<BlockRequest>& DriftingScene::step(double churn, double visible,
                                                     std::uint32_t largest_log2) {
  visible_.clear();
  const std::uint32_t low = settings_.min_block_log2;
  const std::uint32_t high = std::clamp(largest_log2, low, settings_.superblock_log2);
  for (std::uint32_t i = 0; i < wish_.size(); ++i) {
    if (random_.uniform() < churn) {
      shown_[i] = random_.uniform() < visible;
      const auto a = low + static_cast<std::uint32_t>(random_.below(high - low + 1));
      const auto b = low + static_cast<std::uint32_t>(random_.below(high - low + 1));
      wish_[i] = request(i, std::max(a, b), std::min(a, b), random_.below(2) == 0);
    }
    if (shown_[i]) visible_.push_back(wish_[i]);
  }
  return visible_;
}

}  // namespace atlaswire::render
