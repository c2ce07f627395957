#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/descriptors.h"
#include "render/gpu/image.h"
#include "render/gpu/submit_context.h"
#include "render/passes/light_table.h"
#include "render/passes/moved_vertices.h"
#include "render/passes/shadow_fit.h"
#include "render/passes/shadow_map.h"
#include "render/passes/texture_upload.h"
#include "render/scene/moved_scene.h"
#include "render/scene/scene.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace atlaswire::render {

/// A scene on the device, uploaded once and shared by every pass that draws it: geometry, textures, one
/// descriptor set a material, lights, and the sun's shadow map. At rest until it is posed; only what moves is
/// written again, and the shadow map drawn again with it. Between poses immutable, so that any thread may
/// record with it.
class SceneGpu {
 public:
  SceneGpu(Device& device, std::shared_ptr<const Scene> scene);

  [[nodiscard]] const Scene& scene() const { return *scene_; }

  /// Moves the scene to a time, on the host: MovedScene::pose.
  void pose(std::optional<double> seconds) { moved_.pose(seconds); }
  /// Brings the device to the last pose, before all that is recorded behind. What was recorded before must be
  /// over. VisibilityPass does the same for itself.
  void record_moves(const vk::raii::CommandBuffer& commands);
  /// Both, and waits.
  void move_to(std::optional<double> seconds);
  /// Where things are.
  [[nodiscard]] const MovedScene& moved() const { return moved_; }

  /// ShadingVertex array, then one made-up fourth corner for each patch of one triangle.
  [[nodiscard]] const Buffer& vertices() const { return vertices_; }
  /// 32-bit, three a triangle.
  [[nodiscard]] const Buffer& indices() const { return indices_; }
  /// Patch of each triangle, 32-bit.
  [[nodiscard]] const Buffer& triangle_patch() const { return triangle_patch_; }
  /// Which lights reach what.
  [[nodiscard]] const LightTable& lights() const { return lights_; }
  /// The vertex that completes a one-triangle patch to a parallelogram: what texels beyond its longest side
  /// are shaded with, so that filtering along that side finds the triangle's own plane.
  [[nodiscard]] std::uint32_t fourth_corner(PatchId patch) const;

  /// Set 0 of shaders/material.glsl, and set 1 by material.
  [[nodiscard]] const DescriptorLayout& scene_layout() const { return scene_layout_; }
  [[nodiscard]] const DescriptorLayout& material_layout() const { return material_layout_; }
  [[nodiscard]] vk::DescriptorSet scene_set() const { return scene_sets_.handle(); }
  [[nodiscard]] vk::DescriptorSet material_set(std::size_t material) const {
    return material_sets_.handle(static_cast<std::uint32_t>(material));
  }
  /// gpu_layout::kFeature bits that a material and this scene's lights need.
  [[nodiscard]] std::uint32_t features(std::size_t material) const { return features_[material]; }

  /// 1 x 1 and fully lit in a scene without sun.
  [[nodiscard]] const Image& shadow_map() const { return shadow_map_; }

 private:
  void draw_shadows();
  void write_scene_set();
  void write_material_sets(const Device& device);

  std::shared_ptr<const Scene> scene_;
  MovedScene moved_;
  SubmitContext context_;
  std::vector<std::uint32_t> solo_patches_;  ///< of one triangle, ascending
  LightTable lights_;
  ShadowFit shadow_fit_;
  Buffer vertices_;
  Buffer indices_;
  Buffer triangle_patch_;
  Buffer constants_;
  Buffer light_buffer_;
  Buffer light_list_;
  std::vector<Buffer> materials_;
  TextureSet textures_;
  Image shadow_map_;
  vk::raii::Sampler shadow_sampler_;
  DescriptorLayout scene_layout_;
  DescriptorLayout material_layout_;
  DescriptorSets scene_sets_;
  DescriptorSets material_sets_;
  std::vector<std::uint32_t> features_;
  // Of a scene that moves.
  std::optional<MovedVertices> moved_vertices_;
  std::optional<MovingShadows> shadows_;  ///< and has a sun
};

}  // namespace atlaswire::render
