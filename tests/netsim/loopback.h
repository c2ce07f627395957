#pragma once

#include "base/bytes.h"

#include <netinet/in.h>
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace atlaswire::netsim {

/// A blocking loopback socket with a time limit on every call, closed at its end.
class LoopbackSocket {
 public:
  enum class Kind { kUdp, kTcp };
  explicit LoopbackSocket(Kind kind);
  explicit LoopbackSocket(int fd) : fd_(fd) {}
  LoopbackSocket(LoopbackSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  LoopbackSocket& operator=(LoopbackSocket&&) = delete;
  ~LoopbackSocket();

  [[nodiscard]] int fd() const { return fd_; }
  bool connect(std::uint16_t port) const;
  /// To 127.0.0.1 and any free port, or to `port`; gives the port, 0 on failure.
  std::uint16_t bind_and_listen(Kind kind, std::uint16_t port = 0) const;
  bool send(ByteView octets) const;
  /// One datagram, or what a stream has; empty: end. nullopt: nothing within the limit, or an error (errno).
  std::optional<ByteBuffer> receive() const;
  /// What it sends from now on has these ECN bits, 0..3.
  void send_with_ecn(int bits) const;
  struct Received {
    ByteBuffer octets;
    int ecn = 0;
    sockaddr_in from{};
  };
  /// One datagram, its ECN bits and its sender.
  [[nodiscard]] std::optional<Received> receive_with_ecn() const;
  void limit_waiting(std::chrono::milliseconds limit) const;
  void end_sending() const;
  void reset();

 private:
  int fd_;
};

/// Echoes datagrams, ECN bits included, and streams of one port on threads of its own until it ends.
class EchoServer {
 public:
  EchoServer();
  ~EchoServer();
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] int resets() const { return resets_; }

 private:
  void echo_datagrams();
  void echo_streams();

  LoopbackSocket udp_;
  LoopbackSocket tcp_;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_ = false;
  std::atomic<int> resets_ = 0;
  std::thread datagrams_;
  std::thread streams_;
};

/// Runs a command line; its exit code, and stdout and stderr together.
std::pair<int, std::string> run_command(const std::string& command);

}  // namespace atlaswire::netsim
