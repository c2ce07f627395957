#include "server/listen_sockets.h"

#include <fmt/format.h>

#include <utility>

namespace atlaswire::server {

namespace {

/// Ports tried for one that is free in both TCP and UDP.
constexpr int kAttempts = 32;

asio::ip::address parse_address(const std::string& text) {
  boost::system::error_code e;
  const auto address = asio::ip::make_address(text, e);
  if (e) throw ProgramError(ExitCode::kUsage, fmt::format("--listen {}: must be an IP address", text));
  return address;
}

/// Listening detects a listener that shares the address; `bind` alone does not with SO_REUSEADDR, which is
/// there so that a restarted daemon gets its port back at once.
bool bind_both(ListenSockets& s, const asio::ip::address& address, std::uint16_t port,
               boost::system::error_code& e) {
  const tcp::endpoint at(address, port);
  s.stream.open(at.protocol(), e);
  if (!e) s.stream.set_option(tcp::acceptor::reuse_address(true), e);
  if (!e) s.stream.bind(at, e);
  if (e) return false;
  const udp::endpoint beside(address, s.stream.local_endpoint().port());
  s.datagram.open(beside.protocol(), e);
  if (!e) s.datagram.bind(beside, e);
  return !e;
}

}  // namespace

ProgramError cannot_listen(const std::string& address, std::uint16_t port, const std::string& why) {
  return {ExitCode::kPortInUse,
          fmt::format("cannot listen on {} port {} (TCP and UDP): {}; end what holds it, or choose another "
                      "--port (0: any free one)",
                      address, port, why)};
}

ListenSockets open_sockets(asio::io_context& io, const std::string& address, std::uint16_t port) {
  const auto ip = parse_address(address);
  boost::system::error_code e;
  for (int attempt = 0; attempt < (port == 0 ? kAttempts : 1); ++attempt) {
    ListenSockets sockets{tcp::acceptor(io), udp::socket(io)};
    if (bind_both(sockets, ip, port, e)) return sockets;
  }
  throw cannot_listen(address, port, e.message());
}

}  // namespace atlaswire::server
