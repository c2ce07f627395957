#include "netsim/emulator.h"

#include <algorithm>
#include <utility>

namespace atlaswire::netsim {

namespace {

constexpr Direction kDirections[] = {Direction::kUp, Direction::kDown};

}  // namespace

Emulator::Emulator(const Profile& profile, std::uint64_t seed, Time start)
    : path_(profile, seed, start),
      round_trip_(profile.up.steps[0].parameters.delay.base + profile.down.steps[0].parameters.delay.base) {}

void Emulator::datagram(FlowId flow, Direction direction, ByteBuffer octets, Time now) {
  advance(direction, now);
  path_.link(direction).send(std::move(octets), now, flow);
  sort_decisions(direction);
}

void Emulator::stream(FlowId flow, Direction direction, ByteView octets, Time now) {
  advance(direction, now);
  const auto [entry, fresh] = streams(direction).try_emplace(flow, flow, round_trip_);
  entry->second.send(octets, path_.link(direction), now);
  sort_decisions(direction);
}

std::size_t Emulator::outstanding(FlowId flow, Direction direction) const {
  const auto found = streams(direction).find(flow);
  return found == streams(direction).end() ? 0 : found->second.outstanding();
}

void Emulator::close_stream(FlowId flow) {
  for (const Direction d : kDirections) streams(d).erase(flow);
}

void Emulator::sort_decisions(Direction direction) {
  for (const Decision& decision : path_.link(direction).take_decisions()) {
    decisions_.push_back({direction, decision});
    const auto stream = streams(direction).find(decision.flow);
    if (stream != streams(direction).end()) stream->second.decided(decision);
  }
}

void Emulator::hand_out(Direction direction, Datagram datagram) {
  const auto stream = streams(direction).find(datagram.flow);
  if (stream == streams(direction).end()) {
    out_.push_back({datagram.flow, direction, datagram.arrival, std::move(datagram.payload)});
    return;
  }
  stream->second.arrived(datagram);
  ByteBuffer octets = stream->second.take();
  if (!octets.empty()) out_.push_back({datagram.flow, direction, datagram.arrival, std::move(octets)});
}

std::optional<Time> Emulator::next_of(Direction direction) const {
  std::optional<Time> next = path_.link(direction).next_event();
  for (const auto& [flow, stream] : streams(direction)) {
    if (const auto repeat = stream.next_repeat()) next = next ? std::min(*next, *repeat) : *repeat;
  }
  return next;
}

void Emulator::advance(Direction direction, Time now) {
  // From event to event: a repeat must enter the link at its own time, not when somebody looks.
  Link& link = path_.link(direction);
  while (const auto at = next_of(direction)) {
    if (*at > now) return;
    for (Datagram& datagram : link.deliver(*at)) hand_out(direction, std::move(datagram));
    sort_decisions(direction);
    for (auto& [flow, stream] : streams(direction)) {
      const std::uint64_t before = stream.repeats();
      stream.repeat(link, *at);
      stream_repeats_ += stream.repeats() - before;
    }
    sort_decisions(direction);
  }
}

std::optional<Time> Emulator::next_event() const {
  const auto up = next_of(Direction::kUp);
  const auto down = next_of(Direction::kDown);
  std::optional<Time> next = !up || !down ? (up ? up : down) : std::min(*up, *down);
  return next;
}

std::optional<Time> Emulator::next_arrival() const {
  const auto up = path_.link(Direction::kUp).next_arrival();
  const auto down = path_.link(Direction::kDown).next_arrival();
  return !up || !down ? (up ? up : down) : std::min(*up, *down);
}

std::size_t Emulator::stream_room(Direction direction) const {
  const Link& link = path_.link(direction);
  std::uint64_t half = (link.backlog() + link.room()) / 2;
  if (link.backlog() == 0) half = std::max<std::uint64_t>(half, StreamLink::kSegmentOctets);
  return half > link.backlog() ? half - link.backlog() : 0;
}

void Emulator::finish() {
  for (const Direction d : kDirections) {
    streams(d).clear();
    path_.link(d).finish();
    sort_decisions(d);
  }
}

std::vector<Delivery> Emulator::deliver(Time now) {
  for (const Direction d : kDirections) advance(d, now);
  return std::exchange(out_, {});
}

std::vector<DirectedDecision> Emulator::take_decisions() { return std::exchange(decisions_, {}); }

}  // namespace atlaswire::netsim
