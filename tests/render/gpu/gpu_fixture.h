#pragma once

#include "render/gpu/device.h"

#include <gtest/gtest.h>

#include <memory>

namespace atlaswire::render::test {

/// A device under the validation layer, shared by a binary's tests; each test fails on any message.
class GpuTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!shared()) shared() = open_device({.select = "auto", .validation = true});
  }
  void SetUp() override { messages_before_ = device().validation_messages().size(); }
  void TearDown() override {
    const auto messages = device().validation_messages();
    for (std::size_t i = messages_before_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
  }
  static Device& device() { return *shared(); }

 private:
  static std::shared_ptr<Device>& shared() {
    static std::shared_ptr<Device> device;
    return device;
  }
  std::size_t messages_before_ = 0;
};

}  // namespace atlaswire::render::test
