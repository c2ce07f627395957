#include "render/scene/requirements.h"

#include <fmt/format.h>

#include <algorithm>

namespace atlaswire::render {

std::vector<std::string> explain(const SceneRequirements& r) {
  const auto line = [](const char* feature, bool on, const std::string& why) {
    return fmt::format("{:<28} {:<4} {}", feature, on ? "on" : "off", why);
  };
  const double patches =
      std::max(1.0, static_cast<double>(r.patches_of[1]) + r.patches_of[2] + r.patches_of[3]);
  const auto share = [&](int n) { return 100.0 * r.patches_of[n] / patches; };
  return {
      fmt::format(
          "{} triangles in {:.0f} patches: {:.1f} % of one triangle, {:.1f} % of two, {:.1f} % of three",
          r.triangles, patches, share(1), share(2), share(3)),
      fmt::format("{} degenerate triangles dropped, {} added by splitting huge ones", r.degenerate_triangles,
                  r.split_triangles),
      line("alpha mask", r.alpha_mask,
           r.alpha_mask ? "a material cuts out: coverage plane, discard in id pass"
                        : "no cut-out material: no coverage plane"),
      line("alpha blend", r.alpha_blend,
           r.alpha_blend ? "a material blends: sorted draws, coverage plane" : "no blended material"),
      line("double-sided", r.double_sided,
           r.double_sided ? "a material shows its back: a second cull mode" : "every back face is culled"),
      line("base colour textures", r.base_color_textures,
           r.base_color_textures ? "sampled" : "constant colours only"),
      line("normal maps", r.normal_maps,
           r.normal_maps ? "tangents are interpolated" : "no tangent frame is interpolated"),
      line("metallic-roughness textures", r.metallic_roughness_textures,
           r.metallic_roughness_textures ? "sampled" : "constants only"),
      line("emission", r.emissive, r.emissive ? "a material shines" : "no material shines"),
      line("sun and shadow map", r.sun,
           r.sun ? "a directional light: one shadow pass, filtered" : "no directional light: no shadow pass"),
      line("punctual lights", r.lights > 0,
           fmt::format("{} in all, at most {} reach one chunk", r.lights, r.most_lights_per_chunk)),
      line("motion", r.clips > 0,
           r.clips == 0
               ? std::string("nothing moves: no buffer is written twice, no message sent")
               : fmt::format("{} clips move {} rigid objects and deform {} parts of {} points: buffers and "
                             "the shadow map follow each frame, so do messages",
                             r.clips, r.rigid_objects, r.deformed_parts, r.deformed_points)),
  };
}

}  // namespace atlaswire::render
