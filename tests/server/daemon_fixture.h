#pragma once

#include "server/daemon.h"
#include "tests/server/raw_client.h"

#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <memory>
#include <thread>

namespace atlaswire::server {

/// A daemon on a free loopback port, served by a thread of its own.
class RunningDaemon {
 public:
  RunningDaemon(DaemonSettings settings, StreamSource& source, const std::function<Emphasis()>& reread = {}) {
    settings.port = 0;
    settings.stats_interval = Duration{0};
    daemon_ = std::make_unique<Daemon>(settings);
    std::promise<void> ready;
    auto listening = ready.get_future();
    thread_ = std::thread([this, &source, &ready, reread] {
      daemon_->serve(source, {.on_ready = [&ready] { ready.set_value(); }, .reread = reread});
    });
    listening.get();
  }
  ~RunningDaemon() { stop(); }

  /// Drains and waits for the end.
  void stop() {
    if (!thread_.joinable()) return;
    daemon_->stop();
    thread_.join();
  }
  void request_stop() { daemon_->stop(); }
  void reload() { daemon_->reload(); }
  void draw_layout() { daemon_->draw_layout(); }
  [[nodiscard]] std::uint16_t port() const { return daemon_->port(); }

 private:
  std::unique_ptr<Daemon> daemon_;
  std::thread thread_;
};

}  // namespace atlaswire::server
