#include "render/scene/keyframes.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace atlaswire::render {

namespace {

using Interpolation = RigChannel::Interpolation;

glm::dquat quaternion(std::span<const double> v) { return {v[3], v[0], v[1], v[2]}; }

void put_unit(const glm::dquat& q, std::span<double> out) {
  const double length = glm::length(q);
  const glm::dquat unit = length > 1e-12 && std::isfinite(length) ? q / length : glm::dquat(1, 0, 0, 0);
  out[0] = unit.x;
  out[1] = unit.y;
  out[2] = unit.z;
  out[3] = unit.w;
}

/// A key's numbers; of a cubic spline `part` 0 is the in-tangent, 1 the value, 2 the out-tangent.
std::span<const float> key(const RigChannel& channel, std::size_t index, std::size_t part) {
  const bool cubic = channel.interpolation == Interpolation::kCubicSpline;
  const std::size_t at = cubic ? 3 * index + part : index;
  return std::span(channel.values).subspan(at * channel.width, channel.width);
}

void hermite(const RigChannel& channel, std::size_t from, double t, double elapsed, std::span<double> out) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  const auto value0 = key(channel, from, 1);
  const auto tangent0 = key(channel, from, 2);
  const auto tangent1 = key(channel, from + 1, 0);
  const auto value1 = key(channel, from + 1, 1);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = (2 * t3 - 3 * t2 + 1) * value0[i] + elapsed * (t3 - 2 * t2 + t) * tangent0[i] +
             (-2 * t3 + 3 * t2) * value1[i] + elapsed * (t3 - t2) * tangent1[i];
  }
}

void between(const RigChannel& channel, std::size_t from, double t, std::span<double> out) {
  const auto a = key(channel, from, 1);
  const auto b = key(channel, from + 1, 1);
  if (channel.path == RigChannel::Path::kRotation) {
    const glm::dquat qa = glm::normalize(glm::dquat(a[3], a[0], a[1], a[2]));
    const glm::dquat qb = glm::normalize(glm::dquat(b[3], b[0], b[1], b[2]));
    put_unit(glm::slerp(qa, qb, t), out);
    return;
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = (1 - t) * a[i] + t * b[i];
}

}  // namespace

void sample(const RigChannel& channel, double seconds, std::span<double> out) {
  AW_ASSERT(!channel.times.empty() && out.size() == channel.width);
  const auto after = std::ranges::upper_bound(channel.times, seconds, std::less<>{});
  const auto count = static_cast<std::size_t>(after - channel.times.begin());
  const std::size_t from = count == 0 ? 0 : count - 1;
  const bool ends = count == 0 || count == channel.times.size();
  if (ends || channel.interpolation == Interpolation::kStep) {
    std::ranges::copy(key(channel, from, 1), out.begin());
  } else {
    const double elapsed = double{channel.times[from + 1]} - channel.times[from];
    const double t = (seconds - channel.times[from]) / elapsed;
    if (channel.interpolation == Interpolation::kCubicSpline) {
      hermite(channel, from, t, elapsed, out);
    } else {
      between(channel, from, t, out);
    }
  }
  if (channel.path == RigChannel::Path::kRotation) put_unit(quaternion(out), out);
}

}  // namespace atlaswire::render
