#pragma once

#include "netsim/link_profile.h"

#include <cstdint>
#include <optional>

namespace atlaswire::netsim {

/// When one packet may start and when its last octet leaves.
struct Service {
  Time start{};  ///< taken from the queue
  Time end{};    ///< wholly sent
};

/// The rate of a link: a token bucket or a trace of packet opportunities, in exact integer arithmetic.
class Bottleneck {
 public:
  explicit Bottleneck(Time start) : epoch_(start), full_at_(start) {}

  /// A packet of `octets` waits since `ready`, behind all that was served: when would it be sent? Empty:
  /// never, at this rate. Does not change state.
  [[nodiscard]] std::optional<Service> plan(const RateModel& model, Time ready, std::uint64_t octets) const;
  /// The packet is sent as planned.
  void commit(const RateModel& model, const Service& service, Time ready, std::uint64_t octets);
  /// The rate changes at `at`: tokens owed are kept, in octets.
  void change_rate(const RateModel& before, const RateModel& after, Time at);

 private:
  /// A place in the endless repetition of a trace: opportunity number and octets of it already used.
  struct Cursor {
    std::uint64_t opportunity = 0;
    std::uint64_t used = 0;
  };
  [[nodiscard]] Time opportunity_time(const RateModel& model, std::uint64_t index) const;
  [[nodiscard]] Cursor first_opportunity(const RateModel& model, Time ready) const;
  [[nodiscard]] Service plan_trace(const RateModel& model, Time ready, std::uint64_t octets,
                                   Cursor& end) const;

  Time epoch_;
  Time full_at_;  ///< token bucket: when the bucket is (or was) full again
  Cursor cursor_;
};

/// Octets of one mahimahi packet opportunity.
inline constexpr std::uint64_t kOpportunityOctets = 1504;

}  // namespace atlaswire::netsim
