#pragma once

#include "base/units.h"
#include "render/display/i420_planes.h"
#include "render/gpu/buffer.h"
#include "render/gpu/descriptors.h"
#include "render/gpu/pipeline.h"
#include "render/gpu/submit_context.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace atlaswire::render {

/// The client's atlas: decoded pictures as RGBA8 images in a ring, so that one is drawn while the next ones
/// arrive. One thread uploads; any may draw.
class AtlasTexture {
 public:
  /// `colors`: the atlas without its coverage plane, width a multiple of 8, even height (else throws
  /// ProgramError). `slots` >= 2.
  AtlasTexture(Device& device, Extent2D colors, bool coverage, std::uint32_t slots = 3);

  /// Starts the upload of one picture and gives its slot. Draws submitted from now on see it; it stays for
  /// `slots` - 1 further uploads. Copies the planes before it returns; waits only when every slot's upload
  /// is still pending. The picture has picture_extent().
  std::uint32_t upload(const I420Planes& picture);

  [[nodiscard]] Extent2D colors() const { return colors_; }
  [[nodiscard]] Extent2D picture_extent() const;
  [[nodiscard]] std::uint32_t slots() const { return static_cast<std::uint32_t>(slots_.size()); }
  /// A slot's image, in use kSampledInFragment once its upload() returned.
  [[nodiscard]] const Image& image(std::uint32_t slot) const { return slots_[slot]->image; }

 private:
  struct Slot {
    Buffer planes;
    Buffer texels;  ///< converted; a copy to the image is far cheaper on a CPU than image stores
    Image image;
    Slot(const Device& device, Extent2D colors, Extent2D picture);
  };
  void copy_planes(const I420Planes& picture, const Buffer& to) const;

  Extent2D colors_;
  bool coverage_;
  DescriptorLayout layout_;
  Pipeline pipeline_;
  std::vector<std::unique_ptr<Slot>> slots_;
  DescriptorSets sets_;
  SubmitContext context_;
  std::uint32_t next_ = 0;
};

}  // namespace atlaswire::render
