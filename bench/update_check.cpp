#include "bench/update_check.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>

namespace atlaswire::bench {

namespace {

void demand(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

void take_in(const codec::MetaUpdate& update, std::vector<GridPosition>& positions) {
  if (update.reset) positions.clear();
  for (const codec::NewVertex& vertex : update.vertices) {
    const std::size_t id = value(vertex.id);
    if (id >= positions.size()) positions.resize(id + 1);
    positions[id] = vertex.position;
  }
}

template <class Entry>
std::vector<Entry> by_id(std::vector<Entry> list) {
  std::ranges::sort(list, {}, &Entry::id);
  return list;
}

std::vector<PatchId> sorted(std::vector<PatchId> ids) {
  std::ranges::sort(ids);
  return ids;
}

std::uint64_t mixed(std::uint64_t h) {
  h = (h ^ h >> 30U) * 0xBF58476D1CE4E5B9U;
  h = (h ^ h >> 27U) * 0x94D049BB133111EBU;
  return h ^ h >> 31U;
}

}  // namespace

void UpdateCheck::compare(const codec::MetaUpdate& told, const codec::MetaUpdate& heard) {
  take_in(told, told_);
  take_in(heard, heard_);
  demand(told.frame == heard.frame && told.reset == heard.reset, "another frame was decoded");
  demand(sorted(told.removed) == sorted(heard.removed), "other removals were decoded");
  const auto told_added = by_id(told.added);
  const auto heard_added = by_id(heard.added);
  demand(told_added.size() == heard_added.size(), "more or fewer patches were decoded");
  for (std::size_t i = 0; i < told_added.size(); ++i) {
    const codec::AddedPatch& a = told_added[i];
    const codec::AddedPatch& b = heard_added[i];
    demand(std::tie(a.id, a.triangles, a.draw, a.block) == std::tie(b.id, b.triangles, b.draw, b.block),
           "another patch was decoded");
    for (std::uint32_t c = 0; c < corner_count(a.triangles); ++c) {
      demand(told_.at(value(a.corners[c])) == heard_.at(value(b.corners[c])), "another corner was decoded");
    }
  }
  const auto told_moved = by_id(told.moved);
  const auto heard_moved = by_id(heard.moved);
  demand(std::ranges::equal(told_moved, heard_moved,
                            [](const codec::MovedPatch& a, const codec::MovedPatch& b) {
                              return a.id == b.id && a.block == b.block;
                            }),
         "other moves were decoded");
}

std::uint64_t triangle_set_hash(const std::vector<GridPosition>& positions,
                                const std::vector<std::uint32_t>& indices) {
  std::uint64_t sum = 0;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    std::array<std::uint64_t, 3> corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      const GridPosition& at = positions.at(indices[t + c]);
      corners[c] = mixed(std::uint64_t{at.x} | std::uint64_t{at.y} << 21U | std::uint64_t{at.z} << 42U);
    }
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    sum += mixed(mixed(mixed(corners[0]) + corners[1]) + corners[2]);
  }
  return sum;
}

}  // namespace atlaswire::bench
