#pragma once

#include "base/program.h"
#include "server/asio_types.h"
#include "server/connection.h"
#include "server/daemon.h"
#include "server/frame_stats.h"
#include "server/listen_sockets.h"
#include "server/mirror.h"
#include "server/reaper.h"
#include "server/udp_port.h"

#include <boost/asio/signal_set.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace atlaswire::server {

/// The daemon's parts, all on the I/O thread. daemon.cpp: serving and draining; daemon_host.cpp: what it does
/// for its connections; daemon_requests.cpp: what an operator asks of it while it runs.
class Daemon::Impl final : public ConnectionHost {
 public:
  explicit Impl(const DaemonSettings& settings);
  ~Impl() override;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  void serve(StreamSource& source, const DaemonHooks& hooks);
  void stop();
  void reload();
  void draw_layout();

  std::optional<proto::Refusal> admit(const Connection& connection) override;
  [[nodiscard]] const proto::StreamDescription& description() const override;
  [[nodiscard]] const Emphasis& emphasis() const override { return settings_.stream.render.emphasis; }
  std::unique_ptr<StreamRunner> start_stream(Connection& connection) override;
  void end_stream(std::unique_ptr<StreamRunner> runner) override;
  bool can_send() override { return !udp_->is_blocked(); }
  void send(const Connection& connection, const OutgoingDatagram& datagram) override;
  void on_address(Connection& connection, const proto::PeerAddress& address) override;
  void on_departure(const Connection& connection, const Departure& departure) override;
  void on_closed(Connection& connection) override;

 private:
  void watch_signals();
  void wait_signal();
  void watch_requests();
  void wait_request();
  void reload_now();
  void draw_layout_now();
  void keep_layout(SessionId session, const render::Picture& layout) const;
  void drain(const std::string& why);
  void finish_drain();
  void end_connections();
  void accept();
  void take(tcp::socket socket);
  void on_datagram(const proto::PeerAddress& from, ByteView datagram);
  Connection* find(SessionId id);
  [[nodiscard]] std::vector<std::shared_ptr<Connection>> snapshot() const;
  void pump_marked();
  void pump_all();
  void arm_end();
  void arm_stats();
  void log_stats();

  DaemonSettings settings_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer accept_again_;
  asio::signal_set signals_;
  asio::signal_set requests_;  ///< of the operator, to a daemon that goes on
  asio::steady_timer stats_timer_;
  asio::steady_timer end_timer_;
  asio::steady_timer drain_timer_;
  std::uint16_t port_ = 0;
  StreamSource* source_ = nullptr;
  DaemonHooks hooks_;
  StatsCsv csv_;
  StatsLine line_;
  Time stats_since_{};
  std::unique_ptr<UdpPort> udp_;
  std::unique_ptr<Mirror> mirror_;
  std::optional<SessionId> mirrored_;
  std::uint32_t last_session_ = 0;
  std::size_t streaming_ = 0;
  std::uint64_t stray_datagrams_ = 0;
  bool draining_ = false;
  std::map<proto::PeerAddress, SessionId> by_address_;
  std::map<SessionId, std::shared_ptr<Connection>> connections_;
  std::unique_ptr<Reaper> reaper_;  ///< while serving: its runners use `source_` and post to `io_`
};

}  // namespace atlaswire::server
