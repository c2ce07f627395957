#include "codec/resident_set.h"

#include <algorithm>

namespace atlaswire::codec {

std::uint32_t ResidentSet::lower_bound(PatchId id) const {
  const auto at = std::ranges::lower_bound(presences_, id, {}, &Presence::id);
  return static_cast<std::uint32_t>(at - presences_.begin());
}

void ResidentSet::merge(std::span<const NewResident> arrivals) {
  std::size_t old = presences_.size();
  std::size_t at = old + arrivals.size();
  presences_.resize(at);
  shapes_.resize(at);
  blocks_.resize(at);
  visible_ += static_cast<std::uint32_t>(arrivals.size());
  // From the back, so that each entry moves once, and in runs between arrivals.
  for (std::size_t left = arrivals.size(); left > 0;) {
    const NewResident& arrival = arrivals[--left];
    const auto begin = presences_.begin();
    const auto first = std::lower_bound(begin, begin + static_cast<std::ptrdiff_t>(old), arrival.id,
                                        [](const Presence& p, PatchId id) { return p.id < id; }) -
                       begin;
    const auto move_run = [&](auto& list) {
      std::move_backward(list.begin() + first, list.begin() + static_cast<std::ptrdiff_t>(old),
                         list.begin() + static_cast<std::ptrdiff_t>(at));
    };
    move_run(presences_);
    move_run(shapes_);
    move_run(blocks_);
    at -= old - static_cast<std::size_t>(first) + 1;
    old = static_cast<std::size_t>(first);
    presences_[at] = {.id = arrival.id, .visible = true, .history = 1};
    shapes_[at] = arrival.shape;
    blocks_[at] = arrival.block;
  }
}

void ResidentSet::drop(const std::vector<bool>& marks) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < presences_.size(); ++i) {
    if (marks[i]) {
      if (presences_[i].visible) --visible_;
      continue;
    }
    presences_[kept] = presences_[i];
    shapes_[kept] = shapes_[i];
    blocks_[kept] = blocks_[i];
    ++kept;
  }
  presences_.resize(kept);
  shapes_.resize(kept);
  blocks_.resize(kept);
}

void ResidentSet::clear() {
  presences_.clear();
  shapes_.clear();
  blocks_.clear();
  visible_ = 0;
}

}  // namespace atlaswire::codec
