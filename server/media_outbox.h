#pragma once

#include "base/time.h"
#include "base/units.h"
#include "proto/pacer.h"
#include "proto/rtp_sender.h"
#include "server/encoded_frame.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace atlaswire::server {

/// A frame that is through with a session's media queue.
struct Departure {
  FramePtr frame;
  Time queued{};
  Time left{};           ///< its last datagram went to the socket
  bool dropped = false;  ///< none of it went
};

/// A session's media: frames in, paced RTP datagrams and sender reports out. Bounded: a frame that does not
/// fit is dropped whole.
class MediaOutbox {
 public:
  struct Settings {
    proto::RtpSender::Settings rtp;
    proto::Pacer::Settings pacer;
    std::size_t max_pictures = 3;  ///< waiting: as many make it congested
    Duration report_interval = std::chrono::seconds(1);
  };

  explicit MediaOutbox(const Settings& settings);

  /// False when the frame was dropped: the next one must be an I-frame.
  bool send(const FramePtr& frame, Time now);
  /// The next datagram that may leave at `now`, borrowed until the next call.
  std::optional<ByteView> next_media(Time now);
  /// A sender report (SR and SDES), once an interval after the first picture; borrowed likewise.
  std::optional<ByteView> next_report(Time now);
  [[nodiscard]] std::optional<Time> next_deadline() const;

  /// What waits takes half the pacer's longest delay already, or is many pictures: frames should pause.
  [[nodiscard]] bool is_congested() const;
  /// Frames that left or were dropped since the last call, in order.
  std::vector<Departure> take_departures() { return std::exchange(departures_, {}); }
  [[nodiscard]] std::uint32_t ssrc() const { return sender_.ssrc(); }
  [[nodiscard]] std::uint32_t packet_count() const { return sender_.packet_count(); }

 private:
  void note_departures(Time now);

  Settings settings_;
  proto::RtpSender sender_;
  proto::Pacer pacer_;
  proto::DatagramBatch batch_;
  struct Waiting {
    FramePtr frame;
    Time queued{};
  };
  std::deque<Waiting> waiting_;  ///< the pictures in the pacer, in its order
  std::vector<Departure> departures_;
  ByteBuffer report_;
  std::optional<Time> report_due_;
};

}  // namespace atlaswire::server
