#pragma once

#include "base/random.h"
#include "netsim/link_profile.h"

#include <cstdint>

namespace atlaswire::netsim {

/// CoDel's control law, RFC 8289 section 5 pseudo-code: asked for each packet that leaves the queue.
class Codel {
 public:
  /// A packet leaves at `now` after `sojourn`, `backlog` octets remain behind it: drop (or mark) it? When
  /// true and the packet is dropped, ask again for the next one at the same `now`.
  bool drop(const QueueModel& model, Duration sojourn, std::uint64_t backlog, Time now);

 private:
  bool above_target(const QueueModel& model, Duration sojourn, std::uint64_t backlog, Time now);

  bool dropping_ = false;
  bool timing_ = false;  ///< first_above_ is set
  Time first_above_{};   ///< when sojourn will have been above target for an interval
  Time drop_next_{};
  std::uint32_t count_ = 0;
  std::uint32_t last_count_ = 0;
};

/// PIE, RFC 8033 section 4, with timestamps for the queueing delay: asked for each packet that arrives.
class Pie {
 public:
  explicit Pie(std::uint64_t seed) : random_(seed) {}
  static constexpr Duration kUpdatePeriod = std::chrono::milliseconds(15);

  /// Every kUpdatePeriod: the head packet's present waiting time (zero: empty queue).
  void update(const QueueModel& model, Duration queue_delay);
  /// A packet of `size` octets arrives while `backlog` octets wait: drop (or mark) it?
  bool drop(const QueueModel& model, std::uint64_t backlog, Duration queue_delay);
  [[nodiscard]] double probability() const { return probability_; }
  /// Further updates with an empty queue would change nothing.
  [[nodiscard]] bool settled() const;

 private:
  Random random_;
  double probability_ = 0;
  Duration old_delay_{};
  Duration burst_allowance_ = std::chrono::milliseconds(150);
};

}  // namespace atlaswire::netsim
