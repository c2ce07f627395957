#include "render/scene/load.h"

#include "render/scene/atrium.h"
#include "render/scene/gltf.h"
#include "render/scene/parade.h"
#include "render/scene/scene_error.h"

#include <filesystem>

namespace atlaswire::render {

std::vector<std::string> builtin_scenes() { return {"atrium", "parade"}; }

Result<Scene> load_scene(const std::string& name_or_file, const AssembleSettings& settings) {
  if (name_or_file == "atrium" || name_or_file.starts_with("atrium:")) {
    const auto options = parse_atrium_name(name_or_file);
    if (options.has_error()) return options.error();
    return assemble(make_atrium(*options), settings);
  }
  if (name_or_file == "parade") return assemble(make_parade(), settings);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(name_or_file, ignored)) {
    return Error{SceneError::kNotFound, "'" + name_or_file + "'"};
  }
  auto source = read_gltf(name_or_file);
  if (source.has_error()) return source.error();
  return assemble(std::move(*source), settings);
}

}  // namespace atlaswire::render
