#include "bench/stream_run.h"

#include "bench/row_output.h"
#include "bench/update_check.h"
#include "tests/bench/moving_recording.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace atlaswire::bench {
namespace {

MetaRecording without_cues(MetaRecording recording) {
  for (auto& update : recording.updates) update.cue.reset();
  return recording;
}

Row row_of(codec::MetaCodecKind kind, const MetaRecording& recording) {
  return run_stream(*make_own_rival(kind, recording), "strip", recording);
}

TEST(RunStream, CountsMotionWithinTotals) {
  const MetaRecording recording = without_cues(moving_recording(10));
  std::vector<std::unique_ptr<CodecRival>> rivals;
  rivals.push_back(make_naive_rival());
  rivals.push_back(make_draco_rival());
  rivals.push_back(make_meshopt_rival());
  rivals.push_back(make_own_rival(codec::MetaCodecKind::kPaper, recording));
  rivals.push_back(make_own_rival(codec::MetaCodecKind::kGate, recording));
  for (const auto& rival : rivals) {
    const Row row = run_stream(*rival, "strip", recording);
    EXPECT_GT(row.first_motion, 0) << row.codec;
    EXPECT_GT(row.motion, 0) << row.codec;
    EXPECT_DOUBLE_EQ(row.all(), row.mesh + row.blocks + row.motion) << row.codec;
    EXPECT_GE(row.encode, row.motion_encode) << row.codec;
    EXPECT_GE(row.decode, row.motion_decode) << row.codec;
  }
}

TEST(RunStream, NaiveMotionIsItsStructs) {
  const MetaRecording recording = without_cues(moving_recording(4));
  const Row row = run_stream(*make_naive_rival(), "strip", recording);
  EXPECT_EQ(row.motion, 42 * 16 + 32);
}

TEST(RunStream, HasNoMotionWhereNothingMoves) {
  MetaRecording recording = without_cues(moving_recording(4));
  recording.motion.reset();
  EXPECT_EQ(row_of(codec::MetaCodecKind::kGate, recording).motion, 0);
}

TEST(RunStream, MirrorRunsTheAtlassMemory) {
  // The cues' checks are of no layout at all.
  EXPECT_THROW(row_of(codec::MetaCodecKind::kMirror, moving_recording(4)), std::runtime_error);
}

TEST(UpdateCheck, SeesWhatDiffers) {
  const codec::MetaUpdate told = moving_recording(1).updates[0];
  const auto differs = [&](const std::function<void(codec::MetaUpdate&)>& change) {
    codec::MetaUpdate heard = told;
    change(heard);
    try {
      UpdateCheck().compare(told, heard);
    } catch (const std::runtime_error&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(differs([](codec::MetaUpdate&) {}));
  EXPECT_FALSE(differs([](codec::MetaUpdate& u) { std::swap(u.added[0], u.added[5]); }));
  EXPECT_TRUE(differs([](codec::MetaUpdate& u) { ++u.vertices[3].position.y; }));
  EXPECT_TRUE(differs([](codec::MetaUpdate& u) { std::swap(u.added[2].corners[0], u.added[2].corners[1]); }));
  EXPECT_TRUE(differs([](codec::MetaUpdate& u) { u.added[2].block.x += 8; }));
  EXPECT_TRUE(differs([](codec::MetaUpdate& u) { u.added.pop_back(); }));
  EXPECT_TRUE(differs([](codec::MetaUpdate& u) { u.removed.push_back(PatchId{1}); }));
}

TEST(TriangleSetHash, KnowsNoOrderButOrientation) {
  const std::vector<GridPosition> p{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {9, 9, 5}};
  const auto hash = triangle_set_hash(p, {0, 1, 2, 2, 1, 3});
  EXPECT_EQ(hash, triangle_set_hash(p, {3, 2, 1, 1, 2, 0}));
  EXPECT_NE(hash, triangle_set_hash(p, {0, 2, 1, 2, 1, 3}));
  EXPECT_NE(hash, triangle_set_hash(p, {0, 1, 2}));
}

TEST(RowOutput, WritesTheSameFieldsToBothFiles) {
  const MetaRecording recording = without_cues(moving_recording(3));
  const std::vector<Row> rows{row_of(codec::MetaCodecKind::kGate, recording)};
  const std::string stem = ::testing::TempDir() + "row_output_test";
  write_csv(rows, stem + ".csv");
  write_json(rows, stem + ".json");
  std::ifstream csv(stem + ".csv");
  std::string head;
  std::string line;
  std::getline(csv, head);
  std::getline(csv, line);
  const auto json = nlohmann::json::parse(std::ifstream(stem + ".json"));
  ASSERT_EQ(json.size(), 1U);
  std::istringstream names(head);
  std::istringstream values(line);
  std::string name;
  std::size_t fields = 0;
  for (std::string text; std::getline(names, name, ',') && std::getline(values, text, ','); ++fields) {
    ASSERT_TRUE(json[0].contains(name)) << name;
    if (json[0][name].is_string()) {
      EXPECT_EQ(json[0][name], text);
    } else {
      EXPECT_DOUBLE_EQ(json[0][name].get<double>(), std::stod(text)) << name;
    }
  }
  EXPECT_EQ(fields, json[0].size());
  std::remove((stem + ".csv").c_str());
  std::remove((stem + ".json").c_str());
}

}  // namespace
}  // namespace atlaswire::bench
