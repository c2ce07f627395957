#include "server/stream_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace atlaswire::server {

namespace {

constexpr std::uint32_t kMaxInEncoder = 2;
constexpr std::uint32_t kMaxUntaken = 2;

Duration interval_of(double fps) { return from_seconds(1.0 / fps); }

}  // namespace

StreamRunner::StreamRunner(const Settings& settings, Callbacks callbacks)
    : settings_(settings),
      callbacks_(std::move(callbacks)),
      emphasis_(settings.emphasis),
      cover_(settings.cover, interval_of(settings.max_fps)),
      rate_(settings.bit_rate, settings.encoder_fps),
      renderer_([this](const std::stop_token& stop) { render_loop(stop); }),
      encoder_([this] { encode_loop(); }) {}

StreamRunner::~StreamRunner() {
  request_stop();
  encoder_.join();
  renderer_.join();
}

void StreamRunner::request_stop() { renderer_.request_stop(); }

void StreamRunner::set_view(const StampedPose& pose, Time received, Duration round_trip) {
  {
    const std::lock_guard lock(mutex_);
    view_ = View{pose, received};
    cover_.on_round_trip(round_trip);
  }
  changed_.notify_all();
}

void StreamRunner::request_refresh() {
  const std::lock_guard lock(mutex_);
  refresh_ = true;
}

void StreamRunner::request_restart() {
  const std::lock_guard lock(mutex_);
  restart_ = true;
}

void StreamRunner::request_layout() {
  const std::lock_guard lock(mutex_);
  layout_ = true;
}

void StreamRunner::set_emphasis(Emphasis emphasis) {
  const std::lock_guard lock(mutex_);
  emphasis_ = std::move(emphasis);
}

void StreamRunner::set_paused(bool paused) {
  {
    const std::lock_guard lock(mutex_);
    if (paused_ == paused) return;
    paused_ = paused;
  }
  changed_.notify_all();
}

void StreamRunner::frame_taken() {
  {
    const std::lock_guard lock(mutex_);
    --untaken_;
  }
  changed_.notify_all();
}

void StreamRunner::frame_left(Duration sending) {
  const std::lock_guard lock(mutex_);
  cover_.on_sending(sending);
}

void StreamRunner::fail(const std::string& reason) {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(failed_, true)) return;
  }
  callbacks_.on_failure(reason);
  changed_.notify_all();
}

bool StreamRunner::wait_for_turn(const std::stop_token& stop, Time earliest) {
  std::unique_lock lock(mutex_);
  const auto ready = [&] {
    return failed_ || (view_ && !paused_ && in_encoder_ < kMaxInEncoder && untaken_ < kMaxUntaken);
  };
  while (!stop.stop_requested()) {
    changed_.wait(lock, stop, ready);
    if (stop.stop_requested() || failed_) return false;
    if (steady_now() >= earliest) return true;
    // Poses keep arriving: sleep to the frame's time whatever they say, then look again.
    const auto until = std::chrono::steady_clock::time_point(earliest.time_since_epoch());
    changed_.wait_until(lock, stop, until, [&] { return failed_; });
  }
  return false;
}

ViewRequest StreamRunner::make_request() {
  const std::lock_guard lock(mutex_);
  ViewRequest request;
  request.camera = settings_.camera;
  request.camera.pose = view_->pose.pose;
  request.hints.eye_separation = settings_.eye_separation;
  request.pose = view_->pose.id;
  request.pose_received = view_->received;
  request.cover = cover_.cover();
  request.refresh = std::exchange(refresh_, false);
  request.restart = std::exchange(restart_, false);
  request.layout = std::exchange(layout_, false);
  request.meta_codec = settings_.meta_codec;
  request.bit_rate = rate_.take();
  request.emphasis = std::exchange(emphasis_, std::nullopt);
  return request;
}

/// Things move by the stream's own clock, from its first frame on.
void StreamRunner::time_scene(Time now, ViewRequest& request) {
  if (!settings_.shows_motion) return;
  if (!first_start_) first_start_ = now;
  request.scene_time = now - *first_start_;
  if (!settings_.foresee_motion) return;
  const std::lock_guard lock(mutex_);
  request.scene_ahead = cover_.display_delay(now - request.pose_received);
}

void StreamRunner::render_loop(const std::stop_token& stop) {
  std::optional<std::string> failure;
  try {
    maker_ = callbacks_.make();
    const Duration interval = interval_of(settings_.max_fps);
    Time earliest{};
    while (wait_for_turn(stop, earliest)) {
      ViewRequest request = make_request();
      const Time start = steady_now();
      time_scene(start, request);
      // Late by less than an interval: keep the rhythm; by more: start a new one.
      earliest = start - earliest < interval ? earliest + interval : start + interval;
      PreparedFrame prepared = maker_->render(request);
      prepared.stamps.render_start = start;
      prepared.stamps.render_end = steady_now();
      {
        const std::lock_guard lock(mutex_);
        ++in_encoder_;
        prepared_.push_back(std::move(prepared));
      }
      changed_.notify_all();
    }
  } catch (const std::exception& e) {
    failure = fmt::format("rendering failed: {}", e.what());
  }
  // What was rendered before is whole, and leaves before the stream's end is told.
  std::unique_lock lock(mutex_);
  rendering_over_ = true;
  changed_.notify_all();
  changed_.wait(lock, [&] { return in_encoder_ == 0; });
  const bool unharmed = maker_ && !failed_;
  lock.unlock();
  if (failure) return fail(*failure);
  if (unharmed && callbacks_.give_back) callbacks_.give_back(std::move(maker_));
}

void StreamRunner::encode_loop() {
  // Ends when rendering has ended and all that was rendered is encoded: streams demand every frame.
  for (;;) {
    PreparedFrame prepared;
    bool wanted = true;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return !prepared_.empty() || rendering_over_; });
      if (prepared_.empty()) return;
      prepared = std::move(prepared_.front());
      prepared_.pop_front();
      wanted = !failed_;
    }
    if (wanted) encode_one(std::move(prepared));
    {
      const std::lock_guard lock(mutex_);
      --in_encoder_;
    }
    changed_.notify_all();
  }
}

void StreamRunner::encode_one(PreparedFrame prepared) {
  try {
    if (prepared.layout && callbacks_.on_layout) callbacks_.on_layout(*prepared.layout);
    const Time start = steady_now();
    auto encoded = maker_->encode(std::move(prepared));
    if (!encoded) return fail(fmt::format("encoding failed: {}", encoded.error().message()));
    const Time end = steady_now();
    encoded->stamps.encode_end = end;
    encoded->report.encode = end - start;
    {
      const std::lock_guard lock(mutex_);
      ++untaken_;
      const auto& stamps = encoded->stamps;
      const Duration interval = last_start_ ? stamps.render_start - *last_start_ : Duration{0};
      if (last_start_) rate_.on_interval(interval);
      last_start_ = stamps.render_start;
      cover_.on_frame(end - stamps.pose_received, interval);
    }
    callbacks_.on_frame(std::make_shared<const EncodedFrame>(std::move(*encoded)));
  } catch (const std::exception& e) {
    fail(fmt::format("encoding failed: {}", e.what()));
  }
}

}  // namespace atlaswire::server
