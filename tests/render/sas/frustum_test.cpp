#include "base/random.h"
#include "render/passes/visibility_frustum.h"

#include <gtest/gtest.h>

#include <cmath>

namespace atlaswire::render {
namespace {

Camera looking_along_minus_z() {
  Camera camera;
  camera.vertical_fov = 1.5707963267948966;  // tangents: 1 up, 2 across
  camera.extent = {200, 100};
  camera.near_plane = 0.1;
  return camera;
}

Box around(const glm::vec3& centre, float half) { return {.low = centre - half, .high = centre + half}; }

TEST(ViewVolume, KeepsWhatIsInFrontAndDropsEachSide) {
  const ViewVolume volume(looking_along_minus_z(), glm::dvec3{0.0});
  EXPECT_TRUE(volume.may_see(around({0, 0, -5}, 1)));
  EXPECT_FALSE(volume.may_see(around({0, 0, 5}, 1)));
  EXPECT_TRUE(volume.may_see(around({9.5F, 0, -5}, 0.4F)));
  EXPECT_FALSE(volume.may_see(around({12, 0, -5}, 0.4F)));
  EXPECT_FALSE(volume.may_see(around({-12, 0, -5}, 0.4F)));
  EXPECT_FALSE(volume.may_see(around({0, 6, -5}, 0.4F)));
  EXPECT_FALSE(volume.may_see(around({0, -6, -5}, 0.4F)));
  EXPECT_FALSE(volume.may_see(around({0, 0, -0.04F}, 0.02F))) << "nearer than the near plane";
  EXPECT_TRUE(volume.may_see(around({0, 0, 0}, 100))) << "the camera is inside";
}

TEST(ViewVolume, NeverDropsABoxThatHoldsAVisiblePoint) {
  Random random(7);
  Camera camera = looking_along_minus_z();
  const glm::dvec3 origin{1e6, -2e6, 3e5};
  for (int i = 0; i < 2000; ++i) {
    const auto draw = [&] { return random.uniform() * 2 - 1; };
    camera.pose.position = origin + glm::dvec3{draw(), draw(), draw()} * 10.0;
    camera.pose.orientation = glm::normalize(glm::dquat(draw() + 2, draw() * 3, draw() * 3, draw() * 3));
    const double depth = 0.2 + 40 * random.uniform();
    const glm::dvec3 seen{2 * depth * draw() * 0.999, depth * draw() * 0.999, -depth};
    const glm::dvec3 point = camera.pose.position + camera.pose.orientation * seen - origin;
    const glm::dvec3 low = point - glm::dvec3{random.uniform(), random.uniform(), random.uniform()};
    const glm::dvec3 high = point + glm::dvec3{random.uniform(), random.uniform(), random.uniform()};
    EXPECT_TRUE(ViewVolume(camera, origin).may_see({.low = low, .high = high})) << i;
  }
}

}  // namespace
}  // namespace atlaswire::render
