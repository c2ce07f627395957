#pragma once

#include "render/relative_camera.h"
#include "render/scene/scene.h"

namespace atlaswire::render {

/// Can any of the box be in the picture? May say yes for a box that just misses, never no for a visible one.
inline bool may_see(const RelativeCamera& camera, const Box& box) {
  bool left = true;
  bool right = true;
  bool above = true;
  bool below = true;
  bool too_near = true;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner{(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                           (i & 4) != 0 ? box.high.z : box.low.z};
    const glm::vec3 relative = (corner - glm::vec3{camera.high}) - glm::vec3{camera.low};
    const glm::vec4 clip = camera.clip_from_relative * glm::vec4{relative, 1.0F};
    left = left && clip.x < -clip.w;
    right = right && clip.x > clip.w;
    above = above && clip.y < -clip.w;
    below = below && clip.y > clip.w;
    too_near = too_near && clip.z > clip.w;
  }
  return !(left || right || above || below || too_near);
}

}  // namespace atlaswire::render
