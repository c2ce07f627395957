#include "client/motion.h"

#include "base/program.h"
#include "render/scene/camera_path.h"
#include "render/scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace atlaswire::client {
namespace {

Tracker::Motion play(render::CameraPath path) {
  return [path = std::move(path)](Duration t) { return path.at(t); };
}

Tracker::Motion load_path(const std::string& name_or_file) {
  Result<render::CameraPath> path = render::CameraPath::load(name_or_file);
  if (path) return play(std::move(*path));
  throw ProgramError(ExitCode::kBadScene, "--path: " + path.error().message());
}

}  // namespace

Motion::Motion(const std::string& path) : name_(path) {
  if (!path.empty()) motion_ = load_path(path);
}

Tracker::Motion Motion::choose(const std::string& scene) {
  if (motion_) return motion_;
  name_ = scene.substr(0, scene.find(':'));  // "atrium:0.2" walks as "atrium" does
  const std::vector<std::string> builtin = render::CameraPath::builtin();
  if (std::ranges::find(builtin, name_) == builtin.end()) {
    throw ProgramError(
        ExitCode::kBadScene,
        fmt::format("the server's scene {} has no built-in camera path; give one with --path FILE.csv",
                    scene));
  }
  return load_path(name_);
}

std::shared_ptr<const render::Scene> load_truth(const std::string& scene) {
  Result<render::Scene> loaded = render::load_scene(scene);
  if (!loaded) throw ProgramError(ExitCode::kBadScene, "--reference: " + loaded.error().message());
  return std::make_shared<const render::Scene>(std::move(*loaded));
}

}  // namespace atlaswire::client
