#include "client/output_folder.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

namespace atlaswire::client {
namespace {

void write_or_throw(const std::filesystem::path& path, std::string_view text) {
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (out) return;
  throw ProgramError(ExitCode::kCannotWrite, "cannot write " + path.string() + ": " + std::strerror(errno) +
                                                 "; choose another folder with --out");
}

}  // namespace

OutputFolder::OutputFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw ProgramError(ExitCode::kCannotWrite, "cannot make the folder " + folder_.string() + ": " +
                                                   error.message() + "; choose another one with --out");
  }
  const std::filesystem::path probe = folder_ / ".atlas-client.probe";
  write_or_throw(probe, "");
  std::filesystem::remove(probe, error);
}

void OutputFolder::write_text(std::string_view name, std::string_view text) {
  const std::filesystem::path path = folder_ / name;
  write_or_throw(path, text);
  remember(path);
}

}  // namespace atlaswire::client
