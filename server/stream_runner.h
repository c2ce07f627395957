#pragma once

#include "base/time.h"
#include "base/units.h"
#include "render/camera.h"
#include "server/cover_estimator.h"
#include "server/encoded_frame.h"
#include "server/rate_fitter.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace atlaswire::server {

/// Gives a stream's frames a pace and two threads: one renders frame n + 1 while the other encodes n.
/// At most two frames are between them, and at most two encoded ones untaken, so that a slow reader slows
/// rendering instead of filling memory. All methods but the destructor return at once.
class StreamRunner {
 public:
  struct Settings {
    double max_fps = 15;
    bool shows_motion = false;    ///< the client does; its scene moves from the first frame on
    bool foresee_motion = false;  ///< StreamSettings::foresee_motion
    CoverSettings cover;
    render::Camera camera;            ///< its pose is replaced by the client's
    double eye_separation = 0;        ///< metres; above 0 the client's two eyes are beside the pose
    std::optional<BitRate> bit_rate;  ///< to hold at whatever frame rate comes about; nullopt: the stream's
    double encoder_fps = 15;          ///< the frame rate that the encoder was told
    std::optional<codec::MetaCodecKind> meta_codec;  ///< nullopt: the stream's
    Emphasis emphasis;  ///< told with the first frame, since a warm stream may have another client's
  };
  struct Callbacks {
    /// Makes the stream, or hands out a warm one; called on the rendering thread. May throw.
    std::function<std::unique_ptr<FrameMaker>()> make;
    /// A frame is ready; encoding thread. Answer with frame_taken() once it is dealt with.
    std::function<void(FramePtr)> on_frame;
    /// The stream failed and makes no more frames; a runner's thread, once at most.
    std::function<void(std::string)> on_failure;
    /// The picture that request_layout() asked for; encoding thread.
    std::function<void(const render::Picture&)> on_layout;
    /// Gets the stream back when the runner ends unharmed; rendering thread, after the last frame.
    std::function<void(std::unique_ptr<FrameMaker>)> give_back;
  };

  StreamRunner(const Settings& settings, Callbacks callbacks);
  /// Stops and joins: waits for the frames in work.
  ~StreamRunner();
  StreamRunner(const StreamRunner&) = delete;
  StreamRunner& operator=(const StreamRunner&) = delete;

  /// The newest pose; without one nothing is rendered.
  void set_view(const StampedPose& pose, Time received, Duration round_trip);
  void request_refresh();
  /// The client knows nothing any more, or something wrong: the next frame tells all.
  void request_restart();
  /// The next frame's layout goes to on_layout, if the stream follows it.
  void request_layout();
  /// From the next frame on.
  void set_emphasis(Emphasis emphasis);
  /// Frames stop being started while paused.
  void set_paused(bool paused);
  void frame_taken();
  /// How long a frame waited for the network after encoding.
  void frame_left(Duration sending);
  /// Asks both threads to end after the frames in work; the destructor waits for it.
  void request_stop();

 private:
  struct View {
    StampedPose pose;
    Time received{};
  };

  void render_loop(const std::stop_token& stop);
  void encode_loop();
  bool wait_for_turn(const std::stop_token& stop, Time earliest);
  ViewRequest make_request();
  void time_scene(Time now, ViewRequest& request);
  void encode_one(PreparedFrame prepared);
  void fail(const std::string& reason);

  Settings settings_;
  Callbacks callbacks_;
  std::unique_ptr<FrameMaker> maker_;  ///< set by the rendering thread before the first hand-over

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<View> view_;
  bool paused_ = false;
  bool refresh_ = false;
  bool restart_ = true;
  bool layout_ = false;
  std::optional<Emphasis> emphasis_;  ///< not yet told to the stream
  bool failed_ = false;
  bool rendering_over_ = false;
  std::uint32_t in_encoder_ = 0;  ///< rendered and not yet encoded
  std::uint32_t untaken_ = 0;     ///< encoded and not yet taken
  std::deque<PreparedFrame> prepared_;
  CoverEstimator cover_;
  RateFitter rate_;
  std::optional<Time> last_start_;
  std::optional<Time> first_start_;  ///< rendering thread

  // The renderer first: should the second thread not start, the first one ends on its stop token.
  std::jthread renderer_;
  std::jthread encoder_;
};

}  // namespace atlaswire::server
