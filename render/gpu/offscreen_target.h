#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/image.h"
#include "render/gpu/submit_context.h"
#include "render/image/picture.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>

namespace atlaswire::render {

/// What a picture is drawn into and read back from: RGBA8 colour, D32 depth, and a host buffer for the
/// colour.
struct OffscreenTarget {
  Image color;
  Image depth;
  Buffer readback;

  /// `name` leads the three objects' debug names.
  OffscreenTarget(const Device& device, const std::string& name, Extent2D extent);

  /// What becomes of the depth once the picture is drawn.
  enum class Depth : std::uint8_t { kDropped, kKept };
  /// Begins rendering over the whole extent: colour `background` (encoded, 0..1) with alpha 0, depth 0, which
  /// is infinity, viewport set. The caller ends it with endRendering().
  void begin(const vk::raii::CommandBuffer& commands, const glm::vec3& background,
             Depth depth_after = Depth::kDropped);
  /// Begins rendering over the colours that are there already; the depth is undefined.
  void resume(const vk::raii::CommandBuffer& commands);
  /// Copies the colour to the host buffer; it is in use kTransferSource then.
  void record_readback(const vk::raii::CommandBuffer& commands);
  /// What record_readback() copied, once it is waited for.
  void copy_to(Picture& picture) const;
};

/// Makes `target` anew unless it has this extent already.
void fit_target(std::unique_ptr<OffscreenTarget>& target, const Device& device, const std::string& name,
                Extent2D extent);
/// Copies the colour to the host, and waits.
void read_back(SubmitContext& context, OffscreenTarget& target, Picture& picture);

}  // namespace atlaswire::render
