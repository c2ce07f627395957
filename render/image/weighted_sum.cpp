#include "render/image/weighted_sum.h"

#include <array>

namespace atlaswire::render {

namespace {

/// Outputs at once: their sums stay in registers while the weights are gone through.
constexpr std::size_t kLanes = 16;

template <class SourceOf>
void sum_blocks(std::span<const float> weights, const SourceOf& source_of, std::size_t count, float* out) {
  std::size_t x = 0;
  for (; x + kLanes <= count; x += kLanes) {
    std::array<float, kLanes> sums{};
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const float weight = weights[i];
      const float* from = source_of(i) + x;
      for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += weight * from[lane];
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) out[x + lane] = sums[lane];
  }
  for (; x < count; ++x) {
    float sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * source_of(i)[x];
    out[x] = sum;
  }
}

}  // namespace

void weighted_sum(std::span<const float> weights, const float* const* sources, std::size_t count,
                  float* out) {
  sum_blocks(
      weights, [sources](std::size_t i) { return sources[i]; }, count, out);
}

void weighted_sum_along(std::span<const float> weights, const float* row, std::size_t count, float* out) {
  sum_blocks(
      weights, [row](std::size_t i) { return row + i; }, count, out);
}

}  // namespace atlaswire::render
