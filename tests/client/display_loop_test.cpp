#include "client/display_loop.h"

#include "client/decode_thread.h"
#include "client/pair_renderer.h"
#include "render/image/metrics.h"
#include "render/passes/tonemap.h"
#include "tests/client/synthetic_pair.h"
#include "tests/render/gpu/gpu_fixture.h"

#include <gtest/gtest.h>

namespace atlaswire::client {
namespace {

using std::chrono::milliseconds;
using testing::square_stream;
using testing::SquareServer;

class DisplayLoopTest : public render::test::GpuTest {
 protected:
  /// A pair of the square in one grey, as the decode thread makes it.
  Pair pair_of(std::uint8_t luma) {
    SquareServer server;
    ArrivalQueue arrivals(kArrivalPlaces);
    arrivals.try_push(server.update(0, true));
    arrivals.try_push(server.picture(0, luma, true));
    arrivals.close();
    HandOver<Pair> made;
    DecodeThread decoder(
        square_stream(), {}, arrivals, made,
        {.decode_failed = [] {}, .peer_broke = [](auto) {}, .out_of_step = [](auto, auto) {}});
    decoder.finish();
    return made.take().value();
  }

  static DisplaySettings settings() {
    DisplaySettings s{.rate = 0, .duration = milliseconds(300), .warm_up = milliseconds(100)};
    s.camera.extent = {64, 64};
    s.camera.vertical_fov = 2.0;
    return s;
  }
};

TEST_F(DisplayLoopTest, RendererShowsThePairWhereItLies) {
  PairRenderer renderer(device(), square_stream(), settings().camera);
  renderer.show(pair_of(180));
  render::Camera camera = settings().camera;
  renderer.draw(camera);
  const render::Picture& picture = renderer.read_back();
  EXPECT_NEAR(picture.at(32, 32)[0], 180, 4);
  EXPECT_EQ(picture.at(32, 32)[3], 255);
  EXPECT_EQ(picture.at(1, 1)[3], 0) << "nothing is drawn in the corner";
  camera.pose.position = {100, 0, 0};
  renderer.draw(camera);
  EXPECT_EQ(renderer.read_back().at(32, 32)[3], 0);
}

TEST_F(DisplayLoopTest, BackgroundIsToneMappedAsTheGroundTruths) {
  proto::StreamDescription stream = square_stream();
  stream.background = {0.35F, 0.55F, 0.85F};
  PairRenderer renderer(device(), stream, settings().camera);
  renderer.show(pair_of(180));
  renderer.draw(settings().camera);
  const glm::vec3 sky = render::display_color({0.35F, 0.55F, 0.85F}, 1);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(renderer.read_back().at(1, 1)[static_cast<std::size_t>(c)], sky[c] * 255, 1.5);
}

TEST_F(DisplayLoopTest, RendererWarmsUpForEveryClassOfPatch) {
  proto::StreamDescription stream = square_stream();
  stream.picture = {64, 128};
  stream.has_coverage = stream.alpha_mask = stream.alpha_blend = stream.double_sided = true;
  PairRenderer renderer(device(), stream, settings().camera);
  EXPECT_EQ(renderer.read_back().at(32, 32)[3], 255);
}

TEST_F(DisplayLoopTest, ShowsBothEyesSideBySide) {
  const render::Camera head = settings().camera;
  PairRenderer mono(device(), square_stream(), head);
  PairRenderer stereo(device(), square_stream(), head, {.ipd = 0.4});
  mono.show(pair_of(180));
  stereo.show(pair_of(180));
  stereo.draw(head);
  const render::Picture both = stereo.read_back();
  ASSERT_EQ(both.extent, (Extent2D{128, 64}));
  for (const std::uint32_t eye : {0U, 1U}) {
    render::Camera camera = head;
    camera.pose.position.x = eye == 0 ? -0.2 : 0.2;
    mono.draw(camera);
    const render::Picture& one = mono.read_back();
    for (std::uint32_t y = 0; y < 64; ++y) {
      for (std::uint32_t x = 0; x < 64; ++x) ASSERT_EQ(both.at(64 * eye + x, y), one.at(x, y));
    }
  }
}

TEST_F(DisplayLoopTest, MeasuresTheLeftEyeThroughNoLens) {
  const Headset headset{.ipd = 0.4, .lens = render::parse_lens("0.5,0.5").value()};
  const render::Camera head = settings().camera;
  PairRenderer renderer(device(), square_stream(), head, headset);
  renderer.show(pair_of(180));
  renderer.draw(head);
  const render::Picture displayed = renderer.read_back();
  const render::Camera eye = renderer.measured_camera(head);
  EXPECT_NEAR(eye.pose.position.x, -0.2, 1e-12);
  const render::Picture measured = renderer.draw_undistorted(eye);
  PairRenderer mono(device(), square_stream(), head);
  mono.show(pair_of(180));
  mono.draw(eye);
  EXPECT_EQ(measured, mono.read_back());
  EXPECT_EQ(renderer.read_back(), displayed) << "measuring changes nothing on the display";
  EXPECT_GT(render::hole_share(displayed), render::hole_share(measured)) << "the lens makes it smaller";
}

TEST_F(DisplayLoopTest, RedrawsOnePairForManyPoses) {
  PairRenderer renderer(device(), square_stream(), settings().camera);
  HandOver<Pair> pairs;
  pairs.put(pair_of(90));
  Tracker tracker;
  tracker.set_motion([](Duration t) { return Pose{.position = {0.5 * to_seconds(t), 0, 0}}; });
  DisplaySettings s = settings();
  s.samples = 2;
  int measurings = 0;
  const DisplayOutcome o = run_display(s, tracker, pairs, renderer, nullptr,
                                       {.should_stop = [] { return false; },
                                        .on_progress = [](const Progress&) {},
                                        .on_measuring = [&](Time) { ++measurings; }});
  ASSERT_TRUE(o.first);
  EXPECT_GE(o.end - *o.first, s.duration);
  EXPECT_GT(o.displayed, 2U);
  EXPECT_EQ(o.log.rows().size(), o.displayed);
  EXPECT_EQ(measurings, 1);
  EXPECT_LT(o.displayed_measured, o.displayed);
  ASSERT_EQ(o.samples.size(), 2U);
  EXPECT_GT(o.samples[1].camera.pose.position.x, o.samples[0].camera.pose.position.x);
  EXPECT_NEAR(o.samples[1].view.at(32, 32)[1], 90, 4);
  EXPECT_TRUE(o.log.rows()[0].is_first());
  EXPECT_FALSE(o.log.rows()[1].is_first());
  EXPECT_GT(o.log.rows().back().draw.end, o.log.rows().back().draw.first_end);
}

TEST_F(DisplayLoopTest, DrawsSamplesAtTheServersPose) {
  PairRenderer renderer(device(), square_stream(), settings().camera);
  HandOver<Pair> pairs;
  Pair pair = pair_of(90);
  pair.server_pose = StampedPose{.id = PoseId{1}, .sampled = Time{}, .pose = {.position = {0, 0, 1}}};
  pairs.put(std::move(pair));
  Tracker tracker;
  tracker.set_motion([](Duration) { return Pose{.position = {50, 0, 0}}; });
  DisplaySettings s = settings();
  s.samples = 1;
  s.at_server_pose = true;
  const DisplayOutcome o = run_display(s, tracker, pairs, renderer, nullptr,
                                       {.should_stop = [] { return false; },
                                        .on_progress = [](const Progress&) {},
                                        .on_measuring = [](Time) {}});
  ASSERT_EQ(o.samples.size(), 1U);
  EXPECT_EQ(o.samples[0].camera.pose.position.z, 1);
  EXPECT_EQ(o.samples[0].view.at(32, 32)[3], 255);
}

TEST_F(DisplayLoopTest, EndsWithoutAPairWhenToldTo) {
  PairRenderer renderer(device(), square_stream(), settings().camera);
  HandOver<Pair> pairs;
  Tracker tracker;
  tracker.set_motion([](Duration) { return Pose{}; });
  int asked = 0;
  const DisplayOutcome o = run_display(settings(), tracker, pairs, renderer, nullptr,
                                       {.should_stop = [&] { return ++asked > 3; },
                                        .on_progress = [](const Progress&) {},
                                        .on_measuring = [](Time) {}});
  EXPECT_FALSE(o.first);
  EXPECT_EQ(o.displayed, 0U);
}

}  // namespace
}  // namespace atlaswire::client
