#include "lab/point_run.h"

#include "base/program.h"
#include "lab/contender.h"
#include "lab/truth.h"
#include "render/scene/camera_path.h"
#include "render/scene/load.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace atlaswire::lab {
namespace {

namespace fs = std::filesystem;

/// A folder that goes with its test.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(fs::temp_directory_path() / (name + "." + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

PointSettings small(const std::string& method) {
  PointSettings s;
  s.scene = "atrium:0.05";
  s.path = "atrium";
  s.seconds = 0.4;
  s.display = {160, 96};
  s.method = method;
  s.atlas = {512, 512};
  s.server_hz = 10;
  s.client_hz = 20;
  s.measure_every = 2;
  s.views = 4;
  return s;
}

double figure(const PointResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.figures, name, &Figure::name);
  EXPECT_NE(found, result.figures.end()) << name;
  return found == result.figures.end() ? kNotApplicable : found->value;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void expect_same(const PointResult& a, const PointResult& b) {
  ASSERT_EQ(a.figures.size(), b.figures.size());
  for (std::size_t i = 0; i < a.figures.size(); ++i) {
    EXPECT_EQ(a.figures[i].name, b.figures[i].name);
    EXPECT_TRUE(same(a.figures[i].value, b.figures[i].value)) << a.figures[i].name;
  }
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) EXPECT_TRUE(same(a.frames[i].mssim, b.frames[i].mssim));
}

TEST(PointRun, EveryMethodGivesTheSameFiguresInTheSameOrderTwice) {
  std::vector<std::string> names;
  for (const char* method : {"sas", "atw", "mesh", "iterative"}) {
    PointSettings s = small(method);
    s.bitrate_mbps = 4;
    s.latency_ms = 100;
    s.depth = "coded";
    const PointResult first = run_point(s, {});
    expect_same(first, run_point(s, {}));
    std::vector<std::string> own;
    for (const Figure& f : first.figures) own.push_back(f.name);
    if (names.empty()) names = own;
    EXPECT_EQ(own, names) << method;
    EXPECT_EQ(first.frames.size(), 3U);
    EXPECT_GT(figure(first, "mssim"), 0.3) << method;
    EXPECT_DOUBLE_EQ(figure(first, "pose_age_ms"), 100 + 0.0) << method;
    EXPECT_LT(figure(first, "total_mbps"), 8) << method;
    for (const Figure& t : first.timings) EXPECT_GE(t.value, 0) << t.name;
    EXPECT_GT(std::ranges::find(first.timings, "server_cpu_ms", &Figure::name)->value, 0);
  }
}

TEST(PointRun, AMovingSceneIsShownWhereItIsAndLatencyCosts) {
  PointSettings s = small("sas");
  s.scene = "parade";
  s.path = "parade-still";
  s.server_hz = s.client_hz;
  const PointResult live = run_point(s, {});
  PointSettings resting = small("sas");
  resting.server_hz = resting.client_hz;
  resting.path = "atrium-still";
  EXPECT_GT(figure(live, "mssim"), 0.98);
  EXPECT_GT(figure(live, "mssim"), figure(run_point(resting, {}), "mssim") - 0.01)
      << "as good as a scene that rests";
  EXPECT_GT(figure(live, "motion_mbps"), 0.01);
  s.latency_ms = 200;
  EXPECT_LT(figure(run_point(s, {}), "mssim"), figure(live, "mssim") - 0.01)
      << "nobody but what is there moves";
  s.foresee_motion = true;
  EXPECT_GT(figure(run_point(s, {}), "mssim"), figure(live, "mssim") - 0.005) << "clips can be foreseen";
  s.profile = "wifi6";
  s.bitrate_mbps = 8;
  EXPECT_GT(figure(run_point(s, {}), "motion_mbps"), 0.01) << "real sessions over a network";
}

TEST(PointRun, WarpsShowMovingScenesToo) {
  PointSettings s = small("atw");
  s.scene = "parade";
  s.path = "parade-still";
  s.server_hz = s.client_hz;
  EXPECT_GT(figure(run_point(s, {}), "mssim"), 0.995);
}

TEST(PointRun, WithoutLatencyAndCodingAWarpIsTheTruthButForItsChroma) {
  for (const char* method : {"atw", "mesh", "iterative"}) {
    PointSettings s = small(method);
    s.server_hz = s.client_hz;
    const PointResult result = run_point(s, {});
    EXPECT_GT(figure(result, "mssim"), 0.995) << method;
    EXPECT_EQ(figure(result, "holes"), 0) << method;
    EXPECT_TRUE(std::isnan(figure(result, "video_mbps"))) << "bare planes are no bit rate";
  }
}

TEST(PointRun, ALensBendsTheTruthAndEveryMethodAlike) {
  for (const char* method : {"sas", "atw", "mesh", "iterative"}) {
    PointSettings s = small(method);
    s.server_hz = s.client_hz;
    const double straight = figure(run_point(s, {}), "mssim");
    s.lens = "0.1,0,0.2,0,0.3,0";
    EXPECT_GT(figure(run_point(s, {}), "mssim"), straight - 0.005) << method;
  }
}

TEST(PointRun, ALensLeavesTheTruthsCornersBlack) {
  const Folder folder("atlaswire_lens_truth");
  const auto device = render::open_device({});
  const auto scene = std::make_shared<const render::Scene>(render::load_scene("atrium:0.05").value());
  PointSettings s = small("sas");
  render::Camera camera = display_camera(s);
  camera.pose = render::CameraPath::load("atrium").value().at(Duration{});
  const TruePicture straight = Truth(*device, scene, s.scene, folder.path()).picture(camera, {});
  s.lens = "generic";
  const TruePicture bent = Truth(*device, scene, s.scene, folder.path(), display_lens(s)).picture(camera, {});
  EXPECT_NE(straight.picture.at(0, 0)[3], 0);
  EXPECT_EQ(bent.picture.at(0, 0)[3], 0);
  EXPECT_EQ(bent.deferred_fragments, straight.deferred_fragments) << "shaded before the lens";
  const TruePicture kept = Truth(*device, scene, s.scene, folder.path(), display_lens(s)).picture(camera, {});
  EXPECT_EQ(kept.picture, bent.picture);
  EXPECT_EQ(kept.deferred_fragments, bent.deferred_fragments);
}

TEST(PointRun, LatencyIsHowOldAPictureIsWhateverTheRates) {
  for (const double latency_ms : {0.0, 20.0, 130.0}) {
    PointSettings s = small("atw");
    s.server_hz = s.client_hz;
    s.latency_ms = latency_ms;
    const PointResult result = run_point(s, {});
    EXPECT_NEAR(figure(result, "pose_age_ms"), latency_ms, 1e-6);
    EXPECT_EQ(figure(result, "server_frames"), s.seconds * s.client_hz);
  }
}

TEST(PointRun, KnowingTheFutureClosesHoles) {
  PointSettings s = small("sas");
  s.latency_ms = 400;
  s.views = 1;
  const double blind = figure(run_point(s, {}), "holes");
  s.foresight = true;
  const double sighted = figure(run_point(s, {}), "holes");
  EXPECT_GT(blind, 0.001);
  EXPECT_LT(sighted, blind / 2);
}

TEST(PointRun, StereoCarriesTwoPicturesOfAWarpAndOneAtlas) {
  PointSettings s = small("atw");
  s.qp = 24;
  const double one = figure(run_point(s, {}), "video_mbps");
  s.stereo = true;
  const double two = figure(run_point(s, {}), "video_mbps");
  EXPECT_NEAR(two / one, 2, 0.3);
  s.method = "sas";
  const double atlas_of_two = figure(run_point(s, {}), "video_mbps");
  s.stereo = false;
  EXPECT_NEAR(atlas_of_two / figure(run_point(s, {}), "video_mbps"), 1, 0.2);
}

TEST(PointRun, RealSessionsOverAProfileRepeatByTheirSeed) {
  PointSettings s = small("sas");
  s.bitrate_mbps = 4;
  s.profile = "lossy-wifi";
  s.seed = 7;
  const PointResult first = run_point(s, {});
  expect_same(first, run_point(s, {}));
  EXPECT_GT(figure(first, "mssim"), 0.3);
  EXPECT_GT(figure(first, "pose_age_ms"), 1);
  s.seed = 8;
  EXPECT_NE(figure(first, "packets_lost_percent"), figure(run_point(s, {}), "packets_lost_percent"));
}

TEST(PointRun, KeepsTheTruthAndLeavesPictures) {
  const Folder folder("atlaswire_point_run");
  PointOutputs outputs;
  outputs.pictures = folder.path();
  outputs.truth_cache = folder.path() / "truth";
  double progress = 0;
  outputs.progress = [&](double share) {
    EXPECT_GE(share, progress);
    progress = share;
  };
  const PointSettings s = small("atw");
  const PointResult first = run_point(s, outputs);
  EXPECT_EQ(progress, 1);
  EXPECT_TRUE(fs::exists(folder.path() / "worst.png"));
  EXPECT_TRUE(fs::exists(folder.path() / "last.png"));
  const auto kept = std::distance(fs::directory_iterator(outputs.truth_cache), fs::directory_iterator{});
  EXPECT_EQ(kept, 7);  // frames 1 to 7: three measured, each with the one before, and the last before the end
  progress = 0;
  expect_same(first, run_point(s, outputs));
}

TEST(PointRun, RefusesWhatCannotBe) {
  PointSettings s = small("sas");
  s.profile = "wifi6";
  EXPECT_THROW(run_point(s, {}), ProgramError) << "bare planes in packets";
  s = small("holograms");
  EXPECT_THROW(run_point(s, {}), ProgramError);
  s = small("sas");
  s.scene = "no_such_scene.glb";
  EXPECT_THROW(run_point(s, {}), ProgramError);
  PointOutputs stop;
  stop.should_stop = [] { return true; };
  EXPECT_THROW(run_point(small("atw"), stop), Interrupted);
}

}  // namespace
}  // namespace atlaswire::lab
