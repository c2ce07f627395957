#pragma once

#include "base/pose.h"
#include "base/time.h"
#include "client/tracker.h"
#include "render/scene/scene.h"

#include <memory>
#include <optional>
#include <string>

namespace atlaswire::client {

/// The camera motion of --path: a CSV file, a built-in path, or the built-in path of whatever scene the
/// server shows. It plays forwards, then backwards, and so on: no jumps, however long the run.
class Motion {
 public:
  /// A file is read, and a built-in name looked up, at once. Throws ProgramError(kBadScene).
  explicit Motion(const std::string& path);

  /// The motion to play in the server's scene. Throws ProgramError(kBadScene) when --path was empty and
  /// that scene has no path of its own.
  Tracker::Motion choose(const std::string& scene);
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  Tracker::Motion motion_;  ///< empty: by the scene's name
};

/// The scene that ground truth is rendered from. Throws ProgramError(kBadScene).
std::shared_ptr<const render::Scene> load_truth(const std::string& scene);

}  // namespace atlaswire::client
