#include "netsim/relay.h"

#include "base/program.h"
#include "netsim/relay_tcp.h"
#include "netsim/relay_udp.h"

#include <fmt/format.h>
#include <sys/prctl.h>

#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdio>

namespace atlaswire::netsim {

namespace {

/// Ports tried for one that is free in both TCP and UDP.
constexpr int kAttempts = 32;
constexpr Duration kHousekeeping = std::chrono::seconds(1);

struct Listeners {
  tcp::acceptor stream;
  udp::socket datagram;
};

bool bind_both(Listeners& l, const asio::ip::address& address, std::uint16_t port,
               boost::system::error_code& e) {
  l.stream.open(address.is_v6() ? tcp::v6() : tcp::v4(), e);
  if (!e) l.stream.set_option(tcp::acceptor::reuse_address(true), e);
  if (!e) l.stream.bind({address, port}, e);
  if (!e) l.stream.listen(asio::socket_base::max_listen_connections, e);
  if (e) return false;
  const udp::endpoint beside(address, l.stream.local_endpoint().port());
  l.datagram.open(beside.protocol(), e);
  if (!e) l.datagram.bind(beside, e);
  return !e;
}

Listeners listen(asio::io_context& io, const RelaySettings& s) {
  boost::system::error_code e;
  const auto address = asio::ip::make_address(s.listen_address, e);
  if (e)
    throw ProgramError(ExitCode::kUsage, fmt::format("--listen {}: must be an IP address", s.listen_address));
  for (int attempt = 0; attempt < (s.port == 0 ? kAttempts : 1); ++attempt) {
    Listeners l{tcp::acceptor(io), udp::socket(io)};
    if (bind_both(l, address, s.port, e)) return l;
  }
  throw ProgramError(
      ExitCode::kPortInUse,
      fmt::format("cannot listen on {} port {} (TCP and UDP): {}; end what holds it, or choose "
                  "another port (0: any free one)",
                  s.listen_address, s.port, e.message()));
}

asio::ip::address resolve(asio::io_context& io, const std::string& host) {
  boost::system::error_code e;
  udp::resolver resolver(io);
  const auto found = resolver.resolve(host, "", e);
  if (e || found.empty()) {
    throw ProgramError(ExitCode::kCannotConnect,
                       fmt::format("cannot find --to host '{}': {}", host, e.message()));
  }
  return found.begin()->endpoint().address();
}

Duration unix_now() { return std::chrono::system_clock::now().time_since_epoch(); }

}  // namespace

struct Relay::Impl {
  explicit Impl(const RelaySettings& s)
      : settings(s),
        listeners(listen(io, settings)),
        port(listeners.stream.local_endpoint().port()),
        target(resolve(io, settings.target_host)),
        udp_half(io, std::move(listeners.datagram), {target, settings.target_port}),
        tcp_half(io, std::move(listeners.stream), {target, settings.target_port}),
        context(std::make_unique<RelayContext>(settings, start, unix_now())) {}

  void run() {
    prctl(PR_SET_TIMERSLACK, 1UL);  // wake up when asked to, not 50 us later
    signals.async_wait([this](const boost::system::error_code& e, int) { stopped = stopped || !e; });
    udp_half.start(*context);
    tcp_half.start(*context);
    next_housekeeping = start + kHousekeeping;
    last_line = start;
    while (!stopped) {
      serve_sockets();
      const Time now = context->now();
      pump(now);
      if (settings.duration > Duration::zero() && now - start >= settings.duration) break;
      wait(now);
    }
    elapsed = context->now() - start;
    context->emulator.finish();
    keep_decisions();
    context->stats.stream_repeats = context->emulator.stream_repeats();
    context->recorder.close();
  }

  /// Sockets that are ready get their turn, until something is due: a flood would keep them ready for ever.
  void serve_sockets() {
    while (!stopped && io.poll_one() > 0) {
      const auto due = context->emulator.next_event();
      if (due && *due <= context->now()) return;
    }
  }

  void keep_decisions() {
    for (const DirectedDecision& d : context->emulator.take_decisions()) {
      context->stats.count(d.decision, d.direction);
      context->recorder.log(d);
    }
  }

  void pump(Time now) {
    for (const Delivery& d : context->emulator.deliver(now)) {
      udp_half.deliver(d);
      tcp_half.deliver(d);
    }
    tcp_half.resume();
    keep_decisions();
    if (now < next_housekeeping) return;
    next_housekeeping += kHousekeeping;
    udp_half.expire(now);
    if (settings.live_line) show_line(now);
  }

  void show_line(Time now) {
    const std::string line = stats_line(context->stats, before, now - last_line);
    std::fprintf(stderr, "%s\n", line.c_str());
    before = context->stats;
    last_line = now;
  }

  /// Sleeps until shortly before the next arrival, and not at all when it is near: `run` then spins.
  void wait(Time now) {
    Time wake = next_housekeeping;
    if (settings.duration > Duration::zero()) wake = std::min(wake, start + settings.duration);
    if (const auto event = context->emulator.next_event()) wake = std::min(wake, *event);
    if (const auto arrival = context->emulator.next_arrival())
      wake = std::min(wake, *arrival - settings.spin);
    if (stopped || wake <= now) return;
    if (wake != armed) {
      armed = wake;
      timer.expires_at(std::chrono::steady_clock::time_point(wake.time_since_epoch()));
      timer.async_wait([](const boost::system::error_code&) {});
    }
    io.run_one();
  }

  const RelaySettings settings;
  asio::io_context io{1};
  Listeners listeners;
  std::uint16_t port;
  asio::ip::address target;
  Time start = steady_now();
  RelayUdp udp_half;
  RelayTcp tcp_half;
  std::unique_ptr<RelayContext> context;
  asio::steady_timer timer{io};
  asio::signal_set signals{io, SIGINT, SIGTERM};
  bool stopped = false;
  Time next_housekeeping{};
  Time armed{};
  Time last_line{};
  RelayStats before;
  Duration elapsed{};
};

Relay::Relay(const RelaySettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Relay::~Relay() = default;
std::uint16_t Relay::port() const { return impl_->port; }
void Relay::run() { impl_->run(); }
void Relay::stop() {
  asio::post(impl_->io, [impl = impl_.get()] { impl->stopped = true; });
}
const RelayStats& Relay::stats() const { return impl_->context->stats; }
Duration Relay::elapsed() const { return impl_->elapsed; }

}  // namespace atlaswire::netsim
