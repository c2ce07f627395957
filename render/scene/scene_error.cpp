#include "render/scene/scene_error.h"

namespace atlaswire::render {

const char* error_text(SceneError e) {
  switch (e) {
    case SceneError::kNotFound:
      return "no such scene or file";
    case SceneError::kBadName:
      return "bad options of a built-in scene";
    case SceneError::kMalformed:
      return "malformed scene file";
    case SceneError::kUnsupported:
      return "unsupported scene feature";
    case SceneError::kMissingAttribute:
      return "missing vertex attribute";
    case SceneError::kBadAccessor:
      return "bad accessor";
    case SceneError::kIndexOutOfRange:
      return "index out of range";
    case SceneError::kNotFinite:
      return "coordinate is not finite";
    case SceneError::kBadImage:
      return "image cannot be decoded";
    case SceneError::kEmpty:
      return "scene has no triangles";
    case SceneError::kTooLarge:
      return "scene is too large";
    case SceneError::kBadPath:
      return "bad camera path";
  }
  return "unknown scene error";
}

}  // namespace atlaswire::render
