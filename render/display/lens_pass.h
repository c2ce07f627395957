#pragma once

#include "render/display/stereo.h"
#include "render/gpu/pipeline.h"
#include "render/gpu/submit_context.h"
#include "render/image/lens_correction.h"
#include "render/image/picture.h"

#include <memory>

namespace atlaswire::render {

struct OffscreenTarget;

/// The second sub-stage of display ([SAS] 3.6): copies the eyes' pictures side by side, left eye left, each
/// corrected for its lens at every pixel and in every channel. Samples bilinearly, between encoded values;
/// without distortion, pixels come out as they went in. What lies beyond an eye's picture is black with alpha
/// 0; alpha is otherwise that of where green comes from. One thread at a time.
class LensPass {
 public:
  /// `eyes`: 1 or 2, pictures in a row.
  LensPass(Device& device, const LensCorrection& lens, std::uint32_t eyes);
  ~LensPass();

  /// Writes an eye's picture into its part, and waits. The left eye comes first and clears the whole; with
  /// one eye it is the only one. All have one extent.
  void apply(OffscreenTarget& eye_picture, Eye eye);
  /// The picture written last; empty before the first. Valid until the next call.
  const Picture& read_back();

 private:
  void record(const vk::raii::CommandBuffer& commands, OffscreenTarget& eye_picture, Eye eye);

  SubmitContext context_;
  LensCorrection lens_;
  std::uint32_t eyes_;
  vk::raii::Sampler sampler_;
  DescriptorLayout layout_;
  DescriptorSets sets_;
  Pipeline pipeline_;
  std::unique_ptr<OffscreenTarget> target_;  ///< of the last eye's extent, times the eyes
  Picture picture_;
};

}  // namespace atlaswire::render
