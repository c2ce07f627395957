#pragma once

#include "base/ids.h"
#include "base/pose.h"
#include "base/time.h"
#include "proto/pose_packet.h"

#include <cstdint>
#include <optional>

namespace atlaswire::proto {

/// A pose with the server's time of its first arrival.
struct ReceivedPose {
  StampedPose stamped;  ///< `sampled` is in the client's clock
  Time received{};      ///< server clock
};

/// Server: keeps a client's newest pose by serial id, whatever order packets come in.
class PoseInbox {
 public:
  /// True when the packet brought a newer pose.
  bool add(const PosePacket& packet, Time received);
  /// nullopt before the first.
  [[nodiscard]] const std::optional<ReceivedPose>& newest() const { return newest_; }

  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  /// Packets that brought nothing new: duplicates and overtaken ones.
  [[nodiscard]] std::uint64_t stale_packets() const { return stale_; }
  /// Pose ids that were skipped for good: no packet brought them before a newer one came.
  [[nodiscard]] std::uint64_t missed_poses() const { return missed_; }

 private:
  std::optional<ReceivedPose> newest_;
  std::uint64_t packets_ = 0;
  std::uint64_t stale_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace atlaswire::proto
