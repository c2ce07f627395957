#include "render/scene/surface_priorities.h"

#include <gtest/gtest.h>

namespace atlaswire::render {
namespace {

using Numbers = std::vector<float>;

Scene two_materials_one_object() {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].name = "stone";
  scene.materials[0].atlas_priority = -1;
  scene.materials[1].name = "skin";
  scene.objects = {{"hero", 0.5F}};
  return scene;
}

TEST(SurfacePriorities, WithoutEmphasisAreTheScenes) {
  EXPECT_EQ(surface_priorities(two_materials_one_object(), {}), (Numbers{-1, 0, 0.5F}));
}

TEST(SurfacePriorities, NamedSurfacesGetTheEmphasisInstead) {
  const Emphasis emphasis{.priorities = {{"stone", 1}, {"hero", -2}, {"nobody", 8}, {"stone", 3}}};
  EXPECT_EQ(surface_priorities(two_materials_one_object(), emphasis), (Numbers{3, 0, -2}));
  EXPECT_EQ(unknown_surfaces(two_materials_one_object(), emphasis), std::vector<std::string>{"nobody"});
}

TEST(SurfacePriorities, OneNameMayMeanMaterialsAndObjects) {
  Scene scene = two_materials_one_object();
  scene.objects.push_back({"skin", 0});
  EXPECT_EQ(surface_priorities(scene, {.priorities = {{"skin", 2}}}), (Numbers{-1, 2, 0.5F, 2}));
}

TEST(SurfacePriorities, SceneWithoutObjectsStillHasOneNumberForThem) {
  Scene scene = two_materials_one_object();
  scene.objects.clear();
  EXPECT_EQ(surface_priorities(scene, {}), (Numbers{-1, 0, 0}));
}

TEST(SurfacePriorities, StayWithinEightOctaves) {
  Scene scene = two_materials_one_object();
  scene.objects[0].atlas_priority = 20;
  EXPECT_EQ(surface_priorities(scene, {.priorities = {{"stone", -99}}}), (Numbers{-8, 0, 8}));
}

}  // namespace
}  // namespace atlaswire::render
