#include "render/scene/camera_path.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

/// Any text: a path whose every pose is sane, or an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using atlaswire::render::CameraPath;
  const auto path = CameraPath::parse({reinterpret_cast<const char*>(data), size});
  if (path.has_error()) return 0;
  for (const int ms : {-1000, 0, 1, 500, 100'000}) {
    const auto pose = path->at(std::chrono::milliseconds(ms));
    if (!(pose.position.x <= 1e9 && pose.position.x >= -1e9)) std::abort();
  }
  return 0;
}
