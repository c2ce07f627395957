#pragma once

#include "base/units.h"
#include "render/gpu/buffer.h"
#include "render/gpu/descriptors.h"
#include "render/gpu/pipeline.h"
#include "render/method.h"

#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Converts an RGBA8 image to I420 (BT.709 full range, chroma the mean of 2 x 2) in host memory, and leaves
/// room for a second plane below the colours where one is needed. One thread at a time.
class I420Pass {
 public:
  /// What lies below the colours; its chroma is 128.
  enum class LowerHalf : std::uint8_t {
    kNone,
    kCoverage,  ///< the source's alpha as luma, for scenes with alpha
    kFromHost,  ///< luma that the caller writes
  };
  /// `source` is sampled by every record(); its width is a multiple of 8 and its height even (else throws
  /// ProgramError). `slots`: pictures in flight.
  I420Pass(const Device& device, const Image& source, LowerHalf lower, std::uint32_t slots);

  /// Converts into a slot. `source` must be in use kSampledInCompute.
  void record(const vk::raii::CommandBuffer& commands, std::uint32_t slot) const;
  /// The slot's planes, once the work is waited for; valid until its next record().
  [[nodiscard]] I420Picture picture(std::uint32_t slot) const;
  /// With kFromHost, the lower half's luma of a slot, to be filled after picture(): as many octets as the
  /// source has pixels.
  [[nodiscard]] std::span<std::uint8_t> lower_luma(std::uint32_t slot) const;
  /// Twice as high as the source with a lower half.
  [[nodiscard]] Extent2D picture_extent() const;

 private:
  Extent2D colors_;
  LowerHalf lower_;
  vk::raii::Sampler sampler_;
  DescriptorLayout layout_;
  Pipeline pipeline_;
  std::vector<Buffer> planes_;
  DescriptorSets sets_;
};

}  // namespace atlaswire::render
