#include "netsim/relay_udp.h"

namespace atlaswire::netsim {

namespace {

constexpr std::size_t kMostDatagram = 65'536;
/// Datagrams taken from one socket before others, and deliveries, get their turn.
constexpr int kBatch = 32;

}  // namespace

RelayUdp::RelayUdp(asio::io_context& io, udp::socket listener, const udp::endpoint& target)
    : io_(io), listener_(std::move(listener)), target_(target), buffer_(kMostDatagram) {}

void RelayUdp::start(RelayContext& context) {
  context_ = &context;
  wait_for_clients();
}

void RelayUdp::wait_for_clients() {
  listener_.socket().async_wait(udp::socket::wait_read, [this](const boost::system::error_code& e) {
    if (e) return;
    receive_from_clients();
    wait_for_clients();
  });
}

void RelayUdp::wait_for_target(Flow& flow) {
  flow.upstream.socket().async_wait(udp::socket::wait_read,
                                    [this, id = flow.id](const boost::system::error_code& e) {
                                      if (!e) receive_from_target(id);
                                    });
}

RelayUdp::Flow* RelayUdp::flow_of(const udp::endpoint& client) {
  if (const auto known = by_client_.find(client); known != by_client_.end()) return &flows_.at(known->second);
  const auto id = context_->open_flow();
  if (!id) return nullptr;
  udp::socket upstream(io_);
  boost::system::error_code e;
  upstream.open(target_.protocol(), e);
  if (!e) upstream.connect(target_, e);
  if (e) {
    context_->close_flow();
    ++context_->stats.connect_failures;
    return nullptr;
  }
  ++context_->stats.udp_flows;
  by_client_[client] = *id;
  Flow& flow = flows_.emplace(*id, Flow{*id, client, RelaySocket(std::move(upstream)), {}}).first->second;
  wait_for_target(flow);
  return &flow;
}

/// What is in the buffer, now.
void RelayUdp::enter(Flow& flow, Direction direction, std::size_t size, Ecn ecn) {
  const Time now = context_->now();
  flow.last_used = now;
  const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(size);
  context_->emulator.datagram(flow.id, direction, ByteBuffer(buffer_.begin(), end), now, ecn);
}

void RelayUdp::receive_from_clients() {
  for (int i = 0; i < kBatch; ++i) {
    udp::endpoint from;
    Ecn ecn{};
    boost::system::error_code e;
    const std::size_t size = listener_.receive(buffer_, from, ecn, e);
    if (e == asio::error::would_block) return;
    if (e) continue;  // an ICMP error of an earlier send
    Flow* flow = flow_of(from);
    if (!flow) continue;
    enter(*flow, Direction::kUp, size, ecn);
  }
}

void RelayUdp::receive_from_target(FlowId id) {
  const auto found = flows_.find(id);
  if (found == flows_.end()) return;
  Flow& flow = found->second;
  for (int i = 0; i < kBatch; ++i) {
    udp::endpoint from;
    Ecn ecn{};
    boost::system::error_code e;
    const std::size_t size = flow.upstream.receive(buffer_, from, ecn, e);
    if (e == asio::error::would_block) break;
    if (e) continue;  // such as "connection refused": nobody listens yet
    enter(flow, Direction::kDown, size, ecn);
  }
  wait_for_target(flow);
}

void RelayUdp::deliver(const Delivery& delivery) {
  const auto found = flows_.find(delivery.flow);
  if (found == flows_.end()) return;
  Flow& flow = found->second;
  boost::system::error_code e;
  if (delivery.direction == Direction::kUp) {
    flow.upstream.send(delivery.octets, target_, delivery.ecn, e);
    // That was about an earlier datagram, which nobody was there to take; this one has not been sent.
    if (e == asio::error::connection_refused) flow.upstream.send(delivery.octets, target_, delivery.ecn, e);
  } else {
    listener_.send(delivery.octets, flow.client, delivery.ecn, e);
  }
  context_->stats.lateness.add(delivery.arrival, steady_now());
  if (e) ++context_->stats.way(delivery.direction).send_failures;
}

void RelayUdp::expire(Time now) {
  for (auto it = flows_.begin(); it != flows_.end();) {
    if (now - it->second.last_used < context_->settings.idle_timeout) {
      ++it;
      continue;
    }
    by_client_.erase(it->second.client);
    context_->close_flow();
    it = flows_.erase(it);
  }
}

}  // namespace atlaswire::netsim
