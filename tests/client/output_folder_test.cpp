#include "client/output_folder.h"

#include "client/picture_writer.h"
#include "render/image/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace atlaswire::client {
namespace {

class OutputFolderTest : public ::testing::Test {
 protected:
  OutputFolderTest()
      : base_(std::filesystem::temp_directory_path() / ("atlaswire_output_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(base_);
  }
  ~OutputFolderTest() override { std::filesystem::remove_all(base_); }

  std::filesystem::path base_;
};

TEST_F(OutputFolderTest, MakesFoldersAndWritesText) {
  OutputFolder folder(base_ / "a" / "b");
  folder.write_text("summary.json", "{}\n");
  std::ifstream in(base_ / "a" / "b" / "summary.json");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "{}\n");
  EXPECT_EQ(folder.written().size(), 1U);
}

TEST_F(OutputFolderTest, RefusesAFolderThatCannotBe) {
  std::filesystem::create_directories(base_);
  std::ofstream(base_ / "file") << "x";
  try {
    OutputFolder folder(base_ / "file" / "sub");
    FAIL();
  } catch (const ProgramError& e) {
    EXPECT_EQ(e.code(), ExitCode::kCannotWrite);
    EXPECT_THAT(e.what(), ::testing::HasSubstr("--out"));
  }
}

TEST_F(OutputFolderTest, EmptyMeansNothingIsWritten) { EXPECT_FALSE(OutputFolder("").wanted()); }

TEST_F(OutputFolderTest, PictureWriterWritesInItsOwnThread) {
  std::filesystem::create_directories(base_);
  PictureWriter writer;
  EXPECT_TRUE(writer.write(base_ / "a.png", render::Picture({4, 4}, {1, 2, 3, 0})));
  EXPECT_TRUE(writer.write(base_ / "missing" / "b.png", render::Picture({4, 4})));
  const PictureWriter::Outcome outcome = writer.finish();
  EXPECT_EQ(outcome.written.size(), 1U);
  EXPECT_THAT(outcome.failure, ::testing::HasSubstr("b.png"));
  EXPECT_EQ(render::read_png(base_ / "a.png")->at(2, 2), (render::Rgba8{1, 2, 3, 255}));
}

}  // namespace
}  // namespace atlaswire::client
