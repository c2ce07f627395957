#include "server/ready_file.h"

#include "base/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <utility>

namespace atlaswire::server {

ReadyFile::ReadyFile(std::string path) : path_(std::move(path)) {
  if (!path_.empty()) std::remove(path_.c_str());
}

ReadyFile::~ReadyFile() {
  if (!path_.empty()) std::remove(path_.c_str());
}

void ReadyFile::write(std::uint16_t port) const {
  if (path_.empty()) return;
  const std::string beside = fmt::format("{}.{}", path_, ::getpid());
  std::ofstream file(beside, std::ios::trunc);
  file << fmt::format("{{\"port\":{},\"pid\":{}}}\n", port, ::getpid());
  file.close();
  if (file && std::rename(beside.c_str(), path_.c_str()) == 0) return;
  std::remove(beside.c_str());
  throw ProgramError(ExitCode::kCannotWrite, fmt::format("--ready-file {}: cannot write there", path_));
}

}  // namespace atlaswire::server
