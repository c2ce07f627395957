#pragma once

#include "server/settings.h"
#include "server/stream_source.h"

#include <cstdint>
#include <functional>
#include <memory>

namespace atlaswire::server {

/// What the daemon calls on its I/O thread.
struct DaemonHooks {
  std::function<void()> on_ready;  ///< clients may connect now
  std::function<Emphasis()>
      reread;  ///< the operator's emphasis, anew; may throw ProgramError; empty: no SIGHUP
};

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
  /// drains. `source` must outlive the call.
  void serve(StreamSource& source, const DaemonHooks& hooks = {});
  /// Drains, as SIGTERM does. Any thread.
  void stop();
  /// What SIGHUP does: running streams and later ones get the emphasis that `reread` gives. Any thread.
  void reload();
  /// What SIGUSR1 does: the mirrored session's stream draws its atlas's layout into the file that the
  /// settings name. Any thread.
  void draw_layout();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atlaswire::server
