#include "render/image/png.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 32768
#include <stb/stb_image.h>

namespace atlaswire::render {

namespace {

void append(void* out, void* data, int size) {
  static_cast<std::string*>(out)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

Error cannot_write(const std::filesystem::path& path, const std::string& cause) {
  return {PictureError::kCannotWrite, path.string() + ": " + cause};
}

}  // namespace

Result<void> write_png(const Picture& image, const std::filesystem::path& path) {
  if (image.empty()) return Error{PictureError::kEmpty, path.string()};
  const auto width = static_cast<int>(image.extent.width);
  const auto height = static_cast<int>(image.extent.height);
  std::string png;
  if (stbi_write_png_to_func(append, &png, width, height, 4, image.rgba.data(), 4 * width) == 0) {
    return cannot_write(path, "encoding failed");
  }
  std::filesystem::path part = path;
  part += ".part";
  {
    std::ofstream file(part, std::ios::binary | std::ios::trunc);
    file.write(png.data(), static_cast<std::streamsize>(png.size()));
    file.close();
    if (!file) {
      const std::string cause = std::strerror(errno);
      std::error_code ignored;
      std::filesystem::remove(part, ignored);
      return cannot_write(path, cause);
    }
  }
  std::error_code failed;
  std::filesystem::rename(part, path, failed);
  if (!failed) return {};
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  return cannot_write(path, failed.message());
}

Result<Picture> read_png(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{PictureError::kCannotRead, path.string()};
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (file.bad()) return Error{PictureError::kCannotRead, path.string()};
  if (bytes.size() > (std::size_t{1} << 30U)) return Error{PictureError::kTooLarge, path.string()};

  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  int width = 0;
  int height = 0;
  int channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, static_cast<int>(bytes.size()), &width, &height, &channels, 4),
      stbi_image_free);
  if (!pixels) {
    const std::string reason = stbi_failure_reason() != nullptr ? stbi_failure_reason() : "unreadable";
    const bool large = reason == "too large";
    return Error{large ? PictureError::kTooLarge : PictureError::kNotPng, path.string() + ": " + reason};
  }
  Picture image;
  image.extent = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  image.rgba.assign(pixels.get(), pixels.get() + 4 * image.extent.area());
  return image;
}

const char* error_text(PictureError e) {
  switch (e) {
    case PictureError::kCannotRead:
      return "the picture cannot be read";
    case PictureError::kNotPng:
      return "not a PNG picture that we can read";
    case PictureError::kTooLarge:
      return "the picture is too large; sides may be up to 32768";
    case PictureError::kEmpty:
      return "an empty picture cannot be written";
    case PictureError::kCannotWrite:
      return "the picture cannot be written";
  }
  return "unknown picture error";
}

}  // namespace atlaswire::render
