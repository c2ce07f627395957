#pragma once

#include "base/bytes.h"
#include "base/time.h"
#include "proto/messages.h"

#include <cstddef>
#include <optional>

namespace atlaswire::server {

/// What waits for a session's TCP connection. Meta updates cannot be dropped (later ones build on them), so
/// a queue above its bound pauses the stream instead, and one that stays there ends the session.
class ReliableOutbox {
 public:
  struct Settings {
    std::size_t bound = std::size_t{8} << 20U;  ///< octets; above it the stream must pause
    Duration stall_timeout = std::chrono::seconds(10);
  };

  explicit ReliableOutbox(const Settings& settings) : settings_(settings) {}

  void push(const proto::Message& message, Time now);
  /// What the socket should take next, borrowed until `consume`. Messages pushed meanwhile do not move it.
  [[nodiscard]] ByteView front() const { return ByteView(leaving_).subspan(left_); }
  /// The socket took `count` octets of front().
  void consume(std::size_t count, Time now);

  [[nodiscard]] std::size_t size() const { return leaving_.size() - left_ + waiting_.size(); }
  [[nodiscard]] bool is_over() const { return size() > settings_.bound; }
  /// Over the bound for the whole stall timeout, or so far over (four times) that nobody paused.
  [[nodiscard]] bool is_stalled(Time now) const;
  /// When is_stalled() turns true if nothing leaves.
  [[nodiscard]] std::optional<Time> next_deadline() const;

 private:
  void note_level(Time now);

  Settings settings_;
  ByteBuffer leaving_;  ///< the socket may be reading it: never appended to
  std::size_t left_ = 0;
  ByteBuffer waiting_;
  std::optional<Time> over_since_;
};

}  // namespace atlaswire::server
