#pragma once

#include "base/program.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::client {

/// The folder of --out. Everything written into it is remembered for the report.
class OutputFolder {
 public:
  /// Makes the folder and proves that it can be written; an empty path means "write nothing". Throws
  /// ProgramError(kCannotWrite).
  explicit OutputFolder(std::filesystem::path folder);

  [[nodiscard]] bool wanted() const { return !folder_.empty(); }
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return folder_ / name; }
  void remember(const std::filesystem::path& file) { written_.push_back(file.string()); }
  [[nodiscard]] const std::vector<std::string>& written() const { return written_; }
  /// Throws ProgramError(kCannotWrite).
  void write_text(std::string_view name, std::string_view text);

 private:
  std::filesystem::path folder_;
  std::vector<std::string> written_;
};

}  // namespace atlaswire::client
