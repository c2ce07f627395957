#include "render/image/png.h"

#include "base/random.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace atlaswire::render {
namespace {

class Png : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    directory_ =
        std::filesystem::temp_directory_path() / ("atlaswire_png_" + name + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path directory_;
};

Picture noise(Extent2D extent) {
  Random random(1);
  Picture picture(extent);
  for (auto& byte : picture.rgba) byte = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

TEST_F(Png, RoundTripsEveryByteAndLeavesNoOtherFile) {
  const auto path = directory_ / "a.png";
  for (const Extent2D extent : {Extent2D{1, 1}, Extent2D{33, 7}, Extent2D{300, 200}}) {
    const Picture picture = noise(extent);
    ASSERT_FALSE(write_png(picture, path).has_error());
    const auto back = read_png(path);
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(*back, picture);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_), {}), 1);
}

TEST_F(Png, FailsWithTheNameOfTheFile) {
  const auto into_nowhere = write_png(noise({2, 2}), directory_ / "none" / "a.png");
  ASSERT_TRUE(into_nowhere.has_error());
  EXPECT_EQ(into_nowhere.error().code, make_error_code(PictureError::kCannotWrite));
  EXPECT_NE(into_nowhere.error().message().find("a.png"), std::string::npos);
  EXPECT_EQ(write_png(Picture(), directory_ / "a.png").error().code, make_error_code(PictureError::kEmpty));
  EXPECT_EQ(read_png(directory_ / "none.png").error().code, make_error_code(PictureError::kCannotRead));
}

TEST_F(Png, KeepsTheOldFileWhenRenamingFails) {
  const auto path = directory_ / "a.png";
  std::filesystem::create_directories(path / "in the way");
  EXPECT_TRUE(write_png(noise({2, 2}), path).has_error());
  EXPECT_TRUE(std::filesystem::is_directory(path));
  EXPECT_FALSE(std::filesystem::exists(directory_ / "a.png.part"));
}

TEST_F(Png, RejectsBrokenFiles) {
  const auto path = directory_ / "a.png";
  ASSERT_FALSE(write_png(noise({20, 20}), path).has_error());
  std::ifstream in(path, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, std::size_t{20}, whole.size() / 2}) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << whole.substr(0, length);
    EXPECT_EQ(read_png(path).error().code, make_error_code(PictureError::kNotPng)) << length;
  }
  std::string huge = whole;
  huge[16] = 0x7F;  // the width's highest byte
  std::ofstream(path, std::ios::binary | std::ios::trunc) << huge;
  EXPECT_EQ(read_png(path).error().code, make_error_code(PictureError::kTooLarge));
}

}  // namespace
}  // namespace atlaswire::render
