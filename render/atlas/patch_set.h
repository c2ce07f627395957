#pragma once

#include "base/ids.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// A set of patches, a bit each; it grows to the largest id put in.
class PatchSet {
 public:
  [[nodiscard]] bool contains(PatchId patch) const {
    return word(patch) < words_.size() && (words_[word(patch)] & bit(patch)) != 0;
  }
  void insert(PatchId patch) {
    if (word(patch) >= words_.size()) words_.resize(word(patch) + 1);
    words_[word(patch)] |= bit(patch);
  }
  void erase(PatchId patch) {
    if (word(patch) < words_.size()) words_[word(patch)] &= ~bit(patch);
  }
  void clear() { std::ranges::fill(words_, 0U); }

  /// Ascending.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::size_t i = 0; i < words_.size(); ++i) visit_word(i, words_[i], visit);
  }
  /// Those that are not in `other`, ascending.
  template <class Visit>
  void for_each_not_in(const PatchSet& other, Visit visit) const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      visit_word(i, i < other.words_.size() ? words_[i] & ~other.words_[i] : words_[i], visit);
    }
  }

 private:
  static constexpr std::uint32_t kBits = 64;

  static std::size_t word(PatchId patch) { return value(patch) / kBits; }
  static std::uint64_t bit(PatchId patch) { return std::uint64_t{1} << (value(patch) % kBits); }
  template <class Visit>
  static void visit_word(std::size_t i, std::uint64_t bits, Visit& visit) {
    for (; bits != 0; bits &= bits - 1) {
      visit(PatchId{static_cast<std::uint32_t>(i * kBits) +
                    static_cast<std::uint32_t>(std::countr_zero(bits))});
    }
  }

  std::vector<std::uint64_t> words_;
};

}  // namespace atlaswire::render
