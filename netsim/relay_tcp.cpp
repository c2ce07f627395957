#include "netsim/relay_tcp.h"

#include <boost/asio/buffer.hpp>

namespace atlaswire::netsim {

namespace {

constexpr std::size_t kChunk = 16 * 1024;
/// Chunks read from one socket before others, and deliveries, get their turn.
constexpr int kBatch = 8;
constexpr std::byte kMarker[1] = {};

/// Closes so that the peer sees a reset.
void abort_socket(tcp::socket& socket) {
  boost::system::error_code ignored;
  socket.set_option(asio::socket_base::linger(true, 0), ignored);
  socket.close(ignored);
}

}  // namespace

RelayTcp::RelayTcp(asio::io_context& io, tcp::acceptor acceptor, const tcp::endpoint& target)
    : io_(io), acceptor_(std::move(acceptor)), retry_(io), target_(target), buffer_(kChunk) {}

void RelayTcp::start(RelayContext& context) {
  context_ = &context;
  accept();
}

void RelayTcp::accept() {
  acceptor_.async_accept([this](const boost::system::error_code& e, tcp::socket socket) {
    if (e == asio::error::operation_aborted) return;
    if (!e) {
      admit(std::move(socket));
      return accept();
    }
    // Out of descriptors, most likely: trying again at once would spin.
    retry_.expires_after(std::chrono::milliseconds(100));
    retry_.async_wait([this](const boost::system::error_code& cancelled) {
      if (!cancelled) accept();
    });
  });
}

void RelayTcp::admit(tcp::socket socket) {
  const auto flow = context_->open_flow();
  if (!flow) return abort_socket(socket);
  ++context_->stats.tcp_connections;
  context_->recorder.mark_stream(*flow);
  auto made = std::make_unique<Connection>(io_, *flow);
  Connection& c = *connections_.emplace(*flow, std::move(made)).first->second;
  boost::system::error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.non_blocking(true, ignored);
  c.from(Direction::kUp).socket = std::move(socket);
  enter(c, Direction::kUp, kMarker);
}

RelayTcp::Connection* RelayTcp::find(FlowId flow) {
  const auto found = connections_.find(flow);
  return found == connections_.end() || found->second->ended ? nullptr : found->second.get();
}

void RelayTcp::enter(Connection& c, Direction d, ByteView octets) {
  c.from(d).entered += octets.size();
  context_->emulator.stream(c.flow, d, octets, context_->now());
}

void RelayTcp::connect(Connection& c) {
  tcp::socket& socket = c.from(Direction::kDown).socket;
  socket.async_connect(target_, [this, flow = c.flow](const boost::system::error_code& e) {
    Connection* found = find(flow);
    if (!found || e == asio::error::operation_aborted) return;
    if (e) {
      ++context_->stats.connect_failures;
      return fail(*found, Direction::kDown);
    }
    boost::system::error_code ignored;
    found->from(Direction::kDown).socket.set_option(tcp::no_delay(true), ignored);
    found->from(Direction::kDown).socket.non_blocking(true, ignored);
    enter(*found, Direction::kDown, kMarker);
  });
}

void RelayTcp::open(Connection& c) {
  c.open = true;
  wait_readable(c, Direction::kUp);
  wait_readable(c, Direction::kDown);
}

void RelayTcp::close_way(Connection& c, Direction d, bool reset) {
  Side& side = c.from(d);
  side.reset = side.reset || reset;
  if (side.closing) return;
  side.closing = true;
  enter(c, d, kMarker);
}

/// The socket whose octets go in direction `d` is broken.
void RelayTcp::fail(Connection& c, Direction d) {
  Side& side = c.from(d);
  if (side.dead) return;
  side.dead = true;
  side.out.clear();
  abort_socket(side.socket);
  close_way(c, d, true);
  if (side.finished) end(c);
}

void RelayTcp::wait_readable(Connection& c, Direction d) {
  Side& side = c.from(d);
  if (side.dead || side.closing) return;
  side.socket.async_wait(tcp::socket::wait_read,
                         [this, flow = c.flow, d](const boost::system::error_code& e) {
                           Connection* found = find(flow);
                           if (found && !e) read(*found, d);
                         });
}

std::size_t RelayTcp::room(Connection& c, Direction d) const {
  const std::size_t held = context_->emulator.outstanding(c.flow, d) + c.to(d).out.size();
  const std::size_t window = held < kWindow ? kWindow - held : 0;
  return std::min(window, context_->emulator.stream_room(c.flow, d));
}

void RelayTcp::read(Connection& c, Direction d) {
  Side& side = c.from(d);
  for (int i = 0; i < kBatch && !side.dead && !side.closing; ++i) {
    const std::size_t free = room(c, d);
    if (free < StreamLink::kSegmentOctets) {
      paused_.emplace_back(c.flow, d);
      return;
    }
    boost::system::error_code e;
    const std::size_t size = side.socket.read_some(asio::buffer(buffer_.data(), std::min(free, kChunk)), e);
    if (e == asio::error::would_block) break;
    if (e == asio::error::eof) return close_way(c, d, false);
    if (e) return fail(c, d);
    enter(c, d, ByteView(buffer_).first(size));
  }
  wait_readable(c, d);
}

void RelayTcp::deliver(const Delivery& delivery) {
  Connection* c = find(delivery.flow);
  if (!c) return;
  const Direction d = delivery.direction;
  Side& from = c->from(d);
  Side& to = c->to(d);
  ByteView octets = delivery.octets;
  const bool first = from.arrived == 0 && !octets.empty();
  from.arrived += octets.size();
  from.finished = from.closing && from.arrived == from.entered;
  if (first) octets = octets.subspan(1);
  if (from.finished && !octets.empty()) octets = octets.first(octets.size() - 1);
  if (from.finished && from.reset) return end(*c);
  if (first && d == Direction::kUp) connect(*c);
  if (first && d == Direction::kDown) open(*c);
  if (to.dead) return;
  to.out.insert(to.out.end(), octets.begin(), octets.end());
  write(*c, d);
}

/// What has arrived in direction `d` goes to the socket there.
void RelayTcp::write(Connection& c, Direction d) {
  Side& side = c.to(d);
  if (side.dead || side.write_waiting) return;
  std::size_t done = 0;
  while (done < side.out.size()) {
    boost::system::error_code e;
    done += side.socket.write_some(asio::buffer(side.out.data() + done, side.out.size() - done), e);
    if (e == asio::error::would_block) break;
    if (e) return fail(c, d == Direction::kUp ? Direction::kDown : Direction::kUp);
  }
  side.out.erase(side.out.begin(), side.out.begin() + static_cast<std::ptrdiff_t>(done));
  if (!side.out.empty()) {
    side.write_waiting = true;
    side.socket.async_wait(tcp::socket::wait_write,
                           [this, flow = c.flow, d](const boost::system::error_code& e) {
                             Connection* found = find(flow);
                             if (!found || e) return;
                             found->to(d).write_waiting = false;
                             write(*found, d);
                           });
  } else if (c.from(d).finished && !side.shut) {
    side.shut = true;
    boost::system::error_code ignored;
    side.socket.shutdown(tcp::socket::shutdown_send, ignored);
    if (c.sides[0].shut && c.sides[1].shut) end(c);
  }
}

void RelayTcp::end(Connection& c) {
  if (c.ended) return;
  c.ended = true;
  for (Side& side : c.sides) {
    const bool clean = side.shut && side.closing && !side.reset;
    boost::system::error_code ignored;
    if (clean) {
      side.socket.close(ignored);
    } else if (!side.dead) {
      abort_socket(side.socket);
    }
    side.dead = true;
  }
  ended_.push_back(c.flow);
}

void RelayTcp::resume() {
  for (std::size_t left = paused_.size(); left > 0; --left) {
    const auto [flow, d] = paused_.front();
    paused_.pop_front();
    if (Connection* c = find(flow)) read(*c, d);
  }
  for (const FlowId flow : ended_) {
    context_->emulator.close_stream(flow);
    context_->close_flow();
    connections_.erase(flow);
  }
  ended_.clear();
}

}  // namespace atlaswire::netsim
