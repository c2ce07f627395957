#include "codec/flat_index.h"

#include <utility>

namespace atlaswire::codec {

namespace {

constexpr std::size_t kSmallest = 64;

}  // namespace

void FlatIndex::clear() {
  entries_.assign(kSmallest, {});
  mask_ = kSmallest - 1;
  size_ = 0;
}

void FlatIndex::insert(std::uint64_t key, std::uint32_t value) {
  if (2 * (size_ + 1) > entries_.size()) grow();
  entries_[place_of(key)] = {key, value};
  ++size_;
}

void FlatIndex::erase(std::uint64_t key) {
  std::size_t hole = place_of(key);
  for (std::size_t at = (hole + 1) & mask_; entries_[at].key != kEmpty; at = (at + 1) & mask_) {
    // An entry may move up unless its home lies behind the hole, up to where it is.
    const std::size_t home = home_of(entries_[at].key);
    if (((at - home) & mask_) < ((at - hole) & mask_)) continue;
    entries_[hole] = entries_[at];
    hole = at;
  }
  entries_[hole] = {};
  --size_;
}

void FlatIndex::grow() {
  std::vector<Entry> old(2 * entries_.size());
  std::swap(old, entries_);
  mask_ = entries_.size() - 1;
  for (const Entry& entry : old) {
    if (entry.key != kEmpty) entries_[place_of(entry.key)] = entry;
  }
}

}  // namespace atlaswire::codec
