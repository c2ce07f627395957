#pragma once

#include "render/gpu/image.h"
#include "render/gpu/submit_context.h"
#include "render/scene/scene.h"

#include <memory>
#include <vector>

namespace atlaswire::render {

/// A scene's textures on the device, with full mip chains made by blits (in linear light for sRGB ones),
/// ready to be sampled; beside them a white one for materials that lack a texture, and the few samplers.
class TextureSet {
 public:
  TextureSet(SubmitContext& context, const std::vector<Texture>& textures);

  /// kNoTexture gives the white one.
  [[nodiscard]] const Image& image(std::int32_t texture) const;
  [[nodiscard]] const vk::raii::Sampler& sampler(std::int32_t texture) const;

 private:
  std::vector<std::unique_ptr<Image>> images_;  ///< the white one last
  std::vector<vk::raii::Sampler> samplers_;     ///< by address modes and filter
  std::vector<std::size_t> sampler_of_;         ///< by texture, the white one last
};

}  // namespace atlaswire::render
