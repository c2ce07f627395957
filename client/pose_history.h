#pragma once

#include "base/ids.h"
#include "base/pose.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace atlaswire::client {

/// The poses sent last, by number: the server answers with the number it rendered for. Bounded.
class PoseHistory {
 public:
  explicit PoseHistory(std::size_t places = 4096) : ring_(places) {}

  void add(const StampedPose& pose) { ring_[value(pose.id) % ring_.size()] = pose; }
  /// nullopt for number 0, and for poses too old or never sent.
  [[nodiscard]] std::optional<StampedPose> find(PoseId id) const {
    const StampedPose& pose = ring_[value(id) % ring_.size()];
    if (id == PoseId{} || pose.id != id) return std::nullopt;
    return pose;
  }

 private:
  std::vector<StampedPose> ring_;
};

}  // namespace atlaswire::client
