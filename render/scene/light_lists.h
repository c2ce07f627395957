#pragma once

#include "render/scene/scene.h"

namespace atlaswire::render {

/// Fills light_lists and each chunk's share of it: the lights whose range reaches the chunk's box.
void list_lights(Scene& scene);

/// Does the light's sphere of range touch the box?
bool reaches(const PunctualLight& light, const Box& box);

/// The range at which a light of that peak intensity falls to 1/100 of a unit, for lights that state none:
/// sqrt(100 * intensity), within 0.1..100 m.
float implied_range(const glm::vec3& color);

}  // namespace atlaswire::render
