#include "proto/ntp_time.h"

namespace atlaswire::proto {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// Whole seconds rounded down, and the nanoseconds left, 0..kSecond - 1.
struct Split {
  std::int64_t seconds;
  std::uint64_t nanos;
};

Split split(Time t) {
  const std::int64_t all = to_nanos(t);
  std::int64_t seconds = all / kSecond;
  std::int64_t nanos = all % kSecond;
  if (nanos < 0) {
    nanos += kSecond;
    --seconds;
  }
  return {seconds, static_cast<std::uint64_t>(nanos)};
}

}  // namespace

NtpTime to_ntp(Time t) {
  const Split at = split(t);
  return (static_cast<std::uint64_t>(at.seconds) << 32U) | ((at.nanos << 32U) / kSecond);
}

Time from_ntp(NtpTime ntp) {
  const std::uint64_t fraction = ntp & 0xFFFF'FFFFU;
  const std::uint64_t nanos = (fraction * kSecond + (1ULL << 31U)) >> 32U;
  return from_nanos(static_cast<std::int64_t>((ntp >> 32U) * kSecond + nanos));
}

std::uint32_t to_rtp_time(Time t, std::uint32_t base) {
  const Split at = split(t);
  return base + static_cast<std::uint32_t>(static_cast<std::uint64_t>(at.seconds) * 90'000U +
                                           at.nanos * 9U / 100'000U);
}

}  // namespace atlaswire::proto
