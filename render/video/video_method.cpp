#include "render/video/video_method.h"

#include "base/assert.h"
#include "base/program.h"
#include "render/gpu/barriers.h"
#include "render/video/depth_plane.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace atlaswire::render {
namespace {

MethodSettings checked(const MethodSettings& s) {
  const Extent2D display = s.video.display;
  if (!(s.fov_scale >= 1.0 && s.fov_scale <= 4.0) || s.frames_in_flight < 1 || display.area() == 0 ||
      display.width % 2 != 0 || display.height % 2 != 0) {
    throw ProgramError(ExitCode::kUsage,
                       "video: the field of view's scale must be in [1, 4], frames in flight at least 1, and "
                       "the display's sides even");
  }
  return s;
}

/// What is drawn for a display's camera.
Camera view_of(const Camera& display, double scale) {
  Camera view = enlarged(display, scale);
  // I420Pass converts 8 pixels at a time. Pixels stay as large as they are: the vertical field of view
  // decides.
  view.extent.width = (view.extent.width + 7) / 8 * 8;
  return view;
}

Extent2D view_extent(const MethodSettings& s) {
  return view_of({.extent = s.video.display}, s.fov_scale).extent;
}

I420Pass::LowerHalf lower_half(VideoDepth depth) {
  return depth == VideoDepth::kCoded ? I420Pass::LowerHalf::kFromHost : I420Pass::LowerHalf::kNone;
}

}  // namespace

VideoMethod::VideoMethod(Device& device, std::shared_ptr<const Scene> scene, const MethodSettings& settings)
    : settings_(checked(settings)),
      scene_gpu_(device, std::move(scene)),
      forward_(device, scene_gpu_),
      target_(device, "video", view_extent(settings_)),
      conversion_(device, target_.color, lower_half(settings_.video.depth), settings_.frames_in_flight),
      depths_(settings_.frames_in_flight),
      timer_(device, "video timer", 1),
      context_(device, "video") {
  if (settings_.video.depth == VideoDepth::kNone) return;
  depth_.emplace(device, BufferSettings{.name = "video depth",
                                        .size = target_.depth.extent().area() * sizeof(float),
                                        .usage = vk::BufferUsageFlagBits::eTransferDst,
                                        .residence = Residence::kReadback});
}

RenderedFrame VideoMethod::render(const FrameRequest& request) {
  AW_ASSERT(request.camera.extent == settings_.video.display);
  const Camera view = view_of(request.camera, settings_.fov_scale);
  const std::uint32_t slot = frames_++ % settings_.frames_in_flight;
  RenderedFrame frame{.frame = request.frame};
  const Time start = steady_now();
  scene_gpu_.pose(request.scene_seconds);
  frame.timings.motion = steady_now() - start;
  draw(view, slot, frame.timings);
  frame.picture = conversion_.picture(slot);
  frame.shaded_texels = view.extent.area();
  frame.view = RenderedView{.camera = view, .nearest = view.near_plane};
  if (settings_.video.depth == VideoDepth::kNone) return frame;

  const Time drawn = steady_now();
  std::vector<float>& depth = depths_[slot];
  read_depth(view, depth);
  frame.view->nearest = std::ranges::min(depth);
  if (settings_.video.depth == VideoDepth::kCoded) {
    frame.view->nearest = depth_plane_nearest(frame.view->nearest);
    encode_depth_plane(depth, frame.view->nearest, conversion_.lower_luma(slot));
  } else {
    frame.view->depth = depth;
  }
  frame.timings.conversion += steady_now() - drawn;
  return frame;
}

void VideoMethod::draw(const Camera& view, std::uint32_t slot, RenderTimings& timings) {
  using Depth = OffscreenTarget::Depth;
  const Time start = steady_now();
  const auto& commands = context_.begin();
  timer_.reset(commands);
  scene_gpu_.record_moves(commands);
  forward_.record(commands, view, target_, depth_.has_value() ? Depth::kKept : Depth::kDropped);
  use_image(commands, target_.color, ImageUse::kSampledInCompute);
  timer_.begin(commands, "conversion");
  conversion_.record(commands, slot);
  timer_.end(commands);
  if (depth_.has_value()) {
    use_image(commands, target_.depth, ImageUse::kTransferSource);
    const vk::BufferImageCopy region{
        .imageSubresource = {.aspectMask = target_.depth.aspect(), .layerCount = 1},
        .imageExtent = {view.extent.width, view.extent.height, 1}};
    commands.copyImageToBuffer(target_.depth.handle(), target_.depth.layout(), depth_->handle(), region);
  }
  writes_to_host(commands);
  context_.wait(context_.submit());
  for (const auto& [stage, duration] : timer_.collect()) timings.conversion += duration;
  timings.shading = std::max(Duration::zero(), steady_now() - start - timings.conversion);
}

void VideoMethod::read_depth(const Camera& view, std::vector<float>& depth) const {
  depth_->invalidate();
  const auto buffer = depth_->mapped<float>();
  depth.resize(view.extent.area());
  // reversed_projection() makes depth = near / distance, and clears it to 0: infinitely far.
  const auto near_plane = static_cast<float>(view.near_plane);
  std::ranges::transform(buffer.first(depth.size()), depth.begin(),
                         [near_plane](float value) { return near_plane / value; });
}

}  // namespace atlaswire::render
