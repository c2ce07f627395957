#include "base/result.h"

#include "base/program.h"
#include "base/units.h"

#include <gtest/gtest.h>

namespace atlaswire {
namespace {

using units::UnitError;

TEST(Error, MessageNamesTheThingAndTheReason) {
  const Error bare(UnitError::kBadBitRate);
  EXPECT_EQ(bare.message(), units::error_text(UnitError::kBadBitRate));
  const Error named(UnitError::kBadBitRate, "'fast'");
  EXPECT_EQ(named.message(), "'fast': " + bare.message());
  EXPECT_STREQ(named.code.category().name(), "atlaswire.units.UnitError");
}

TEST(Result, ValueOfAnErrorThrowsItsMessage) {
  const Result<int> failed = Error(UnitError::kBadExtent, "'7'");
  ASSERT_FALSE(failed);
  try {
    (void)failed.value();
    FAIL() << "no exception";
  } catch (const ResultError& e) {
    EXPECT_EQ(std::string(e.what()), failed.error().message());
  }
}

TEST(Result, HoldsItsValue) {
  const Result<int> fine = 5;
  ASSERT_TRUE(fine);
  EXPECT_EQ(*fine, 5);
}

TEST(RunProgram, TurnsExceptionsIntoExitCodes) {
  EXPECT_EQ(run_program("test", 0, nullptr, [](int, char**) { return 3; }), 3);
  const auto refuses = [](int, char**) -> int {
    throw ProgramError(ExitCode::kPortInUse, "port 7400 is taken");
  };
  const auto breaks = [](int, char**) -> int { throw std::runtime_error("unforeseen"); };
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_program("test", 0, nullptr, refuses), 5);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "test: error: port 7400 is taken\n");
  EXPECT_EQ(run_program("test", 0, nullptr, breaks), 1);
}

}  // namespace
}  // namespace atlaswire
