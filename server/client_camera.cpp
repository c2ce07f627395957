#include "server/client_camera.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::server {

render::Camera client_camera(const Extent2D& display, double vertical_fov, double near_plane) {
  constexpr double kMost = 4096;
  const double scale = std::min(1.0, kMost / std::max(display.width, display.height));
  const auto side = [&](std::uint32_t pixels) {
    return std::max(1U, static_cast<std::uint32_t>(std::lround(pixels * scale)));
  };
  render::Camera camera;
  camera.vertical_fov = vertical_fov;
  camera.near_plane = near_plane;
  camera.extent = {side(display.width), side(display.height)};
  return camera;
}

}  // namespace atlaswire::server
