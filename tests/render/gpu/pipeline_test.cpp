#include "render/gpu/pipeline.h"

#include "render/gpu/barriers.h"
#include "render/gpu/submit_context.h"
#include "shaders/level_layout.h"
#include "shaders/shaders.h"
#include "shaders/visibility_layout.h"
#include "tests/render/gpu/gpu_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

namespace atlaswire::render {
namespace {

using visibility::LevelConstants;
using visibility::PatchCorners;

/// [SAS] eq. 1 and Heron's formula in double, straight from the definitions.
double edge(const glm::dvec3& camera, const glm::dvec3& a, const glm::dvec3& b, double pixels_per_radian) {
  const glm::dvec3 u = a - camera;
  const glm::dvec3 v = b - camera;
  return pixels_per_radian * std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

double heron(double a, double b, double c) {
  const double s = (a + b + c) / 2;
  return std::sqrt(std::max(0.0, s * (s - a) * (s - b) * (s - c)));
}

/// What the level word should say of a block whose texels' centres span `area` pixels: one texel more a side,
/// and no more than four times the area.
struct Wanted {
  double log2_area;
  double log2_aspect;
};
Wanted wanted(double area, double width, double height) {
  const double side_u = std::sqrt(area * width / height);
  const double side_v = area / side_u;
  return {std::log2(std::min((side_u + 1) * (side_v + 1), 4 * area)), std::log2((side_u + 1) / (side_v + 1))};
}

class LevelPass : public test::GpuTest {
 protected:
  /// Runs the level shader over patches given by corner positions; all but `hidden` are listed.
  std::vector<std::uint32_t> run(const std::vector<std::vector<glm::vec3>>& patches, const glm::dvec3& camera,
                                 float pixels_per_radian, std::size_t hidden = ~std::size_t{0}) {
    std::vector<glm::vec3> positions;
    std::vector<PatchCorners> corners;
    std::vector<std::uint32_t> marks;
    std::vector<std::uint32_t> list{1, 1, 1, 0};
    for (const auto& patch : patches) {
      PatchCorners& c = corners.emplace_back();
      for (std::uint32_t i = 0; i < 5; ++i) {
        c.position[i] =
            static_cast<std::uint32_t>(positions.size() + std::min<std::size_t>(i, patch.size() - 1));
      }
      c.triangles = static_cast<std::uint32_t>(patch.size() - 2);
      c.surface[0] = 0;
      c.surface[1] = 1;
      positions.insert(positions.end(), patch.begin(), patch.end());
      if (marks.size() != hidden) {
        list.push_back(static_cast<std::uint32_t>(marks.size()));
        ++list[visibility::kListHeader - 1];
      }
      marks.push_back(marks.size() == hidden ? 0 : 1);
    }
    const Buffer position_buffer = filled("positions", positions);
    const Buffer corner_buffer = filled("corners", corners);
    const Buffer mark_buffer = filled("marks", marks);
    const Buffer levels = filled("levels", std::vector<std::uint32_t>(patches.size(), 0));
    const Buffer list_buffer = filled("list", list);
    const Buffer priorities = filled("priorities", priorities_);
    const DescriptorLayout layout(
        device(), "level",
        {{.binding = 1}, {.binding = 3}, {.binding = 4}, {.binding = 5}, {.binding = 6}, {.binding = 7}});
    DescriptorSets sets(device(), "level", layout);
    sets.write(0, 1, mark_buffer);
    sets.write(0, 3, position_buffer);
    sets.write(0, 4, corner_buffer);
    sets.write(0, 5, levels);
    sets.write(0, 6, list_buffer);
    sets.write(0, 7, priorities);
    const Pipeline pipeline(device(), ComputeSettings{.name = "level",
                                                      .shader = shaders::visibility_level_comp,
                                                      .layouts = {layout.handle()},
                                                      .push_constant_bytes = sizeof(LevelConstants)});
    const glm::vec3 high(camera);
    const LevelConstants constants{.camera_high = glm::vec4(high, 0),
                                   .camera_low = glm::vec4(glm::vec3(camera - glm::dvec3(high)), 0),
                                   .pixels_per_radian = pixels_per_radian,
                                   .foveation = foveation_,
                                   .foveal_angle = std::numbers::pi_v<float> / 18,
                                   .padding = {},
                                   .gaze = {0, 0, -1, 0}};
    SubmitContext context(device(), "level");
    context.run([&](const vk::raii::CommandBuffer& commands) {
      pipeline.bind(commands, {sets.handle()});
      pipeline.push(commands, constants);
      commands.dispatch(group_count(patches.size(), visibility::kListGroup), 1, 1);
      writes_to_host(commands);
    });
    for (const std::uint32_t mark : mark_buffer.mapped<std::uint32_t>()) EXPECT_EQ(mark, 0U);
    const auto words = levels.mapped<std::uint32_t>();
    return {words.begin(), words.end()};
  }

  float foveation_ = 0;
  std::vector<float> priorities_{0, 0};  ///< of the material and the object of every patch

 private:
  template <class T>
  Buffer filled(const char* name, const std::vector<T>& data) {
    Buffer buffer(device(), {.name = name,
                             .size = data.size() * sizeof(T),
                             .usage = vk::BufferUsageFlagBits::eStorageBuffer,
                             .residence = Residence::kReadback});
    std::memcpy(buffer.mapped().data(), data.data(), data.size() * sizeof(T));
    buffer.flush();
    return buffer;
  }
};

const std::vector<std::vector<glm::vec3>> kShapes{
    {{0, 0, -3}, {1, 0, -3}, {0, 2, -3}},
    {{0, 0, -3}, {1, 0, -3}, {1, 1, -3.5F}, {0, 1, -3}},
    {{-2, 0, -5}, {0, 0.1F, -5}, {0, 4, -5}, {-1, 4, -5.2F}, {-2, 4, -5}},
    {{0, 0, 7}, {-1, 0, 7}, {-1, 1, 7}, {0, 1, 7}},      // behind the camera
    {{-1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, -1}},  // through the camera's plane
    {{100, 0, -900}, {100.01F, 0, -900}, {100.01F, 0.02F, -900}, {100, 0.02F, -900}},  // tiny and far
    {{0, 0, -2}, {30, 0, -2}, {30, 0.01F, -2}, {0, 0.01F, -2}},                        // long and thin
};

TEST_F(LevelPass, AgreesWithDoublePrecision) {
  const glm::dvec3 camera{0.1, 0.2, 0.3};
  const double scale = 467.65;
  const auto words = run(kShapes, camera, static_cast<float>(scale));
  for (std::size_t i = 0; i < kShapes.size(); ++i) {
    const auto& p = kShapes[i];
    const auto side = [&](std::size_t a, std::size_t b) { return edge(camera, p[a], p[b], scale); };
    const auto tri = [&](std::size_t a, std::size_t b, std::size_t c) {
      return heron(side(a, b), side(b, c), side(c, a));
    };
    double area = 2 * tri(0, 1, 2);
    double width = side(0, 1);
    double height = side(0, 2);
    if (p.size() == 4) {
      area = tri(0, 1, 2) + tri(0, 2, 3);
      width = std::max(side(0, 1), side(2, 3));
      height = std::max(side(1, 2), side(3, 0));
    } else if (p.size() == 5) {
      area = tri(0, 1, 3) + tri(1, 2, 3) + tri(0, 3, 4);
      width = std::max(side(0, 1), side(2, 3) + side(3, 4));
      height = std::max(side(1, 2), side(4, 0));
    }
    const Wanted want = wanted(area, width, height);
    EXPECT_NEAR(level_log2_area(words[i]), want.log2_area, 0.02) << "shape " << i;
    EXPECT_NEAR(level_log2_aspect(words[i]), want.log2_aspect, 0.01) << "shape " << i;
  }
}

TEST_F(LevelPass, EdgesOfNearlyHalfATurnKeepTheirDigits) {
  // Strips that pass a centimetre below the camera: their long sides are seen at 180 degrees less 2e-2 to
  // 2e-5.
  const glm::dvec3 camera{0.1, 0.2, 0.3};
  for (const float reach : {1.0F, 10.0F, 100.0F, 1000.0F}) {
    const std::vector<glm::vec3> p{
        {-reach, 0.19F, 0.3F}, {reach, 0.19F, 0.3F}, {reach, 0.19F, 0.4F}, {-reach, 0.19F, 0.4F}};
    const auto words = run({p}, camera, 467.65F);
    const double width = std::max(edge(camera, p[0], p[1], 467.65), edge(camera, p[2], p[3], 467.65));
    const double height = std::max(edge(camera, p[1], p[2], 467.65), edge(camera, p[3], p[0], 467.65));
    EXPECT_GT(width, 467 * 3.1);
    const double diagonal = edge(camera, p[0], p[2], 467.65);
    const double area = heron(edge(camera, p[0], p[1], 467.65), edge(camera, p[1], p[2], 467.65), diagonal) +
                        heron(diagonal, edge(camera, p[2], p[3], 467.65), edge(camera, p[3], p[0], 467.65));
    EXPECT_NEAR(level_log2_aspect(words[0]), wanted(area, width, height).log2_aspect, 0.02) << reach;
  }
}

TEST_F(LevelPass, FoveationAndPriorityChangeTheAreaAlone) {
  const glm::dvec3 camera{0.1, 0.2, 0.3};
  const auto plain = run(kShapes, camera, 500.0F);
  foveation_ = 2;
  priorities_ = {2, -0.5F};
  const auto biased = run(kShapes, camera, 500.0F);
  for (std::size_t i = 0; i < kShapes.size(); ++i) {
    const auto away = [&](const glm::dvec3& p) {
      const glm::dvec3 to = p - camera;
      return std::atan2(std::hypot(to.x, to.y), -to.z);
    };
    const double angle = std::min(away(kShapes[i][0]), away(kShapes[i][2]));
    const double loss = 2 * std::max(0.0, angle - std::numbers::pi / 18);
    EXPECT_NEAR(level_log2_area(biased[i]), level_log2_area(plain[i]) + 1.5 - loss, 0.02) << "shape " << i;
    EXPECT_EQ(level_log2_aspect(biased[i]), level_log2_aspect(plain[i])) << "shape " << i;
  }
}

TEST_F(LevelPass, HiddenPatchesAreZeroAndMarksAreTakenBack) {
  const auto words = run(kShapes, {0, 0, 0}, 500.0F, 2);
  for (std::size_t i = 0; i < kShapes.size(); ++i) EXPECT_EQ(words[i] == 0, i == 2) << i;
}

TEST_F(LevelPass, DegeneratePatchesGetTheSmallestArea) {
  const auto words = run({{{1, 1, -1}, {1, 1, -1}, {1, 1, -1}},
                          {{0, 0, -1}, {1, 0, -1}, {2, 0, -1}},
                          {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}},
                         {0, 0, 0}, 500.0F);
  EXPECT_LT(level_log2_area(words[0]), -30);
  EXPECT_LT(level_log2_area(words[1]), 8);
  EXPECT_LT(level_log2_area(words[2]), -30);
  for (const std::uint32_t word : words) EXPECT_NE(word, 0U);
}

TEST_F(LevelPass, FarCamerasLoseNothing) {
  // The same view, kilometres away from the scene's origin.
  const glm::dvec3 shift{4096.0, -2048.0, 1024.0};
  std::vector<std::vector<glm::vec3>> moved{{{0, 0, -3}, {1, 0, -3}, {1, 1, -3.5F}, {0, 1, -3}}};
  const auto near_words = run(moved, {0.1, 0.2, 0.3}, 500.0F);
  for (auto& p : moved[0]) p += glm::vec3(shift);
  const auto far_words = run(moved, glm::dvec3{0.1, 0.2, 0.3} + shift, 500.0F);
  EXPECT_EQ(near_words, far_words);
}

}  // namespace
}  // namespace atlaswire::render
