#include "lab/options.h"

#include "tests/lab/temporary_folder.h"

#include <gtest/gtest.h>

namespace atlaswire::lab {
namespace {

using Command = LabOptions::Command;

LabOptions parse(std::vector<const char*> words) {
  words.insert(words.begin(), "atlas-lab");
  return parse_lab_options(static_cast<int>(words.size()), words.data());
}

std::string refusal(std::vector<const char*> words) {
  try {
    parse(std::move(words));
    return "";
  } catch (const ProgramError& e) {
    EXPECT_EQ(e.code(), ExitCode::kUsage);
    return e.what();
  }
}

TEST(LabOptions, ReadsARun) {
  const LabOptions o =
      parse({"run", "latency", "--quick", "--set", "latency_ms=0,50", "--set", "seed=2", "--only", "ATW",
             "--jobs", "3", "--out", "o", "--fresh", "--json", "--no-report"});
  EXPECT_EQ(o.command, Command::kRun);
  EXPECT_EQ(o.run.experiment, "latency");
  EXPECT_TRUE(o.run.request.quick);
  EXPECT_EQ(o.run.request.set, (std::vector<std::string>{"latency_ms=0,50", "seed=2"}));
  EXPECT_EQ(o.run.request.only, (std::vector<std::string>{"ATW"}));
  EXPECT_EQ(o.run.jobs, 3U);
  EXPECT_FALSE(o.run.report);
  EXPECT_TRUE(parse({"run", "latency"}).run.report);
}

TEST(LabOptions, PathsGoWithScenesByPlace) {
  const LabOptions o = parse({"plan", "latency", "--scene", "a.glb", "--scene", "b.glb", "--path", "a.csv"});
  EXPECT_EQ(o.command, Command::kPlan);
  ASSERT_EQ(o.run.request.scenes.size(), 2U);
  EXPECT_EQ(o.run.request.scenes[0].path, "a.csv");
  EXPECT_EQ(o.run.request.scenes[1].path, "");
  EXPECT_EQ(parse({"run", "latency", "--path", "p.csv"}).run.request.set,
            (std::vector<std::string>{"path=p.csv"}));
}

TEST(LabOptions, ReadsAConfigFile) {
  const TemporaryFolder folder;
  folder.write("lab.toml", "[run]\njobs = 2\nquick = true\n");
  const std::string file = (folder.path() / "lab.toml").string();
  const LabOptions o = parse({"--config", file.c_str(), "run", "latency", "--jobs", "4"});
  EXPECT_TRUE(o.run.request.quick);
  EXPECT_EQ(o.run.jobs, 4U) << "the command line wins";
}

TEST(LabOptions, HelpTeaches) {
  const LabOptions o = parse({"--help"});
  EXPECT_EQ(o.command, Command::kPrint);
  EXPECT_NE(o.text.find("atlas-lab run latency --quick"), std::string::npos);
  EXPECT_NE(parse({"run", "--help"}).text.find("--set"), std::string::npos);
}

TEST(LabOptions, RefusesInOneLine) {
  EXPECT_NE(refusal({}).find("see atlas-lab --help"), std::string::npos);
  EXPECT_NE(refusal({"run"}).find("experiment is required"), std::string::npos);
  EXPECT_NE(refusal({"run", "latency", "--jobs", "5000"}).find("--jobs 5000: must be 0..1024"),
            std::string::npos);
  EXPECT_NE(refusal({"run", "latency", "--path", "a", "--path", "b"}).find("more paths than scenes"),
            std::string::npos);
  EXPECT_NE(refusal({"fly"}).find("see atlas-lab --help"), std::string::npos);
}

}  // namespace
}  // namespace atlaswire::lab
