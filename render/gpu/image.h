#pragma once

#include "base/units.h"
#include "render/gpu/buffer.h"

#include <cstdint>
#include <string>
#include <vector>

namespace atlaswire::render {

/// What an image is to be. kDevice images are optimal; host-visible ones are linear, mapped, and have one
/// level and layer.
struct ImageSettings {
  std::string name;
  Extent2D extent;
  vk::Format format = vk::Format::eR8G8B8A8Unorm;
  vk::ImageUsageFlags usage;
  std::uint32_t levels = 1;
  std::uint32_t layers = 1;  ///< above 1 the view is a 2D array
  Residence residence = Residence::kDevice;
};

/// What an image is used for next; `use_image` makes the barrier from its last use.
enum class ImageUse : std::uint8_t {
  kNone,  ///< contents undefined
  kColorTarget,
  kDepthTarget,
  kSampledInCompute,
  kSampledInFragment,
  kStorageInCompute,
  kStorageInFragment,
  kTransferSource,
  kTransferTarget,
  kHostRead,
};

/// An image with its own memory, one view of all of it, and its last recorded use: record commands for one
/// image in the order they are submitted.
class Image {
 public:
  Image(const Device& device, const ImageSettings& settings);

  [[nodiscard]] vk::Image handle() const { return *image_; }
  [[nodiscard]] vk::ImageView view() const { return *view_; }
  [[nodiscard]] Extent2D extent() const { return extent_; }
  [[nodiscard]] vk::Format format() const { return format_; }
  [[nodiscard]] vk::ImageAspectFlags aspect() const { return aspect_; }
  [[nodiscard]] std::uint32_t levels() const { return levels_; }
  [[nodiscard]] std::uint32_t layers() const { return layers_; }
  [[nodiscard]] vk::ImageLayout layout() const;
  /// All of it, for barriers and views.
  [[nodiscard]] vk::ImageSubresourceRange whole() const;
  /// Mapped bytes and bytes a row; null for kDevice images.
  [[nodiscard]] const std::byte* mapped() const { return mapped_; }
  [[nodiscard]] std::size_t row_pitch() const { return row_pitch_; }

 private:
  friend void use_image(const vk::raii::CommandBuffer& commands, Image& image, ImageUse next);
  friend void discard_image(const vk::raii::CommandBuffer& commands, Image& image, ImageUse next);
  void transition(const vk::raii::CommandBuffer& commands, ImageUse next, bool discard);

  Extent2D extent_;
  vk::Format format_;
  vk::ImageAspectFlags aspect_;
  std::uint32_t levels_;
  std::uint32_t layers_;
  vk::raii::Image image_;
  vk::raii::DeviceMemory memory_;
  vk::raii::ImageView view_;
  std::byte* mapped_ = nullptr;
  std::size_t row_pitch_ = 0;
  ImageUse use_ = ImageUse::kNone;
};

/// Waits for the last use and changes the layout for the next. `kNone` as the last use discards contents.
void use_image(const vk::raii::CommandBuffer& commands, Image& image, ImageUse next);
/// The same, discarding what it holds.
void discard_image(const vk::raii::CommandBuffer& commands, Image& image, ImageUse next);

/// How a sampler reads.
struct SamplerSettings {
  std::string name;
  vk::Filter filter = vk::Filter::eLinear;
  bool mipmaps = false;
  float anisotropy = 1.0F;  ///< clamped to what the device has
  vk::SamplerAddressMode address_u = vk::SamplerAddressMode::eClampToEdge;
  vk::SamplerAddressMode address_v = vk::SamplerAddressMode::eClampToEdge;
  bool depth_compare = false;  ///< percentage-closer: compares with eGreaterOrEqual
};
vk::raii::Sampler make_sampler(const Device& device, const SamplerSettings& settings);

}  // namespace atlaswire::render
