#pragma once

#include "base/bytes.h"
#include "proto/framing.h"
#include "proto/messages.h"
#include "proto/pose_packet.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace atlaswire::server {

/// A connected non-blocking socket on loopback; closed with the object.
class RawSocket {
 public:
  /// `type`: SOCK_STREAM or SOCK_DGRAM.
  RawSocket(int type, std::uint16_t port);
  ~RawSocket();
  RawSocket(const RawSocket&) = delete;
  RawSocket& operator=(const RawSocket&) = delete;

  [[nodiscard]] int fd() const { return fd_; }
  bool send(ByteView bytes);
  /// What is there now; empty when nothing is. `ended` turns true at the end of a stream.
  ByteBuffer receive();
  [[nodiscard]] bool ended() const { return ended_; }
  /// Waits up to `timeout` for something to read.
  bool wait(Duration timeout) const;

 private:
  int fd_ = -1;
  bool ended_ = false;
};

/// The least of a client: shakes hands, proves its address, sends poses, counts what comes. For tests of the
/// daemon; it decodes nothing.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port, const proto::ClientHello& hello = {});

  /// Works until `done` or the timeout; true when done.
  bool run_until(const std::function<bool()>& done, Duration timeout);
  bool run_until_frames(std::size_t frames, Duration timeout) {
    return run_until([&] { return paired() >= frames; }, timeout);
  }
  void send(const proto::Message& message);
  /// Sends a PLI.
  void lose_picture();

  [[nodiscard]] const std::optional<proto::ServerHello>& hello() const { return hello_; }
  [[nodiscard]] const std::optional<proto::Refusal>& refusal() const { return refusal_; }
  [[nodiscard]] const std::optional<proto::Goodbye>& goodbye() const { return goodbye_; }
  [[nodiscard]] const std::vector<proto::FrameMeta>& metas() const { return metas_; }
  /// Frames of which the last packet and the meta came.
  [[nodiscard]] std::size_t paired() const;
  [[nodiscard]] bool is_closed() const { return tcp_.ended(); }
  [[nodiscard]] std::uint64_t packets() const { return packets_; }

 private:
  void read_stream();
  void read_datagrams();
  void send_due(Time now);

  RawSocket tcp_;
  RawSocket udp_;
  proto::FrameReader reader_{proto::kMaxEnvelope};
  std::optional<proto::ServerHello> hello_;
  std::optional<proto::Refusal> refusal_;
  std::optional<proto::Goodbye> goodbye_;
  std::vector<proto::FrameMeta> metas_;
  std::set<FrameId> pictures_;
  std::uint64_t packets_ = 0;
  std::optional<proto::PoseOutbox> poses_;
  Time next_pose_{};
  bool proven_ = false;
};

}  // namespace atlaswire::server
