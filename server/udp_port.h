#pragma once

#include "base/bytes.h"
#include "proto/peer_address.h"
#include "server/asio_types.h"

#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>

namespace atlaswire::server {

/// An address of the kernel's as ours, and back; `v6`: for a socket of that family.
proto::PeerAddress to_peer(const sockaddr_storage& address);
socklen_t to_sockaddr(const proto::PeerAddress& peer, bool v6, sockaddr_storage& out);
/// "127.0.0.1:7400", "[::1]:7400".
std::string to_text(const proto::PeerAddress& peer);

/// The daemon's UDP socket. Reads in bounded batches, so that a flood never keeps the loop from sending;
/// while the kernel's send buffer is full, one datagram waits here and the owner must hold back the rest.
class UdpPort {
 public:
  using OnDatagram = std::function<void(const proto::PeerAddress& from, ByteView datagram)>;
  using OnBatch = std::function<void()>;

  /// `on_datagram` for each that came, then `on_batch`; `on_writable` when sending may go on.
  UdpPort(udp::socket socket, OnDatagram on_datagram, OnBatch on_batch, OnBatch on_writable);

  void start();
  void close();
  /// Sends or keeps it for later; not to be called while is_blocked(). Errors of one destination are
  /// nobody's business: the datagram is lost, as datagrams are.
  void send(const proto::PeerAddress& to, ByteView datagram);
  [[nodiscard]] bool is_blocked() const { return !pending_.empty(); }

 private:
  static constexpr std::size_t kBatch = 32;
  static constexpr std::size_t kBatchesPerTurn = 8;
  /// Clients send nothing larger; longer datagrams are cut, and then refused by their parsers.
  static constexpr std::size_t kMaxDatagram = 1500;

  struct Buffers {
    std::array<std::array<std::byte, kMaxDatagram>, kBatch> octets;
    std::array<sockaddr_storage, kBatch> from;
    std::array<iovec, kBatch> parts;
    std::array<mmsghdr, kBatch> messages;
  };

  void wait_readable();
  void wait_writable();
  void read_turn();
  int read_batch();
  bool try_send(const proto::PeerAddress& to, ByteView datagram);

  udp::socket socket_;
  bool v6_;
  OnDatagram on_datagram_;
  OnBatch on_batch_;
  OnBatch on_writable_;
  std::unique_ptr<Buffers> buffers_;
  proto::PeerAddress pending_to_;
  ByteBuffer pending_;
};

}  // namespace atlaswire::server
