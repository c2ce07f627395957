#include "server/daemon.h"

#include "proto/datagram.h"
#include "server/daemon_impl.h"
#include "server/secure_random.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <csignal>
#include <cstdlib>
#include <utility>

namespace atlaswire::server {

Daemon::Daemon(const DaemonSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Daemon::~Daemon() = default;
std::uint16_t Daemon::port() const { return impl_->port(); }
void Daemon::serve(StreamSource& source, const DaemonHooks& hooks) { impl_->serve(source, hooks); }
void Daemon::stop() { impl_->stop(); }
void Daemon::reload() { impl_->reload(); }
void Daemon::draw_layout() { impl_->draw_layout(); }

Daemon::Impl::Impl(const DaemonSettings& settings)
    : settings_(settings),
      acceptor_(io_),
      accept_again_(io_),
      signals_(io_),
      requests_(io_),
      stats_timer_(io_),
      end_timer_(io_),
      drain_timer_(io_),
      csv_(settings.stats_csv) {
  auto sockets = open_sockets(io_, settings.listen, settings.port);
  acceptor_ = std::move(sockets.stream);
  port_ = acceptor_.local_endpoint().port();
  udp_ = std::make_unique<UdpPort>(
      std::move(sockets.datagram),
      [this](const proto::PeerAddress& from, ByteView datagram) { on_datagram(from, datagram); },
      [this] { pump_marked(); }, [this] { pump_all(); });
  if (settings.mirror) mirror_ = std::make_unique<Mirror>(io_, *settings.mirror);
}

Daemon::Impl::~Impl() { end_connections(); }

void Daemon::Impl::end_connections() {
  for (const auto& connection : std::exchange(connections_, {})) connection.second->abort("daemon ends");
  reaper_.reset();
}

void Daemon::Impl::serve(StreamSource& source, const DaemonHooks& hooks) {
  source_ = &source;
  hooks_ = hooks;
  reaper_ = std::make_unique<Reaper>();
  boost::system::error_code e;
  acceptor_.listen(asio::socket_base::max_listen_connections, e);
  if (e) throw cannot_listen(settings_.listen, port_, e.message());
  watch_signals();
  watch_requests();
  udp_->start();
  accept();
  if (settings_.max_runtime > Duration{0}) arm_end();
  if (settings_.stats_interval > Duration{0}) arm_stats();
  spdlog::info("listening on {}:{} (TCP and UDP), scene '{}', atlas {}x{}", settings_.listen, port_,
               source.description().scene, source.description().atlas.width,
               source.description().atlas.height);
  if (hooks_.on_ready) hooks_.on_ready();
  io_.run();
  udp_->close();
  end_connections();
  spdlog::info("served {} sessions; bye", last_session_);
}

void Daemon::Impl::stop() {
  asio::post(io_, [this] { drain("asked to stop"); });
}

void Daemon::Impl::watch_signals() {
  boost::system::error_code ignored;
  signals_.add(SIGINT, ignored);
  signals_.add(SIGTERM, ignored);
  wait_signal();
}

void Daemon::Impl::wait_signal() {
  signals_.async_wait([this](const boost::system::error_code& e, int number) {
    if (e) return;
    if (draining_) std::_Exit(static_cast<int>(ExitCode::kInterrupted));
    drain(number == SIGINT ? "SIGINT" : "SIGTERM");
    wait_signal();
  });
}

void Daemon::Impl::drain(const std::string& why) {
  if (std::exchange(draining_, true)) return;
  spdlog::info("draining {} connections ({})", connections_.size(), why);
  boost::system::error_code ignored;
  acceptor_.close(ignored);
  accept_again_.cancel();
  stats_timer_.cancel();
  end_timer_.cancel();
  drain_timer_.expires_after(settings_.admission.drain_timeout + std::chrono::milliseconds(500));
  drain_timer_.async_wait([this](const boost::system::error_code& e) {
    if (!e) io_.stop();
  });
  for (const auto& connection : snapshot()) {
    connection->close(proto::Goodbye::Reason::kDraining, "the server is shutting down");
  }
  finish_drain();
}

void Daemon::Impl::finish_drain() {
  if (draining_ && connections_.empty()) io_.stop();
}

void Daemon::Impl::accept() {
  acceptor_.async_accept([this](const boost::system::error_code& e, tcp::socket socket) {
    if (e == asio::error::operation_aborted || draining_) return;
    if (e) {
      // Out of file descriptors, most likely: try again when some may be free.
      spdlog::warn("cannot accept a connection: {}", e.message());
      accept_again_.expires_after(std::chrono::milliseconds(100));
      accept_again_.async_wait([this](const boost::system::error_code& again) {
        if (!again) accept();
      });
      return;
    }
    take(std::move(socket));
    accept();
  });
}

void Daemon::Impl::take(tcp::socket socket) {
  boost::system::error_code gone;
  const auto peer = socket.remote_endpoint(gone);
  if (gone) return;
  const auto& limits = settings_.admission;
  const auto same = std::count_if(connections_.begin(), connections_.end(),
                                  [&](const auto& c) { return c.second->peer_address() == peer.address(); });
  if (connections_.size() >= limits.max_connections ||
      static_cast<std::uint64_t>(same) >= limits.max_connections_per_address) {
    spdlog::warn("{}: too many connections ({} in all, {} from there); closed", peer.address().to_string(),
                 connections_.size(), same);
    return;
  }
  last_session_ = std::max(last_session_ + 1, 1U);
  const SessionId id{last_session_};
  const SessionSettings session{limits, settings_.delivery, settings_.stream.video.bit_rate};
  const auto connection = std::make_shared<Connection>(*this, std::move(socket), session, random_keys(id));
  connections_.emplace(id, connection);
  connection->start();
}

void Daemon::Impl::on_datagram(const proto::PeerAddress& from, ByteView datagram) {
  using proto::DatagramKind;
  const Time now = steady_now();
  Connection* connection = nullptr;
  switch (proto::classify(datagram)) {
    case DatagramKind::kProbe:
    case DatagramKind::kConfirm:
    case DatagramKind::kPose:
    case DatagramKind::kSyncRequest:
      if (const auto session = proto::session_of(datagram)) connection = find(*session);
      break;
    case DatagramKind::kRtcp:
      if (const auto known = by_address_.find(from); known != by_address_.end())
        connection = find(known->second);
      break;
    default:
      break;
  }
  if (connection == nullptr) {
    ++stray_datagrams_;
    return;
  }
  connection->on_datagram(from, datagram, now);
}

Connection* Daemon::Impl::find(SessionId id) {
  const auto found = connections_.find(id);
  return found == connections_.end() ? nullptr : found->second.get();
}

std::vector<std::shared_ptr<Connection>> Daemon::Impl::snapshot() const {
  std::vector<std::shared_ptr<Connection>> all;
  for (const auto& connection : connections_) all.push_back(connection.second);
  return all;
}

void Daemon::Impl::pump_marked() {
  for (const auto& connection : snapshot()) {
    if (connection->needs_pump()) connection->pump();
  }
}

void Daemon::Impl::pump_all() {
  for (const auto& connection : snapshot()) connection->pump();
}

void Daemon::Impl::arm_end() {
  end_timer_.expires_after(settings_.max_runtime);
  end_timer_.async_wait([this](const boost::system::error_code& e) {
    if (!e) drain("--max-runtime passed");
  });
}

void Daemon::Impl::arm_stats() {
  stats_since_ = steady_now();
  stats_timer_.expires_after(settings_.stats_interval);
  stats_timer_.async_wait([this](const boost::system::error_code& e) {
    if (e) return;
    if (streaming_ > 0) log_stats();
    arm_stats();
  });
}

void Daemon::Impl::log_stats() {
  const std::string atlas = line_.atlas();
  spdlog::info("{} | stray datagrams {}", line_.take(steady_now() - stats_since_, streaming_),
               stray_datagrams_);
  spdlog::info(atlas);
  for (const auto& connection : connections_) {
    const Session& session = connection.second->session();
    if (session.state() != SessionState::kStreaming) continue;
    spdlog::debug("session {}: round trip {:.1f} ms, loss {:.1f} %, picture losses {}, dropped {}",
                  value(session.id()), to_ms(session.round_trip()), session.loss() * 100,
                  session.counts().picture_losses, session.counts().frames_dropped);
  }
}

}  // namespace atlaswire::server
