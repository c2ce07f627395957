#include "lab/point_files.h"

#include "lab/lab_error.h"
#include "lab/plan.h"
#include "netsim/profile.h"
#include "render/scene/atrium.h"
#include "render/scene/camera_path.h"
#include "render/scene/load.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace atlaswire::lab {
namespace {

namespace fs = std::filesystem;

bool among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string stem_of_builtin(const std::string& scene) { return scene.substr(0, scene.find(':')); }

/// The absolute name of a file given by name, or nothing.
std::string find_file(const std::string& name, const std::string& folder) {
  std::error_code ignored;
  for (const fs::path& candidate : {fs::path(folder) / name, fs::path(name)}) {
    if (fs::is_regular_file(candidate, ignored)) return fs::weakly_canonical(candidate, ignored).string();
  }
  return {};
}

/// "scene=town.glb HASH" and the absolute name; the error says what `hint` would be instead.
Result<std::string> resolve(const char* key, std::string& name, const std::string& folder,
                            const std::string& hint, FileHashes& hashes) {
  const std::string file = find_file(name, folder);
  if (file.empty()) return Error{LabError::kNotFound, std::string(key) + " '" + name + "' (" + hint + ")"};
  name = file;
  std::string& hash = hashes[file];
  if (hash.empty()) {
    std::ifstream in(file, std::ios::binary);
    hash = text_hash(std::string{std::istreambuf_iterator<char>(in), {}});
  }
  return std::string(key) + "=" + fs::path(file).filename().string() + " " + hash + "\n";
}

Result<std::string> resolve_scene(PointSettings& s, const std::string& folder, FileHashes& hashes) {
  const std::string stem = stem_of_builtin(s.scene);
  if (!among(render::builtin_scenes(), stem)) {
    return resolve("scene", s.scene, folder, "neither built-in nor a file", hashes);
  }
  if (const auto options = render::parse_atrium_name(s.scene); options.has_error()) return options.error();
  return "scene=" + s.scene + "\n";
}

Result<std::string> resolve_path(PointSettings& s, const std::string& folder, FileHashes& hashes) {
  if (among(render::CameraPath::builtin(), s.path)) return "path=" + s.path + "\n";
  return resolve("path", s.path, folder, "neither built-in nor a file", hashes);
}

Result<std::string> resolve_profile(PointSettings& s, const std::string& folder, FileHashes& hashes) {
  if (s.profile.empty() || among(netsim::shipped_profiles(), s.profile)) return "profile=" + s.profile + "\n";
  auto text = resolve("profile", s.profile, folder, "neither shipped nor a .toml file", hashes);
  if (text.has_error()) return text;
  if (const auto profile = netsim::load_profile(s.profile); profile.has_error()) return profile.error();
  return text;
}

}  // namespace

Result<std::string> resolve_files(PointSettings& settings, const std::string& folder, FileHashes& hashes) {
  std::string all;
  for (const auto resolve_one : {resolve_scene, resolve_path, resolve_profile}) {
    auto text = resolve_one(settings, folder, hashes);
    if (text.has_error()) return text;
    all += *text;
  }
  return all;
}

std::string own_path(const std::string& scene) {
  const std::string stem = stem_of_builtin(scene);
  if (among(render::builtin_scenes(), stem)) return stem;
  const fs::path file(scene);
  return (file.parent_path() / (file.stem().string() + "_path.csv")).string();
}

}  // namespace atlaswire::lab
