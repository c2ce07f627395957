#include "server/ready_file.h"

#include "base/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <utility>

namespace atlaswire::server {

namespace {

ProgramError cannot_write(const std::string& path) {
  return {ExitCode::kCannotWrite, fmt::format("--ready-file {}: cannot write there", path)};
}

/// Where the file is written before it is renamed: scripts wait for `path` itself.
std::string beside(const std::string& path) { return fmt::format("{}.{}", path, ::getpid()); }

}  // namespace

ReadyFile::ReadyFile(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  std::remove(path_.c_str());
  // Found out now, not after the warm-up.
  const bool writable = std::ofstream(beside(path_)).good();
  std::remove(beside(path_).c_str());
  if (!writable) throw cannot_write(path_);
}

ReadyFile::~ReadyFile() {
  if (!path_.empty()) std::remove(path_.c_str());
}

void ReadyFile::write(std::uint16_t port) const {
  if (path_.empty()) return;
  const std::string fresh = beside(path_);
  std::ofstream file(fresh, std::ios::trunc);
  file << fmt::format("{{\"port\":{},\"pid\":{}}}\n", port, ::getpid());
  file.close();
  if (file && std::rename(fresh.c_str(), path_.c_str()) == 0) return;
  std::remove(fresh.c_str());
  throw cannot_write(path_);
}

}  // namespace atlaswire::server
