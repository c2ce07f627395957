#include "codec/raw_picture.h"

#include "base/bytes.h"

#include <cstring>
#include <new>

namespace atlaswire::codec {
namespace {

constexpr std::size_t kHeader = 8;

void write_plane(const std::uint8_t* rows, std::uint32_t stride, Extent2D extent, std::byte* out) {
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    std::memcpy(out + std::size_t{y} * extent.width, rows + std::size_t{y} * stride, extent.width);
  }
}

void read_plane(const std::byte* in, Extent2D extent, std::uint8_t* rows, int stride) {
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    std::memcpy(rows + std::size_t{y} * static_cast<std::size_t>(stride), in + std::size_t{y} * extent.width,
                extent.width);
  }
}

}  // namespace

void write_raw_picture(const I420View& picture, ByteBuffer& out) {
  const Extent2D chroma{picture.extent.width / 2, picture.extent.height / 2};
  out.clear();
  ByteWriter writer(out);
  writer.write(picture.extent.width);
  writer.write(picture.extent.height);
  out.resize(kHeader + picture.extent.area() + 2 * chroma.area());
  std::byte* at = out.data() + kHeader;
  write_plane(picture.y, picture.y_stride, picture.extent, at);
  write_plane(picture.u, picture.uv_stride, chroma, at + picture.extent.area());
  write_plane(picture.v, picture.uv_stride, chroma, at + picture.extent.area() + chroma.area());
}

Result<AvFrame> read_raw_picture(ByteView bytes, Extent2D max_extent) {
  if (bytes.size() < kHeader) return VideoError::kCorrupt;
  ByteReader reader(bytes);
  const std::uint32_t width = reader.read<std::uint32_t>();
  const std::uint32_t height = reader.read<std::uint32_t>();
  if (width > max_extent.width || height > max_extent.height) return VideoError::kTooLarge;
  if (width == 0 || height == 0 || width % 2 != 0 || height % 2 != 0) return VideoError::kWrongFormat;
  const Extent2D extent{width, height};
  const Extent2D chroma{width / 2, height / 2};
  if (bytes.size() != kHeader + extent.area() + 2 * chroma.area()) return VideoError::kCorrupt;
  AvFrame frame(av_frame_alloc());
  if (!frame) throw std::bad_alloc();
  frame->format = AV_PIX_FMT_YUV420P;
  frame->width = static_cast<int>(width);
  frame->height = static_cast<int>(height);
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  const std::byte* at = bytes.data() + kHeader;
  read_plane(at, extent, frame->data[0], frame->linesize[0]);
  read_plane(at + extent.area(), chroma, frame->data[1], frame->linesize[1]);
  read_plane(at + extent.area() + chroma.area(), chroma, frame->data[2], frame->linesize[2]);
  return frame;
}

}  // namespace atlaswire::codec
