#include "proto/clock_sync.h"

#include <algorithm>

namespace atlaswire::proto {

namespace {

constexpr std::size_t kMaxPending = 16;
constexpr std::size_t kMaxSamples = 256;

}  // namespace

SyncResponse answer_sync(const SyncRequest& request, Time received, Time sent) {
  return {request.session, request.sequence, request.client_sent, to_nanos(received), to_nanos(sent)};
}

std::optional<SyncRequest> ClockSync::poll(Time now) {
  if (now < next_) return std::nullopt;
  next_ = now + (answers_ < settings_.fast_count ? settings_.fast_interval : settings_.interval);
  if (pending_.size() >= kMaxPending) pending_.pop_front();
  const SyncRequest request{session_, ++sequence_, to_nanos(now)};
  pending_.push_back({request.sequence, request.client_sent});
  return request;
}

bool ClockSync::on_response(const SyncResponse& response, Time received) {
  if (response.session != session_) return false;
  const auto request = std::find_if(pending_.begin(), pending_.end(),
                                    [&](const Pending& p) { return p.sequence == response.sequence; });
  if (request == pending_.end() || request->sent != response.client_sent) return false;
  const std::int64_t t1 = request->sent;
  const std::int64_t t4 = to_nanos(received);
  const std::int64_t t2 = response.server_received;
  const std::int64_t t3 = response.server_sent;
  if (!is_wire_time(t1) || !is_wire_time(t4) || !is_wire_time(t2) || !is_wire_time(t3)) return false;
  if (t4 < t1 || t3 < t2 || t3 - t2 > t4 - t1) return false;
  pending_.erase(request);
  // RFC 5905 section 8: offset ((t2 - t1) + (t3 - t4)) / 2.
  const Duration offset{((t2 - t1) + (t3 - t4)) / 2};
  samples_.push_back({received, offset, Duration{(t4 - t1) - (t3 - t2)}});
  while (samples_.size() > kMaxSamples ||
         (samples_.size() > 1 && received - samples_.front().received > settings_.window)) {
    samples_.pop_front();
  }
  ++answers_;
  return true;
}

const ClockSync::Sample* ClockSync::best() const {
  const Sample* least = nullptr;
  for (const Sample& sample : samples_) {
    if (least == nullptr || sample.round_trip <= least->round_trip) least = &sample;  // newest of equals
  }
  return least;
}

Duration ClockSync::offset() const {
  const Sample* sample = best();
  return sample == nullptr ? Duration{} : sample->offset;
}

Duration ClockSync::round_trip() const {
  const Sample* sample = best();
  return sample == nullptr ? Duration{} : sample->round_trip;
}

Duration ClockSync::last_round_trip() const {
  return samples_.empty() ? Duration{} : samples_.back().round_trip;
}

Duration ClockSync::error_bound(Time now) const {
  const Sample* sample = best();
  if (sample == nullptr) return Duration::max();
  const Duration age = std::max(Duration{}, now - sample->received);
  return sample->round_trip / 2 + from_seconds(to_seconds(age) * settings_.max_drift);
}

std::int64_t ClockSync::to_server(Time client) const { return to_nanos(client + offset()); }

Time ClockSync::to_client(std::int64_t server_nanos) const { return from_nanos(server_nanos) - offset(); }

}  // namespace atlaswire::proto
