#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlaswire::codec {

/// A map from 64-bit keys to 32-bit values, in one array: open addressing with linear probing, entries moved
/// up on erasure. `seed` scatters the keys: a peer that chooses keys but does not know it cannot make them
/// collide. What it answers depends on nothing but what was put in.
class FlatIndex {
 public:
  static constexpr std::uint32_t kNone = ~0U;

  explicit FlatIndex(std::uint64_t seed) : seed_(seed | 1U) { clear(); }

  /// The value at a key; kNone: there is none.
  [[nodiscard]] std::uint32_t find(std::uint64_t key) const {
    const Entry& entry = entries_[place_of(key)];
    return entry.key == key ? entry.value : kNone;
  }
  /// The key must be new and not 2^64 - 1.
  void insert(std::uint64_t key, std::uint32_t value);
  /// The key must be there.
  void erase(std::uint64_t key);
  void clear();
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  struct Entry {
    std::uint64_t key = kEmpty;
    std::uint32_t value = 0;
  };

  [[nodiscard]] std::size_t home_of(std::uint64_t key) const {
    std::uint64_t x = (key ^ seed_) * 0x9E3779B97F4A7C15U;
    x = (x ^ x >> 32U) * seed_;
    return static_cast<std::size_t>(x ^ x >> 29U) & mask_;
  }
  /// Where the key is, or the empty place where it would go.
  [[nodiscard]] std::size_t place_of(std::uint64_t key) const {
    std::size_t at = home_of(key);
    while (entries_[at].key != key && entries_[at].key != kEmpty) at = (at + 1) & mask_;
    return at;
  }
  void grow();

  std::uint64_t seed_;
  std::vector<Entry> entries_;
  std::size_t mask_ = 0;
  std::size_t size_ = 0;
};

}  // namespace atlaswire::codec
