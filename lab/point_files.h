#pragma once

#include "base/result.h"
#include "lab/point.h"

#include <map>
#include <string>

namespace atlaswire::lab {

/// Content hashes of files already read, by absolute name.
using FileHashes = std::map<std::string, std::string>;

/// Makes the file names among the settings (scene, path, profile) absolute and checks that they exist: a name
/// that is nothing built in is looked for in `folder` first, then in the current one. Gives them as the
/// text that enters the point's id: built-in names, or a file's name without folders and a hash of its
/// content.
Result<std::string> resolve_files(PointSettings& settings, const std::string& folder, FileHashes& hashes);

/// The path that belongs to a scene: the built-in one's own, or for "town.glb" the file "town_path.csv"
/// beside it.
std::string own_path(const std::string& scene);

}  // namespace atlaswire::lab
