#include "lab/point_run.h"

#include "base/program.h"
#include "lab/contender.h"
#include "lab/direct_carrier.h"
#include "lab/frame_source.h"
#include "lab/head_motion.h"
#include "lab/meter.h"
#include "lab/session_carrier.h"
#include "lab/truth.h"
#include "lab/work.h"
#include "render/gpu/device.h"
#include "render/scene/load.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace atlaswire::lab {
namespace {

std::shared_ptr<const render::Scene> load_scene(const std::string& name) {
  Result<render::Scene> scene = render::load_scene(name);
  if (!scene) throw ProgramError(ExitCode::kUsage, scene.error().message());
  return std::make_shared<const render::Scene>(std::move(*scene));
}

render::CameraPath load_path(const std::string& name) {
  Result<render::CameraPath> path = render::CameraPath::load(name);
  if (!path) throw ProgramError(ExitCode::kUsage, path.error().message());
  return std::move(*path);
}

class PointRun {
 public:
  PointRun(const PointSettings& settings, const PointOutputs& outputs)
      : settings_(settings),
        outputs_(outputs),
        device_(render::open_device({})),
        scene_(load_scene(settings.scene)),
        motion_(load_path(settings.path), from_seconds(1 / settings.client_hz)),
        camera_(display_camera(settings)),
        contender_(make_contender(settings, *device_, scene_)),
        source_(settings, *contender_, motion_),
        carrier_(make_carrier()),
        truth_(*device_, scene_, settings.scene, outputs.truth_cache, display_lens(settings)),
        meter_(settings.measure_flip, outputs.pictures) {}

  PointResult run() {
    const auto displayed =
        static_cast<std::int64_t>(std::floor(settings_.seconds * settings_.client_hz + 1e-9));
    Displayed before;
    for (std::int64_t i = 0; i < displayed; ++i) {
      if (outputs_.should_stop && outputs_.should_stop()) throw Interrupted{};
      const Duration now = from_seconds(static_cast<double>(i) / settings_.client_hz);
      advance(now);
      const bool is_measured = i > 0 && i % settings_.measure_every == 0;
      const bool is_before_one = (i + 1) % settings_.measure_every == 0;
      if (!is_measured && !is_before_one) continue;
      Displayed shown = display(now);
      if (is_measured && on_display_) {
        meter_.add(to_seconds(now), to_ms(now - carrier_->posed(*on_display_)), before, shown);
      }
      before = std::move(shown);
      if (outputs_.progress) outputs_.progress(static_cast<double>(i + 1) / static_cast<double>(displayed));
    }
    meter_.write_pictures();
    return result();
  }

 private:
  std::unique_ptr<Carrier> make_carrier() {
    if (settings_.profile.empty()) {
      return std::make_unique<DirectCarrier>(settings_, source_, *contender_, motion_);
    }
    return std::make_unique<SessionCarrier>(settings_, source_, *contender_, motion_);
  }

  void advance(Duration now) {
    const Work start = work_now();
    const Work made = source_.work();
    carrier_->advance(now);
    if (const auto frame = contender_->show_newest()) {
      on_display_ = frame;
      shown_since_ = now;
    }
    receiving_ += (work_now() - start) - (source_.work() - made);
    longest_still_ = std::max(longest_still_, now - shown_since_);
  }

  Displayed display(Duration now) {
    render::Camera eye = camera_;
    eye.pose = motion_.at(now);
    if (settings_.stereo) eye.pose = render::eye_pose(eye.pose, -settings_.ipd / 2);
    Displayed shown{.truth = truth_.picture(eye, now), .view = render::Picture(eye.extent, {0, 0, 0, 0})};
    if (on_display_) {
      const Work start = work_now();
      shown.view = contender_->draw(eye);
      drawing_ += work_now() - start;
      ++draws_;
    }
    return shown;
  }

  PointResult result() const {
    PointResult result;
    meter_.add_figures(settings_.client_hz, result.figures);
    source_.add_figures(from_seconds(settings_.seconds) - carrier_->first_frame(), result.figures);
    carrier_->add_figures(result.figures);
    result.figures.push_back({"longest_still_ms", to_ms(longest_still_)});
    source_.add_timings(result.timings);
    const auto per = [](Duration sum, std::uint64_t count) {
      return count == 0 ? kNotApplicable : to_ms(sum) / static_cast<double>(count);
    };
    result.timings.push_back({"client_receive_ms", per(receiving_.wall, source_.frames())});
    result.timings.push_back({"client_receive_cpu_ms", per(receiving_.cpu, source_.frames())});
    result.timings.push_back({"client_draw_ms", per(drawing_.wall, draws_)});
    result.timings.push_back({"client_draw_cpu_ms", per(drawing_.cpu, draws_)});
    result.frames = meter_.rows();
    return result;
  }

  PointSettings settings_;
  PointOutputs outputs_;
  std::shared_ptr<render::Device> device_;
  std::shared_ptr<const render::Scene> scene_;
  HeadMotion motion_;
  render::Camera camera_;
  std::unique_ptr<Contender> contender_;
  FrameSource source_;
  std::unique_ptr<Carrier> carrier_;
  Truth truth_;
  Meter meter_;
  std::optional<FrameId> on_display_;
  Duration shown_since_{};    ///< of what is on display
  Duration longest_still_{};  ///< without a newer frame
  Work receiving_;            ///< decoding and showing, and the network's model with a profile
  Work drawing_;
  std::uint64_t draws_ = 0;
};

}  // namespace

PointResult run_point(const PointSettings& settings, const PointOutputs& outputs) {
  return PointRun(settings, outputs).run();
}

}  // namespace atlaswire::lab
