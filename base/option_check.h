#pragma once

#include "base/program.h"

#include <fmt/format.h>

#include <string>

namespace atlaswire {

/// Ends a program for a bad value of an option: "OPTION GIVEN: must be ALLOWED", exit code kUsage.
[[noreturn]] inline void refuse_option(const std::string& option, const std::string& given,
                                       const std::string& allowed) {
  throw ProgramError(ExitCode::kUsage, fmt::format("{} {}: must be {}", option, given, allowed));
}

/// Refuses a number outside of `low`..`high`, and NaN.
template <class T>
void demand_range(const char* option, T v, T low, T high, const char* unit = "") {
  if (!(v >= low && v <= high)) {
    refuse_option(option, fmt::format("{}", v), fmt::format("{}..{}{}", low, high, unit));
  }
}

}  // namespace atlaswire
