#include "lab/view_header.h"

namespace atlaswire::lab {

ByteBuffer write_view_header(const ViewHeader& header) {
  ByteBuffer bytes;
  ByteWriter out(bytes);
  const render::Camera& camera = header.camera;
  out.write(value(header.frame));
  for (int i = 0; i < 3; ++i) out.write(camera.pose.position[i]);
  for (int i = 0; i < 4; ++i) out.write(camera.pose.orientation[i]);
  out.write(camera.vertical_fov);
  out.write(static_cast<std::uint16_t>(camera.extent.width));
  out.write(static_cast<std::uint16_t>(camera.extent.height));
  out.write(static_cast<float>(camera.near_plane));
  out.write(static_cast<float>(header.nearest));
  return bytes;
}

std::optional<ViewHeader> read_view_header(ByteView bytes) {
  ByteReader in(bytes);
  ViewHeader header;
  render::Camera& camera = header.camera;
  header.frame = FrameId{in.read<std::uint32_t>()};
  for (int i = 0; i < 3; ++i) camera.pose.position[i] = in.read<double>();
  for (int i = 0; i < 4; ++i) camera.pose.orientation[i] = in.read<double>();
  camera.vertical_fov = in.read<double>();
  camera.extent.width = in.read<std::uint16_t>();
  camera.extent.height = in.read<std::uint16_t>();
  camera.near_plane = in.read<float>();
  header.nearest = in.read<float>();
  if (!in.finished()) return std::nullopt;
  return header;
}

}  // namespace atlaswire::lab
