#pragma once

#include "server/asio_types.h"
#include "server/session.h"
#include "server/stream_runner.h"

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace atlaswire::server {

class Connection;

/// What a connection needs of the daemon around it.
class ConnectionHost {
 public:
  virtual ~ConnectionHost() = default;
  /// May one more session begin? The refusal, if not.
  virtual std::optional<proto::Refusal> admit(const Connection& connection) = 0;
  [[nodiscard]] virtual const proto::StreamDescription& description() const = 0;
  /// The operator's; a client's wish stands before it.
  [[nodiscard]] virtual const Emphasis& emphasis() const = 0;
  /// Starts a runner whose frames come back through Connection::on_frame and on_stream_failure.
  virtual std::unique_ptr<StreamRunner> start_stream(Connection& connection) = 0;
  /// Ends a runner without waiting.
  virtual void end_stream(std::unique_ptr<StreamRunner> runner) = 0;
  /// False when the socket is full: nothing more may be sent until the host pumps again.
  virtual bool can_send() = 0;
  virtual void send(const Connection& connection, const OutgoingDatagram& datagram) = 0;
  virtual void on_address(Connection& connection, const proto::PeerAddress& address) = 0;
  virtual void on_departure(const Connection& connection, const Departure& departure) = 0;
  /// It is over; the host forgets it.
  virtual void on_closed(Connection& connection) = 0;
};

/// A session on its TCP connection: moves bytes and frames between sockets, timer, runner and the session
/// core. Lives on the I/O thread alone. Handlers hold it; the host's list decides how long it matters.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(ConnectionHost& host, tcp::socket socket, const SessionSettings& settings,
             const SessionKeys& keys);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start();
  /// A datagram for this session; `pump` follows once a batch is read.
  void on_datagram(const proto::PeerAddress& from, ByteView datagram, Time now);
  void on_frame(const FramePtr& frame);
  void on_stream_failure(const std::string& reason);
  void close(proto::Goodbye::Reason reason, const std::string& text);
  /// The host's emphasis is another one now.
  void on_emphasis();
  /// Asks the stream for a picture of its layout; false when none runs.
  bool request_layout();
  /// Without a goodbye.
  void abort(const std::string& reason);
  /// Lets everything out that may leave, acts on the session's state, arms the timer.
  void pump();

  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] const Session& session() const { return session_; }
  /// "127.0.0.1:40312", of the TCP connection.
  [[nodiscard]] const std::string& peer() const { return peer_; }
  [[nodiscard]] const asio::ip::address& peer_address() const { return peer_address_; }
  [[nodiscard]] bool needs_pump() const { return needs_pump_; }

 private:
  void read();
  void write();
  void answer_hello(Time now);
  void steer_stream();
  void send_datagrams(Time now);
  void arm_timer(Time now);
  void finish();

  ConnectionHost& host_;
  tcp::socket socket_;
  asio::steady_timer timer_;
  std::optional<Time> armed_for_;
  asio::ip::address peer_address_;
  std::string peer_;
  Session session_;
  std::unique_ptr<StreamRunner> runner_;
  PoseId last_pose_{};
  Emphasis wish_;
  std::optional<proto::PeerAddress> known_address_;
  std::array<std::byte, 16384> input_{};
  bool reading_ = false;
  bool writing_ = false;
  bool needs_pump_ = false;
  bool finished_ = false;
};

}  // namespace atlaswire::server
