#pragma once

#include <cstdint>

namespace atlaswire {

/// xoshiro256** seeded through SplitMix64 (Blackman and Vigna 2018): equal seeds give equal draws on
/// every machine. Not for secrets. The distributions are ours because std ones differ between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  /// 64 raw bits.
  std::uint64_t bits();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Uniform integer in [0, bound), bound >= 1, unbiased.
  std::uint64_t below(std::uint64_t bound);
  /// Normal with mean 0 and deviation 1 (polar Box-Muller, one draw kept).
  double normal();

 private:
  std::uint64_t state_[4];
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace atlaswire
