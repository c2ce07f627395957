#include "netsim/stream_link.h"

#include <algorithm>

namespace atlaswire::netsim {

namespace {

constexpr Duration kFirstTimeout = std::chrono::milliseconds(200);
constexpr std::uint32_t kMostDoublings = 4;

}  // namespace

void StreamLink::launch(std::uint64_t segment, Link& link, Time now) {
  segment_of_packet_[link.send(unacknowledged_.at(segment).octets, now, flow_)] = segment;
}

void StreamLink::send(ByteView octets, Link& link, Time now) {
  outstanding_ += octets.size();
  while (!octets.empty()) {
    const ByteView part = octets.first(std::min(octets.size(), kSegmentOctets));
    octets = octets.subspan(part.size());
    unacknowledged_[next_segment_].octets.assign(part.begin(), part.end());
    launch(next_segment_++, link, now);
  }
}

void StreamLink::decided(const Decision& decision) {
  const auto found = segment_of_packet_.find(decision.packet);
  const bool damaged = decision.corrupted && decision.fate == Fate::kDelivered;  // a checksum would reject it
  if (found == segment_of_packet_.end() || (decision.fate == Fate::kDelivered && !damaged)) return;
  const std::uint64_t segment = found->second;
  segment_of_packet_.erase(found);
  const auto waiting = unacknowledged_.find(segment);
  if (waiting == unacknowledged_.end()) return;
  const std::uint32_t tries = waiting->second.tries++;
  const Duration wait =
      tries == 0 ? round_trip_ : kFirstTimeout * (1U << std::min(tries - 1, kMostDoublings));
  due_.emplace(decision.left_queue + wait, segment);
}

void StreamLink::arrived(const Datagram& datagram) {
  const auto found = segment_of_packet_.find(datagram.packet);
  if (found == segment_of_packet_.end()) return;  // a duplicate, or damaged
  const std::uint64_t segment = found->second;
  segment_of_packet_.erase(found);
  if (unacknowledged_.erase(segment) == 0) return;
  early_[segment] = datagram.payload;
  while (!early_.empty() && early_.begin()->first == next_in_order_) {
    const ByteBuffer& octets = early_.begin()->second;
    ready_.insert(ready_.end(), octets.begin(), octets.end());
    early_.erase(early_.begin());
    ++next_in_order_;
  }
}

void StreamLink::repeat(Link& link, Time now) {
  while (!due_.empty() && due_.begin()->first <= now) {
    const std::uint64_t segment = due_.begin()->second;
    due_.erase(due_.begin());
    launch(segment, link, now);
    ++repeats_;
  }
}

std::optional<Time> StreamLink::next_repeat() const {
  return due_.empty() ? std::nullopt : std::optional(due_.begin()->first);
}

ByteBuffer StreamLink::take() {
  outstanding_ -= ready_.size();
  return std::exchange(ready_, {});
}

}  // namespace atlaswire::netsim
