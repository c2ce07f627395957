#include "codec/motion_fit.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::codec {

namespace {

constexpr std::uint32_t kCount = MotionWeights::kCount;
constexpr std::uint32_t kMostWanted = 8192;
constexpr double kKept = 0.9;  ///< of the sums, from frame to frame

using Row = std::array<double, kCount + 1>;

/// Gaussian elimination of a positive definite system; the last column is the right-hand side.
void solve(std::array<Row, kCount>& rows) {
  for (std::size_t pivot = 0; pivot < kCount; ++pivot) {
    for (std::size_t row = 0; row < kCount; ++row) {
      if (row == pivot) continue;
      const double factor = rows[row][pivot] / rows[pivot][pivot];
      for (std::size_t column = pivot; column <= kCount; ++column)
        rows[row][column] -= factor * rows[pivot][column];
    }
  }
}

}  // namespace

void MotionFit::note(std::uint32_t set, const Features& features, double velocity, double calmness) {
  Sums& sums = sets_[set];
  for (std::uint32_t row = 0; row < kCount; ++row) {
    const double weighed = calmness * features[row];
    for (std::uint32_t column = row; column < kCount; ++column)
      sums.products[row][column] += weighed * features[column];
    sums.with_velocity[row] += weighed * velocity;
  }
  ++sums.noted;
  sums.fresh = true;
}

MotionWeights MotionFit::renew(std::uint32_t set, const MotionWeights& now) {
  Sums& sums = sets_[set];
  MotionWeights renewed = now;
  if (!sums.fresh) return renewed;
  sums.fresh = false;
  if (sums.noted >= sums.wanted) {
    double trace = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) trace += sums.products[i][i];
    // Weights that nothing speaks for stay as they are.
    const double inertia = 1e-5 * trace / kCount + 1e-3;
    std::array<Row, kCount> rows{};
    for (std::uint32_t row = 0; row < kCount; ++row) {
      for (std::uint32_t column = 0; column < kCount; ++column)
        rows[row][column] = sums.products[std::min(row, column)][std::max(row, column)];
      rows[row][row] += inertia;
      rows[row][kCount] = sums.with_velocity[row] + inertia * now.of[row] / MotionWeights::kOne;
    }
    solve(rows);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const double weight = std::round(MotionWeights::kOne * rows[i][kCount] / rows[i][i]);
      if (!std::isfinite(weight)) return now;
      renewed.of[i] =
          static_cast<std::int32_t>(std::clamp<double>(weight, -MotionWeights::kMost, MotionWeights::kMost));
    }
    sums.noted = 0;
    sums.wanted = std::min(2 * sums.wanted, kMostWanted);
  }
  for (auto& row : sums.products) {
    for (double& product : row) product *= kKept;
  }
  for (double& product : sums.with_velocity) product *= kKept;
  return renewed;
}

}  // namespace atlaswire::codec
