#pragma once

#include "netsim/relay_context.h"
#include "netsim/relay_socket.h"

#include <map>
#include <vector>

namespace atlaswire::netsim {

/// The relay's UDP half: one flow a client endpoint, each with a socket of its own towards the target. ECN
/// bits pass through, or come out as the model marks them.
class RelayUdp {
 public:
  RelayUdp(asio::io_context& io, udp::socket listener, const udp::endpoint& target);
  /// Starts to receive.
  void start(RelayContext& context);
  /// What the model delivers; not ours: ignored.
  void deliver(const Delivery& delivery);
  /// Forgets flows without a packet for the idle timeout.
  void expire(Time now);

 private:
  struct Flow {
    FlowId id{};
    udp::endpoint client;
    RelaySocket upstream;
    Time last_used{};
  };
  Flow* flow_of(const udp::endpoint& client);
  void enter(Flow& flow, Direction direction, std::size_t size, Ecn ecn);
  void receive_from_clients();
  void receive_from_target(FlowId id);
  void wait_for_clients();
  void wait_for_target(Flow& flow);

  asio::io_context& io_;
  RelayContext* context_ = nullptr;
  RelaySocket listener_;
  udp::endpoint target_;
  std::map<FlowId, Flow> flows_;
  std::map<udp::endpoint, FlowId> by_client_;
  std::vector<std::byte> buffer_;
};

}  // namespace atlaswire::netsim
