#pragma once

#include "base/time.h"

#include <cstdint>

namespace atlaswire::proto {

/// Seconds and 2^-32 fractions of a clock since its own zero, as RTCP and the capture time extension carry
/// them; wraps after 2^32 s. Not wall-clock time: docs/PROTOCOL.md, section 4.2.
using NtpTime = std::uint64_t;

/// Exact to 2^-32 s; `from_ntp(to_ntp(t))` is `t` within 1 ns for t in [0, 2^32 s).
NtpTime to_ntp(Time t);
Time from_ntp(NtpTime ntp);

/// The middle 32 bits, as LSR carries them (RFC 3550 section 4): units of 2^-16 s.
constexpr std::uint32_t middle(NtpTime ntp) { return static_cast<std::uint32_t>(ntp >> 16U); }

/// RTP's 90 kHz clock at `t`, from `base` at the clock's zero; wraps.
std::uint32_t to_rtp_time(Time t, std::uint32_t base);

}  // namespace atlaswire::proto
