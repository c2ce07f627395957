#pragma once

#include "base/program.h"
#include "server/asio_types.h"

#include <cstdint>
#include <string>

namespace atlaswire::server {

/// A bound TCP acceptor, not yet listening, and a UDP socket of the same address and port number.
struct ListenSockets {
  tcp::acceptor stream;
  udp::socket datagram;
};

/// Port 0: a number that is free for both. Throws ProgramError: kUsage when `address` is no IP address,
/// kPortInUse when it cannot be had.
ListenSockets open_sockets(asio::io_context& io, const std::string& address, std::uint16_t port);

/// The error to throw when listening fails.
ProgramError cannot_listen(const std::string& address, std::uint16_t port, const std::string& why);

}  // namespace atlaswire::server
