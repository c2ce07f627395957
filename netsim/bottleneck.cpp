#include "netsim/bottleneck.h"

#include <algorithm>

namespace atlaswire::netsim {

namespace {

__extension__ using Wide = unsigned __int128;

/// Nanoseconds that `octets` take at `rate` > 0, rounded up, so that no window ever exceeds the rate.
Duration time_for(std::uint64_t octets, BitRate rate) {
  const Wide bits = Wide{octets} * 8U * 1'000'000'000U;
  const Wide nanos = (bits + rate.bits_per_second - 1) / rate.bits_per_second;
  constexpr Wide kMost = 0x3FFFFFFFFFFFFFFF;
  return Duration{static_cast<std::int64_t>(std::min(nanos, kMost))};
}

}  // namespace

std::optional<Service> Bottleneck::plan(const RateModel& model, Time ready, std::uint64_t octets) const {
  if (!model.trace.empty()) {
    Cursor end;
    return plan_trace(model, ready, octets, end);
  }
  if (!model.rate) return Service{ready, ready};
  if (model.rate->bits_per_second == 0) return std::nullopt;
  const std::uint64_t depth = model.burst.count;
  if (depth >= octets) {
    const Time at = std::max(ready, full_at_ - time_for(depth - octets, *model.rate));
    return Service{at, at};
  }
  const Time start = std::max(ready, full_at_);
  return Service{start, start + time_for(octets - depth, *model.rate)};
}

void Bottleneck::commit(const RateModel& model, const Service& service, Time ready, std::uint64_t octets) {
  if (!model.trace.empty()) {
    Cursor end;
    (void)plan_trace(model, ready, octets, end);
    cursor_ = end;
  } else if (model.rate && model.rate->bits_per_second > 0) {
    full_at_ = std::max(service.start, full_at_) + time_for(octets, *model.rate);
  }
}

void Bottleneck::change_rate(const RateModel& before, const RateModel& after, Time at) {
  const bool finite_before = before.trace.empty() && before.rate && before.rate->bits_per_second > 0;
  const bool finite_after = after.trace.empty() && after.rate && after.rate->bits_per_second > 0;
  if (finite_before && finite_after && full_at_ > at) {
    const Wide owed = static_cast<Wide>((full_at_ - at).count()) * before.rate->bits_per_second;
    full_at_ = at + Duration{static_cast<std::int64_t>(owed / after.rate->bits_per_second)};
  } else {
    full_at_ = at;
  }
  epoch_ = at;  // a trace starts over where its step begins
  cursor_ = {};
}

Time Bottleneck::opportunity_time(const RateModel& model, std::uint64_t index) const {
  const std::uint64_t count = model.trace.size();
  const auto rounds = static_cast<std::int64_t>(index / count);
  return epoch_ + model.trace_period * rounds + model.trace[index % count];
}

Bottleneck::Cursor Bottleneck::first_opportunity(const RateModel& model, Time ready) const {
  const std::uint64_t count = model.trace.size();
  if (opportunity_time(model, cursor_.opportunity) >= ready) return cursor_;
  const Duration since = ready - epoch_;
  const std::int64_t rounds = since / model.trace_period;
  const Duration within = since % model.trace_period;
  const auto found = std::lower_bound(model.trace.begin(), model.trace.end(), within);
  const auto place = static_cast<std::uint64_t>(found - model.trace.begin());
  Cursor cursor{static_cast<std::uint64_t>(rounds) * count + place, 0};
  if (rounds > 0) {
    // The period's last opportunity coincides with the next round's zero: it may still lie at `ready`.
    while (cursor.opportunity > 0 && opportunity_time(model, cursor.opportunity - 1) >= ready)
      --cursor.opportunity;
  }
  return cursor.opportunity > cursor_.opportunity ? cursor : cursor_;
}

Service Bottleneck::plan_trace(const RateModel& model, Time ready, std::uint64_t octets, Cursor& end) const {
  Cursor at = first_opportunity(model, ready);
  if (at.used == kOpportunityOctets) at = {at.opportunity + 1, 0};
  const Time start = opportunity_time(model, at.opportunity);
  const std::uint64_t total = at.used + std::max<std::uint64_t>(octets, 1);
  const std::uint64_t further = (total - 1) / kOpportunityOctets;
  end = {at.opportunity + further, total - further * kOpportunityOctets};
  return {start, opportunity_time(model, end.opportunity)};
}

}  // namespace atlaswire::netsim
