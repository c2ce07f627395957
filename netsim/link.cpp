#include "netsim/link.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::netsim {

namespace {

/// Heap order: the earliest arrival on top, first launched first.
constexpr auto kLater = [](const auto& a, const auto& b) {
  return a.arrival != b.arrival ? a.arrival > b.arrival : a.order > b.order;
};

}  // namespace

const char* fate_name(Fate fate) {
  switch (fate) {
    case Fate::kDelivered:
      return "delivered";
    case Fate::kLost:
      return "lost";
    case Fate::kBlackout:
      return "blackout";
    case Fate::kQueueFull:
      return "queue_full";
    case Fate::kEarlyDrop:
      return "early_drop";
    case Fate::kExpired:
      return "expired";
    case Fate::kUnsent:
      return "unsent";
  }
  return "unknown";
}

Link::Link(LinkProfile profile, std::uint64_t seed, Time start)
    : profile_(std::move(profile)),
      start_(start),
      bottleneck_(start),
      loss_(seed ^ 0x6C6F7373ULL),
      delay_(seed ^ 0x64656C61ULL),
      air_(seed ^ 0x616972ULL),
      pie_(seed ^ 0x706965ULL),
      next_pie_update_(start + Pie::kUpdatePeriod),
      last_sent_(start) {
  AW_ASSERT(!profile_.steps.empty());
}

std::uint64_t Link::send(ByteBuffer payload, Time now, FlowId flow, Ecn ecn) {
  advance(now);
  last_sent_ = now;
  const LinkParameters& p = parameters();
  Waiting packet;
  packet.decision.packet = packets_++;
  packet.decision.flow = flow;
  packet.decision.size = static_cast<std::uint32_t>(payload.size());
  packet.decision.ecn = ecn;
  packet.decision.arrived = now;
  packet.decision.left_queue = now;
  packet.octets = payload.size() + p.overhead.count;
  packet.lost = loss_.lose(p.loss, packet.decision.packet);
  packet.copy = air_.uniform() < p.duplicate;
  packet.decision.corrupted = air_.uniform() < p.corrupt && !payload.empty();
  packet.decision.reordered = air_.uniform() < p.reorder;
  packet.flipped_bit = air_.bits();
  packet.propagation = delay_.next(p.delay, Time{now - start_});
  packet.payload = std::move(payload);
  const std::uint64_t number = packet.decision.packet;
  if (admit(packet, now)) {
    backlog_ += packet.octets;
    queue_.push_back(std::move(packet));
    advance(now);
  }
  return number;
}

bool Link::admit(Waiting& packet, Time now) {
  const QueueModel& queue = parameters().queue;
  Fate fate = Fate::kDelivered;
  if (profile_.steps[step_].down) {
    fate = Fate::kBlackout;
  } else if (queue.policy == QueueModel::Policy::kPie && pie_.drop(queue, backlog_, head_delay(now))) {
    const bool mark = queue.ecn && packet.can_be_marked() && pie_.probability() < 0.1;
    packet.decision.marked = mark;
    if (!mark) fate = Fate::kEarlyDrop;
  }
  if (fate == Fate::kDelivered && backlog_ + packet.octets > queue.limit.count) {
    if (queue.policy == QueueModel::Policy::kDropHead && packet.octets <= queue.limit.count) {
      while (!queue_.empty() && backlog_ + packet.octets > queue.limit.count)
        drop_front(Fate::kQueueFull, now);
    } else {
      fate = Fate::kQueueFull;
    }
  }
  if (fate == Fate::kDelivered) return true;
  packet.decision.fate = fate;
  decide(packet.decision, packet.payload);
  return false;
}

void Link::decide(const Decision& decision, ByteView payload) {
  decisions_.push_back(decision);
  if (tap_) tap_->decided(decision, payload);
}

Duration Link::head_delay(Time now) const {
  return queue_.empty() ? Duration::zero() : now - queue_.front().decision.arrived;
}

void Link::drop_front(Fate fate, Time at) {
  Waiting& head = queue_.front();
  head.decision.fate = fate;
  head.decision.left_queue = at;
  decide(head.decision, head.payload);
  backlog_ -= head.octets;
  queue_.pop_front();
}

std::optional<Time> Link::next_internal() const {
  std::optional<Time> next;
  const auto consider = [&next](Time t) { next = next ? std::min(*next, t) : t; };
  if (!queue_.empty() && !profile_.steps[step_].down) {
    const Waiting& head = queue_.front();
    const Time ready = std::max(head.decision.arrived, start_ + profile_.steps[step_].at);
    if (const auto service = bottleneck_.plan(parameters().rate, ready, head.octets))
      consider(service->start);
  }
  if (step_ + 1 < profile_.steps.size() && !queue_.empty()) consider(start_ + profile_.steps[step_ + 1].at);
  if (parameters().queue.policy == QueueModel::Policy::kPie && !queue_.empty()) consider(next_pie_update_);
  return next;
}

std::optional<Time> Link::next_event() const {
  std::optional<Time> next = next_internal();
  if (!in_flight_.empty())
    next = next ? std::min(*next, in_flight_.front().arrival) : in_flight_.front().arrival;
  return next;
}

std::optional<Time> Link::next_arrival() const {
  return in_flight_.empty() ? std::nullopt : std::optional(in_flight_.front().arrival);
}

std::uint64_t Link::room() const {
  const std::uint64_t limit = parameters().queue.limit.count;
  return limit > backlog_ ? limit - backlog_ : 0;
}

void Link::finish() {
  const Time end = last_sent_ + std::chrono::hours(24);
  while (!queue_.empty()) {
    const auto next = next_internal();
    if (!next || *next > end) break;
    advance(*next);
  }
  while (!queue_.empty()) drop_front(Fate::kUnsent, queue_.front().decision.arrived);
}

void Link::enter_next_step() {
  const RateModel& before = parameters().rate;
  const Time at = start_ + profile_.steps[step_ + 1].at;
  bottleneck_.change_rate(before, profile_.steps[step_ + 1].parameters.rate, at);
  ++step_;
}

void Link::advance(Time to) {
  for (;;) {
    std::optional<Service> service;
    if (!queue_.empty() && !profile_.steps[step_].down) {
      const Waiting& head = queue_.front();
      const Time ready = std::max(head.decision.arrived, start_ + profile_.steps[step_].at);
      service = bottleneck_.plan(parameters().rate, ready, head.octets);
    }
    const bool step_due = step_ + 1 < profile_.steps.size() && start_ + profile_.steps[step_ + 1].at <= to;
    const Time step_at = step_due ? start_ + profile_.steps[step_ + 1].at : Time::max();
    const bool service_due = service && service->start <= to;
    const Time service_at = service_due ? service->start : Time::max();
    const bool pie_due = parameters().queue.policy == QueueModel::Policy::kPie && next_pie_update_ <= to;
    const Time pie_at = pie_due ? next_pie_update_ : Time::max();
    if (step_due && step_at <= std::min(service_at, pie_at)) {
      enter_next_step();
    } else if (pie_due && pie_at <= service_at) {
      pie_.update(parameters().queue, head_delay(pie_at));
      next_pie_update_ += Pie::kUpdatePeriod;
      const Duration idle = std::min(to, step_at) - next_pie_update_;
      if (queue_.empty() && pie_.settled() && idle > Duration::zero()) {
        next_pie_update_ += idle / Pie::kUpdatePeriod * Pie::kUpdatePeriod;
      }
    } else if (service_due) {
      serve_head(*service);
    } else {
      return;
    }
  }
}

void Link::serve_head(const Service& service) {
  const QueueModel& queue = parameters().queue;
  Waiting& head = queue_.front();
  const Duration sojourn = service.start - head.decision.arrived;
  if (queue.time_limit && sojourn > *queue.time_limit) {
    drop_front(Fate::kExpired, service.start);
    return;
  }
  if (queue.policy == QueueModel::Policy::kCodel &&
      codel_.drop(queue, sojourn, backlog_ - head.octets, service.start)) {
    if (!(queue.ecn && head.can_be_marked())) {
      drop_front(Fate::kEarlyDrop, service.start);
      return;
    }
    head.decision.marked = true;
  }
  const Time ready = std::max(head.decision.arrived, start_ + profile_.steps[step_].at);
  bottleneck_.commit(parameters().rate, service, ready, head.octets);
  Waiting packet = std::move(head);
  queue_.pop_front();
  backlog_ -= packet.octets;
  propagate(std::move(packet), service.end);
}

void Link::propagate(Waiting packet, Time left) {
  Decision decision = packet.decision;
  decision.left_queue = left;
  if (packet.lost) {
    decision.fate = Fate::kLost;
    decide(decision, packet.payload);
    return;
  }
  if (decision.corrupted) {
    const std::uint64_t bit = packet.flipped_bit % (packet.payload.size() * 8);
    packet.payload[bit / 8] ^= std::byte{1} << (bit % 8);
  }
  decision.delivered = decision.reordered ? left : std::max(left + packet.propagation, last_arrival_);
  if (!decision.reordered) last_arrival_ = decision.delivered;
  launch(packet, decision);
  if (packet.copy) {
    decision.duplicate = true;
    launch(packet, decision);
  }
}

void Link::launch(const Waiting& packet, Decision decision) {
  decide(decision, packet.payload);
  in_flight_.push_back({decision.delivered,
                        launches_++,
                        {decision.packet, decision.flow, decision.delivered, packet.payload,
                         decision.marked ? Ecn::kCongestion : decision.ecn}});
  std::push_heap(in_flight_.begin(), in_flight_.end(), kLater);
}

std::vector<Datagram> Link::deliver(Time now) {
  advance(now);
  std::vector<Datagram> out;
  while (!in_flight_.empty() && in_flight_.front().arrival <= now) {
    std::pop_heap(in_flight_.begin(), in_flight_.end(), kLater);
    out.push_back(std::move(in_flight_.back().datagram));
    in_flight_.pop_back();
  }
  return out;
}

std::vector<Decision> Link::take_decisions() { return std::exchange(decisions_, {}); }

}  // namespace atlaswire::netsim
