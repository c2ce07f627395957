#include "render/display/lens_pass.h"

#include "base/assert.h"
#include "render/gpu/offscreen_target.h"
#include "shaders/lens_layout.h"
#include "shaders/shaders.h"

namespace atlaswire::render {
namespace {

gpu_layout::LensConstants constants_of(const LensCorrection& lens, Extent2D eye, float left) {
  gpu_layout::LensConstants constants{.extent = {eye.width, eye.height}, .corner = {left, 0.0F}};
  for (int c = 0; c < 3; ++c) {
    constants.k1[c] = static_cast<float>(lens.channels[static_cast<std::size_t>(c)].k1);
    constants.k2[c] = static_cast<float>(lens.channels[static_cast<std::size_t>(c)].k2);
  }
  return constants;
}

}  // namespace

LensPass::LensPass(Device& device, const LensCorrection& lens, std::uint32_t eyes)
    : context_(device, "lens", 1),
      lens_(lens),
      eyes_(eyes),
      sampler_(make_sampler(device, {.name = "eye picture"})),
      layout_(device, "lens",
              {{0, vk::DescriptorType::eCombinedImageSampler, vk::ShaderStageFlagBits::eFragment}}),
      sets_(device, "lens", layout_),
      pipeline_(device, GraphicsSettings{.name = "lens",
                                         .vertex = shaders::warp_screen_vert,
                                         .fragment = shaders::lens_frag,
                                         .layouts = {layout_.handle()},
                                         .push_constant_bytes = sizeof(gpu_layout::LensConstants),
                                         .colors = {vk::Format::eR8G8B8A8Unorm},
                                         .depth = vk::Format::eD32Sfloat,
                                         .depth_test = false,
                                         .depth_write = false}) {
  AW_ASSERT(eyes == 1 || eyes == 2);
}

LensPass::~LensPass() = default;

void LensPass::apply(OffscreenTarget& eye_picture, Eye eye) {
  AW_ASSERT(eye == Eye::kLeft || (eyes_ == 2 && target_ != nullptr));
  const Extent2D extent = eye_picture.color.extent();
  fit_target(target_, context_.device(), "lens", {extent.width * eyes_, extent.height});
  sets_.write(0, 0, eye_picture.color, sampler_);
  context_.run([&](const vk::raii::CommandBuffer& commands) { record(commands, eye_picture, eye); });
}

void LensPass::record(const vk::raii::CommandBuffer& commands, OffscreenTarget& eye_picture, Eye eye) {
  const Extent2D extent = eye_picture.color.extent();
  const std::uint32_t left = eye == Eye::kLeft ? 0 : extent.width;
  use_image(commands, eye_picture.color, ImageUse::kSampledInFragment);
  if (eye == Eye::kLeft) {
    target_->begin(commands, {0, 0, 0});
  } else {
    target_->resume(commands);
  }
  commands.setScissor(
      0, vk::Rect2D{.offset = {static_cast<std::int32_t>(left), 0}, .extent = {extent.width, extent.height}});
  pipeline_.bind(commands, {sets_.handle()});
  pipeline_.push(commands, constants_of(lens_, extent, static_cast<float>(left)));
  commands.draw(3, 1, 0, 0);
  commands.endRendering();
}

const Picture& LensPass::read_back() {
  if (target_ != nullptr) render::read_back(context_, *target_, picture_);
  return picture_;
}

}  // namespace atlaswire::render
