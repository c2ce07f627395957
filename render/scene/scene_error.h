#pragma once

#include "base/error_enum.h"

namespace atlaswire::render {

/// Why a scene or a camera path cannot be used. Error::detail names the file and the offending part.
enum class SceneError {
  kNotFound = 1,      ///< no such file, and no built-in of that name
  kBadName,           ///< a built-in scene's options do not parse
  kMalformed,         ///< not glTF 2.0, or truncated
  kUnsupported,       ///< needs a glTF extension or a feature that is absent here
  kMissingAttribute,  ///< a primitive without positions
  kBadAccessor,       ///< an accessor reaches outside its buffer, or has the wrong type
  kIndexOutOfRange,   ///< a vertex, node, mesh, material, texture or image index
  kNotFinite,         ///< a NaN or infinite coordinate
  kBadImage,          ///< a texture's image cannot be read or decoded
  kEmpty,             ///< nothing to draw
  kTooLarge,          ///< more materials, triangles or texels than the renderer can number
  kBadPath,           ///< a camera path row does not parse
};
const char* error_text(SceneError e);

}  // namespace atlaswire::render
ATLASWIRE_ERROR_ENUM(render, SceneError);
