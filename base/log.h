#pragma once

#include <spdlog/spdlog.h>

#include <string_view>

namespace atlaswire {

/// How a program logs: human lines or one JSON object a line, both on stderr, so that stdout stays for
/// results. Call once, at the start of `main`; use spdlog::info and friends afterwards.
struct LogSettings {
  bool json = false;
  spdlog::level::level_enum level = spdlog::level::info;
};
void set_up_logging(std::string_view program, const LogSettings& settings);

}  // namespace atlaswire
