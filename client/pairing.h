#pragma once

#include "base/ids.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace atlaswire::client {

/// What pairing did with what it was given.
struct PairingCounts {
  std::uint64_t paired = 0;            ///< atlas N with replica N
  std::uint64_t pictureless = 0;       ///< updates applied without display: their picture was lost or late
  std::uint64_t late_pictures = 0;     ///< pictures older than the replica, repeated, or without an update
  std::uint64_t dropped_pictures = 0;  ///< pictures given up because too many waited for their updates
};

/// Brings pictures and meta updates of one stream together ([SAS] 3.5): atlas N is only ever shown with
/// replica N. Updates travel reliably and arrive in order, one a frame; pictures arrive in order, with
/// gaps. Updates wait for their frame's picture; once a newer picture is there, the updates of frames
/// without one are to be applied, in order, and not displayed. Frame ids may wrap. Both queues are
/// bounded. Pure: no clock, no threads.
template <class Picture, class Update>
class Pairing {
 public:
  /// One thing to do, in the order given: apply `update` to the replica; if `picture` is there, replica
  /// and picture are now a pair to display.
  struct Step {
    FrameId frame{};
    Update update;
    std::optional<Picture> picture;
  };

  Pairing(std::size_t max_pictures, std::size_t max_updates)
      : max_pictures_(max_pictures), max_updates_(max_updates) {}

  /// A decoded picture. One that is not newer than the last is ignored and counted.
  void add_picture(FrameId frame, Picture picture) {
    if (last_picture_ && !is_newer(frame, *last_picture_)) {
      ++counts_.late_pictures;
      return;
    }
    last_picture_ = frame;
    pictures_.emplace_back(frame, std::move(picture));
    if (pictures_.size() > max_pictures_) {
      pictures_.pop_front();
      ++counts_.dropped_pictures;
    }
  }

  /// A decoded update. False, with no effect, when it is not newer than the last: the peer broke the order.
  [[nodiscard]] bool add_update(FrameId frame, Update update) {
    if (last_update_ && !is_newer(frame, *last_update_)) return false;
    last_update_ = frame;
    updates_.emplace_back(frame, std::move(update));
    return true;
  }

  /// The next thing to do; nullopt: wait for more input.
  [[nodiscard]] std::optional<Step> next_step() {
    // Pictures whose update is gone, or was never sent, can no longer be shown.
    while (!pictures_.empty() && update_has_passed(pictures_.front().first)) {
      pictures_.pop_front();
      ++counts_.late_pictures;
    }
    if (updates_.empty()) return std::nullopt;
    const FrameId frame = updates_.front().first;
    if (!pictures_.empty() && pictures_.front().first == frame) {
      ++counts_.paired;
      return take(std::move(pictures_.front().second));
    }
    const bool overtaken = !pictures_.empty() || (last_picture_ && !is_newer(frame, *last_picture_));
    if (overtaken || updates_.size() > max_updates_) {
      ++counts_.pictureless;
      return take(std::nullopt);
    }
    return std::nullopt;
  }

  [[nodiscard]] const PairingCounts& counts() const { return counts_; }
  [[nodiscard]] std::size_t waiting_pictures() const { return pictures_.size(); }
  [[nodiscard]] std::size_t waiting_updates() const { return updates_.size(); }

 private:
  [[nodiscard]] bool update_has_passed(FrameId frame) const {
    if (!updates_.empty()) return is_newer(updates_.front().first, frame);
    return last_update_ && !is_newer(frame, *last_update_);
  }

  Step take(std::optional<Picture> picture) {
    Step step{updates_.front().first, std::move(updates_.front().second), std::move(picture)};
    updates_.pop_front();
    if (step.picture) pictures_.pop_front();
    return step;
  }

  std::size_t max_pictures_;
  std::size_t max_updates_;
  std::deque<std::pair<FrameId, Picture>> pictures_;
  std::deque<std::pair<FrameId, Update>> updates_;
  std::optional<FrameId> last_picture_;
  std::optional<FrameId> last_update_;
  PairingCounts counts_;
};

}  // namespace atlaswire::client
