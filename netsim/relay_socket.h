#pragma once

#include "base/bytes.h"
#include "netsim/packet.h"

#include <boost/asio/ip/udp.hpp>
#include <span>

namespace atlaswire::netsim {

/// A UDP socket, non-blocking, that receives and sends datagrams with the ECN bits of their IP headers, IPv4
/// and IPv6 alike. The six bits beside them (DSCP) are not kept.
class RelaySocket {
 public:
  using Endpoint = boost::asio::ip::udp::endpoint;
  /// `socket`: open, and connected or not. Where the kernel cannot tell the bits, all arrives as not capable.
  explicit RelaySocket(boost::asio::ip::udp::socket socket);

  /// One datagram's octets; `from` and `ecn` are its sender and bits. `e`: would_block when none waits.
  std::size_t receive(std::span<std::byte> buffer, Endpoint& from, Ecn& ecn, boost::system::error_code& e);
  /// One datagram to `to`, which a connected socket is connected to.
  void send(ByteView octets, const Endpoint& to, Ecn ecn, boost::system::error_code& e);
  /// For waiting.
  boost::asio::ip::udp::socket& socket() { return socket_; }

 private:
  boost::asio::ip::udp::socket socket_;
  bool connected_;
};

}  // namespace atlaswire::netsim
