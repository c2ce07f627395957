#pragma once

#include "netsim/relay_context.h"

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <vector>

namespace atlaswire::netsim {

/// The relay's TCP half. A connection is two sockets and a stream of the emulator each way. As in TCP,
/// opening and closing take an octet of sequence space each way: the server is contacted when the client's
/// first octet (its SYN) has travelled up, nothing is read before the server's has travelled down, and an end
/// or a reset arrives behind the octets before it.
class RelayTcp {
 public:
  /// Octets one direction of a connection may have on their way or unread by the far end.
  static constexpr std::size_t kWindow = 4 * 1024 * 1024;

  RelayTcp(asio::io_context& io, tcp::acceptor acceptor, const tcp::endpoint& target);
  /// Starts to accept.
  void start(RelayContext& context);
  /// What the model delivers; not ours: ignored.
  void deliver(const Delivery& delivery);
  /// Reads on where the model has room again, and buries what has ended. Call after every delivery.
  void resume();

 private:
  /// One end: the socket, and the stream that what is read from it enters.
  struct Side {
    explicit Side(asio::io_context& io) : socket(io) {}
    tcp::socket socket;
    ByteBuffer out;             ///< arrived for this side, not yet taken by its socket
    std::uint64_t entered = 0;  ///< octets of this side's stream, markers included
    std::uint64_t arrived = 0;  ///< of those, at the far end
    bool closing = false;       ///< the last octet that entered says: no more
    bool reset = false;         ///< and it says so by a reset
    bool finished = false;      ///< that octet has arrived
    bool shut = false;          ///< told our socket that no more comes from the far end
    bool dead = false;          ///< our socket is closed
    bool write_waiting = false;
  };
  struct Connection {
    Connection(asio::io_context& io, FlowId f) : flow(f), sides{Side(io), Side(io)} {}
    FlowId flow;
    std::array<Side, 2> sides;  ///< by the direction their octets take: the client's, the server's
    bool open = false;
    bool ended = false;
    Side& from(Direction d) { return sides[static_cast<std::size_t>(d)]; }
    Side& to(Direction d) { return sides[1 - static_cast<std::size_t>(d)]; }
  };

  void accept();
  void admit(tcp::socket socket);
  void connect(Connection& c);
  void open(Connection& c);
  Connection* find(FlowId flow);
  void enter(Connection& c, Direction d, ByteView octets);
  void close_way(Connection& c, Direction d, bool reset);
  void fail(Connection& c, Direction d);
  void wait_readable(Connection& c, Direction d);
  void read(Connection& c, Direction d);
  [[nodiscard]] std::size_t room(Connection& c, Direction d) const;
  void write(Connection& c, Direction d);
  void end(Connection& c);

  asio::io_context& io_;
  RelayContext* context_ = nullptr;
  tcp::acceptor acceptor_;
  asio::steady_timer retry_;  ///< until accepting is tried again after a failure
  tcp::endpoint target_;
  std::map<FlowId, std::unique_ptr<Connection>> connections_;
  std::deque<std::pair<FlowId, Direction>> paused_;
  std::vector<FlowId> ended_;
  std::vector<std::byte> buffer_;
};

}  // namespace atlaswire::netsim
