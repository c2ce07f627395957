#pragma once

#include "base/bytes.h"
#include "base/ids.h"
#include "base/time.h"
#include "proto/datagram.h"
#include "proto/tokens.h"

#include <optional>

namespace atlaswire::proto {

/// Client: makes its UDP address known (docs/PROTOCOL.md, section 3.1). Probes until anything else than a
/// challenge comes back, then goes quiet; starts again after `silence` without a datagram. Challenges are
/// answered at any time, so that a changed address is proven without a probe.
class UdpGreeter {
 public:
  struct Settings {
    Duration interval = std::chrono::milliseconds(100);
    Duration silence = std::chrono::seconds(2);
  };

  UdpGreeter(SessionId session, const UdpToken& token) : UdpGreeter(session, token, Settings{}) {}
  UdpGreeter(SessionId session, const UdpToken& token, const Settings& settings)
      : session_(session), token_(token), settings_(settings) {}

  /// The probe to send now, or nullopt. Call when next_deadline() is reached.
  std::optional<Probe> poll(Time now);
  /// When to call `poll` next; Time{} before the first call (at once).
  [[nodiscard]] Time next_deadline() const { return next_; }
  /// The answer to a challenge; nullopt when it names another session.
  [[nodiscard]] std::optional<Confirm> on_challenge(const Challenge& challenge) const;
  /// A valid datagram other than a challenge came: the server knows our address.
  void on_received(Time now);
  /// True once the server has sent anything but challenges, until `silence` passes.
  [[nodiscard]] bool is_established() const { return established_; }

 private:
  SessionId session_;
  UdpToken token_;
  Settings settings_;
  Time next_{};
  bool established_ = false;
};

}  // namespace atlaswire::proto
