#include "render/gpu/device.h"

#include "base/program.h"
#include "render/gpu/buffer.h"
#include "tests/render/gpu/gpu_fixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace atlaswire::render {
namespace {

using ::testing::HasSubstr;

TEST(ListDevices, FindsAUsableOne) {
  const auto devices = list_devices();
  ASSERT_FALSE(devices.empty());
  EXPECT_TRUE(std::ranges::any_of(devices, [](const DeviceInfo& d) { return d.missing.empty(); }));
}

TEST(OpenDevice, TakesAnIndexOrPartOfANameInAnyCase) {
  const auto devices = list_devices();
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(device_name(*open_device({.select = "0"})), devices[0].name);
  std::string part = devices[0].name.substr(0, 5);
  std::ranges::transform(part, part.begin(), [](unsigned char c) { return std::toupper(c); });
  EXPECT_EQ(device_name(*open_device({.select = part})), devices[0].name);
}

std::string refusal(const std::string& select) {
  try {
    (void)open_device({.select = select});
  } catch (const ProgramError& error) {
    EXPECT_EQ(error.code(), ExitCode::kNoDevice);
    return error.what();
  }
  return "opened";
}

TEST(OpenDevice, RefusalNamesWhatWasFoundAndTheCure) {
  const std::string found = list_devices().at(0).name;
  for (const char* select : {"no such device", "999"}) {
    const std::string text = refusal(select);
    EXPECT_THAT(text, HasSubstr(select));
    EXPECT_THAT(text, HasSubstr(found));
    EXPECT_THAT(text, HasSubstr("install mesa-vulkan-drivers or set --device"));
  }
}

TEST(OpenDevice, WithoutADriverSaysWhatToInstall) {
  // In a process of its own: the loader reads its environment when an instance is made.
  EXPECT_EXIT(
      {
        setenv("VK_DRIVER_FILES", "/nonexistent.json", 1);
        setenv("VK_ICD_FILENAMES", "/nonexistent.json", 1);
        const bool empty = list_devices().empty();
        const std::string text = refusal("auto");
        const bool cured = text.find("install mesa-vulkan-drivers") != std::string::npos;
        std::exit(empty && cured ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(Device, ReportsMisuseToItsValidationLog) {
  const auto device = open_device({.select = "auto", .validation = true});
  EXPECT_TRUE(validation_messages(*device).empty());
  // A buffer of no size is invalid usage.
  const vk::raii::Buffer wrong(device->vk(), {.size = 0, .usage = vk::BufferUsageFlagBits::eStorageBuffer});
  EXPECT_FALSE(validation_messages(*device).empty());
}

}  // namespace
}  // namespace atlaswire::render
