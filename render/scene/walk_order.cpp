#include "render/scene/walk_order.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <tuple>

namespace atlaswire::render {

namespace {

constexpr std::uint32_t kNone = ~0U;

/// One number for each distinct position.
std::vector<std::uint32_t> numbers_of(std::span<const glm::vec3> positions) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t v) { return std::tie(positions[v].x, positions[v].y, positions[v].z); };
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> numbers(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    numbers[order[i]] = same ? numbers[order[i - 1]] : order[i];
  }
  return numbers;
}

/// A side of a patch, its ends by position.
struct Side {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::uint32_t group = 0;
};

bool operator<(const Side& a, const Side& b) {
  return std::tie(a.from, a.to, a.group) < std::tie(b.from, b.to, b.group);
}

std::vector<Side> sides_of(std::span<const glm::vec3> positions, std::span<const TriangleGroup> groups) {
  const std::vector<std::uint32_t> numbers = numbers_of(positions);
  std::vector<Side> sides;
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    const std::uint32_t corners = corner_count(groups[g].count);
    for (std::uint32_t c = 0; c < corners; ++c) {
      sides.push_back({numbers[groups[g].corners[c]], numbers[groups[g].corners[(c + 1) % corners]], g});
    }
  }
  return sides;
}

}  // namespace

WalkOrder::WalkOrder(std::span<const glm::vec3> positions, std::span<const TriangleGroup> groups)
    : behind_(groups.size()), where_(groups.size()) {
  const std::vector<Side> sides = sides_of(positions, groups);
  std::vector<Side> sorted = sides;
  std::ranges::sort(sorted, std::less<>{});
  for (const Side& side : sides) {
    while (first_.size() <= side.group) first_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
    const auto across = std::lower_bound(sorted.begin(), sorted.end(), Side{side.to, side.from, 0});
    if (across == sorted.end() || across->from != side.to || across->to != side.from) continue;
    if (across->group != side.group) neighbours_.push_back(across->group);
  }
  first_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
}

void WalkOrder::arrange(std::span<std::uint32_t> part) {
  // What a walk reaches is all that hangs together, so that no start changes what another touches.
  std::ranges::stable_sort(part, [&](std::uint32_t a, std::uint32_t b) { return behind_[a] > behind_[b]; });
  for (const std::uint32_t group : part) where_[group] = Where::kInPart;
  walk_.clear();
  for (const std::uint32_t start : part) {
    if (where_[start] == Where::kInPart) walk_from(start);
  }
  std::ranges::copy(walk_, part.begin());
}

void WalkOrder::walk_from(std::uint32_t start) {
  visit(start);
  trail_.assign(1, start);
  while (!trail_.empty()) {
    const std::uint32_t next = next_from(trail_.back());
    if (next == kNone) {
      trail_.pop_back();
    } else {
      visit(next);
      trail_.push_back(next);
    }
  }
}

/// The neighbour to go to, or kNone.
std::uint32_t WalkOrder::next_from(std::uint32_t group) const {
  std::uint32_t best = kNone;
  for (const std::uint32_t other : neighbours(group)) {
    if (where_[other] != Where::kInPart) continue;
    if (best == kNone || behind_[other] > behind_[best]) best = other;
  }
  return best;
}

void WalkOrder::visit(std::uint32_t group) {
  where_[group] = Where::kWalked;
  walk_.push_back(group);
  for (const std::uint32_t other : neighbours(group)) ++behind_[other];
}

}  // namespace atlaswire::render
