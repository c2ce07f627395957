#include "lab/provenance.h"

#include "base/version.h"

#include <lab_build_commit.h>
#include <sys/utsname.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <string_view>
#include <thread>

namespace atlaswire::lab {
namespace {

/// The first "model name" of /proc/cpuinfo.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

/// "libx264.so.164" when that library is mapped into this process, or "".
std::string loaded_library(std::string_view stem) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const auto slash = line.rfind('/');
    if (slash != std::string::npos && line.compare(slash + 1, stem.size(), stem) == 0)
      return line.substr(slash + 1);
  }
  return {};
}

std::string operating_system() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

}  // namespace

std::string build_commit() { return AW_BUILD_COMMIT; }

Facts program_facts() {
  Facts facts{{"version", kVersion},         {"commit", build_commit()},
              {"build_type", AW_BUILD_TYPE}, {"compiler", __VERSION__},
              {"processor", processor()},    {"cores", std::to_string(std::thread::hardware_concurrency())},
              {"system", operating_system()}};
  for (const char* stem : {"libx264.so", "libavcodec.so"}) {
    if (std::string library = loaded_library(stem); !library.empty())
      facts.emplace_back(stem, std::move(library));
  }
  return facts;
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace atlaswire::lab
