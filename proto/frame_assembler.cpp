#include "proto/frame_assembler.h"

#include "base/assert.h"

#include <algorithm>
#include <bit>

namespace atlaswire::proto {

namespace {

constexpr std::size_t kMaxReady = 64;        // frames that wait for pop()
constexpr std::size_t kKeptCapacity = 2048;  // octets a free slot may keep allocated
constexpr std::int64_t kOpeningReach = 256;  // packets that the first one may have overtaken

}  // namespace

FrameAssembler::FrameAssembler(const Settings& settings)
    : settings_(settings), mask_(settings.max_packets - 1), slots_(settings.max_packets) {
  AW_ASSERT(std::has_single_bit(settings.max_packets) && settings.max_packets >= 1024 &&
            settings.max_packets <= 16384);
}

void FrameAssembler::add(const RtpPacketView& packet, std::size_t datagram_octets, Time arrival) {
  if (!packet.header.extensions.frame || packet.payload.empty()) {
    ++counts_.refused;
    return;
  }
  const std::int64_t sequence = unwrapper_.peek(packet.header.sequence);
  if (!admit(sequence, packet.header.sequence)) return;
  unwrapper_.unwrap(packet.header.sequence);
  if (!make_room(packet.payload.size())) {
    ++counts_.refused;
    return;
  }
  if (sequence < next_) {  // making room gave it up
    ++counts_.late;
    return;
  }
  store(packet, sequence, datagram_octets, arrival);
  advance();
  poll(arrival);
}

/// Is the packet one to store? Counts what is not.
bool FrameAssembler::admit(std::int64_t sequence, std::uint16_t raw) {
  const auto window = static_cast<std::int64_t>(settings_.max_packets);
  if (!started_) {
    started_ = true;
    restart_at(sequence);
    return true;
  }
  const std::int64_t ahead = sequence - next_;
  if (ahead >= window - kOpeningReach || ahead <= -window) {
    // RFC 3550 A.1: one stray packet is nothing, two in a row are a sender that restarted or a long outage.
    if (far_ && static_cast<std::uint16_t>(*far_ + 1U) == raw) {
      give_up_until(end_, std::nullopt);
      restart_at(sequence);
      return true;
    }
    far_ = raw;
    ++counts_.refused;
    return false;
  }
  if (ahead < 0 && opening_ && end_ - sequence <= kOpeningReach) {
    next_ = scanned_ = sequence;
    return true;
  }
  if (ahead < 0) {
    ++counts_.late;
    return false;
  }
  if (sequence < end_ && slot(sequence).used) {
    ++counts_.duplicates;
    return false;
  }
  far_.reset();
  return true;
}

void FrameAssembler::restart_at(std::int64_t sequence) {
  next_ = scanned_ = end_ = sequence;
  opening_ = true;
  far_.reset();
  gap_since_.reset();
}

/// Keeps what is held below its bound, by giving up the oldest first.
bool FrameAssembler::make_room(std::size_t octets) {
  if (octets > settings_.max_octets) return false;
  while (held_octets_ + octets > settings_.max_octets) {
    if (scanned_ < end_) {
      give_up_gap();
    } else {
      give_up_until(end_, std::nullopt);
    }
  }
  return true;
}

void FrameAssembler::store(const RtpPacketView& packet, std::int64_t sequence, std::size_t octets,
                           Time arrival) {
  const RtpExtensions& extensions = packet.header.extensions;
  Slot& to = slot(sequence);
  to.used = true;
  to.marker = packet.header.marker;
  to.frame = *extensions.frame;
  to.timestamp = packet.header.timestamp;
  to.pose = extensions.pose;
  to.capture = extensions.capture.value_or(0);
  to.arrival = arrival;
  to.datagram_octets = octets;
  to.payload.assign(packet.payload.begin(), packet.payload.end());
  held_octets_ += packet.payload.size();
  end_ = std::max(end_, sequence + 1);
  ++counts_.packets;
}

/// Takes every frame that is whole at the window's start.
void FrameAssembler::advance() {
  while (scanned_ < end_ && slot(scanned_).used) {
    if (opening_ && scanned_ == next_ && !slot(next_).pose && end_ - next_ < kOpeningReach) {
      scanned_ = --next_;  // the frame began before: wait for that as for any gap
      break;
    }
    if (slot(scanned_).marker) {
      take_frame(scanned_);
    } else {
      ++scanned_;
    }
  }
  note_gap();
}

void FrameAssembler::note_gap() {
  if (scanned_ >= end_) {
    gap_since_.reset();
    return;
  }
  if (gap_since_ && gap_ == scanned_) return;
  std::int64_t beyond = scanned_;
  while (!slot(beyond).used) ++beyond;
  gap_ = scanned_;
  gap_since_ = slot(beyond).arrival;
}

/// The packets from next_ to `last`, whose marker ends a frame, have all come.
void FrameAssembler::take_frame(std::int64_t last) {
  const FrameId id = slot(last).frame;
  const bool rest_of_lost = !slot(next_).pose && last_frame_ == id;  // it was given up and counted before
  auto frame = is_one_frame(last) ? join(last) : Result<AssembledFrame>(WireError::kMalformed);
  release_until(last + 1);
  opening_ = false;
  last_frame_ = id;
  if (rest_of_lost) return;
  if (frame.has_value()) {
    deliver(std::move(*frame));
  } else {
    ++counts_.lost;
    lose();
  }
}

bool FrameAssembler::is_one_frame(std::int64_t last) const {
  const Slot& first = slot(next_);
  if (!first.pose) return false;
  for (std::int64_t i = next_ + 1; i <= last; ++i) {
    const Slot& s = slot(i);
    if (s.pose || s.frame != first.frame || s.timestamp != first.timestamp) return false;
  }
  return true;
}

Result<AssembledFrame> FrameAssembler::join(std::int64_t last) {
  const Slot& first = slot(next_);
  AssembledFrame out;
  out.frame = first.frame;
  out.pose = *first.pose;
  out.capture = first.capture;
  out.first_arrival = out.last_arrival = first.arrival;
  out.packets = static_cast<std::uint32_t>(last - next_ + 1);
  depacketizer_.begin(out.access_unit);
  for (std::int64_t i = next_; i <= last; ++i) {
    const Slot& s = slot(i);
    out.first_arrival = std::min(out.first_arrival, s.arrival);
    out.last_arrival = std::max(out.last_arrival, s.arrival);
    out.octets += s.datagram_octets;
    const auto added = depacketizer_.add(s.payload);
    if (added.has_error()) return added.error();
  }
  const auto ended = depacketizer_.end();
  if (ended.has_error()) return ended.error();
  out.idr = depacketizer_.has_idr();
  return out;
}

void FrameAssembler::deliver(AssembledFrame frame) {
  if (gated_ && !frame.idr) {
    ++counts_.withheld;
    needs_refresh_ = true;
    return;
  }
  if (ready_.size() >= kMaxReady) {  // nobody pops
    ++counts_.lost;
    lose();
    return;
  }
  gated_ = false;
  needs_refresh_ = false;
  ++counts_.frames;
  ready_.push_back(std::move(frame));
}

void FrameAssembler::release_until(std::int64_t end) {
  for (; next_ < end; ++next_) {
    Slot& s = slot(next_);
    if (!s.used) continue;
    s.used = false;
    held_octets_ -= s.payload.size();
    s.payload.clear();
    if (s.payload.capacity() > kKeptCapacity) s.payload = {};
  }
  scanned_ = next_;
  end_ = std::max(end_, next_);
}

/// Gives up the frames that the gap at scanned_ touches: everything before the next frame's start.
void FrameAssembler::give_up_gap() {
  std::int64_t start = scanned_ + 1;
  while (start < end_ && !(slot(start).used && slot(start).pose)) ++start;
  give_up_until(start, start < end_ ? std::optional(slot(start).frame) : std::nullopt);
  advance();
}

/// Gives up every packet before `end`; `next_frame` is the frame that begins there, if known.
void FrameAssembler::give_up_until(std::int64_t end, std::optional<FrameId> next_frame) {
  std::optional<FrameId> last_lost;
  if (next_frame) last_lost = FrameId{value(*next_frame) - 1U};
  for (std::int64_t i = end; !last_lost && i-- > next_;) {
    if (slot(i).used) last_lost = slot(i).frame;
  }
  release_until(end);
  opening_ = false;
  if (!last_lost) return;
  if (!last_frame_) {
    ++counts_.lost;
    last_frame_ = last_lost;
  } else {
    if (is_newer(*last_lost, *last_frame_)) counts_.lost += value(*last_lost) - value(*last_frame_);
    last_frame_ = last_lost;
  }
  lose();
}

void FrameAssembler::lose() {
  gated_ = true;
  needs_refresh_ = true;
}

void FrameAssembler::poll(Time now) {
  while (gap_since_ && *gap_since_ + settings_.reorder_wait <= now) give_up_gap();
}

std::optional<Time> FrameAssembler::next_deadline() const {
  if (!gap_since_) return std::nullopt;
  return *gap_since_ + settings_.reorder_wait;
}

std::optional<AssembledFrame> FrameAssembler::pop() {
  if (ready_.empty()) return std::nullopt;
  auto frame = std::move(ready_.front());
  ready_.pop_front();
  return frame;
}

void FrameAssembler::require_idr() {
  while (!ready_.empty() && !ready_.front().idr) {
    ready_.pop_front();
    --counts_.frames;
    ++counts_.withheld;
  }
  if (ready_.empty()) lose();
}

}  // namespace atlaswire::proto
