#include "lab/head_motion.h"
#include "lab/rate_budget.h"
#include "lab/view_header.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace atlaswire::lab {
namespace {

using namespace std::chrono_literals;

TEST(RateBudget, PaysGeometryBackFromHalfOfTheVideo) {
  RateBudget budget(BitRate{8'000'000}, 10);  // 100 kB a frame
  EXPECT_EQ(budget.video_rate(), BitRate{8'000'000});
  budget.on_frame(75'000);
  EXPECT_EQ(budget.video_rate(), BitRate{4'000'000});
  budget.on_frame(0);
  EXPECT_EQ(budget.video_rate(), BitRate{6'000'000});  // 25 kB are left
  budget.on_frame(0);
  EXPECT_EQ(budget.video_rate(), BitRate{8'000'000});
}

TEST(HeadMotion, KnowsThePastOnly) {
  // Stands for a second, then walks at 1 m/s.
  const auto path = render::CameraPath::parse("0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,1\n2,0,0,-1,0,0,0,1\n").value();
  const HeadMotion head(path, 100ms);
  EXPECT_EQ(head.at(1s).velocity, glm::dvec3(0));
  EXPECT_NEAR(head.at(1050ms).velocity.z, -0.5, 1e-9);
  EXPECT_NEAR(head.at(1500ms).velocity.z, -1, 1e-9);
  EXPECT_NEAR(head.at(1500ms).position.z, -0.5, 1e-9);
}

TEST(ViewHeader, ComesBack) {
  ViewHeader header{.frame = FrameId{77}, .nearest = 0.25};
  header.camera.pose.position = {1.25, -2e6, 3e-3};
  header.camera.pose.orientation = glm::normalize(glm::dquat{0.5, 0.1, -0.7, 0.2});
  header.camera.vertical_fov = 0.9;
  header.camera.extent = {576, 324};
  header.camera.near_plane = 0.0625;
  const ByteBuffer bytes = write_view_header(header);
  EXPECT_EQ(bytes.size(), 80U);
  const auto back = read_view_header(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->frame, header.frame);
  EXPECT_EQ(back->camera.pose.position, header.camera.pose.position);
  EXPECT_EQ(back->camera.pose.orientation, header.camera.pose.orientation);
  EXPECT_EQ(back->camera.vertical_fov, header.camera.vertical_fov);
  EXPECT_EQ(back->camera.extent, header.camera.extent);
  EXPECT_EQ(back->camera.near_plane, header.camera.near_plane);
  EXPECT_EQ(back->nearest, header.nearest);
  EXPECT_FALSE(read_view_header(ByteView(bytes).first(79)));
}

}  // namespace
}  // namespace atlaswire::lab
