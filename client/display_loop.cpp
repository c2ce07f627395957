#include "client/display_loop.h"

#include "client/display_clock.h"
#include "client/pair_renderer.h"
#include "client/picture_writer.h"

#include <fmt/format.h>

#include <thread>
#include <utility>

namespace atlaswire::client {
namespace {

constexpr Duration kFirstPairPoll = std::chrono::milliseconds(2);
constexpr Duration kProgressInterval = std::chrono::seconds(1);

class DisplayLoop {
 public:
  DisplayLoop(const DisplaySettings& settings, Tracker& tracker, HandOver<Pair>& pairs,
              PairRenderer& renderer, PictureWriter* writer, const DisplayHooks& hooks)
      : settings_(settings),
        tracker_(&tracker),
        pairs_(&pairs),
        renderer_(&renderer),
        writer_(writer),
        hooks_(&hooks),
        clock_(settings.rate),
        schedule_(settings.samples, settings.warm_up, settings.duration) {}

  DisplayOutcome run() {
    if (!wait_for_first_pair()) return std::move(outcome_);
    while (!hooks_->should_stop() && !is_over(steady_now())) {
      std::this_thread::sleep_until(
          std::chrono::steady_clock::time_point{clock_.next(steady_now()).time_since_epoch()});
      display_frame();
      report_progress(draw_.end);
    }
    outcome_.end = steady_now();
    return std::move(outcome_);
  }

 private:
  bool wait_for_first_pair() {
    const Time patience = steady_now() + settings_.first_pair_patience;
    while (!hooks_->should_stop() && steady_now() < patience) {
      if (auto pair = pairs_->take()) {
        const Time now = steady_now();
        pending_ = std::move(pair);
        outcome_.first = now;
        outcome_.measured_from = now + settings_.warm_up;
        next_progress_ = now + kProgressInterval;
        tracker_->start(now);
        return true;
      }
      std::this_thread::sleep_for(kFirstPairPoll);
    }
    return false;
  }

  [[nodiscard]] bool is_over(Time now) const {
    return settings_.duration != Duration{} && now - *outcome_.first >= settings_.duration;
  }

  void display_frame() {
    draw_.start = steady_now();
    if (!measuring_ && draw_.start >= outcome_.measured_from) {
      measuring_ = true;
      hooks_->on_measuring(draw_.start);
    }
    const bool is_first = switch_pair();
    posed_ = steady_now();
    render::Camera camera = settings_.camera;
    camera.pose = tracker_->at(posed_).value();
    renderer_->draw(camera);
    draw_.end = steady_now();
    if (is_first) {
      draw_.first_start = draw_.start;
      draw_.first_end = draw_.end;
    }
    outcome_.log.add({pair_.times, draw_});
    ++outcome_.displayed;
    recent_motion_.add(draw_.end - posed_);
    if (measuring_) {
      ++outcome_.displayed_measured;
      outcome_.paired_measured += is_first ? 1U : 0U;
      outcome_.motion_to_photon.add(draw_.end - posed_);
    }
    keep_pictures(camera);
  }

  /// Takes the newest pair if there is a new one.
  bool switch_pair() {
    if (auto newer = pairs_->take()) pending_ = std::move(newer);
    if (!pending_) return false;
    pair_ = std::move(*pending_);
    pending_.reset();
    renderer_->show(pair_);
    ++paired_;
    return true;
  }

  void keep_pictures(const render::Camera& head) {
    if (writer_ != nullptr && settings_.png_every != 0 && outcome_.displayed % settings_.png_every == 0) {
      writer_->write(settings_.png_folder / fmt::format("frame_{:06}.png", outcome_.displayed),
                     renderer_->read_back());
    }
    if (!schedule_.take(draw_.start - *outcome_.first)) return;
    Sample sample{.frame = pair_.times.frame,
                  .display_index = outcome_.displayed,
                  .camera = head,
                  .scene_time = scene_time_now(),
                  .view = {},
                  .atlas = pair_.picture};
    if (settings_.at_server_pose && pair_.server_pose) {
      sample.camera.pose = pair_.server_pose->pose;
      if (sample.scene_time) sample.scene_time = *pair_.times.scene_time + pair_.times.scene_ahead;
    }
    sample.camera = renderer_->measured_camera(sample.camera);
    sample.view = renderer_->draw_undistorted(sample.camera);
    outcome_.samples.push_back(std::move(sample));
  }

  /// Where the server's scene is by now, whatever the pair shows: what moved meanwhile is latency's cost.
  [[nodiscard]] std::optional<Duration> scene_time_now() const {
    const PairTimes& pair = pair_.times;
    return pair.scene_time ? std::optional(*pair.scene_time + (posed_ - pair.render_start)) : std::nullopt;
  }

  void report_progress(Time now) {
    if (now < next_progress_) return;
    const Duration span = now - (next_progress_ - kProgressInterval);
    const double rate = static_cast<double>(outcome_.displayed - displayed_before_) / to_seconds(span);
    displayed_before_ = outcome_.displayed;
    next_progress_ = now + kProgressInterval;
    hooks_->on_progress({.newest_frame = pair_.times.frame,
                         .paired = paired_,
                         .displayed = outcome_.displayed,
                         .display_rate = rate,
                         .motion_to_photon = from_seconds(recent_motion_.summary().p50 / 1000)});
    recent_motion_ = {};
  }

  const DisplaySettings& settings_;
  Tracker* tracker_;
  HandOver<Pair>* pairs_;
  PairRenderer* renderer_;
  PictureWriter* writer_;
  const DisplayHooks* hooks_;
  DisplayClock clock_;
  SampleSchedule schedule_;
  std::optional<Pair> pending_;  ///< taken, not shown yet
  Pair pair_;                    ///< on display
  Time posed_{};                 ///< when the pose on display was sampled
  DrawTimes draw_;
  bool measuring_ = false;
  std::uint64_t paired_ = 0;
  std::uint64_t displayed_before_ = 0;
  Time next_progress_{};
  Distribution recent_motion_;
  DisplayOutcome outcome_;
};

}  // namespace

DisplayOutcome run_display(const DisplaySettings& settings, Tracker& tracker, HandOver<Pair>& pairs,
                           PairRenderer& renderer, PictureWriter* writer, const DisplayHooks& hooks) {
  return DisplayLoop(settings, tracker, pairs, renderer, writer, hooks).run();
}

}  // namespace atlaswire::client
