#include "server/atlas_stream.h"

#include "proto/framing.h"
#include "proto/plain_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace atlaswire::server {

namespace {

codec::VideoEncoderSettings video_settings(const StreamSettings& settings, const Extent2D& picture) {
  codec::VideoEncoderSettings video = settings.video;
  video.extent = picture;
  video.frame_rate = settings.max_fps;
  return video;
}

codec::I420View view_of(const render::I420Picture& picture) {
  return {picture.extent, picture.y, picture.u, picture.v, picture.extent.width, picture.extent.width / 2};
}

/// The method may have no memory that a receiver can mirror.
codec::MetaCodecKind suited(codec::MetaCodecKind wanted, const render::Method& method) {
  return leaves_positions(wanted) && !method.memory() ? codec::MetaCodecKind::kGate : wanted;
}

}  // namespace

AtlasStream::AtlasStream(const StreamSettings& settings, std::shared_ptr<const render::Scene> scene,
                         std::unique_ptr<render::Method> method)
    : method_(std::move(method)),
      preferred_meta_codec_(suited(settings.meta_codec, *method_)),
      tracker_(std::move(scene), settings.grid_bits),
      schedule_({.interval = settings.video.intra_interval}),
      layout_colours_(settings.layout_colours),
      video_(video_settings(settings, method_->picture_extent())),
      limits_(tracker_.limits(settings.render.atlas)),
      meta_codec_(preferred_meta_codec_),
      meta_(codec::make_meta_encoder(meta_codec_, limits_)) {
  if (tracker_.scene()->motion) motion_.emplace(tracker_.scene(), tracker_.grid());
  const render::AllocatorSettings& allocator = settings.render.allocator;
  if (layout_colours_) layout_.emplace(settings.render.atlas, allocator.superblock_log2);
}

PreparedFrame AtlasStream::render(const ViewRequest& request) {
  if (request.refresh) schedule_.ask_for_loss();
  if (request.restart) schedule_.ask_at_once();
  if (method_->wants_intra()) schedule_.ask_for_memory();
  if (request.emphasis) method_->set_emphasis(*request.emphasis);
  PreparedFrame prepared;
  prepared.pose = request.pose;
  prepared.cover = request.cover;
  prepared.bit_rate = request.bit_rate;
  prepared.stamps.pose_received = request.pose_received;
  prepared.intra = schedule_.next();
  const bool first = !std::exchange(told_, true);
  const bool restart = request.restart || first;
  if (restart) told_as_ = request.meta_codec.value_or(preferred_meta_codec_);
  prepared.rendered = method_->render({.frame = next_frame_,
                                       .camera = request.camera,
                                       .cover = request.cover,
                                       .intra = prepared.intra,
                                       .restart = restart,
                                       .scene_seconds = scene_seconds(request),
                                       .hints = request.hints});
  prepared.scene_time = request.scene_time;
  prepared.scene_ahead = request.scene_ahead;
  if (motion_ && request.scene_time && prepared.rendered.moved != nullptr)
    prepared.moved = motion_->look(*prepared.rendered.moved);
  if (layout_) {
    layout_->observe(*prepared.rendered.change);
    if (request.layout) prepared.layout = layout_->picture(*layout_colours_);
  }
  prepared.update = update_for(prepared.rendered, restart);
  if (restart) prepared.meta_codec = told_as_;
  prepared.rendered.change = nullptr;
  prepared.rendered.requests = {};
  prepared.rendered.moved = nullptr;
  next_frame_ = next(next_frame_);
  return prepared;
}

codec::MetaUpdate AtlasStream::update_for(const render::RenderedFrame& rendered, bool restart) {
  std::vector<render::PlacedPatch> live;
  if (restart || rendered.change->reset) live = method_->blocks();
  if (leaves_positions(told_as_)) {
    const ReplicaTracker::Asked asked{rendered.requests, rendered.change, live};
    return restart ? tracker_.restart(rendered.frame, asked) : tracker_.update(rendered.frame, asked);
  }
  return restart ? tracker_.restart(rendered.frame, live) : tracker_.update(rendered.frame, *rendered.change);
}

namespace {

/// More octets than the plain form of an update can take.
std::size_t most_bytes(const codec::MetaUpdate& update) {
  return 64 + update.removed.size() * 5 + update.vertices.size() * 20 + update.added.size() * 48 +
         update.moved.size() * 20;
}

Error too_large() {
  return Error{codec::MetaError::kTooLarge,
               "the visible set's meta update; a smaller --atlas or a simpler scene shrinks it"};
}

}  // namespace

Result<EncodedFrame> AtlasStream::encode(PreparedFrame prepared) {
  if (most_bytes(prepared.update) > codec::kMaxMetaBody) return too_large();
  if (prepared.bit_rate) video_.set_bit_rate(*prepared.bit_rate);
  auto picture = video_.encode(view_of(prepared.rendered.picture), prepared.intra);
  if (!picture) return picture.error();
  EncodedFrame frame;
  frame.frame = prepared.rendered.frame;
  frame.pose = prepared.pose;
  frame.cover = prepared.cover;
  frame.idr = picture->idr;
  frame.video = std::move(picture->bytes);
  if (prepared.meta_codec && *prepared.meta_codec != meta_codec_) {
    meta_codec_ = *prepared.meta_codec;
    meta_ = codec::make_meta_encoder(meta_codec_, limits_);
  }
  frame.meta.reserve(last_meta_bytes_ + last_meta_bytes_ / 4);
  meta_->encode(prepared.update, frame.meta);
  last_meta_bytes_ = frame.meta.size();
  if (prepared.moved) {
    frame.scene_time = *prepared.scene_time;
    frame.scene_ahead = prepared.scene_ahead;
    if (auto told = motion_->tell(prepared.update, *prepared.moved, frame.motion); !told) return told.error();
  }
  constexpr std::size_t kRest = 1024;  // of the envelope
  if (frame.meta.size() + frame.motion.size() > proto::kMaxEnvelope - kRest) return too_large();
  frame.stamps = prepared.stamps;
  FrameReport& report = frame.report;
  report.render = prepared.rendered.timings;
  report.usage = prepared.rendered.usage;
  report.layout = prepared.rendered.layout;
  report.visible_patches = prepared.rendered.visible_patches;
  report.waiting_patches = prepared.rendered.waiting_patches;
  report.added_patches = static_cast<std::uint32_t>(prepared.update.added.size());
  report.removed_patches = static_cast<std::uint32_t>(prepared.update.removed.size());
  report.new_vertices = static_cast<std::uint32_t>(prepared.update.vertices.size());
  for (const codec::AddedPatch& patch : prepared.update.added) report.added_triangles += patch.triangles;
  report.shaded_texels = prepared.rendered.shaded_texels;
  report.bias = prepared.rendered.bias;
  return frame;
}

proto::StreamDescription describe(const render::Scene& scene, const AtlasStream& stream,
                                  const StreamSettings& settings) {
  proto::StreamDescription d;
  d.scene = proto::to_plain_text(scene.name, 256);
  d.picture = stream.picture_extent();
  d.atlas = settings.render.atlas;
  d.has_coverage = scene.requirements.alpha();
  d.grid = stream.grid();
  d.meta_codec = static_cast<std::uint32_t>(stream.preferred_meta_codec());
  if (const auto memory = stream.memory()) {
    d.memory = {memory->superblock_log2, memory->min_block_log2, memory->high_water};
  }
  d.max_vertices = std::max(1U, static_cast<std::uint32_t>(scene.positions.size()));
  d.max_patches = std::max(1U, static_cast<std::uint32_t>(scene.patches.size()));
  d.frame_rate = settings.max_fps;
  d.near_plane = render::Camera{}.near_plane;
  const glm::vec3 background = glm::clamp(scene.background * scene.exposure, 0.0F, 65504.0F);
  d.background = {background.r, background.g, background.b};
  d.alpha_mask = scene.requirements.alpha_mask;
  d.alpha_blend = scene.requirements.alpha_blend;
  d.double_sided = scene.requirements.double_sided;
  d.motion = stream.motion();
  return d;
}

}  // namespace atlaswire::server
