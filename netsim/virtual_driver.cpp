#include "netsim/virtual_driver.h"

#include "base/assert.h"

#include <algorithm>
#include <utility>

namespace atlaswire::netsim {

namespace {

/// Steps at one instant that only an endpoint which never moves its deadline on would need.
constexpr int kMostStepsAtOnce = 1'000'000;

}  // namespace

VirtualDriver::VirtualDriver(Endpoint& client, Endpoint& server, const Profile& profile, std::uint64_t seed,
                             Time start)
    : client_(client), server_(server), emulator_(profile, seed, start), now_(start) {}

void VirtualDriver::schedule(Time at, std::function<void(Time)> what) {
  scheduled_.emplace(std::max(at, now_), std::move(what));
}

std::optional<Time> VirtualDriver::next_event() const {
  std::optional<Time> next = emulator_.next_event();
  const auto consider = [&next](std::optional<Time> t) {
    if (t) next = next ? std::min(*next, *t) : t;
  };
  consider(client_.next_deadline());
  consider(server_.next_deadline());
  if (!scheduled_.empty()) consider(scheduled_.begin()->first);
  return next;
}

void VirtualDriver::collect(Endpoint& from, Direction direction) {
  for (Outgoing& out : from.take_outgoing()) {
    if (out.stream) {
      emulator_.stream(out.flow, direction, out.octets, now_);
    } else {
      emulator_.datagram(out.flow, direction, std::move(out.octets), now_);
    }
  }
}

void VirtualDriver::step(Time now) {
  now_ = now;
  while (!scheduled_.empty() && scheduled_.begin()->first <= now) {
    const auto what = std::move(scheduled_.begin()->second);
    scheduled_.erase(scheduled_.begin());
    what(now);
  }
  for (const Delivery& d : emulator_.deliver(now)) {
    (d.direction == Direction::kUp ? server_ : client_).receive(d.flow, d.octets, now);
  }
  for (Endpoint* endpoint : {&client_, &server_}) {
    if (const auto deadline = endpoint->next_deadline(); deadline && *deadline <= now) endpoint->wake(now);
  }
  collect(client_, Direction::kUp);
  collect(server_, Direction::kDown);
}

void VirtualDriver::run_until(Time end) {
  collect(client_, Direction::kUp);  // what they wanted to say before anything happened
  collect(server_, Direction::kDown);
  int at_once = 0;
  for (auto next = next_event(); next && *next <= end; next = next_event()) {
    const Time at = std::max(*next, now_);
    at_once = at == now_ ? at_once + 1 : 0;
    AW_ASSERT(at_once < kMostStepsAtOnce);
    step(at);
  }
  now_ = std::max(now_, end);
}

}  // namespace atlaswire::netsim
