#include "lab/warp_contender.h"

#include "client/pairing.h"
#include "lab/coding.h"
#include "lab/view_header.h"
#include "lab/view_stream.h"
#include "render/display/lens_pass.h"
#include "render/passes/tonemap.h"
#include "render/video/depth_plane.h"

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace atlaswire::lab {
namespace {

using render::VideoDepth;

VideoDepth depth_of(render::WarpKind kind, const PointSettings& point) {
  if (kind == render::WarpKind::kTimeWarp) return VideoDepth::kNone;
  return point.depth == "coded" ? VideoDepth::kCoded : VideoDepth::kFree;
}

render::MethodSettings method_settings(VideoDepth depth, const PointSettings& point) {
  render::MethodSettings s;
  s.fov_scale = point.fov_scale;
  s.video = {.display = point.display, .depth = depth};
  return s;
}

proto::StreamDescription describe(const render::Scene& scene, Extent2D picture, double frame_rate) {
  proto::StreamDescription d;
  d.scene = scene.name;
  d.picture = picture;
  d.atlas = picture;
  d.frame_rate = frame_rate;
  return d;
}

render::I420Planes planes_of(const codec::I420View& v) {
  return {.extent = v.extent, .y = v.y, .u = v.u, .v = v.v, .y_stride = v.y_stride, .uv_stride = v.uv_stride};
}

class WarpContender final : public Contender {
 public:
  WarpContender(render::WarpKind kind, const PointSettings& point, render::Device& device,
                const std::shared_ptr<const render::Scene>& scene)
      : depth_(depth_of(kind, point)),
        stream_(render::make_method("video", device, scene, method_settings(depth_, point)),
                video_settings(point)),
        description_(describe(*scene, stream_.picture_extent(), point.server_hz)),
        decoder_(description_.picture, 1, video_coding(point)),
        pairing_(kMaxWaiting, kMaxWaiting),
        warp_(
            render::make_view_warp(kind, device, render::display_color(scene->background, scene->exposure))) {
    if (const render::LensCorrection lens = display_lens(point); lens != render::LensCorrection{}) {
      lens_.emplace(device, lens, 1);
    }
  }

  server::FrameMaker& maker() override { return stream_; }
  [[nodiscard]] const proto::StreamDescription& description() const override { return description_; }

  void on_frame(const proto::AssembledFrame& frame) override {
    if (needs_idr_ && !frame.idr) return;
    Result<codec::DecodedPicture> picture = decoder_.decode(frame.access_unit);
    needs_idr_ = !picture.has_value();
    if (needs_idr_) {
      refresh_ = true;
      return;
    }
    pairing_.add_picture(frame.frame, std::move(*picture));
    keep_newest();
  }
  void on_update(const client::UpdateArrival& update) override {
    const auto header = read_view_header(update.update.meta.meta);
    if (!header || !pairing_.add_update(header->frame, *header)) {
      throw std::logic_error("a view header broke the order or its form");
    }
    keep_newest();
  }
  std::optional<FrameId> show_newest() override {
    if (!newest_) return std::nullopt;
    const ViewHeader& header = newest_->update;
    render::I420Planes planes = planes_of(newest_->picture->view());
    std::vector<float> depth = stream_.take_depth(header.frame);
    if (depth_ == VideoDepth::kCoded) {
      render::decode_depth_plane(planes, header.nearest, depth);
      planes = render::upper_half(planes);
    }
    warp_->show({.camera = header.camera, .colors = planes, .depth = depth});
    newest_.reset();
    return header.frame;
  }
  const render::Picture& draw(const render::Camera& eye) override {
    warp_->draw(eye);
    if (!lens_) return warp_->read_back();
    lens_->apply(*warp_->target(), render::Eye::kLeft);
    return lens_->read_back();
  }
  bool take_refresh() override { return std::exchange(refresh_, false); }

 private:
  using Pairs = client::Pairing<codec::DecodedPicture, ViewHeader>;
  static constexpr std::size_t kMaxWaiting = 128;

  void keep_newest() {
    while (auto step = pairing_.next_step()) {
      if (step->picture) newest_ = std::move(step);
    }
  }

  VideoDepth depth_;
  ViewStream stream_;
  proto::StreamDescription description_;
  codec::VideoDecoder decoder_;
  Pairs pairing_;
  std::unique_ptr<render::ViewWarp> warp_;
  std::optional<render::LensPass> lens_;  ///< nullopt: the display has none
  std::optional<Pairs::Step> newest_;
  bool needs_idr_ = false;
  bool refresh_ = false;
};

}  // namespace

std::unique_ptr<Contender> make_warp_contender(render::WarpKind kind, const PointSettings& settings,
                                               render::Device& device,
                                               std::shared_ptr<const render::Scene> scene) {
  return std::make_unique<WarpContender>(kind, settings, device, scene);
}

}  // namespace atlaswire::lab
