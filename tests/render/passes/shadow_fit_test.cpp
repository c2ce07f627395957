#include "render/passes/shadow_fit.h"

#include "base/random.h"
#include "render/scene/scene.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace atlaswire::render {
namespace {

glm::vec3 mapped(const ShadowFit& fit, const glm::vec3& p) {
  return {glm::dot(fit.rows[0], glm::vec4{p, 1}), glm::dot(fit.rows[1], glm::vec4{p, 1}),
          glm::dot(fit.rows[2], glm::vec4{p, 1})};
}

TEST(ShadowFit, HoldsEveryVertexForAnyDirection) {
  Random random(7);
  const auto coordinate = [&] { return static_cast<float>(random.uniform() * 40.0 - 20.0); };
  for (int round = 0; round < 20; ++round) {
    std::vector<ShadingVertex> vertices(50);
    for (auto& v : vertices) v.position = {coordinate(), coordinate(), coordinate()};
    const glm::vec3 direction = glm::normalize(glm::vec3{coordinate(), coordinate(), coordinate()});
    const ShadowFit fit = fit_shadow(vertices, direction, 1024);
    for (const auto& v : vertices) {
      const glm::vec3 at = mapped(fit, v.position);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GT(at[axis], 0.0F);
        EXPECT_LT(at[axis], 1.0F);
      }
      EXPECT_GT(mapped(fit, v.position - direction).z, at.z) << "nearer the sun is deeper";
    }
  }
}

TEST(ShadowFit, StraightDownAndFlatScenesAreFine) {
  const std::vector<ShadingVertex> one(1);
  for (const glm::vec3 direction : {glm::vec3{0, -1, 0}, glm::vec3{1, 0, 0}}) {
    const ShadowFit fit = fit_shadow(one, direction, 1024);
    EXPECT_TRUE(std::isfinite(mapped(fit, {0, 0, 0}).x));
    EXPECT_GT(fit.texel, 0.0F);
  }
  EXPECT_TRUE(std::isfinite(mapped(fit_shadow({}, {0, -1, 0}, 1024), {1, 2, 3}).z));
}

}  // namespace
}  // namespace atlaswire::render
