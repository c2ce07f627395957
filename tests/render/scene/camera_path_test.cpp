#include "render/scene/camera_path.h"

#include "render/scene/scene_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace atlaswire::render {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

TEST(CameraPath, InterpolatesAndGivesVelocities) {
  const auto path =
      CameraPath::parse("t,px,py,pz,qx,qy,qz,qw\n1,0,0,0,0,0,0,1\n2,2,0,0,0,0.70710678,0,0.70710678\r\n");
  ASSERT_TRUE(path.has_value()) << path.error().message();
  EXPECT_EQ(path->length(), std::chrono::seconds(1)) << "times start at zero";
  const Pose half = path->at(milliseconds(500));
  EXPECT_NEAR(half.position.x, 1, 1e-9);
  EXPECT_NEAR(half.velocity.x, 2, 1e-9);
  EXPECT_NEAR(half.angular_velocity.y, 1.5707963, 1e-6);
  EXPECT_NEAR(half.orientation.y, 0.38268343, 1e-6);
}

TEST(CameraPath, WalksBackAndForthWithoutAJump) {
  const auto path = CameraPath::parse("0,0,0,0,0,0,0,1\n1,3,0,0,0,0,0,1\n");
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR(path->at(milliseconds(1250)).position.x, 2.25, 1e-9);
  EXPECT_NEAR(path->at(milliseconds(1250)).velocity.x, -3, 1e-9);
  EXPECT_NEAR(path->at(milliseconds(2000)).position.x, 0, 1e-9);
  EXPECT_NEAR(path->at(milliseconds(2500)).position.x, 1.5, 1e-9);
  EXPECT_NEAR(path->at(milliseconds(-500)).position.x, 1.5, 1e-9);
}

TEST(CameraPath, OneRowStandsStill) {
  const auto path = CameraPath::parse("5,1,2,3,0,0,0,1");
  ASSERT_TRUE(path.has_value());
  EXPECT_EQ(path->at(std::chrono::seconds(9)).position, glm::dvec3(1, 2, 3));
}

TEST(CameraPath, RefusesMalformedRowsByLine) {
  const char* good = "0,0,0,0,0,0,0,1\n";
  for (const char* row : {"1,0,0,0,0,0,0", "1,0,0,0,0,0,0,1,2", "1,x,0,0,0,0,0,1", "1,nan,0,0,0,0,0,1",
                          "1,inf,0,0,0,0,0,1", "0,0,0,0,0,0,0,1", "-1,0,0,0,0,0,0,1", "1,0,0,0,0,0,0,0",
                          "1,0,0,0,0,0,0,2", "1,1e10,0,0,0,0,0,1", "1e9,0,0,0,0,0,0,1"}) {
    const auto path = CameraPath::parse(std::string(good) + row);
    ASSERT_TRUE(path.has_error()) << row;
    EXPECT_EQ(path.error().code, SceneError::kBadPath) << row;
    EXPECT_THAT(path.error().message(), HasSubstr("line 2")) << row;
  }
  EXPECT_TRUE(CameraPath::parse("").has_error());
  EXPECT_TRUE(CameraPath::parse("t,px,py,pz,qx,qy,qz,qw\n").has_error());
}

TEST(CameraPath, BuiltInOnesAreSmoothAndAtEyeHeight) {
  for (const std::string& name : CameraPath::builtin()) {
    const auto path = CameraPath::load(name);
    ASSERT_TRUE(path.has_value()) << name;
    for (const CameraPath::Key& key : path->keys()) {
      ASSERT_NEAR(key.pose.position.y, 1.68, 0.05) << name;
      ASSERT_LT(glm::length(key.pose.velocity), 3.5) << name;
      ASSERT_LT(glm::length(key.pose.angular_velocity), name == "atrium-about" ? 9.5 : 2.7) << name;
      ASSERT_TRUE(is_sane(key.pose)) << name;
    }
  }
  EXPECT_EQ(CameraPath::load("no-such-path").error().code, SceneError::kNotFound);
}

}  // namespace
}  // namespace atlaswire::render
