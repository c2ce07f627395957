#pragma once

#include "base/bytes.h"
#include "base/ids.h"
#include "base/pose.h"
#include "base/result.h"
#include "proto/datagram.h"

#include <array>
#include <cstddef>
#include <span>

namespace atlaswire::proto {

/// Poses repeated in each packet, so that one lost packet loses no pose.
inline constexpr std::size_t kMaxPosesPerPacket = 3;
inline constexpr std::size_t kPoseRecordSize = 4 + 8 + 24 + 16 + 12 + 12;

/// Client to server: the last poses, newest first; docs/PROTOCOL.md, section 3.2.
struct PosePacket {
  SessionId session{};
  std::size_t count = 0;  ///< 1..3
  std::array<StampedPose, kMaxPosesPerPacket> poses{};

  [[nodiscard]] std::span<const StampedPose> view() const { return {poses.data(), count}; }
};

/// Replaces `out`'s contents. Orientation and velocities travel as float32, positions as float64.
void encode(const PosePacket& packet, ByteBuffer& out);

/// Refuses wrong sizes, counts, pose id 0, ids that do not descend, and poses that are not `is_sane`.
/// Orientations come out with unit length.
Result<PosePacket> parse_pose_packet(ByteView datagram);

/// Client: keeps the last poses and makes each packet from them.
class PoseOutbox {
 public:
  explicit PoseOutbox(SessionId session) { packet_.session = session; }
  /// Numbers the pose (from 1) and puts it first; gives its id.
  PoseId push(const Pose& pose, Time sampled);
  /// The packet to send now; count is 0 before the first push.
  [[nodiscard]] const PosePacket& packet() const { return packet_; }

 private:
  PosePacket packet_;
  PoseId last_{};
};

}  // namespace atlaswire::proto
