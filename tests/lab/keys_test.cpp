#include "lab/keys.h"

#include "lab/lab_error.h"

#include <gtest/gtest.h>

#include <set>

namespace atlaswire::lab {
namespace {

TEST(Keys, NamesAreUniqueAndFound) {
  std::set<std::string_view> names;
  for (const Key& key : keys()) {
    EXPECT_TRUE(names.insert(key.name).second) << key.name;
    EXPECT_EQ(find_key(key.name), &key);
  }
  EXPECT_EQ(find_key("nonsense"), nullptr);
}

TEST(Keys, DefaultsAreAllowedAndSurviveTheirText) {
  const PointSettings defaults;
  for (const Key& key : keys()) {
    PointSettings other;
    const std::string text = value_text(key, defaults);
    ASSERT_TRUE(set_value(key, text, other).has_value()) << key.name << " = " << text;
    EXPECT_EQ(value_text(key, other), text);
    EXPECT_FALSE(allowed_text(key).empty());
  }
  EXPECT_TRUE(check_together(defaults).has_value());
}

TEST(Keys, EveryMemberOfTheSettingsHasAKey) {
  // Bytes that no key can change would be a member without one: every setting set differently must show.
  PointSettings s;
  for (const Key& key : keys()) {
    const std::string before = value_text(key, s);
    for (const char* text : {"true", "false", "medium", "atw", "coded", "gate", "repack", "other", "64x64",
                             "9", "2", "0.5", "1.5"}) {
      if (set_value(key, text, s).has_value() && value_text(key, s) != before) break;
    }
    EXPECT_NE(value_text(key, s), before) << key.name;
  }
  EXPECT_EQ(keys().size(), 40U);  // members of PointSettings
}

TEST(Keys, RealNumbersSurviveExactly) {
  PointSettings s;
  ASSERT_TRUE(set_value("prediction_step_ms", "33.333333333333336", s).has_value());
  EXPECT_EQ(s.prediction_step_ms, 1000.0 / 30);
}

struct Refused {
  const char* key;
  const char* text;
  const char* said;
};

TEST(Keys, RefusesInOneLineThatNamesKeyValueAndRange) {
  const Refused cases[] = {
      {"latency_ms", "-1", "latency_ms = -1: must be 0..10000"},
      {"latency_ms", "nan", "latency_ms = nan: must be 0..10000"},
      {"latency_ms", "50ms", "latency_ms = 50ms: must be 0..10000"},
      {"latency_ms", "", "latency_ms = : must be 0..10000"},
      {"views", "2.5", "views = 2.5: must be a whole number 1..16"},
      {"seed", "-1", "seed = -1: must be a whole number 0..9007199254740992"},
      {"method", "magic", "method = magic: must be one of sas, atw, mesh, iterative"},
      {"method", "sas atw", "method = sas atw: must be one of sas, atw, mesh, iterative"},
      {"stereo", "yes", "stereo = yes: must be true or false"},
      {"atlas", "2048", "atlas = 2048: must be WxH, sides 64..8192"},
      {"atlas", "32x64", "atlas = 32x64: must be WxH, sides 64..8192"},
      {"scene", "a\nb", "must be text of one line"},
  };
  for (const Refused& c : cases) {
    PointSettings s;
    const auto result = set_value(c.key, c.text, s);
    ASSERT_TRUE(result.has_error()) << c.key << " = " << c.text;
    EXPECT_NE(result.error().message().find(c.said), std::string::npos) << result.error().message();
    EXPECT_EQ(all_values(s), all_values({})) << "a refused value must change nothing";
  }
}

TEST(Keys, SuggestsTheNearestKey) {
  PointSettings s;
  const auto result = set_value("latency", "5", s);
  ASSERT_TRUE(result.has_error());
  EXPECT_EQ(result.error().code, LabError::kUnknownKey);
  EXPECT_NE(result.error().message().find("did you mean latency_ms?"), std::string::npos);
}

TEST(Keys, ChecksSettingsTogether) {
  PointSettings s;
  s.atlas = {1000, 1024};
  EXPECT_TRUE(check_together(s).has_error());
  s = {};
  s.grid_bits = 5;
  EXPECT_TRUE(check_together(s).has_error());
  s = {};
  s.profile = "lan";
  EXPECT_TRUE(check_together(s).has_value());
  s.latency_ms = 10;
  EXPECT_TRUE(check_together(s).has_error());
  s = {};
  s.lens = "0.1,0.2";
  EXPECT_TRUE(check_together(s).has_value());
  s.lens = "fish";
  ASSERT_TRUE(check_together(s).has_error());
  EXPECT_NE(check_together(s).error().message().find("lens = fish"), std::string::npos);
}

}  // namespace
}  // namespace atlaswire::lab
