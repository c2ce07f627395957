#pragma once

#include "base/pose.h"
#include "base/time.h"
#include "client/arrival.h"
#include "client/session_end.h"
#include "client/session_types.h"
#include "client/settings.h"
#include "client/traffic.h"
#include "proto/frame_assembler.h"
#include "proto/messages.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace atlaswire::client {

/// What the network thread is to do.
struct NetworkSettings {
  HostPort server;
  Duration wait{};  ///< to keep trying while nobody listens
  SessionSettings session;
  Duration pose_interval = std::chrono::milliseconds(16);
  /// The tracker, called on the network thread each `pose_interval` once the handshake has ended.
  std::function<std::optional<Pose>(Time)> sample_pose;
};

/// The session's numbers at one instant.
struct NetworkSnapshot {
  Time taken{};
  Traffic traffic;
  PacketCounts packets;
  proto::AssemblerCounts frames;
  std::uint64_t updates = 0;         ///< meta updates that arrived: one a server frame
  std::uint64_t overrun_frames = 0;  ///< dropped because the decoder was too slow
  bool clock_synchronized = false;
  Duration clock_offset{};  ///< server minus client
  Duration clock_error{};   ///< bound of its error
  Duration round_trip{};    ///< least of the last while
};

/// A Session on real sockets, in a thread of its own: connects, carries bytes and datagrams, samples poses,
/// fills the arrival queue, closes it at the end.
class NetworkThread {
 public:
  /// Starts at once. `arrivals` outlives it.
  NetworkThread(NetworkSettings settings, ArrivalQueue& arrivals);
  /// Ends the session without ceremony if it still runs.
  ~NetworkThread();
  NetworkThread(const NetworkThread&) = delete;
  NetworkThread& operator=(const NetworkThread&) = delete;

  /// Blocks until the server has answered, the session ended, or `interrupted` says so (nullopt: see `end`).
  std::optional<proto::ServerHello> wait_for_answer(const std::function<bool()>& interrupted);
  /// Says Goodbye, sends what is left (for a second at most) and joins the thread.
  void finish();

  /// The rest may be called from any thread at any time.
  void set_progress(const Progress& progress);
  void decode_failed();
  void request_restart(FrameId frame, std::string why);
  void fail(std::string why);
  /// At most 20 ms old.
  [[nodiscard]] NetworkSnapshot snapshot() const;
  [[nodiscard]] std::optional<SessionEnd> end() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atlaswire::client
