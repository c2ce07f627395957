#pragma once

#include <cstddef>
#include <span>

namespace atlaswire::render {

/// out[x] = sum over i of weights[i] * sources[i][x], for x < count: one axis of a separable filter, along
/// rows when the sources are one row shifted, across them when they are successive rows. Sums run in the
/// order of the weights, in float: the same on every machine. `out` overlaps no source.
void weighted_sum(std::span<const float> weights, const float* const* sources, std::size_t count, float* out);

/// The same along one row: out[x] = sum over i of weights[i] * row[x + i].
void weighted_sum_along(std::span<const float> weights, const float* row, std::size_t count, float* out);

}  // namespace atlaswire::render
