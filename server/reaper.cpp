#include "server/reaper.h"

#include <utility>

namespace atlaswire::server {

Reaper::Reaper() : thread_([this] { loop(); }) {}

Reaper::~Reaper() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Reaper::take(std::unique_ptr<StreamRunner> runner) {
  if (!runner) return;
  runner->request_stop();
  {
    const std::lock_guard lock(mutex_);
    runners_.push_back(std::move(runner));
  }
  changed_.notify_all();
}

std::size_t Reaper::pending() const {
  const std::lock_guard lock(mutex_);
  return runners_.size() + ending_;
}

void Reaper::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return over_ || !runners_.empty(); });
    if (runners_.empty()) return;
    auto ending = std::exchange(runners_, {});
    ending_ = ending.size();
    lock.unlock();
    ending.clear();
    lock.lock();
    ending_ = 0;
  }
}

}  // namespace atlaswire::server
