#include "bench/increment.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace atlaswire::bench {

Increment IncrementMaker::next(const codec::MetaUpdate& update) {
  Increment increment{.update = &update};
  if (update.reset) shown_.clear();
  for (const codec::NewVertex& vertex : update.vertices) {
    if (value(vertex.id) >= positions_.size()) positions_.resize(std::size_t{value(vertex.id)} + 1);
    positions_[value(vertex.id)] = vertex.position;
  }
  take_out(update, increment);
  weld(update, increment);
  for (const codec::AddedPatch& patch : update.added) shown_.push_back(patch.id);
  return increment;
}

std::uint32_t IncrementMaker::added_triangles(const codec::MetaUpdate& update) {
  std::uint32_t triangles = 0;
  for (const codec::AddedPatch& patch : update.added) triangles += patch.triangles;
  return triangles;
}

void IncrementMaker::take_out(const codec::MetaUpdate& update, Increment& increment) {
  std::vector<PatchId> gone = update.removed;
  std::ranges::sort(gone);
  std::vector<PatchId> left;
  std::unordered_map<std::uint32_t, std::uint32_t> places;
  for (std::uint32_t place = 0; place < shown_.size(); ++place) {
    if (std::ranges::binary_search(gone, shown_[place])) {
      increment.removed.push_back(place);
    } else {
      places[value(shown_[place])] = static_cast<std::uint32_t>(left.size());
      left.push_back(shown_[place]);
    }
  }
  shown_ = std::move(left);
  for (const codec::MovedPatch& patch : update.moved) increment.moved.push_back(places.at(value(patch.id)));
}

void IncrementMaker::weld(const codec::MetaUpdate& update, Increment& increment) const {
  std::unordered_map<std::uint64_t, std::uint32_t> numbers;
  const auto number_of = [&](VertexId vertex) {
    const GridPosition& at = positions_[value(vertex)];
    const std::uint64_t key = std::uint64_t{at.x} | std::uint64_t{at.y} << 21U | std::uint64_t{at.z} << 42U;
    const auto [entry, fresh] =
        numbers.try_emplace(key, static_cast<std::uint32_t>(increment.positions.size()));
    if (fresh) increment.positions.push_back(at);
    return entry->second;
  };
  for (const codec::AddedPatch& patch : update.added) {
    for (std::uint32_t t = 0; t < patch.triangles; ++t) {
      std::array<std::uint32_t, 3> corners{};
      const auto layout = patch_triangle(patch.triangles, t);
      std::ranges::transform(layout, corners.begin(), [&](auto c) { return number_of(patch.corners[c]); });
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
      increment.indices.insert(increment.indices.end(), corners.begin(), corners.end());
    }
  }
}

}  // namespace atlaswire::bench
