#pragma once

#include <cstdint>
#include <string>

namespace atlaswire::server {

/// {"port":N,"pid":N} in a file, for scripts: appears whole (written beside, then renamed) and goes with the
/// object. A file that a killed daemon left is removed at once. Empty path: nothing.
class ReadyFile {
 public:
  explicit ReadyFile(std::string path);
  ~ReadyFile();
  ReadyFile(const ReadyFile&) = delete;
  ReadyFile& operator=(const ReadyFile&) = delete;

  /// Throws ProgramError (kCannotWrite).
  void write(std::uint16_t port) const;

 private:
  std::string path_;
};

}  // namespace atlaswire::server
