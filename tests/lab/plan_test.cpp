#include "lab/plan.h"

#include "lab/lab_error.h"
#include "tests/lab/temporary_folder.h"

#include <gtest/gtest.h>

#include <set>

namespace atlaswire::lab {
namespace {

Experiment experiment(std::string_view more) {
  return parse_experiment(std::string("name = \"t\"\n") + std::string(more), "t").value();
}

constexpr const char* kTwoByThree = R"(
[[variant]]
name = "A"
method = "sas"
[[variant]]
name = "B"
method = "atw"
[sweep]
latency_ms = [0, 50, 100]
)";

std::vector<std::string> labels(const Plan& plan) {
  std::vector<std::string> all;
  for (const PlannedPoint& p : plan.points) all.push_back(label(p, plan));
  return all;
}

TEST(Plan, MultipliesVariantsAndAxesWithTheLastFastest) {
  const Plan plan = make_plan(experiment(std::string(kTwoByThree) + "seed = [1, 2]\n"), {}).value();
  ASSERT_EQ(plan.points.size(), 12U);
  EXPECT_EQ(plan.points[0].variant, "A");
  EXPECT_EQ(plan.points[1].settings.seed, 2U);
  EXPECT_EQ(plan.points[2].settings.latency_ms, 50);
  EXPECT_EQ(plan.points[6].variant, "B");
  EXPECT_EQ(plan.varying, (std::vector<std::string>{"method", "latency_ms", "seed"}));
  EXPECT_EQ(label(plan.points[7], plan), "B, latency_ms 0, seed 2");
}

TEST(Plan, IdsAreStableDistinctAndFollowSettingsAlone) {
  const Plan plan = make_plan(experiment(kTwoByThree), {}).value();
  std::set<std::string> ids;
  for (const PlannedPoint& p : plan.points) ids.insert(p.id);
  EXPECT_EQ(ids.size(), plan.points.size());
  const Plan again =
      make_plan(experiment("[sweep]\nlatency_ms = [50]\n[settings]\nmethod = \"atw\"\n"), {}).value();
  EXPECT_EQ(again.points[0].id, plan.points[4].id) << "a variant's name is no setting";
  EXPECT_EQ(text_hash(""), "cbf29ce484222325");
  EXPECT_EQ(text_hash("a"), "af63dc4c8601ec8c");  // FNV-1a's published vectors
}

TEST(Plan, IdsFollowTheContentOfFilesAndNotTheirFolder) {
  const TemporaryFolder one;
  const TemporaryFolder two;
  const std::string row = "0,0,0,0,0,0,0,1\n";
  one.write("walk.csv", row);
  two.write("walk.csv", row);
  const Experiment e = experiment("[settings]\npath = \"walk.csv\"\n");
  const auto id = [&](const TemporaryFolder& folder) {
    return make_plan(e, {.folder = folder.path().string()}).value().points[0].id;
  };
  EXPECT_EQ(id(one), id(two));
  two.write("walk.csv", row + "1,0,0,0,0,0,0,1\n");
  EXPECT_NE(id(one), id(two));
}

TEST(Plan, AroundChangesOneKeyAtATime) {
  const Plan plan =
      make_plan(
          experiment(
              "[settings]\nviews = 2\n[around]\nviews = [1, 2, 3]\nqp = [20]\n[sweep]\nseed = [1, 2]\n"),
          {})
          .value();
  EXPECT_EQ(plan.points.size(), 8U);  // twice: base, two views, one qp
  EXPECT_EQ(plan.points[0].varied, "");
  EXPECT_EQ(plan.points[1].varied, "views");
  EXPECT_EQ(plan.points[3].varied, "qp");
  EXPECT_EQ(plan.points[3].settings.views, 2U);
  EXPECT_EQ(labels(plan),
            (std::vector<std::string>{"seed 1", "views 1, seed 1", "views 3, seed 1", "seed 1, qp 20",
                                      "seed 2", "views 1, seed 2", "views 3, seed 2", "seed 2, qp 20"}));
}

TEST(Plan, SetReplacesAxesAndSettings) {
  const Experiment e = experiment(kTwoByThree);
  EXPECT_EQ(make_plan(e, {.set = {"latency_ms=20"}})->points.size(), 2U);
  EXPECT_EQ(make_plan(e, {.set = {"latency_ms=20,30", "seed=1,2"}})->points.size(), 8U);
  const Plan plan = make_plan(e, {.set = {"display=64x32", "display=128x64"}}).value();
  EXPECT_EQ(plan.points[0].settings.display, (Extent2D{128, 64})) << "the later one wins";
}

TEST(Plan, RefusesWhatWouldLie) {
  const Experiment e = experiment(kTwoByThree);
  const auto said = [&](const PlanRequest& request) {
    const auto plan = make_plan(e, request);
    return plan.has_error() ? plan.error().message() : "";
  };
  EXPECT_NE(said({.set = {"method=mesh"}}).find("variant 'A' sets method itself"), std::string::npos);
  EXPECT_NE(said({.set = {"latency_ms"}}).find("--set latency_ms: must be key=value"), std::string::npos);
  EXPECT_NE(said({.set = {"latency_ms=x"}}).find("--set latency_ms = x: must be 0..10000"),
            std::string::npos);
  EXPECT_NE(said({.set = {"latency=1"}}).find("did you mean latency_ms?"), std::string::npos);
  EXPECT_NE(said({.only = {"C"}}).find("--only C: there are 'A', 'B'"), std::string::npos);
  EXPECT_NE(said({.scenes = {{"nowhere.glb", "atrium"}}}).find("scene 'nowhere.glb'"), std::string::npos);
  EXPECT_NE(said({.scenes = {{"atrium:huge", ""}}}).find("atrium"), std::string::npos);
  EXPECT_NE(said({.set = {"path=nowhere.csv"}}).find("path 'nowhere.csv'"), std::string::npos);
  EXPECT_NE(said({.set = {"profile=carrier-pigeon", "latency_ms=0"}}).find("profile 'carrier-pigeon'"),
            std::string::npos);
  EXPECT_NE(said({.set = {"profile=lan"}}).find("latency_ms = 50: must be 0 with profile = lan"),
            std::string::npos);
  EXPECT_NE(said({.set = {"atlas=100x100"}}).find("multiples of 64"), std::string::npos);
}

TEST(Plan, RefusesTooManyPoints) {
  std::string many = "0";
  for (int i = 1; i < 400; ++i) many += "," + std::to_string(i);
  const auto plan = make_plan(experiment(""), {.set = {"seed=" + many, "latency_ms=" + many}});
  ASSERT_TRUE(plan.has_error());
  EXPECT_NE(plan.error().message().find("more than 100000 points"), std::string::npos);
}

TEST(Plan, QuickCutsValuesAndVariants) {
  const Experiment e = experiment(
      std::string(kTwoByThree) +
      "[quick]\nvariants = [\"B\"]\n[quick.sweep]\nlatency_ms = [0]\n[quick.settings]\nseconds = 1\n");
  const Plan plan = make_plan(e, {.quick = true}).value();
  EXPECT_EQ(plan.points.size(), 1U);
  EXPECT_EQ(plan.points[0].settings.seconds, 1);
  EXPECT_EQ(labels(plan), (std::vector<std::string>{"B"}));
}

TEST(Plan, ScenesComeWithTheirPaths) {
  const TemporaryFolder folder;
  folder.write("town.glb", "not read here");
  folder.write("town_path.csv", "0,0,0,0,0,0,0,1\n");
  const std::string scene = (folder.path() / "town.glb").string();
  const Plan plan = make_plan(experiment(kTwoByThree), {.scenes = {{"atrium:0.2", ""}, {scene, ""}}}).value();
  EXPECT_EQ(plan.points.size(), 12U);
  EXPECT_EQ(plan.points[0].settings.path, "atrium");
  EXPECT_TRUE(plan.points[6].settings.path.ends_with("town_path.csv"));
}

}  // namespace
}  // namespace atlaswire::lab
