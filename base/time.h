#pragma once

#include <chrono>
#include <cstdint>

namespace atlaswire {

/// Lengths of time everywhere: signed 64-bit nanoseconds.
using Duration = std::chrono::nanoseconds;

/// The clock of a process or of a virtual-time run. It has no `now()`: time enters as an argument, from
/// a steady clock in the shells or from an event queue in the lab. Its zero is arbitrary.
struct SessionClock {
  using duration = Duration;
  using rep = Duration::rep;
  using period = Duration::period;
  using time_point = std::chrono::time_point<SessionClock>;
  static constexpr bool is_steady = true;
};

/// An instant on the local SessionClock.
using Time = SessionClock::time_point;

/// For shells only: this process's steady clock as a Time. Protocol code and models never call it.
inline Time steady_now() {
  return Time{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

/// Nanoseconds since the clock's zero, for the wire and for files.
inline std::int64_t to_nanos(Time t) { return t.time_since_epoch().count(); }
inline Time from_nanos(std::int64_t nanos) { return Time{Duration{nanos}}; }

/// Milliseconds as a real, for reports.
inline double to_ms(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }
inline double to_seconds(Duration d) { return std::chrono::duration<double>(d).count(); }

/// Seconds as a real to a Duration, rounded to nearest; values beyond +-292 years saturate.
Duration from_seconds(double seconds);

}  // namespace atlaswire
