#include "lab/store.h"

#include "base/program.h"
#include "lab/keys.h"
#include "lab/lab_error.h"
#include "tests/lab/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace atlaswire::lab {
namespace {

PointRecord record(const std::string& id, const std::string& commit) {
  PointRecord r{id, all_values({}), {{"commit", commit}, {"device", "a \"quoted\" one"}}, 1.25, {}};
  r.result.figures = {
      {"mssim", 0.1 + 0.2}, {"psnr", std::numeric_limits<double>::infinity()}, {"flip", kNotApplicable}};
  r.result.timings = {{"server_frame_ms", 12.5}};
  r.result.frames = {{.t_s = 1.0 / 3, .mssim = 0.5}};
  return r;
}

void keep(const Store& store, const PointRecord& r) {
  std::filesystem::create_directories(store.point_folder(r.id));
  write_whole(store.point_folder(r.id) / "result.json", to_json(r));
}

TEST(Store, RecordsSurviveExactly) {
  const PointRecord before = record("0123456789abcdef", "c1");
  const auto after = parse_record(to_json(before));
  ASSERT_TRUE(after.has_value()) << after.error().message();
  EXPECT_EQ(after->id, before.id);
  EXPECT_EQ(after->settings, before.settings);
  EXPECT_EQ(after->provenance, before.provenance);
  EXPECT_EQ(after->result.figures[0].value, 0.1 + 0.2);
  EXPECT_TRUE(std::isinf(after->result.figures[1].value));
  EXPECT_TRUE(std::isnan(after->result.figures[2].value));
  EXPECT_EQ(after->result.frames[0].t_s, 1.0 / 3);
  EXPECT_TRUE(std::isnan(after->result.frames[0].holes));
  EXPECT_EQ(to_json(*after), to_json(before));
}

TEST(Store, RefusesTruncatedRecords) {
  const std::string whole = to_json(record("0123456789abcdef", "c1"));
  for (std::size_t length = 0; length + 2 < whole.size(); length += 7) {
    EXPECT_TRUE(parse_record(whole.substr(0, length)).has_error()) << length;
  }
  EXPECT_TRUE(parse_record("{}").has_error());
  EXPECT_TRUE(parse_record("[1]").has_error());
}

TEST(Store, FinishedPointsAreThoseWithAResult) {
  const TemporaryFolder folder;
  const Store store(folder.path());
  EXPECT_TRUE(store.finished().empty());
  store.make_folders();
  keep(store, record("bb", "c1"));
  keep(store, record("aa", "c1"));
  std::filesystem::create_directories(store.point_folder("cc"));
  EXPECT_EQ(store.finished(), (std::vector<std::string>{"aa", "bb"}));
  EXPECT_TRUE(store.load("aa").has_value());
  EXPECT_EQ(store.load("cc").error().code, LabError::kNotFound);
  folder.write("points/dd/result.json", to_json(record("ee", "c1")));
  EXPECT_EQ(store.load("dd").error().code, LabError::kBadRecord) << "a moved result";
  store.clear();
  EXPECT_TRUE(store.finished().empty());
}

TEST(Store, PointsOfAnotherCommitAreRefusedWithTheCure) {
  const TemporaryFolder folder;
  const Store store(folder.path());
  store.make_folders();
  keep(store, record("aa", "c1"));
  EXPECT_TRUE(store.check_commit("c1").has_value());
  const auto refused = store.check_commit("c1+dirty.12345678");
  ASSERT_TRUE(refused.has_error());
  EXPECT_EQ(refused.error().code, LabError::kOtherCommit);
  EXPECT_NE(refused.error().message().find("--fresh"), std::string::npos);
}

TEST(Store, SaysWhichFileCannotBeWritten) {
  try {
    write_whole("/nonexistent/folder/file", "text");
    FAIL();
  } catch (const ProgramError& e) {
    EXPECT_EQ(e.code(), ExitCode::kCannotWrite);
    EXPECT_NE(std::string(e.what()).find("/nonexistent/folder/file"), std::string::npos);
  }
}

}  // namespace
}  // namespace atlaswire::lab
