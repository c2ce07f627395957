#include "tests/render/scene/gltf_support.h"

#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace atlaswire::render {

std::string base64(const std::string& in) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < in.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8U | (i + k < in.size() ? static_cast<unsigned char>(in[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= in.size() ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

TempFile::TempFile(const std::string& name, const std::string& text)
    : path_(std::filesystem::temp_directory_path() / ("atlaswire-" + std::to_string(getpid()) + "-" + name)) {
  std::ofstream(path_, std::ios::binary) << text;
}

TempFile::~TempFile() { std::filesystem::remove(path_); }

}  // namespace atlaswire::render
