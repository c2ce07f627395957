#include "base/time.h"

#include <cmath>
#include <limits>

namespace atlaswire {

Duration from_seconds(double seconds) {
  const double nanos = seconds * 1e9;
  constexpr double kLimit = 9.2e18;
  if (!(nanos < kLimit)) return Duration::max();
  if (!(nanos > -kLimit)) return Duration::min();
  return Duration{std::llround(nanos)};
}

}  // namespace atlaswire
