#pragma once

#include <filesystem>
#include <string>

namespace atlaswire::render {

/// For data URIs.
std::string base64(const std::string& in);

/// A file that is gone when the test is.
class TempFile {
 public:
  TempFile(const std::string& name, const std::string& text);
  ~TempFile();
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace atlaswire::render
