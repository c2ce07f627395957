#include "render/scene/animator.h"
#include "render/scene/gltf.h"
#include "render/scene/load.h"
#include "render/scene/moved_scene.h"
#include "render/scene/scene_error.h"
#include "tests/render/scene/gltf_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>

namespace atlaswire::render {
namespace {

/// A triangle that a skin of two joints and a morph target move; every part can be bent.
struct Dancer {
  std::vector<float> data{
      0, 0, 0, 1, 0,    0,    0, 1, 0,                        // 0: positions
      0, 0, 1, 0, 0,    1,    0, 0, 1,                        // 9: the target's displacements
      1, 0, 0, 0, 0.5F, 0.5F, 0, 0, 1, 0, 0, 0,               // 18: weights
      0, 1,                                                   // 30: times
      0, 0, 0, 0, 8,    0,                                    // 32: translations of joint 2
      0, 1,                                                   // 38: morph weights
      1, 0, 0, 0, 0,    1,    0, 0, 0, 0, 1, 0, 0, 0, 0,  1,  // 40: inverse bind matrices
      1, 0, 0, 0, 0,    1,    0, 0, 0, 0, 1, 0, 0, 0, -1, 1,  // 56
  };
  std::vector<std::uint8_t> joints{0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
  std::string nodes =
      R"({"mesh":0,"skin":0,"translation":[50,0,0]},{"children":[2]},{"translation":[0,0,1]})";
  std::string skin = R"({"joints":[1,2],"inverseBindMatrices":6})";
  std::string samplers = R"({"input":3,"output":4},{"input":3,"output":5,"interpolation":"LINEAR"})";
  std::string channels =
      R"({"sampler":0,"target":{"node":2,"path":"translation"}},{"sampler":1,"target":{"node":0,"path":"weights"}})";
  std::string scene_nodes = "0,1";
  std::string times_count = "2";

  [[nodiscard]] std::string text() const {
    std::string bytes(data.size() * 4, '\0');
    std::memcpy(bytes.data(), data.data(), bytes.size());
    bytes.append(joints.begin(), joints.end());
    const auto floats = [](int at, const std::string& count, const char* type) {
      return R"({"bufferView":0,"componentType":5126,"byteOffset":)" + std::to_string(4 * at) +
             R"(,"count":)" + count + R"(,"type":")" + type + R"("})";
    };
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + scene_nodes + R"(]}],"nodes":[)" +
           nodes +
           R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":7,"WEIGHTS_0":2},"targets":[{"POSITION":1}]}]}],)" +
           R"("skins":[)" + skin + R"(],"animations":[{"name":"dance","samplers":[)" + samplers +
           R"(],"channels":[)" + channels + R"(]}],"accessors":[)" + floats(0, "3", "VEC3") + "," +
           floats(9, "3", "VEC3") + "," + floats(18, "3", "VEC4") + "," + floats(30, times_count, "SCALAR") +
           "," + floats(32, "2", "VEC3") + "," + floats(38, "2", "SCALAR") + "," + floats(40, "2", "MAT4") +
           R"(,{"bufferView":1,"componentType":5121,"count":3,"type":"VEC4"}],)" +
           R"("bufferViews":[{"buffer":0,"byteLength":)" + std::to_string(data.size() * 4) +
           R"(},{"buffer":0,"byteOffset":)" + std::to_string(data.size() * 4) +
           R"(,"byteLength":12}],"buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
           R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) + R"("}]})";
  }
  [[nodiscard]] Result<SceneSource> read() const {
    const TempFile file("dancer.gltf", text());
    return read_gltf(file.path());
  }
};

SceneError refusal(const Dancer& dancer) {
  const auto source = dancer.read();
  EXPECT_TRUE(source.has_error());
  return source.has_error() ? static_cast<SceneError>(source.error().code.value()) : SceneError{};
}

TEST(GltfRig, PlaysASkinAndAMorphTarget) {
  const auto source = Dancer{}.read();
  ASSERT_TRUE(source) << source.error().message();
  ASSERT_TRUE(source->rig.moves());
  EXPECT_EQ(source->rig.clips[0].name, "dance");
  EXPECT_EQ(source->rig.clips[0].duration, 1);
  Animator animator(*source);
  animator.pose(0.5);
  std::vector<glm::dvec3> at;
  animator.positions(0, at);
  ASSERT_EQ(at.size(), 3U) << "split for flat normals, and still three";
  // Joint 1 rests. Joint 2 is at (0, 4, 0), bound at z = 1. The target at half its weight raises all by z =
  // 0.5.
  const glm::dvec3 expected[] = {{0, 0, 0.5}, {1, 2, 0}, {0, 5, -0.5}};
  for (int i = 0; i < 3; ++i)
    EXPECT_LT(glm::distance(at[static_cast<std::size_t>(i)], expected[i]), 1e-9) << i;
}

TEST(GltfRig, WhatAFileMovesIsFoundInItsScene) {
  const TempFile file("dancer.gltf", Dancer{}.text());
  const auto loaded = load_scene(file.path());
  ASSERT_TRUE(loaded) << loaded.error().message();
  const auto scene = std::make_shared<const Scene>(*loaded);
  ASSERT_TRUE(scene->motion);
  ASSERT_EQ(scene->motion->parts.size(), 1U);
  EXPECT_TRUE(scene->motion->parts[0].mover.deforms);
  MovedScene moved(scene);
  moved.pose(0.5);
  std::vector<glm::dvec3> posed;
  const auto source = Dancer{}.read();
  Animator animator(*source);
  animator.pose(0.5);
  animator.positions(0, posed);
  for (const glm::vec3& p : moved.positions(0)) {
    const auto same = [&](const glm::dvec3& q) {
      return glm::distance(glm::dvec3(p) + scene->origin, q) < 1e-5;
    };
    EXPECT_TRUE(std::ranges::any_of(posed, same));
    EXPECT_LE(p.x, scene->box.high.x + 1e-5F);
    EXPECT_GE(p.x, scene->box.low.x - 1e-5F);
  }
}

TEST(GltfRig, WhatFliesAwayLeavesTheSceneWithinReach) {
  Dancer dancer;
  dancer.data[36] = 1e30F;
  const TempFile file("dancer.gltf", dancer.text());
  const auto loaded = load_scene(file.path());
  ASSERT_TRUE(loaded) << loaded.error().message();
  const glm::dvec3 high = loaded->origin + glm::dvec3(loaded->box.high);
  const glm::dvec3 low = loaded->origin + glm::dvec3(loaded->box.low);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(high[axis], 1e9);
    EXPECT_GE(low[axis], -1e9);
  }
}

TEST(GltfRig, LeavesOutChannelsThatItDoesNotKnow) {
  Dancer dancer;
  dancer.channels =
      R"({"sampler":0,"target":{"node":2,"path":"pointer"}},{"sampler":0,"target":{"path":"scale"}},{"sampler":0,"target":{"node":1,"path":"weights"}})";
  const auto source = dancer.read();
  ASSERT_TRUE(source) << source.error().message();
  EXPECT_FALSE(source->rig.moves());
}

TEST(GltfRig, AMatrixIsNotAnimated) {
  Dancer dancer;
  dancer.nodes = R"({"mesh":0,"skin":0},{"children":[2]},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,3,1]})";
  const auto source = dancer.read();
  ASSERT_TRUE(source) << source.error().message();
  EXPECT_EQ(source->rig.clips[0].channels.size(), 1U);
  Animator animator(*source);
  EXPECT_EQ(animator.node(2)[3], glm::dvec4(0, 0, 3, 1));
}

TEST(GltfRig, RefusesNumbersOutOfRange) {
  const auto bent = [](std::string Dancer::*part, const char* from, const char* to) {
    Dancer dancer;
    std::string& text = dancer.*part;
    text.replace(text.find(from), std::strlen(from), to);
    return refusal(dancer);
  };
  EXPECT_EQ(bent(&Dancer::nodes, "\"skin\":0", "\"skin\":1"), SceneError::kIndexOutOfRange);
  EXPECT_EQ(bent(&Dancer::nodes, "[2]", "[7]"), SceneError::kIndexOutOfRange);
  EXPECT_EQ(bent(&Dancer::nodes, "[2]", "[1]"), SceneError::kMalformed);
  EXPECT_EQ(bent(&Dancer::skin, "[1,2]", "[1,9]"), SceneError::kIndexOutOfRange);
  EXPECT_EQ(bent(&Dancer::skin, "[1,2]", "[1]"), SceneError::kIndexOutOfRange);
  EXPECT_EQ(bent(&Dancer::skin, "[1,2]", "[]"), SceneError::kMalformed);
  EXPECT_EQ(bent(&Dancer::skin, "[1,2]", "[1,2,0]"), SceneError::kBadAccessor);
  EXPECT_EQ(bent(&Dancer::skin, "6", "60"), SceneError::kIndexOutOfRange);
  EXPECT_EQ(bent(&Dancer::channels, "\"node\":2", "\"node\":9"), SceneError::kIndexOutOfRange);
  EXPECT_EQ(bent(&Dancer::channels, "\"sampler\":0", "\"sampler\":5"), SceneError::kIndexOutOfRange);
  EXPECT_EQ(bent(&Dancer::channels, "translation", "rotation"), SceneError::kBadAccessor);
  EXPECT_EQ(bent(&Dancer::samplers, "LINEAR", "CUBICSPLINE"), SceneError::kBadAccessor);
  EXPECT_EQ(bent(&Dancer::samplers, "LINEAR", "BEZIER"), SceneError::kMalformed);
  EXPECT_EQ(bent(&Dancer::times_count, "2", "1"), SceneError::kBadAccessor);
  EXPECT_EQ(bent(&Dancer::times_count, "2", "99999999"), SceneError::kTooLarge);
}

TEST(GltfRig, RefusesKeysThatDoNotAscend) {
  Dancer dancer;
  dancer.data[31] = 0;
  EXPECT_EQ(refusal(dancer), SceneError::kMalformed);
  dancer.data[30] = -1;
  EXPECT_EQ(refusal(dancer), SceneError::kMalformed);
}

TEST(GltfRig, RefusesWhatIsNotFinite) {
  for (const std::size_t at : {10U, 19U, 30U, 33U, 38U, 41U}) {
    Dancer dancer;
    dancer.data[at] =
        at % 2 == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refusal(dancer), SceneError::kNotFinite) << at;
  }
}

TEST(GltfRig, SurvivesEveryTruncation) {
  const std::string text = Dancer{}.text();
  for (std::size_t size = 0; size < text.size(); size += 7) {
    const TempFile file("cut.gltf", text.substr(0, size));
    EXPECT_TRUE(read_gltf(file.path()).has_error()) << size;
  }
}

}  // namespace
}  // namespace atlaswire::render
