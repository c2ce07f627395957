#include "tests/netsim/loopback.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace atlaswire::netsim {
namespace {

std::pair<int, std::string> netsim(const std::string& arguments) {
  return run_command(std::string(AW_NETSIM_PROGRAM) + " " + arguments);
}

/// Each test is a process of its own, and two may run at once.
std::string temporary(const std::string& name) {
  return testing::TempDir() + "netsim_program_test_" + std::to_string(getpid()) + "_" + name;
}

TEST(NetsimProgram, ExplainsItself) {
  const auto [code, help] = netsim("--help");
  EXPECT_EQ(code, 0);
  for (const char* word : {"--listen", "--to", "--profile", "Examples", "Exit codes"}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
  const auto [list_code, list] = netsim("--list");
  EXPECT_EQ(list_code, 0);
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 18);
  const auto [show_code, show] = netsim("--show lte");
  EXPECT_EQ(show_code, 0);
  EXPECT_NE(show.find("name = \"lte\""), std::string::npos);
}

TEST(NetsimProgram, WrongUsageIsOneClearLineAndCodeTwo) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "needs --listen and --to"},
      {"--listen 0 --to 127.0.0.1:9", "needs --profile"},
      {"--listen 0 --to 127.0.0.1:9 --profile nowhere", "'nowhere': unknown profile"},
      {"--listen 0 --to 127.0.0.1:9 --profile /nonexistent.toml", "cannot be read"},
      {"--listen 70000 --to 127.0.0.1:9 --profile lan", "--listen 70000"},
      {"--listen here:1 --to 127.0.0.1:9 --profile lan", "must be an IP address"},
      {"--listen 0 --to 127.0.0.1 --profile lan", "--to 127.0.0.1"},
      {"--listen 0 --to :9 --profile lan", "--to :9"},
      {"--listen 0 --to 127.0.0.1:9 --profile lan --duration -1", "--duration -1"},
      {"--show nowhere", "--show nowhere"},
      {"--wat", "--wat"},
      {"--profile lan --replay /nonexistent.csv", "cannot read"},
      {"--profile lan --draw x.csv --load fast", "--load fast"},
  };
  for (const auto& [arguments, expected] : cases) {
    const auto [code, output] = netsim(arguments);
    EXPECT_EQ(code, 2) << arguments << ": " << output;
    EXPECT_NE(output.find(expected), std::string::npos) << arguments << ": " << output;
    EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
  }
}

TEST(NetsimProgram, APortInUseIsCodeFive) {
  for (const auto kind : {LoopbackSocket::Kind::kTcp, LoopbackSocket::Kind::kUdp}) {
    const LoopbackSocket holder(kind);
    const std::uint16_t port = holder.bind_and_listen(kind);
    ASSERT_NE(port, 0);
    const auto [code, output] =
        netsim("--listen " + std::to_string(port) + " --to 127.0.0.1:9 --profile lan --duration 1");
    EXPECT_EQ(code, 5) << output;
    EXPECT_NE(output.find("port " + std::to_string(port)), std::string::npos) << output;
    EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
  }
}

TEST(NetsimProgram, FilesThatCannotBeWrittenAreCodeNine) {
  const std::string relay = "--listen 0 --to 127.0.0.1:9 --profile lan --duration 0.1 ";
  EXPECT_EQ(netsim(relay + "--log /nonexistent/x.csv").first, 9);
  EXPECT_EQ(netsim(relay + "--pcapng /nonexistent/x.pcapng").first, 9);
  EXPECT_EQ(netsim(relay + "--ready-file /nonexistent/x").first, 9);
  EXPECT_EQ(netsim("--profile lan --draw /nonexistent/x.csv").first, 9);
}

TEST(NetsimProgram, ADrawnProfileReplaysAndAnAlteredLineIsShown) {
  const std::string file = temporary("probe.csv");
  ASSERT_EQ(netsim("--profile lossy-wifi --seed 5 --draw " + file + " --load 30M --duration 2").first, 0);
  const auto [code, output] = netsim("--profile lossy-wifi --seed 5 --replay " + file);
  EXPECT_EQ(code, 0) << output;
  EXPECT_NE(output.find("12500 decisions, all identical"), std::string::npos)
      << "2 s of 30 Mbps in packets of 1200 octets, both ways: " << output;
  const auto [other_code, other] = netsim("--profile lossy-wifi --seed 6 --replay " + file);
  EXPECT_EQ(other_code, 1);
  EXPECT_NE(other.find("first difference, at decision 1 of 12500"), std::string::npos) << other;
}

TEST(NetsimProgram, RunsForItsDurationFromAConfigFileAndReports) {
  const std::string config = temporary("netsim.toml");
  const std::string ready = temporary("ready.json");
  std::ofstream(config) << "listen = \"0\"\nto = \"127.0.0.1:9\"\nprofile = \"lan\"\nduration = 0.2\n"
                        << "ready-file = \"" << ready << "\"\njson = true\n";
  const auto [code, output] = netsim("--config " + config);
  EXPECT_EQ(code, 0) << output;
  EXPECT_NE(output.find("\"profile\": \"lan\""), std::string::npos) << output;
  std::string line;
  std::ifstream written(ready);
  std::getline(written, line);
  EXPECT_EQ(line.find("{\"port\":"), 0U) << line;
  std::ofstream(config) << "colour = \"red\"\n";
  EXPECT_EQ(netsim("--config " + config).first, 2);
}

}  // namespace
}  // namespace atlaswire::netsim
