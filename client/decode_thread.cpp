#include "client/decode_thread.h"

#include <mutex>
#include <thread>
#include <utility>

namespace atlaswire::client {

class DecodeThread::Impl {
 public:
  Impl(const proto::StreamDescription& stream, const DecodeSettings& settings, ArrivalQueue& arrivals,
       HandOver<Pair>& pairs, DecodeTroubles troubles)
      : maker_(stream, settings, std::move(troubles)),
        arrivals_(&arrivals),
        pairs_(&pairs),
        thread_([this] { run(); }) {}

  ~Impl() { finish(); }

  void finish() {
    if (thread_.joinable()) thread_.join();
  }

  [[nodiscard]] DecodeCounts counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  void run() {
    std::uint64_t never_shown = 0;
    while (std::optional<Arrival> arrival = arrivals_->pop()) {
      if (maker_.is_broken()) continue;  // drain, so that nobody waits for places
      if (arrival->frame) maker_.on_frame(*arrival->frame);
      if (arrival->update) maker_.on_update(std::move(*arrival->update));
      while (std::optional<Pair> pair = maker_.next_pair()) {
        never_shown += pairs_->put(std::move(*pair)) ? 1U : 0U;
      }
      const std::lock_guard lock(mutex_);
      counts_ = maker_.counts();
      counts_.never_shown = never_shown;
    }
  }

  PairMaker maker_;
  ArrivalQueue* arrivals_;
  HandOver<Pair>* pairs_;
  mutable std::mutex mutex_;
  DecodeCounts counts_;
  std::thread thread_;  // last: everything it uses exists
};

DecodeThread::DecodeThread(const proto::StreamDescription& stream, const DecodeSettings& settings,
                           ArrivalQueue& arrivals, HandOver<Pair>& pairs, DecodeTroubles troubles)
    : impl_(std::make_unique<Impl>(stream, settings, arrivals, pairs, std::move(troubles))) {}
DecodeThread::~DecodeThread() = default;

void DecodeThread::finish() { impl_->finish(); }

DecodeCounts DecodeThread::counts() const { return impl_->counts(); }

}  // namespace atlaswire::client
