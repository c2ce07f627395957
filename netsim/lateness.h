#pragma once

#include "base/time.h"

#include <array>
#include <cstdint>

namespace atlaswire::netsim {

/// How late a live driver acts, in whole microseconds: a histogram of bounded size. What is later than 10 ms
/// counts as 10 ms in quantiles; `most` is exact.
class Lateness {
 public:
  static constexpr std::size_t kBins = 10'001;

  /// Something due at `due` happened at `done`; never early.
  void add(Time due, Time done);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// The least whole number of microseconds that a share `q` in (0, 1] of all does not exceed; 0 if none.
  [[nodiscard]] double quantile_us(double q) const;
  [[nodiscard]] double most_us() const { return to_ms(most_) * 1e3; }

 private:
  std::array<std::uint64_t, kBins> bins_{};  ///< bin n: in (n - 1, n] us
  std::uint64_t count_ = 0;
  Duration most_{};
};

}  // namespace atlaswire::netsim
