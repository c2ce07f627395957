#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>

namespace atlaswire::client {

/// Triple buffering between one producer and one consumer thread ([SAS] 3.5): neither ever waits, the
/// consumer gets the newest value, older ones that it never took are overwritten.
template <class T>
class HandOver {
 public:
  /// Producer: makes `v` the newest value. True when it replaced one that the consumer never took.
  bool put(T v) {
    slots_[back_] = std::move(v);
    const std::uint32_t old = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel);
    back_ = old & kIndex;
    slots_[back_].reset();
    return (old & kFresh) != 0;
  }

  /// Consumer: the newest value, once; nullopt when there is none since the last call.
  std::optional<T> take() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return std::nullopt;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return std::exchange(slots_[front_], std::nullopt);
  }

 private:
  static constexpr std::uint32_t kIndex = 3;
  static constexpr std::uint32_t kFresh = 4;

  std::array<std::optional<T>, 3> slots_;
  std::uint32_t back_ = 0;   ///< the producer's
  std::uint32_t front_ = 1;  ///< the consumer's
  std::atomic<std::uint32_t> middle_{2};
};

}  // namespace atlaswire::client
