#pragma once

#include "server/settings.h"
#include "server/stream_source.h"

#include <cstdint>
#include <functional>
#include <memory>

namespace atlaswire::server {

/// The daemon: one thread of I/O around sessions and their streams. TCP and UDP share one port number.
class Daemon {
 public:
  /// Takes the port, without letting anyone in yet. Throws ProgramError: kPortInUse, kUsage for addresses
  /// that are none, kCannotWrite for the statistics file.
  explicit Daemon(const DaemonSettings& settings);
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// Listens, writes the ready file and serves on this thread until a signal, --max-runtime or `stop`, then
  /// drains. `on_ready` is called once clients may connect. `source` must outlive the call.
  void serve(StreamSource& source, const std::function<void()>& on_ready = {});
  /// Drains, as SIGTERM does. Any thread.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atlaswire::server
