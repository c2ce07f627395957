#include "bench/meta_recording.h"

#include "bench/update_check.h"
#include "tests/bench/moving_recording.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace atlaswire::bench {
namespace {

/// A file's name in the temporary folder; gone at the end.
struct TemporaryFile {
  TemporaryFile()
      : path(::testing::TempDir() + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
             ".meta") {}
  ~TemporaryFile() { std::remove(path.c_str()); }
  std::string path;
};

TEST(MetaRecording, ComesBackAsItWasWritten) {
  const MetaRecording told = moving_recording(9);
  const TemporaryFile file;
  write_recording(told, file.path);
  const MetaRecording heard = read_recording(file.path).value();
  EXPECT_EQ(heard.limits.max_vertices, told.limits.max_vertices);
  EXPECT_EQ(heard.limits.max_patches, told.limits.max_patches);
  EXPECT_EQ(heard.limits.grid_bits, told.limits.grid_bits);
  EXPECT_EQ(heard.limits.atlas.height, told.limits.atlas.height);
  EXPECT_EQ(heard.memory, told.memory);
  ASSERT_EQ(heard.updates.size(), 9U);
  UpdateCheck check;
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NO_THROW(check.compare(told.updates[i], heard.updates[i]));
    EXPECT_EQ(heard.updates[i].cue->reset, i == 3);
    EXPECT_EQ(heard.updates[i].cue->check, 1000 + i);
  }
}

TEST(MetaRecording, BringsItsMovers) {
  const MetaRecording told = moving_recording(9);
  const TemporaryFile file;
  write_recording(told, file.path);
  const RecordedMotion heard = read_recording(file.path).value().motion.value();
  EXPECT_EQ(heard.movers, told.motion->movers);
  EXPECT_EQ(heard.settings.grid.origin, told.motion->settings.grid.origin);
  EXPECT_EQ(heard.settings.grid.step, told.motion->settings.grid.step);
  EXPECT_EQ(heard.settings.grid.bits, told.motion->settings.grid.bits);
  EXPECT_EQ(heard.settings.transforms.step, told.motion->settings.transforms.step);
  EXPECT_EQ(heard.settings.transforms.rotation_bits, told.motion->settings.transforms.rotation_bits);
  ASSERT_EQ(heard.frames.size(), 9U);
  EXPECT_EQ(heard.frames[3].positions.size(), 42U);
  EXPECT_EQ(heard.frames[5].positions.size(), 22U);
  EXPECT_TRUE(heard.frames[5].transforms.empty());
  for (std::size_t i = 0; i < 9; ++i) {
    const MoverPlaces& was = told.motion->frames[i];
    EXPECT_EQ(heard.frames[i].positions, was.positions);
    ASSERT_EQ(heard.frames[i].transforms.size(), was.transforms.size());
    if (was.transforms.empty()) continue;
    EXPECT_EQ(heard.frames[i].transforms[0].translation, was.transforms[0].translation);
    EXPECT_EQ(heard.frames[i].transforms[0].orientation, was.transforms[0].orientation);
  }
}

TEST(MetaRecording, NeedsNoMovers) {
  MetaRecording told = moving_recording(3);
  told.motion.reset();
  for (auto& update : told.updates) update.cue.reset();
  const TemporaryFile file;
  write_recording(told, file.path);
  const MetaRecording heard = read_recording(file.path).value();
  EXPECT_FALSE(heard.motion);
  ASSERT_EQ(heard.updates.size(), 3U);
  EXPECT_FALSE(heard.updates[0].cue);
}

TEST(MetaRecording, RefusesWhatIsCutOffOrLonger) {
  const TemporaryFile file;
  write_recording(moving_recording(3), file.path);
  std::string bytes;
  {
    std::ifstream in(file.path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  const auto readable = [&](const std::string& content) {
    std::ofstream(file.path, std::ios::binary) << content;
    return read_recording(file.path).has_value();
  };
  EXPECT_TRUE(readable(bytes));
  EXPECT_FALSE(readable(bytes + "x"));
  for (std::size_t size = 0; size < bytes.size(); size += 13)
    EXPECT_FALSE(readable(bytes.substr(0, size))) << size;
}

}  // namespace
}  // namespace atlaswire::bench
