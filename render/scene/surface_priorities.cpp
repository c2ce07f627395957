#include "render/scene/surface_priorities.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace atlaswire::render {

std::vector<float> surface_priorities(const Scene& scene, const Emphasis& emphasis) {
  std::unordered_map<std::string, double> named;
  for (const SurfacePriority& p : emphasis.priorities) named[p.name] = p.octaves;
  std::vector<float> octaves;
  const auto add = [&](const std::string& name, float own) {
    const auto found = named.find(name);
    const double chosen = found == named.end() ? double{own} : found->second;
    octaves.push_back(
        static_cast<float>(std::clamp(chosen, -Emphasis::kMostOctaves, Emphasis::kMostOctaves)));
  };
  for (const Material& material : scene.materials) add(material.name, material.atlas_priority);
  for (const SceneObject& object : scene.objects) add(object.name, object.atlas_priority);
  if (scene.objects.empty()) octaves.push_back(0.0F);
  return octaves;
}

std::vector<std::string> unknown_surfaces(const Scene& scene, const Emphasis& emphasis) {
  std::unordered_set<std::string> known;
  for (const Material& material : scene.materials) known.insert(material.name);
  for (const SceneObject& object : scene.objects) known.insert(object.name);
  std::vector<std::string> unknown;
  for (const SurfacePriority& p : emphasis.priorities) {
    if (!known.contains(p.name)) unknown.push_back(p.name);
  }
  return unknown;
}

}  // namespace atlaswire::render
