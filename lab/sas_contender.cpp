#include "lab/sas_contender.h"

#include "client/pair_maker.h"
#include "client/pair_renderer.h"
#include "lab/coding.h"
#include "server/atlas_stream.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace atlaswire::lab {
namespace {

/// So many poses of a frame's life are foreseen, where the future may be known.
constexpr std::uint32_t kForeseenViews = 4;

server::StreamSettings stream_settings(const PointSettings& point) {
  server::StreamSettings s;
  s.method = point.method;
  s.render.atlas = point.atlas;
  s.render.allocator.superblock_log2 = render::suited_superblock_log2(point.atlas);
  s.render.hold_frames = point.hold_frames;
  s.render.fov_scale = point.fov_scale;
  s.render.id_scale = point.id_scale;
  s.render.max_oversampling = point.max_oversampling;
  s.render.emphasis.foveation = point.foveation;
  s.render.strategy = render::find_strategy(point.strategy).value();
  s.render.max_views = point.foresight ? std::max(point.views, kForeseenViews) : point.views;
  s.render.prediction_step = from_seconds(point.prediction_step_ms * 1e-3);
  s.render.reshade_interval = point.reshade_interval;
  s.video = video_settings(point);
  s.max_fps = point.server_hz;
  s.grid_bits = point.grid_bits;
  s.render.most_new_patches = point.new_patches;
  s.meta_codec = codec::find_meta_codec(point.meta_codec).value();  // keys.cpp has checked it
  return s;
}

class SasContender final : public Contender {
 public:
  SasContender(const PointSettings& point, render::Device& device,
               const std::shared_ptr<const render::Scene>& scene)
      : settings_(stream_settings(point)),
        stream_(settings_, scene, render::make_method(settings_.method, device, scene, settings_.render)),
        description_(describe(*scene, stream_, settings_)),
        pairs_(description_, {.coding = video_coding(point), .clock = steady_now},
               {.decode_failed = [this] { refresh_ = true; },
                .peer_broke = [](const std::string& why) { throw std::logic_error("stream broke: " + why); },
                .out_of_step =
                    [](FrameId, const std::string& why) { throw std::logic_error("out of step: " + why); }}),
        renderer_(device, description_, display_camera(point), {.lens = display_lens(point)}) {}

  server::FrameMaker& maker() override { return stream_; }
  [[nodiscard]] const proto::StreamDescription& description() const override { return description_; }

  void on_frame(const proto::AssembledFrame& frame) override {
    pairs_.on_frame(frame);
    keep_newest();
  }
  void on_update(const client::UpdateArrival& update) override {
    pairs_.on_update(update);
    keep_newest();
  }
  std::optional<FrameId> show_newest() override {
    if (!newest_) return std::nullopt;
    renderer_.show(*newest_);
    const FrameId frame = newest_->times.frame;
    newest_.reset();
    return frame;
  }
  const render::Picture& draw(const render::Camera& eye) override {
    renderer_.draw(eye);
    return renderer_.read_back();
  }
  bool take_refresh() override { return std::exchange(refresh_, false); }

 private:
  void keep_newest() {
    while (auto pair = pairs_.next_pair()) newest_ = std::move(pair);
  }

  server::StreamSettings settings_;
  server::AtlasStream stream_;
  proto::StreamDescription description_;
  client::PairMaker pairs_;
  client::PairRenderer renderer_;
  std::optional<client::Pair> newest_;
  bool refresh_ = false;
};

}  // namespace

std::unique_ptr<Contender> make_sas_contender(const PointSettings& settings, render::Device& device,
                                              std::shared_ptr<const render::Scene> scene) {
  return std::make_unique<SasContender>(settings, device, scene);
}

}  // namespace atlaswire::lab
