#pragma once

#include "base/pose.h"
#include "client/stage_times.h"
#include "codec/video.h"
#include "render/display/mesh_builder.h"

#include <glm/vec3.hpp>
#include <memory>
#include <optional>

namespace atlaswire::client {

/// Atlas N with replica N, ready for the display: the vertex buffer refers to nothing but this picture.
struct Pair {
  std::shared_ptr<const codec::DecodedPicture> picture;
  render::MeshData mesh;
  glm::dvec3 origin{0.0};  ///< of the mesh's positions, scene coordinates
  PairTimes times;
  std::optional<StampedPose> server_pose;  ///< that the server rendered for
};

}  // namespace atlaswire::client
