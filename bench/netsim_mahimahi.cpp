#include "bench/netsim_mahimahi.h"

#include <algorithm>
#include <utility>

namespace atlaswire::bench {

void MahimahiDelay::enter(std::string packet, std::uint64_t now_ms) {
  queue_.push_back({now_ms + delay_ms_, std::move(packet)});
}

void MahimahiDelay::release(std::uint64_t now_ms, std::vector<std::string>& out) {
  while (!queue_.empty() && queue_.front().release_ms <= now_ms) {
    out.push_back(std::move(queue_.front().packet));
    queue_.pop_front();
  }
}

void MahimahiLink::enter(std::string packet) { queue_.push_back(std::move(packet)); }

void MahimahiLink::release(std::uint64_t now_ms, std::vector<std::string>& out) {
  while (next_opportunity() <= now_ms) {
    std::size_t left = 1504;
    while (left > 0 && !queue_.empty()) {
      const std::size_t part = std::min(left, queue_.front().size() - sent_of_head_);
      left -= part;
      sent_of_head_ += part;
      if (sent_of_head_ < queue_.front().size()) break;
      out.push_back(std::move(queue_.front()));
      queue_.pop_front();
      sent_of_head_ = 0;
    }
    if (++next_ == trace_.size()) {
      next_ = 0;
      base_ms_ += trace_.back();
    }
  }
}

}  // namespace atlaswire::bench
