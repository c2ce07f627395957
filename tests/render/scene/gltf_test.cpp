#include "render/scene/gltf.h"

#include "render/scene/load.h"
#include "render/scene/scene_error.h"
#include "tests/render/scene/gltf_support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>

namespace atlaswire::render {
namespace {

using testing::HasSubstr;

/// One quad of four vertices and six 16-bit indices; each part can be replaced.
struct Quad {
  float positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
  std::string extra;  ///< further top-level members, ends in a comma
  std::string node = R"({"mesh":0})";
  std::string index_accessor = R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"})";
  std::string position_accessor =
      R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]})";
  std::string primitive = R"({"attributes":{"POSITION":0},"indices":1})";

  [[nodiscard]] std::string text() const {
    std::string data(sizeof(positions) + sizeof(indices), '\0');
    std::memcpy(data.data(), positions, sizeof(positions));
    std::memcpy(data.data() + sizeof(positions), indices, sizeof(indices));
    return R"({"asset":{"version":"2.0"},)" + extra + R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" +
           node + R"(],"meshes":[{"primitives":[)" + primitive + R"(]}],"accessors":[)" + position_accessor +
           "," + index_accessor +
           R"(],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],)" +
           R"("buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,)" + base64(data) +
           R"("}]})";
  }
  [[nodiscard]] Result<Scene> load() const {
    const TempFile file("quad.gltf", text());
    return load_scene(file.path());
  }
};

SceneError code_of(const Result<Scene>& scene) {
  EXPECT_TRUE(scene.has_error());
  return scene.has_error() ? static_cast<SceneError>(scene.error().code.value()) : SceneError{};
}

TEST(Gltf, ReadsAQuadAsOnePatchWithComputedNormals) {
  const auto scene = Quad{}.load();
  ASSERT_TRUE(scene.has_value()) << scene.error().message();
  // Flat normals split the quad's vertices; equal ones are made one again, so the triangles still pair.
  ASSERT_EQ(scene->patches.size(), 1U);
  EXPECT_EQ(scene->patches[0].triangles, 2);
  EXPECT_GT(unpack_normal(scene->vertices[0].normal).z, 0.999F);
  EXPECT_GT(glm::length(scene->sun.color), 0.0F) << "a scene without lights gets a sun";
}

TEST(Gltf, InstancesThroughTheHierarchyInDouble) {
  Quad quad;
  quad.node =
      R"({"children":[1,2],"translation":[1000000,0,0]},{"mesh":0},{"mesh":0,"translation":[0,0,0.125],"scale":[-1,1,1]})";
  const auto scene = quad.load();
  ASSERT_TRUE(scene.has_value()) << scene.error().message();
  EXPECT_EQ(scene->patches.size(), 2U);
  EXPECT_EQ(scene->origin, glm::dvec3(1e6, 0.5, 0.0625));
}

TEST(Gltf, WithoutScenesTheRootsAreTheNodesWithoutParents) {
  Quad quad;
  quad.node = R"({"children":[1],"translation":[5,0,0]},{"mesh":0})";
  std::string text = quad.text();
  const std::string scenes = R"("scene":0,"scenes":[{"nodes":[0]}],)";
  text.erase(text.find(scenes), scenes.size());
  const TempFile file("rootless.gltf", text);
  const auto scene = load_scene(file.path());
  ASSERT_TRUE(scene.has_value()) << scene.error().message();
  EXPECT_EQ(scene->patches.size(), 1U) << "the child is placed once, under its parent";
  EXPECT_EQ(scene->origin.x, 5.5);
}

TEST(Gltf, ReadsMaterialsAndLights) {
  Quad quad;
  quad.extra =
      R"("extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)"
      R"({"type":"point","color":[1,0.5,0],"intensity":10,"range":4},{"type":"directional","intensity":3},)"
      R"({"type":"spot","intensity":2,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.6}}]}},)"
      R"("materials":[{"alphaMode":"MASK","alphaCutoff":0.3,"doubleSided":true,"extras":{"atlas_priority":1.5},"pbrMetallicRoughness":)"
      R"({"baseColorFactor":[1,0,0,0.5],"metallicFactor":0.25,"roughnessFactor":0.75}}],)";
  quad.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  quad.node =
      R"({"mesh":0,"children":[1,2,3]},{"translation":[0,0,5],"extensions":{"KHR_lights_punctual":{"light":0}}},)"
      R"({"extensions":{"KHR_lights_punctual":{"light":1}}},{"extensions":{"KHR_lights_punctual":{"light":2}}})";
  const auto scene = quad.load();
  ASSERT_TRUE(scene.has_value()) << scene.error().message();
  const Material& m = scene->materials[scene->patches[0].material];
  EXPECT_EQ(m.draw, (PatchClass{PatchClass::Alpha::kMask, true}));
  EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.3F);
  EXPECT_FLOAT_EQ(m.atlas_priority, 1.5F);
  EXPECT_FLOAT_EQ(m.metallic, 0.25F);
  ASSERT_EQ(scene->lights.size(), 2U);
  EXPECT_FLOAT_EQ(scene->lights[0].range, 4.0F);
  EXPECT_FLOAT_EQ(scene->lights[0].color.y, 5.0F);
  EXPECT_NEAR(scene->lights[1].cos_outer, std::cos(0.6), 1e-6);
  EXPECT_EQ(scene->sun.direction, glm::vec3(0, 0, -1));
}

TEST(Gltf, NodesNameObjectsAndGiveThemPriorities) {
  Quad quad;
  quad.node =
      R"({"name":"statue","extras":{"atlas_priority":2},"children":[1,2]},{"name":"head","mesh":0},)"
      R"({"mesh":0,"translation":[3,0,0],"children":[3]},{"mesh":0,"extras":{"atlas_priority":-1},"translation":[6,0,0]})";
  const auto scene = quad.load();
  ASSERT_TRUE(scene.has_value()) << scene.error().message();
  ASSERT_EQ(scene->patches.size(), 3U);
  EXPECT_EQ(scene->objects, (std::vector<SceneObject>{{"head", 2.0F}, {"statue", 2.0F}, {"statue", -1.0F}}));
  for (std::uint32_t object = 0; object < 3; ++object) {
    EXPECT_EQ(std::ranges::count(scene->patches, object, &Patch::object), 1) << object;
  }
}

TEST(Gltf, RefusesWhatReachesOutside) {
  Quad index;
  index.indices[4] = 4;
  EXPECT_EQ(code_of(index.load()), SceneError::kIndexOutOfRange);
  Quad count;
  count.position_accessor = R"({"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"})";
  EXPECT_EQ(code_of(count.load()), SceneError::kBadAccessor);
  Quad huge;
  huge.position_accessor = R"({"bufferView":0,"componentType":5126,"count":4000000000,"type":"VEC3"})";
  EXPECT_EQ(code_of(huge.load()), SceneError::kBadAccessor);
  Quad offset;
  offset.index_accessor = R"({"bufferView":1,"byteOffset":2,"componentType":5123,"count":6,"type":"SCALAR"})";
  EXPECT_EQ(code_of(offset.load()), SceneError::kBadAccessor);
  Quad type;
  type.index_accessor = R"({"bufferView":1,"componentType":5126,"count":3,"type":"SCALAR"})";
  EXPECT_EQ(code_of(type.load()), SceneError::kBadAccessor);
  Quad material;
  material.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":7})";
  EXPECT_EQ(code_of(material.load()), SceneError::kIndexOutOfRange);
  Quad accessor;
  accessor.primitive = R"({"attributes":{"POSITION":9},"indices":1})";
  EXPECT_TRUE(accessor.load().has_error());
}

TEST(Gltf, RefusesWhatItCannotShow) {
  Quad nan;
  nan.positions[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(code_of(nan.load()), SceneError::kNotFinite);
  Quad no_position;
  no_position.primitive = R"({"attributes":{"NORMAL":0},"indices":1})";
  EXPECT_EQ(code_of(no_position.load()), SceneError::kMissingAttribute);
  Quad required;
  required.extra = R"("extensionsRequired":["KHR_draco_mesh_compression"],)";
  const auto unsupported = required.load();
  EXPECT_EQ(code_of(unsupported), SceneError::kUnsupported);
  EXPECT_THAT(unsupported.error().message(), HasSubstr("KHR_draco_mesh_compression"));
  Quad empty;
  empty.node = "{}";
  EXPECT_EQ(code_of(empty.load()), SceneError::kEmpty);
  Quad cycle;
  cycle.node = R"({"children":[1]},{"children":[0]})";
  EXPECT_EQ(code_of(cycle.load()), SceneError::kMalformed);
  Quad diamond;  // walked as a tree, each such step would double the work
  diamond.node = R"({"children":[1,2]},{"children":[3]},{"children":[3]},{"mesh":0})";
  EXPECT_EQ(code_of(diamond.load()), SceneError::kMalformed);
  Quad far;
  far.positions[0] = 2e9F;
  EXPECT_EQ(code_of(far.load()), SceneError::kNotFinite);
}

TEST(Gltf, TruncatedAndForeignFilesAreMalformed) {
  const std::string whole = Quad{}.text();
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const TempFile file("cut.gltf", whole.substr(0, length));
    EXPECT_EQ(code_of(load_scene(file.path())), SceneError::kMalformed) << length;
  }
  const TempFile binary("cut.glb", std::string("glTF\x02\0\0\0\xff\xff\xff\x7f", 12));
  EXPECT_EQ(code_of(load_scene(binary.path())), SceneError::kMalformed);
}

TEST(RealScenes, AllLoad) {
  const std::filesystem::path scenes = "../shared/scenes";
  if (!std::filesystem::is_directory(scenes)) GTEST_SKIP() << "no real scenes: ../shared/scenes is absent";
  AssembleSettings as_is;
  as_is.split_huge_triangles = false;
  const auto sponza = load_scene((scenes / "Sponza.glb").string(), as_is);
  ASSERT_TRUE(sponza.has_value()) << sponza.error().message();
  EXPECT_EQ(sponza->requirements.triangles + sponza->requirements.degenerate_triangles, 262'267U);
  const auto& of = sponza->requirements.patches_of;
  EXPECT_GT(of[2] + of[3], 20 * of[1]) << "solo triangles only when unavoidable";
}

}  // namespace
}  // namespace atlaswire::render
