#include "netsim/emulator.h"

#include <utility>

namespace atlaswire::netsim {

namespace {

constexpr Direction kDirections[] = {Direction::kUp, Direction::kDown};

}  // namespace

Emulator::Emulator(const Profile& profile, std::uint64_t seed, Time start) : profile_(profile) {
  for (std::uint32_t i = 0; i < profile.paths(); ++i) paths_.emplace_back(profile, PathId{i}, seed, start);
}

Lane& Emulator::lane(FlowId flow, FlowKind kind, Direction direction) {
  return at(profile_.path_of(flow, kind)).lane(direction);
}

const Lane& Emulator::lane(FlowId flow, FlowKind kind, Direction direction) const {
  return paths_[static_cast<std::size_t>(profile_.path_of(flow, kind))].lane(direction);
}

void Emulator::datagram(FlowId flow, Direction direction, ByteBuffer octets, Time now, Ecn ecn) {
  lane(flow, FlowKind::kDatagram, direction).datagram(flow, std::move(octets), now, ecn);
}

void Emulator::stream(FlowId flow, Direction direction, ByteView octets, Time now) {
  lane(flow, FlowKind::kStream, direction).stream(flow, octets, now);
}

std::size_t Emulator::outstanding(FlowId flow, Direction direction) const {
  return lane(flow, FlowKind::kStream, direction).outstanding(flow);
}

std::size_t Emulator::stream_room(FlowId flow, Direction direction) const {
  return lane(flow, FlowKind::kStream, direction).stream_room();
}

void Emulator::close_stream(FlowId flow) {
  for (const Direction d : kDirections) lane(flow, FlowKind::kStream, d).close_stream(flow);
}

std::optional<Time> Emulator::next_event() const {
  std::optional<Time> next;
  for (const Path& path : paths_) next = earlier(next, path.next_event());
  return next;
}

std::optional<Time> Emulator::next_arrival() const {
  std::optional<Time> next;
  for (const Path& path : paths_) next = earlier(next, path.next_arrival());
  return next;
}

void Emulator::finish() {
  for (Path& path : paths_) {
    for (const Direction d : kDirections) path.lane(d).finish();
  }
}

std::vector<Delivery> Emulator::deliver(Time now) {
  std::vector<Delivery> out;
  for (Path& path : paths_) {
    for (const Direction d : kDirections) {
      path.lane(d).advance(now);
      for (Datagram& datagram : path.lane(d).take_arrived())
        out.push_back({datagram.flow, d, datagram.arrival, std::move(datagram.payload), datagram.ecn});
    }
  }
  return out;
}

std::vector<DirectedDecision> Emulator::take_decisions() {
  std::vector<DirectedDecision> out;
  for (std::uint32_t i = 0; i < paths(); ++i) {
    for (const Direction d : kDirections) {
      for (const Decision& decision : at(PathId{i}).lane(d).take_decisions())
        out.push_back({d, decision, PathId{i}});
    }
  }
  return out;
}

std::uint64_t Emulator::stream_repeats() const {
  std::uint64_t sum = 0;
  for (const Path& path : paths_) {
    for (const Direction d : kDirections) sum += path.lane(d).repeats();
  }
  return sum;
}

}  // namespace atlaswire::netsim
