#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace atlaswire::bench {

/// mahimahi's published approach, for comparison: Netravali et al. 2015, Mahimahi: Accurate Record-and-Replay
/// for HTTP, section 4 (DelayShell and LinkShell). Written from the paper, not from its source: one
/// direction, whole milliseconds, a loop that looks at every millisecond. No losses, no jitter, no seeds: it
/// has none.
class MahimahiDelay {
 public:
  explicit MahimahiDelay(std::uint64_t delay_ms) : delay_ms_(delay_ms) {}
  void enter(std::string packet, std::uint64_t now_ms);
  /// Packets whose delay has passed.
  void release(std::uint64_t now_ms, std::vector<std::string>& out);

 private:
  struct Held {
    std::uint64_t release_ms;
    std::string packet;
  };
  std::uint64_t delay_ms_;
  std::deque<Held> queue_;
};

/// A link by a trace of opportunities of 1504 octets each. Unused opportunities are lost; the trace repeats.
class MahimahiLink {
 public:
  explicit MahimahiLink(std::vector<std::uint64_t> trace_ms) : trace_(std::move(trace_ms)) {}
  void enter(std::string packet);
  /// Uses all opportunities up to now.
  void release(std::uint64_t now_ms, std::vector<std::string>& out);

 private:
  [[nodiscard]] std::uint64_t next_opportunity() const { return base_ms_ + trace_[next_]; }

  std::vector<std::uint64_t> trace_;
  std::uint64_t base_ms_ = 0;
  std::size_t next_ = 0;
  std::deque<std::string> queue_;
  std::size_t sent_of_head_ = 0;
};

}  // namespace atlaswire::bench
