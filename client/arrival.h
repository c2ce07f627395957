#pragma once

#include "base/pose.h"
#include "client/bounded_queue.h"
#include "client/session_types.h"
#include "proto/frame_assembler.h"

#include <cstddef>
#include <memory>
#include <optional>

namespace atlaswire::client {

/// The server's stamps of a frame on the client's clock, and the pose it was rendered for.
struct ServerTimes {
  std::optional<StampedPose> pose;  ///< nullopt: none, or forgotten
  Time pose_received{};
  Time render_start{};
  Time encode_end{};
};

/// A meta update with its frame's server times.
struct UpdateArrival {
  ArrivedUpdate update;
  ServerTimes server;
};

/// What the network thread hands to the decode thread, in the order of arrival; exactly one is there.
struct Arrival {
  std::unique_ptr<proto::AssembledFrame> frame;
  std::unique_ptr<UpdateArrival> update;
};
using ArrivalQueue = BoundedQueue<Arrival>;

/// Places of the queue. With more than `kMaxQueuedFrames` waiting, access units are dropped and an IDR is
/// asked for; with more than `kMaxQueuedUpdates`, the reliable channel is not read, and its peer feels it.
inline constexpr std::size_t kArrivalPlaces = 256;
inline constexpr std::size_t kMaxQueuedFrames = 32;
inline constexpr std::size_t kMaxQueuedUpdates = 192;

}  // namespace atlaswire::client
