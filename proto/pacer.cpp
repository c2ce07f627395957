#include "proto/pacer.h"

#include <algorithm>
#include <utility>

namespace atlaswire::proto {

namespace {
constexpr std::size_t kMaxSpare = 4;
}

void Pacer::set_rate(BitRate rate, Time now) {
  if (next_send_ > now) {  // what was sent ahead is paid for at the new rate
    const auto old_rate = static_cast<double>(settings_.rate.bits_per_second);
    const double octets = to_seconds(next_send_ - now) * old_rate / 8;
    next_send_ = now;
    if (rate.bits_per_second > 0 && rate != kUnlimitedRate) {
      next_send_ += rate.time_for(Bytes{static_cast<std::uint64_t>(octets)});
    }
  }
  settings_.rate = rate;
}

bool Pacer::fits(const DatagramBatch& batch, Time now) const {
  if (queue_.empty()) return true;
  const Bytes total{queued_.count + batch.octets.size()};
  if (total > settings_.max_queued) return false;
  if (settings_.rate == kUnlimitedRate) return true;
  if (settings_.rate.bits_per_second == 0) return false;
  const Duration owed = std::max(Duration{}, std::max(next_send_, now) - now);
  return settings_.rate.time_for(total) <= settings_.max_delay - std::min(owed, settings_.max_delay);
}

PacerVerdict Pacer::enqueue(DatagramBatch& batch, Time now) {
  PacerVerdict verdict;
  if (batch.size() == 0) return verdict;
  if (!fits(batch, now)) {
    if (!batch.idr) {
      verdict.accepted = false;
      return verdict;
    }
    verdict.dropped = drop_waiting();
  }
  last_enqueue_ = now;
  queued_.count += batch.octets.size();
  queue_.push_back(std::move(batch));
  batch = {};
  if (!spare_.empty()) {
    batch = std::move(spare_.back());
    spare_.pop_back();
  }
  return verdict;
}

/// Throws away the pictures of which nothing has left.
std::uint32_t Pacer::drop_waiting() {
  const std::size_t kept = next_in_front_ > 0 ? 1 : 0;
  std::uint32_t dropped = 0;
  while (queue_.size() > kept) {
    queued_.count -= queue_.back().octets.size();
    recycle(std::move(queue_.back()));
    queue_.pop_back();
    ++dropped;
  }
  return dropped;
}

void Pacer::recycle(DatagramBatch&& batch) {
  batch.clear();
  if (spare_.size() < kMaxSpare) spare_.push_back(std::move(batch));
}

std::optional<ByteView> Pacer::pop(Time now) {
  const bool unlimited = settings_.rate == kUnlimitedRate;
  if (queue_.empty() || settings_.rate.bits_per_second == 0) return std::nullopt;
  if (!unlimited && next_send_ > now) return std::nullopt;
  const ByteView datagram = queue_.front()[next_in_front_++];
  queued_.count -= datagram.size();
  if (!unlimited) {
    const Time earliest = now - settings_.rate.time_for(settings_.burst);
    next_send_ = std::max(next_send_, earliest) + settings_.rate.time_for(Bytes{datagram.size()});
  }
  if (next_in_front_ == queue_.front().size()) {
    if (leaving_.octets.capacity() > 0) recycle(std::move(leaving_));
    leaving_ = std::move(queue_.front());  // moving a vector leaves its octets where they are
    queue_.pop_front();
    next_in_front_ = 0;
  }
  return datagram;
}

std::optional<Time> Pacer::next_deadline() const {
  if (queue_.empty() || settings_.rate.bits_per_second == 0) return std::nullopt;
  return settings_.rate == kUnlimitedRate ? last_enqueue_ : std::max(next_send_, last_enqueue_);
}

std::uint32_t Pacer::clear() {
  const auto unsent = static_cast<std::uint32_t>(queue_.size());
  for (auto& batch : queue_) recycle(std::move(batch));
  queue_.clear();
  next_in_front_ = 0;
  queued_ = {};
  return unsent;
}

}  // namespace atlaswire::proto
