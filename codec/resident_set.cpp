#include "codec/resident_set.h"

#include <algorithm>

namespace atlaswire::codec {

std::uint32_t ResidentSet::lower_bound(PatchId id) const {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(ids_, id) - ids_.begin());
}

template <class Do>
void ResidentSet::for_each_list(Do action) {
  action(ids_);
  action(histories_);
  action(calms_);
  action(shapes_);
  action(blocks_);
}

void ResidentSet::merge(std::span<const NewResident> arrivals) {
  std::size_t old = ids_.size();
  std::size_t at = old + arrivals.size();
  for_each_list([&](auto& list) { list.resize(at); });
  visible_ += static_cast<std::uint32_t>(arrivals.size());
  // From the back, so that each entry moves once, and in runs between arrivals.
  for (std::size_t left = arrivals.size(); left > 0;) {
    const NewResident& arrival = arrivals[--left];
    const auto begin = ids_.begin();
    const auto first = std::lower_bound(begin, begin + static_cast<std::ptrdiff_t>(old), arrival.id) - begin;
    for_each_list([&](auto& list) {
      std::move_backward(list.begin() + first, list.begin() + static_cast<std::ptrdiff_t>(old),
                         list.begin() + static_cast<std::ptrdiff_t>(at));
    });
    at -= old - static_cast<std::size_t>(first) + 1;
    old = static_cast<std::size_t>(first);
    ids_[at] = arrival.id;
    histories_[at] = 1;
    calms_[at] = 0;
    shapes_[at] = arrival.shape;
    blocks_[at] = arrival.block;
  }
}

void ResidentSet::drop(const std::vector<bool>& marks) {
  std::size_t kept = 0;
  for (std::uint32_t i = 0; i < size(); ++i) {
    if (marks[i]) {
      if (visible(i)) --visible_;
      continue;
    }
    for_each_list([&](auto& list) { list[kept] = list[i]; });
    ++kept;
  }
  for_each_list([&](auto& list) { list.resize(kept); });
}

void ResidentSet::clear() {
  for_each_list([](auto& list) { list.clear(); });
  visible_ = 0;
}

}  // namespace atlaswire::codec
