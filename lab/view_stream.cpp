#include "lab/view_stream.h"

#include "lab/view_header.h"

#include <utility>

namespace atlaswire::lab {
namespace {

codec::VideoEncoderSettings with_extent(codec::VideoEncoderSettings settings, Extent2D extent) {
  settings.extent = extent;
  return settings;
}

}  // namespace

ViewStream::ViewStream(std::unique_ptr<render::Method> method, codec::VideoEncoderSettings video)
    : method_(std::move(method)),
      schedule_({.interval = video.intra_interval}),
      video_(with_extent(std::move(video), method_->picture_extent())) {}

server::PreparedFrame ViewStream::render(const server::ViewRequest& request) {
  if (request.refresh) schedule_.ask_for_loss();
  if (request.restart) schedule_.ask_at_once();
  server::PreparedFrame prepared;
  prepared.pose = request.pose;
  prepared.cover = request.cover;
  prepared.bit_rate = request.bit_rate;
  prepared.stamps.pose_received = request.pose_received;
  prepared.intra = schedule_.next();
  prepared.rendered = method_->render({.frame = next_frame_,
                                       .camera = request.camera,
                                       .cover = request.cover,
                                       .intra = prepared.intra,
                                       .scene_seconds = server::scene_seconds(request),
                                       .hints = request.hints});
  if (const std::span<const float> depth = prepared.rendered.view->depth; !depth.empty()) {
    depths_.insert_or_assign(next_frame_, std::vector<float>(depth.begin(), depth.end()));
  }
  next_frame_ = next(next_frame_);
  return prepared;
}

Result<server::EncodedFrame> ViewStream::encode(server::PreparedFrame prepared) {
  if (prepared.bit_rate) video_.set_bit_rate(*prepared.bit_rate);
  const render::I420Picture& p = prepared.rendered.picture;
  auto picture = video_.encode({p.extent, p.y, p.u, p.v, p.extent.width, p.extent.width / 2}, prepared.intra);
  if (!picture) return picture.error();
  server::EncodedFrame frame;
  frame.frame = prepared.rendered.frame;
  frame.pose = prepared.pose;
  frame.cover = prepared.cover;
  frame.idr = picture->idr;
  frame.video = std::move(picture->bytes);
  const render::RenderedView& view = *prepared.rendered.view;
  frame.meta = write_view_header({.frame = frame.frame, .camera = view.camera, .nearest = view.nearest});
  frame.stamps = prepared.stamps;
  frame.report.render = prepared.rendered.timings;
  frame.report.shaded_texels = prepared.rendered.shaded_texels;
  return frame;
}

std::vector<float> ViewStream::take_depth(FrameId frame) {
  const auto found = depths_.find(frame);
  if (found == depths_.end()) return {};
  std::vector<float> depth = std::move(found->second);
  depths_.erase(depths_.begin(), std::next(found));
  return depth;
}

}  // namespace atlaswire::lab
