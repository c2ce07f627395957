#pragma once

#include "base/time.h"
#include "base/units.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace atlaswire::netsim {

/// A random delay's shape. `correlation` is the lag-1 correlation of the underlying normal sequence (a
/// Gaussian copula: the shape's own distribution stays exact, which a plain blend of successive draws
/// would not keep).
struct DelayModel {
  enum class Shape : std::uint8_t { kConstant, kUniform, kNormal, kPareto, kEmpirical };
  Shape shape = Shape::kConstant;
  Duration base{};            ///< constant: the delay; uniform: middle; normal: mean; Pareto: the least delay
  Duration spread{};          ///< uniform: half width; normal: deviation; Pareto: mean above `base`
  double pareto_alpha = 3.0;  ///< tail exponent, > 1; smaller is heavier
  std::vector<Duration> samples;  ///< empirical: sorted; drawn by inverse distribution, interpolated
  double correlation = 0.0;       ///< [0, 1), of successive draws
  /// Zero: every packet draws. Otherwise one draw holds for a stretch of this length, so that delay is a
  /// function of time: where packets keep their order, one extreme draw holds up all behind it, and the delay
  /// of a busy link would otherwise grow with its packet rate.
  Duration hold{};
  Duration most = std::chrono::hours(1);  ///< draws beyond are cut to it
};

/// Which packets the air loses.
struct LossModel {
  enum class Kind : std::uint8_t { kNone, kBernoulli, kGilbertElliott, kFourState, kPeriodic, kList };
  Kind kind = Kind::kNone;
  double probability = 0;  ///< Bernoulli
  /// Gilbert-Elliott: good to bad, bad to good, loss in good, loss in bad.
  double p = 0;
  double r = 1;
  double loss_good = 0;
  double loss_bad = 1;
  /// Four states (netem's "state" model): 1 received in gap, 2 received in burst, 3 lost in burst, 4 lone
  /// loss.
  double p13 = 0;
  double p31 = 1;
  double p32 = 0;
  double p23 = 1;
  double p14 = 0;
  std::uint64_t period = 0;         ///< periodic: every `period` packets ...
  std::uint64_t burst = 0;          ///< ... this many are lost
  std::vector<std::uint64_t> list;  ///< packet numbers, ascending
};

/// How fast packets leave. Exactly one of the two kinds.
struct RateModel {
  std::optional<BitRate> rate;  ///< token bucket; absent and no trace: infinite; zero: nothing passes
  Bytes burst{0};               ///< bucket depth; 0 is pure serialization
  std::vector<Duration> trace;  ///< mahimahi: instants within one period at which 1504 octets may leave
  Duration trace_period{};      ///< the last instant, after which the trace starts over
};

/// What holds packets while the bottleneck is busy.
struct QueueModel {
  enum class Policy : std::uint8_t { kDropTail, kDropHead, kCodel, kPie };
  Policy policy = Policy::kDropTail;
  Bytes limit{256 * 1024};
  std::optional<Duration> time_limit;                  ///< packets older than this leave unserved
  Duration target = std::chrono::milliseconds(5);      ///< CoDel; PIE's default is 15 ms
  Duration interval = std::chrono::milliseconds(100);  ///< CoDel's; PIE's update period is 15 ms
  bool ecn = false;                                    ///< mark capable packets rather than drop
};

/// One direction's behaviour for a stretch of time.
struct LinkParameters {
  DelayModel delay;
  LossModel loss;
  RateModel rate;
  QueueModel queue;
  double duplicate = 0;  ///< probability
  double corrupt = 0;    ///< probability that one bit flips
  double reorder = 0;    ///< probability that a packet skips the delay and overtakes
  Bytes overhead{28};    ///< IP and UDP octets that count against rate and queue
};

/// A change during a run: from `at` on, these parameters; `down` is a blackout.
struct ProfileStep {
  Duration at{};
  bool down = false;
  LinkParameters parameters;
};

/// One direction over time; steps ascend, the first is at 0.
struct LinkProfile {
  std::vector<ProfileStep> steps;
};

}  // namespace atlaswire::netsim
