#include "lab/experiment.h"

#include "lab/keys.h"
#include "lab/lab_error.h"
#include "lab/plan.h"

#include <gtest/gtest.h>

namespace atlaswire::lab {
namespace {

std::string error_of(std::string_view toml) {
  const auto e = parse_experiment(toml, "x.toml");
  return e.has_error() ? e.error().message() : "";
}

TEST(Experiment, ReadsAllParts) {
  const auto e = parse_experiment(R"(
name = "mine"
title = "A title"
figure = "fig. 1"
kind = "live"
[settings]
display = "640x360"
stereo = true
[[scenes]]
scene = "atrium"
path = "atrium"
[[variant]]
name = "ours"
method = "sas"
[[variant]]
name = "theirs"
method = "atw"
[sweep]
latency_ms = [0, 50.5]
bitrate_mbps = [5]
[around]
views = [1, 2]
[quick]
variants = "ours"
[quick.sweep]
latency_ms = [0]
[[plot]]
kind = "bars"
x = "variant"
y = "mssim"
[crossover]
x = "latency_ms"
y = "mssim"
reference = "ours"
[pareto]
most = "mssim"
least = ["total_mbps"]
[[recommend]]
client = "phone"
best = "mssim"
at_most = { total_mbps = 10 }
)",
                                  "x.toml");
  ASSERT_TRUE(e.has_value()) << e.error().message();
  EXPECT_TRUE(e->live);
  EXPECT_EQ(e->settings, (std::vector<Assignment>{{"display", "640x360"}, {"stereo", "true"}}));
  ASSERT_EQ(e->sweep.size(), 2U);
  EXPECT_EQ(e->sweep[0].key, "latency_ms") << "axes stay in the file's order";
  EXPECT_EQ(e->sweep[0].values, (std::vector<std::string>{"0", "50.5"}));
  ASSERT_EQ(e->variants.size(), 2U);
  EXPECT_EQ(e->variants[1].settings, (std::vector<Assignment>{{"method", "atw"}}));
  EXPECT_EQ(e->quick.variants, (std::vector<std::string>{"ours"}));
  EXPECT_EQ(e->plots.at(0).kind, Plot::Kind::kBars);
  EXPECT_EQ(e->crossover.reference, "ours");
  EXPECT_EQ(e->recommendations.at(0).at_most.at(0), (std::pair<std::string, double>{"total_mbps", 10}));
}

TEST(Experiment, RefusesInOneLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"name = ", "x.toml line 1: "},
      {"title = \"no name\"", "x.toml: name is missing or empty"},
      {"name = \"a\"\ncolour = 1", "x.toml: colour: unknown key"},
      {"name = \"a\"\n[settings]\nlatency = 1", "x.toml: settings.latency (did you mean latency_ms?)"},
      {"name = \"a\"\n[settings]\nlatency_ms = \"1\"", "x.toml: settings.latency_ms must be 0..10000"},
      {"name = \"a\"\n[settings]\nlatency_ms = -1", "x.toml: settings.latency_ms = -1: must be 0..10000"},
      {"name = \"a\"\n[settings]\nmethod = \"magic\"", "settings.method = magic: must be one of sas,"},
      {"name = \"a\"\n[settings]\nstereo = 1", "settings.stereo must be true or false"},
      {"name = \"a\"\n[sweep]\nviews = 1", "x.toml: sweep.views must be an array of values, not empty"},
      {"name = \"a\"\n[sweep]\nviews = []", "x.toml: sweep.views must be an array of values, not empty"},
      {"name = \"a\"\n[sweep]\nviews = [1, 2, 1]", "x.toml: sweep.views has 1 twice"},
      {"name = \"a\"\n[sweep]\nviews = [1, \"2\"]", "x.toml: sweep.views must be a whole number 1..16"},
      {"name = \"a\"\n[sweep]\nviews = [1]\n[around]\nviews = [2]",
       "x.toml: views is in both sweep and around"},
      {"name = \"a\"\nvariant = 3", "x.toml: variant must be an array"},
      {"name = \"a\"\n[[variant]]\nmethod = \"sas\"", "x.toml: variant.name is missing or empty"},
      {"name = \"a\"\n[[variant]]\nname = \"b\"\n[[variant]]\nname = \"b\"", "'b' is there twice"},
      {"name = \"a\"\n[[variant]]\nname = \"b\"\nmethd = \"sas\"",
       "variant.'b'.methd (did you mean method?)"},
      {"name = \"a\"\n[[plot]]\nx = \"views\"", "x.toml: plot.y is missing"},
      {"name = \"a\"\n[[plot]]\nx = \"views\"\ny = \"m\"\nkind = \"pie\"",
       "plot.kind must be one of line, bars, stack, scatter"},
      {"name = \"a\"\n[crossover]\nx = \"v\"\ny = \"m\"\nreference = \"r\"",
       "crossover.reference: no variant is named 'r'"},
      {"name = \"a\"\n[[recommend]]\nclient = \"c\"\nbest = \"m\"\nat_most = { x = \"y\" }",
       "at_most.x must be a number"},
      {"name = \"\xc3\xa4\"", "x.toml line 1: only ASCII is allowed"},
  };
  for (const auto& [toml, said] : cases) {
    const std::string line = error_of(toml);
    EXPECT_NE(line.find(said), std::string::npos) << "'" << line << "' for\n" << toml;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(Experiment, EveryShippedOneParsesAndPlansWholeAndQuick) {
  const std::vector<std::string> names = shipped_experiments();
  EXPECT_EQ(names, (std::vector<std::string>{"amortization", "atlas_size", "bitrate", "causes", "coherence",
                                             "endtoend", "grid", "join", "latency", "latency-bitrate",
                                             "motion", "network", "tradeoff", "upsampling", "walk"}));
  for (const std::string& name : names) {
    const auto e = parse_experiment(shipped_experiment_text(name), name);
    ASSERT_TRUE(e.has_value()) << e.error().message();
    EXPECT_EQ(e->name, name);
    EXPECT_FALSE(e->title.empty() || e->figure.empty() || e->plots.empty()) << name;
    const auto whole = make_plan(*e, {});
    const auto quick = make_plan(*e, {.quick = true});
    ASSERT_TRUE(whole.has_value()) << name << ": " << whole.error().message();
    ASSERT_TRUE(quick.has_value()) << name << ": " << quick.error().message();
    EXPECT_GE(quick->points.size(), 2U) << name;
    EXPECT_LT(quick->points.size(), whole->points.size()) << name;
  }
}

TEST(Experiment, LoadsFilesAndNames) {
  EXPECT_TRUE(load_experiment_text("latency").has_value());
  EXPECT_EQ(load_experiment_text("latencies").error().code, LabError::kNotFound);
  EXPECT_EQ(load_experiment_text("/nonexistent/x.toml").error().code, LabError::kNotFound);
  EXPECT_EQ(load_experiment_text("lab/experiments/latency.toml")->folder, "lab/experiments");
}

}  // namespace
}  // namespace atlaswire::lab
