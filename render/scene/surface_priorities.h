#pragma once

#include "base/emphasis.h"
#include "render/scene/scene.h"

#include <vector>

namespace atlaswire::render {

/// Octaves of atlas area by surface under an emphasis: first a number for each of the scene's materials, then
/// one for each object (at least one, for scenes without). A patch gets the sum of its two. What the emphasis
/// does not name keeps the scene's own priority; numbers are clamped to -8..8.
std::vector<float> surface_priorities(const Scene& scene, const Emphasis& emphasis);

/// Names in the emphasis that no material and no object has.
std::vector<std::string> unknown_surfaces(const Scene& scene, const Emphasis& emphasis);

}  // namespace atlaswire::render
