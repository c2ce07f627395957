#pragma once

#include "codec/bit_io.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace atlaswire::codec {

/// Bits of a column's own code order.
inline constexpr std::uint32_t kColumnOrderBits = 4;

/// One attribute of a list as [SAS] 6.5 codes it: the order of exponential-Golomb codes that takes the fewest
/// bits, then the numbers.
class GolombColumn {
 public:
  void add(std::uint32_t number) { numbers_.push_back(number); }
  void add_signed(std::int32_t number) { numbers_.push_back(zigzag(number)); }

  void write(BitWriter& out) const {
    if (numbers_.empty()) return;
    std::uint32_t best = 0;
    std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max();
    for (std::uint32_t order = 0; order < (1U << kColumnOrderBits); ++order) {
      std::uint64_t bits = 0;
      for (const std::uint32_t number : numbers_) bits += BitWriter::golomb_length(number, order);
      if (bits >= fewest) continue;
      fewest = bits;
      best = order;
    }
    out.write(best, kColumnOrderBits);
    for (const std::uint32_t number : numbers_) out.write_golomb(number, best);
  }

 private:
  std::vector<std::uint32_t> numbers_;
};

/// Ids that ascend: each less the one before, less one.
class GolombIds {
 public:
  void add(std::uint32_t id) {
    column_.add(id - expected_);
    expected_ = id + 1;
  }
  void write(BitWriter& out) const { column_.write(out); }

 private:
  GolombColumn column_;
  std::uint32_t expected_ = 0;
};

}  // namespace atlaswire::codec
