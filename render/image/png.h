#pragma once

#include "base/error_enum.h"
#include "base/result.h"
#include "render/image/picture.h"

#include <filesystem>

namespace atlaswire::render {

/// Writes an 8-bit RGBA PNG. Whoever opens `path` sees the old file or the whole new one: it is written
/// beside it, as "PATH.part", and renamed. Makes no directories. kCannotWrite names the path and cause.
Result<void> write_png(const Picture& image, const std::filesystem::path& path);

/// Reads a PNG of any colour type as RGBA8; sides up to 32768. Safe on broken files.
Result<Picture> read_png(const std::filesystem::path& path);

/// Why a picture file could not be read or written.
enum class PictureError { kCannotRead = 1, kNotPng, kTooLarge, kEmpty, kCannotWrite };
const char* error_text(PictureError e);

}  // namespace atlaswire::render
ATLASWIRE_ERROR_ENUM(render, PictureError);
