#pragma once

#include "base/pose.h"
#include "base/result.h"
#include "base/time.h"

#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::render {

/// A viewer's way through a scene: poses at ascending times, the first at zero.
class CameraPath {
 public:
  /// One row.
  struct Key {
    Duration at{};
    Pose pose;
  };

  /// From CSV rows `t,px,py,pz,qx,qy,qz,qw` (seconds, metres, unit quaternion camera to scene), a header row
  /// allowed. Times must ascend; they are shifted to start at zero. Velocities come from neighbouring rows.
  /// Error kBadPath names the line.
  static Result<CameraPath> parse(std::string_view csv);
  /// Reads a file, or makes a built-in path by its name.
  static Result<CameraPath> load(const std::string& name_or_file);
  /// Names of the built-in paths: "atrium" walks through the built-in scene, "atrium-turn" spins once about
  /// itself in 4 s, "atrium-about" stands, turns by 180 degrees within half a second and stands,
  /// "atrium-still" stands; "parade" walks about the scene of that name, "parade-still" stands there.
  static std::vector<std::string> builtin();
  /// A viewer who stands still.
  static CameraPath standing(const Pose& pose);

  /// The pose at a time since the start, interpolated; before the first and after the last row the path is
  /// walked back and forth, so that it never jumps and never ends.
  [[nodiscard]] Pose at(Duration time) const;
  [[nodiscard]] Duration length() const { return keys_.back().at; }
  [[nodiscard]] const std::vector<Key>& keys() const { return keys_; }

 private:
  explicit CameraPath(std::vector<Key> keys);
  std::vector<Key> keys_;  ///< never empty
};

}  // namespace atlaswire::render
