#include "proto/pose_inbox.h"

#include <algorithm>

namespace atlaswire::proto {

bool PoseInbox::add(const PosePacket& packet, Time received) {
  if (packet.count == 0) return false;
  ++packets_;
  const StampedPose& first = packet.poses[0];
  if (newest_ && !is_newer(first.id, newest_->stamped.id)) {
    ++stale_;
    return false;
  }
  if (newest_) {
    const PoseId before = newest_->stamped.id;
    const auto brought = std::count_if(packet.view().begin(), packet.view().end(),
                                       [&](const StampedPose& p) { return is_newer(p.id, before); });
    missed_ += value(first.id) - value(before) - static_cast<std::uint32_t>(brought);
  }
  newest_ = ReceivedPose{first, received};
  return true;
}

}  // namespace atlaswire::proto
