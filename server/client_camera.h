#pragma once

#include "render/camera.h"

namespace atlaswire::server {

/// The camera of a client's display at the identity pose. Displays with a side beyond 4096 pixels are
/// rendered for at 4096, aspect kept: what a peer says must not size our buffers.
render::Camera client_camera(const Extent2D& display, double vertical_fov, double near_plane);

}  // namespace atlaswire::server
