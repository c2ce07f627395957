#pragma once

#include "netsim/profile.h"
#include "netsim/relay_stats.h"

#include <cstdint>
#include <memory>
#include <string>

namespace atlaswire::netsim {

/// What a relay is told at its start.
struct RelaySettings {
  std::string listen_address = "127.0.0.1";
  std::uint16_t port = 0;  ///< of TCP and UDP alike; 0: any that is free for both
  std::string target_host;
  std::uint16_t target_port = 0;
  Profile profile;
  std::uint64_t seed = 1;
  Duration duration{};                               ///< zero: until stopped
  Duration spin = std::chrono::microseconds(100);    ///< busy waiting before each arrival
  Duration idle_timeout = std::chrono::seconds(60);  ///< of UDP flows
  std::size_t max_flows = 1024;                      ///< UDP flows and TCP connections together
  std::string log_file;                              ///< decision log; empty: none
  std::string pcapng_file;                           ///< empty: none
  bool live_line = false;                            ///< a summary line on stderr each second
};

/// The live driver: relays UDP flows and TCP connections of one port number to a target, through one shared
/// Emulator. One thread; `stop` may be called from any.
class Relay {
 public:
  /// Binds and opens files; throws ProgramError (port in use, cannot resolve, cannot write). The profile's
  /// clock starts here.
  explicit Relay(const RelaySettings& settings);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// Relays until the duration has passed, `stop`, SIGINT or SIGTERM.
  void run();
  void stop();
  /// After `run`.
  [[nodiscard]] const RelayStats& stats() const;
  [[nodiscard]] Duration elapsed() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atlaswire::netsim
