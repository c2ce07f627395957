#include "netsim/lane.h"

#include <algorithm>
#include <utility>

namespace atlaswire::netsim {

Lane::Lane(const LinkProfile& profile, std::uint64_t seed, Time start, Duration round_trip)
    : link_(profile, seed, start), round_trip_(round_trip) {}

void Lane::datagram(FlowId flow, ByteBuffer octets, Time now, Ecn ecn) {
  advance(now);
  link_.send(std::move(octets), now, flow, ecn);
  sort_decisions();
}

void Lane::stream(FlowId flow, ByteView octets, Time now) {
  advance(now);
  const auto [entry, fresh] = streams_.try_emplace(flow, flow, round_trip_);
  entry->second.send(octets, link_, now);
  sort_decisions();
}

std::size_t Lane::outstanding(FlowId flow) const {
  const auto found = streams_.find(flow);
  return found == streams_.end() ? 0 : found->second.outstanding();
}

std::size_t Lane::stream_room() const {
  std::uint64_t half = (link_.backlog() + link_.room()) / 2;
  if (link_.backlog() == 0) half = std::max<std::uint64_t>(half, StreamLink::kSegmentOctets);
  return half > link_.backlog() ? half - link_.backlog() : 0;
}

void Lane::sort_decisions() {
  std::vector<Decision> fresh = link_.take_decisions();
  for (const Decision& decision : fresh) {
    const auto stream = streams_.find(decision.flow);
    if (stream != streams_.end()) stream->second.decided(decision);
  }
  if (decisions_.empty()) {
    decisions_ = std::move(fresh);
  } else {
    decisions_.insert(decisions_.end(), fresh.begin(), fresh.end());
  }
}

void Lane::hand_out(Datagram datagram) {
  const auto stream = streams_.find(datagram.flow);
  if (stream != streams_.end()) {
    stream->second.arrived(datagram);
    datagram.payload = stream->second.take();
    if (datagram.payload.empty()) return;
  }
  arrived_.push_back(std::move(datagram));
}

std::optional<Time> Lane::next_event() const {
  std::optional<Time> next = link_.next_event();
  for (const auto& [flow, stream] : streams_) {
    if (const auto repeat = stream.next_repeat()) next = next ? std::min(*next, *repeat) : *repeat;
  }
  return next;
}

void Lane::advance(Time now) {
  // From event to event: a repeat must enter the link at its own time, not when somebody looks.
  while (const auto at = next_event()) {
    if (*at > now) return;
    for (Datagram& datagram : link_.deliver(*at)) hand_out(std::move(datagram));
    sort_decisions();
    for (auto& [flow, stream] : streams_) {
      const std::uint64_t before = stream.repeats();
      stream.repeat(link_, *at);
      repeats_ += stream.repeats() - before;
    }
    sort_decisions();
  }
}

void Lane::finish() {
  streams_.clear();
  link_.finish();
  sort_decisions();
}

std::vector<Datagram> Lane::take_arrived() { return std::exchange(arrived_, {}); }

std::vector<Decision> Lane::take_decisions() { return std::exchange(decisions_, {}); }

}  // namespace atlaswire::netsim
