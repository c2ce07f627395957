#pragma once

#include "base/time.h"
#include "server/settings.h"

namespace atlaswire::server {

/// How far ahead of its pose a frame must still be right, from what is measured: the pose's way here and the
/// picture's way back (round trip), our own processing and pacing, and that the client shows a frame until
/// the next one comes (frame interval). Exponentially weighted, so that one slow frame does not swell the
/// visible set.
class CoverEstimator {
 public:
  CoverEstimator(const CoverSettings& settings, Duration nominal_interval);

  void on_round_trip(Duration round_trip) { round_trip_ = round_trip; }
  /// A frame is encoded: time since the arrival of its pose, and since the start of the frame before it.
  void on_frame(Duration processing, Duration interval);
  /// A frame's last datagram left this long after its encoding.
  void on_sending(Duration sending);
  [[nodiscard]] Duration cover() const;
  /// How long after a frame's start its picture is on display, in the middle of that time: what cover() is
  /// beyond the pose's way here, its wait until the start, `waited`, and half a frame interval.
  [[nodiscard]] Duration display_delay(Duration waited) const;

 private:
  CoverSettings settings_;
  Duration round_trip_{};
  Duration processing_{};
  Duration sending_{};
  Duration interval_;
  bool measured_ = false;
};

}  // namespace atlaswire::server
