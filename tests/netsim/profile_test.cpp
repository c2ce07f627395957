#include "netsim/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace atlaswire::netsim {
namespace {

using testing::HasSubstr;

Error error_of(const char* toml) {
  const auto parsed = parse_profile(toml, "test.toml", ".");
  EXPECT_TRUE(parsed.has_error()) << toml;
  return parsed.error();
}

TEST(Profile, EveryShippedOneLoadsAndNamesItsSource) {
  for (const std::string& name : shipped_profiles()) {
    const auto profile = load_profile(name);
    ASSERT_TRUE(profile.has_value()) << name << ": " << profile.error().message();
    EXPECT_EQ(profile->name, name);
    EXPECT_FALSE(profile->source.empty()) << name;
    EXPECT_FALSE(profile->description.empty()) << name;
  }
}

TEST(Profile, ReadsBothDirectionsAndSteps) {
  const auto p = parse_profile(R"(
name = "x"
[both]
delay = { shape = "normal", base_ms = 12.5, spread_ms = 2, correlation = 0.5 }
loss = { kind = "bernoulli", probability = 0.25 }
rate = { mbps = 1.5, burst_kb = 2 }
queue = { policy = "pie", limit_kb = 10, ecn = true }
[[both.step]]
at_ms = 100
down = true
)",
                               "x", ".");
  ASSERT_TRUE(p.has_value()) << p.error().message();
  ASSERT_EQ(p->up.steps.size(), 2U);
  EXPECT_TRUE(p->up.steps[1].down);
  const LinkParameters& link = p->down.steps[0].parameters;
  EXPECT_EQ(link.delay.base, std::chrono::microseconds(12'500));
  EXPECT_EQ(link.loss.probability, 0.25);
  EXPECT_EQ(link.rate.rate->bits_per_second, 1'500'000U);
  EXPECT_EQ(link.rate.burst.count, 2048U);
  EXPECT_EQ(link.queue.target, std::chrono::milliseconds(15));
}

TEST(Profile, RefusesWhatCannotBe) {
  EXPECT_EQ(error_of("[up]\nrate = { mbps = -1 }").code, ProfileError::kOutOfRange);
  EXPECT_EQ(error_of("[up]\nloss = { kind = \"bernoulli\", probability = 1.5 }").code,
            ProfileError::kOutOfRange);
  EXPECT_EQ(error_of("[up]\nloss = { probability = nan }").code, ProfileError::kOutOfRange);
  EXPECT_EQ(error_of("[up]\ndelay = { base_ms = inf }").code, ProfileError::kOutOfRange);
  EXPECT_EQ(error_of("[up]\ndelay = { shape = \"cubic\" }").code, ProfileError::kOutOfRange);
  EXPECT_EQ(error_of("[up]\ndelay = { shape = \"empirical\" }").code, ProfileError::kOutOfRange);
  EXPECT_EQ(error_of("[up]\ndelay = 3").code, ProfileError::kOutOfRange);
  EXPECT_EQ(error_of("[up]\nrate = { mbps = 1, trace = \"x\" }").code, ProfileError::kOutOfRange);
  EXPECT_EQ(error_of("[up]\nrate = { trace = \"missing\" }").code, ProfileError::kCannotRead);
  EXPECT_EQ(error_of("[up]\nspeed = 3").code, ProfileError::kUnknownKey);
  EXPECT_EQ(error_of("[up]\nrate = { mbs = 3 }").code, ProfileError::kUnknownKey);
  EXPECT_EQ(error_of("[up\n").code, ProfileError::kSyntax);
  EXPECT_EQ(error_of("[up]\n[[up.step]]\nat_ms = 0").code, ProfileError::kOutOfRange);
  EXPECT_THAT(error_of("[up]\nrate = { mbps = -1 }").message(),
              HasSubstr("test.toml: up.rate.mbps must be a number from 0"));
}

constexpr const char* kThreePaths = R"(
[both]
delay = { base_ms = 10 }
rate = { mbps = 8 }
[[flow]]
kind = "datagram"
numbers = [7, 3]
[flow.both]
delay = { base_ms = 1 }
[[flow]]
kind = "stream"
[flow.down]
delay = { base_ms = 50 }
[[flow.down.step]]
at_ms = 100
down = true
)";

TEST(Profile, FlowsHaveThePathOfTheFirstRuleThatMatches) {
  const auto p = parse_profile(kThreePaths, "x", ".");
  ASSERT_TRUE(p.has_value()) << p.error().message();
  EXPECT_EQ(p->paths(), 3U);
  EXPECT_EQ(p->path_of(FlowId{1}, FlowKind::kDatagram), PathId{0});
  EXPECT_EQ(p->path_of(FlowId{3}, FlowKind::kDatagram), PathId{1});
  EXPECT_EQ(p->path_of(FlowId{7}, FlowKind::kDatagram), PathId{1});
  EXPECT_EQ(p->path_of(FlowId{3}, FlowKind::kStream), PathId{2});
  const auto first = [&](PathId path, Direction d) -> const LinkParameters& {
    return p->link(path, d).steps[0].parameters;
  };
  EXPECT_EQ(first(PathId{1}, Direction::kUp).delay.base, std::chrono::milliseconds(1));
  EXPECT_FALSE(first(PathId{1}, Direction::kUp).rate.rate.has_value()) << "replaced whole";
  EXPECT_EQ(first(PathId{2}, Direction::kUp).delay.base, std::chrono::milliseconds(10))
      << "not named: as the shared path";
  EXPECT_EQ(p->link(PathId{2}, Direction::kDown).steps.size(), 2U);
  EXPECT_EQ(first(PathId{0}, Direction::kDown).delay.base, std::chrono::milliseconds(10));
}

TEST(Profile, RefusesRulesThatSayNothing) {
  const std::pair<const char*, const char*> cases[] = {
      {"[[flow]]\n", "test.toml: flow.kind or numbers must say which flows"},
      {"[[flow]]\nkind = \"stream\"\nnumbers = []", "flow.kind or numbers must say which flows"},
      {"[[flow]]\nkind = \"tcp\"", "flow.kind must be one of datagram, stream"},
      {"[[flow]]\nnumbers = [0]", "flow.numbers must hold whole numbers from 1 to 4294967295"},
      {"[[flow]]\nnumbers = [1.5]", "flow.numbers must hold whole numbers"},
      {"[[flow]]\nnumbers = 3", "flow.numbers must be an array"},
      {"[[flow]]\nkind = \"stream\"\nrate = { mbps = 1 }", "flow.rate"},
      {"[[flow]]\nkind = \"stream\"\n[flow.up]\nrate = { mbps = -1 }", "flow.up.rate.mbps must be a number"},
      {"[flow]\nkind = \"stream\"", "flow must be an array"},
      {"flow = [1]", "flow must be an array of tables"},
  };
  for (const auto& [toml, expected] : cases)
    EXPECT_THAT(error_of(toml).message(), HasSubstr(expected)) << toml;
  std::string many;
  for (std::size_t i = 0; i <= Profile::kMostRules; ++i) many += "[[flow]]\nkind = \"stream\"\n";
  EXPECT_THAT(error_of(many.c_str()).message(), HasSubstr("more than 16 rules"));
}

TEST(Profile, UnknownNamesAndFilesSaySo) {
  EXPECT_EQ(load_profile("carrier-pigeon").error().code, ProfileError::kUnknownName);
  EXPECT_EQ(load_profile("no/such.toml").error().code, ProfileError::kCannotRead);
}

TEST(Trace, ReadsMahimahiLines) {
  const auto model = parse_trace("0\n1\n1\r\n\n7\n");
  ASSERT_TRUE(model.has_value()) << model.error().message();
  EXPECT_EQ(model->trace.size(), 4U);
  EXPECT_EQ(model->trace_period, std::chrono::milliseconds(7));
}

TEST(Trace, RefusesMalformedOnes) {
  for (const char* text : {"", "\n\n", "0\n", "5\n4\n", "-1\n", "1.5\n", "x\n", "99999999999\n"}) {
    const auto model = parse_trace(text);
    ASSERT_TRUE(model.has_error()) << text;
    EXPECT_EQ(model.error().code, ProfileError::kBadTrace) << text;
  }
  EXPECT_THAT(parse_trace("5\n4\n").error().message(), HasSubstr("line 2 goes back in time"));
}

TEST(Profile, BrokenTablesAreErrorsInEveryBuildType) {
  for (const char* text :
       {"[\n", "[\nrate = { trace = \"x\" }\n", "[[\n", "[a.\n", "=", "a = {", "a = [1,,2]",
        "[up]\n\xCF\x87"
        "ate = 1\n"}) {
    const auto profile = parse_profile(text, "broken", ".");
    ASSERT_TRUE(profile.has_error()) << text;
    EXPECT_EQ(profile.error().code, make_error_code(ProfileError::kSyntax)) << text;
  }
}

}  // namespace
}  // namespace atlaswire::netsim
