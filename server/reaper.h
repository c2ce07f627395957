#pragma once

#include "server/stream_runner.h"

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace atlaswire::server {

/// Ends runners on a thread of its own, because joining waits for a frame in work and the I/O thread may not.
class Reaper {
 public:
  Reaper();
  /// Ends all it was given.
  ~Reaper();
  Reaper(const Reaper&) = delete;
  Reaper& operator=(const Reaper&) = delete;

  void take(std::unique_ptr<StreamRunner> runner);
  /// Runners that are not yet gone.
  [[nodiscard]] std::size_t pending() const;

 private:
  void loop();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::unique_ptr<StreamRunner>> runners_;
  std::size_t ending_ = 0;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace atlaswire::server
