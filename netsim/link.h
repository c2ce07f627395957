#pragma once

#include "base/random.h"
#include "netsim/aqm.h"
#include "netsim/bottleneck.h"
#include "netsim/delay.h"
#include "netsim/loss.h"
#include "netsim/packet.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace atlaswire::netsim {

/// Told of every decision as it becomes final, with the packet's octets as they entered (or, when corrupted,
/// as they leave). For recordings.
class Tap {
 public:
  virtual ~Tap() = default;
  virtual void decided(const Decision& decision, ByteView payload) = 0;
};

/// One direction of an emulated path: queue, then serialize, then propagate.
/// No sockets, threads or clock: time enters as `now`, chance as `seed`, so equal inputs give equal
/// deliveries, byte for byte, however often or seldom the caller looks. `now` must never decrease.
/// The air's chances (loss, duplication, corruption, reordering) are drawn by packet number at arrival,
/// so that runs which differ in rate or queue lose the same packets, and take effect behind the
/// bottleneck: a lost packet has used its share of the rate. Jitter alone never reorders.
class Link {
 public:
  /// Profile times count from `start`.
  Link(LinkProfile profile, std::uint64_t seed, Time start);

  /// A packet of `flow` enters; gives its number. With a capable `ecn`, marking may replace a drop by CoDel
  /// or PIE.
  std::uint64_t send(ByteBuffer payload, Time now, FlowId flow = {}, Ecn ecn = Ecn::kNotCapable);
  /// The next instant at which anything inside may happen; empty: idle until the next `send`.
  [[nodiscard]] std::optional<Time> next_event() const;
  /// What has arrived by `now`, in order of arrival.
  std::vector<Datagram> deliver(Time now);
  /// Decisions made final since the last call, in the order they became so.
  std::vector<Decision> take_decisions();
  /// `tap` (borrowed; null for none) hears of every decision from now on.
  void set_tap(Tap* tap) { tap_ = tap; }
  /// When what is in flight next arrives; empty: nothing is past the bottleneck.
  [[nodiscard]] std::optional<Time> next_arrival() const;
  /// Nothing will be sent any more: decides every waiting packet, running on for at most a day after the last
  /// `send`; what the rate has not let through by then is unsent.
  void finish();
  /// Octets the queue has room for, overhead included.
  [[nodiscard]] std::uint64_t room() const;
  /// Octets waiting for the bottleneck, overhead included.
  [[nodiscard]] std::uint64_t backlog() const { return backlog_; }

 private:
  struct Waiting {
    Decision decision;
    ByteBuffer payload;
    std::uint64_t octets = 0;  ///< with overhead
    Duration propagation{};
    bool lost = false;
    bool copy = false;
    std::uint64_t flipped_bit = 0;
    [[nodiscard]] bool can_be_marked() const { return decision.ecn != Ecn::kNotCapable; }
  };
  struct InFlight {
    Time arrival{};
    std::uint64_t order = 0;
    Datagram datagram;
  };

  [[nodiscard]] const LinkParameters& parameters() const { return profile_.steps[step_].parameters; }
  [[nodiscard]] std::optional<Time> next_internal() const;
  [[nodiscard]] Duration head_delay(Time now) const;
  void advance(Time to);
  void enter_next_step();
  void serve_head(const Service& service);
  void propagate(Waiting packet, Time left);
  void launch(const Waiting& packet, Decision decision);
  void decide(const Decision& decision, ByteView payload);
  void drop_front(Fate fate, Time at);
  bool admit(Waiting& packet, Time now);

  LinkProfile profile_;
  Time start_;
  std::size_t step_ = 0;
  Bottleneck bottleneck_;
  LossProcess loss_;
  DelaySampler delay_;
  Random air_;
  Codel codel_;
  Pie pie_;
  Time next_pie_update_;
  std::deque<Waiting> queue_;
  std::uint64_t backlog_ = 0;
  std::vector<InFlight> in_flight_;  ///< heap by (arrival, order)
  std::vector<Decision> decisions_;
  Tap* tap_ = nullptr;
  std::uint64_t packets_ = 0;
  std::uint64_t launches_ = 0;
  Time last_sent_;
  Time last_arrival_{Duration::min()};
};

}  // namespace atlaswire::netsim
