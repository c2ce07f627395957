#pragma once

#include "base/bytes.h"
#include "base/ids.h"
#include "base/result.h"
#include "base/time.h"
#include "proto/h264_payload.h"
#include "proto/ntp_time.h"
#include "proto/rtp.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace atlaswire::proto {

/// A whole access unit as it came through the network.
struct AssembledFrame {
  FrameId frame{};
  PoseId pose{};
  NtpTime capture = 0;     ///< server clock
  ByteBuffer access_unit;  ///< Annex B
  bool idr = false;
  Time first_arrival{};  ///< client clock, first and last packet to arrive
  Time last_arrival{};
  std::uint32_t packets = 0;
  std::uint64_t octets = 0;  ///< RTP datagrams, headers included
};

/// What the assembler counted since it was made.
struct AssemblerCounts {
  std::uint64_t packets = 0;     ///< accepted
  std::uint64_t duplicates = 0;  ///< had come already
  std::uint64_t late = 0;        ///< their frame was given up or given out before
  std::uint64_t refused = 0;     ///< malformed payloads, no frame id, or too far ahead
  std::uint64_t frames = 0;      ///< given out
  std::uint64_t lost = 0;        ///< frame ids given up for missing or broken packets
  std::uint64_t withheld = 0;    ///< whole frames held back while waiting for an IDR
};

/// Client: RTP packets of one stream, in any order, to whole access units in order. A gap is waited for
/// until `reorder_wait` after the first packet beyond it; then its frame is lost, and frames are withheld
/// until an IDR (they would decode to garbage). Order is the sequence numbers'; frame ids label. Memory is
/// bounded by `max_packets` and `max_octets`. Safe on hostile packets. Deterministic.
class FrameAssembler {
 public:
  struct Settings {
    Duration reorder_wait = std::chrono::milliseconds(30);
    std::size_t max_packets = 8192;       ///< reorder window, a power of two, 1024..16384
    std::size_t max_octets = 16U << 20U;  ///< held at once
  };

  FrameAssembler() : FrameAssembler(Settings{}) {}
  explicit FrameAssembler(const Settings& settings);

  /// One packet of the stream (the caller has checked the SSRC), `datagram_octets` long as it came.
  void add(const RtpPacketView& packet, std::size_t datagram_octets, Time arrival);
  /// Gives up gaps whose time is over. Call when next_deadline() is reached.
  void poll(Time now);
  /// When a gap's time is over; nullopt without a gap.
  [[nodiscard]] std::optional<Time> next_deadline() const;
  /// The next frame in order, if there is one.
  std::optional<AssembledFrame> pop();

  /// Something was lost or withheld and no IDR has come since: ask for one (refresh_timer.h says when).
  [[nodiscard]] bool needs_refresh() const { return needs_refresh_; }
  /// The decoder failed: withhold frames until an IDR.
  void require_idr();
  [[nodiscard]] const AssemblerCounts& counts() const { return counts_; }

 private:
  struct Slot {
    bool used = false;
    bool marker = false;
    FrameId frame{};
    std::uint32_t timestamp = 0;
    std::optional<PoseId> pose;  ///< on a frame's first packet only
    NtpTime capture = 0;
    Time arrival{};
    std::size_t datagram_octets = 0;
    ByteBuffer payload;
  };

  Slot& slot(std::int64_t sequence) { return slots_[static_cast<std::size_t>(sequence) & mask_]; }
  [[nodiscard]] const Slot& slot(std::int64_t sequence) const {
    return slots_[static_cast<std::size_t>(sequence) & mask_];
  }
  bool admit(std::int64_t sequence, std::uint16_t raw);
  void restart_at(std::int64_t sequence);
  bool make_room(std::size_t octets);
  void store(const RtpPacketView& packet, std::int64_t sequence, std::size_t octets, Time arrival);
  void advance();
  void note_gap();
  void take_frame(std::int64_t last);
  [[nodiscard]] bool is_one_frame(std::int64_t last) const;
  Result<AssembledFrame> join(std::int64_t last);
  void deliver(AssembledFrame frame);
  void release_until(std::int64_t end);
  void give_up_gap();
  void give_up_until(std::int64_t end, std::optional<FrameId> next_frame);
  void lose();

  Settings settings_;
  std::size_t mask_;
  std::vector<Slot> slots_;
  std::size_t held_octets_ = 0;
  SequenceUnwrapper unwrapper_;
  bool started_ = false;
  bool opening_ = false;               ///< the first frame's start is not known yet: next_ may move back
  std::int64_t next_ = 0;              ///< first packet not given out or given up
  std::int64_t scanned_ = 0;           ///< first packet at or after next_ that is missing
  std::int64_t end_ = 0;               ///< one past the highest packet held
  std::int64_t gap_ = 0;               ///< the gap that gap_since_ tells of
  std::optional<Time> gap_since_;      ///< arrival of the first packet beyond it
  std::optional<std::uint16_t> far_;   ///< last sequence that was too far ahead: two in a row restart
  std::optional<FrameId> last_frame_;  ///< newest frame given out, withheld or lost
  bool gated_ = true;
  bool needs_refresh_ = false;
  H264Depacketizer depacketizer_;
  std::deque<AssembledFrame> ready_;
  AssemblerCounts counts_;
};

}  // namespace atlaswire::proto
