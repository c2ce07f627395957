#pragma once

#include "base/time.h"
#include "base/units.h"
#include "proto/datagram_batch.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

namespace atlaswire::proto {

/// A rate that never holds anything back.
inline constexpr BitRate kUnlimitedRate{std::numeric_limits<std::uint64_t>::max()};

/// What became of a picture given to the pacer.
struct PacerVerdict {
  bool accepted = true;
  std::uint32_t dropped = 0;  ///< pictures queued before that were thrown away whole for this IDR
  /// The client will miss a picture: the next one sent must be an IDR.
  [[nodiscard]] bool needs_idr() const { return !accepted; }
};

/// Server: releases datagrams at a rate instead of in bursts that routers drop. Bounded by octets and by
/// time: a picture that would wait too long is refused whole; an IDR replaces waiting pictures that have
/// not begun to leave. A picture that began to leave always leaves whole. Rate 0 releases nothing and
/// keeps one picture, kUnlimitedRate releases everything at once. Rates count UDP payload octets.
class Pacer {
 public:
  struct Settings {
    BitRate rate{25'000'000};     ///< e.g. 2.5 times the video's bit rate
    Bytes burst{12'000};          ///< may leave back to back after a pause
    Bytes max_queued{4U << 20U};  ///< one picture is accepted however large when nothing waits
    Duration max_delay = std::chrono::milliseconds(250);  ///< of a picture's last octet, by the rate
  };

  explicit Pacer(const Settings& settings) : settings_(settings) {}

  void set_rate(BitRate rate, Time now);
  /// Takes the picture, or leaves `batch` as it was when refused. `batch` gets a spent batch's buffers, so
  /// that a caller that reuses it allocates nothing.
  PacerVerdict enqueue(DatagramBatch& batch, Time now);
  /// The next datagram if it may leave at `now`, borrowed until the next call of `pop`, `enqueue` or `clear`.
  std::optional<ByteView> pop(Time now);
  /// When the next datagram may leave; nullopt when nothing waits or the rate is 0.
  [[nodiscard]] std::optional<Time> next_deadline() const;
  /// Throws everything away; gives the number of pictures that were not sent whole.
  std::uint32_t clear();

  [[nodiscard]] Bytes queued() const { return queued_; }
  [[nodiscard]] std::size_t queued_pictures() const { return queue_.size(); }

 private:
  [[nodiscard]] bool fits(const DatagramBatch& batch, Time now) const;
  std::uint32_t drop_waiting();
  void recycle(DatagramBatch&& batch);

  Settings settings_;
  std::deque<DatagramBatch> queue_;
  std::size_t next_in_front_ = 0;  ///< datagrams of the front picture that have left
  Bytes queued_{};
  Time next_send_ = Time::min();
  Time last_enqueue_{};
  DatagramBatch leaving_;  ///< holds the last datagram lent out of a picture that is done
  std::vector<DatagramBatch> spare_;
};

}  // namespace atlaswire::proto
