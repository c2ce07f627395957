#include "lab/direct_carrier.h"

#include <utility>

namespace atlaswire::lab {

DirectCarrier::DirectCarrier(const PointSettings& settings, FrameSource& source, Contender& contender,
                             const HeadMotion& motion)
    : rate_(settings.server_hz),
      latency_(from_seconds(settings.latency_ms * 1e-3)),
      source_(&source),
      contender_(&contender),
      motion_(&motion) {}

Duration DirectCarrier::arrival_of(std::int64_t frame) const {
  return from_seconds(static_cast<double>(frame) / rate_);
}

void DirectCarrier::advance(Duration now) {
  // Half a microsecond: frames that fall on a display frame are on it, whatever rounding did.
  constexpr Duration kRounding{500};
  while (arrival_of(next_) <= now + kRounding) carry(next_++);
}

void DirectCarrier::carry(std::int64_t frame) {
  const Duration start = arrival_of(frame) - latency_;
  const FrameTiming timing{
      .posed = start, .made = start, .shown_from = arrival_of(frame), .shown_until = arrival_of(frame + 1)};
  server::EncodedFrame made = source_->make({}, motion_->at(start), timing, contender_->take_refresh());
  posed_.emplace(made.frame, start);
  client::UpdateArrival update;
  update.update.octets = made.meta.size() + made.motion.size();
  update.update.meta = {.frame = made.frame,
                        .cover = made.cover,
                        .meta = std::move(made.meta),
                        .scene_time = made.scene_time,
                        .scene_ahead = made.scene_ahead,
                        .motion = std::move(made.motion)};
  contender_->on_update(update);
  proto::AssembledFrame picture;
  picture.frame = made.frame;
  picture.idr = made.idr;
  picture.octets = made.video.size();
  picture.access_unit = std::move(made.video);
  contender_->on_frame(picture);
}

void DirectCarrier::add_figures(std::vector<Figure>& figures) const {
  for (const char* name : {"frames_lost", "packets_lost_percent"}) figures.push_back({name, 0.0});
  figures.push_back({"first_picture_ms", to_ms(latency_)});
}

}  // namespace atlaswire::lab
