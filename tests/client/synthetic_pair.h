#pragma once

#include "base/time.h"
#include "client/arrival.h"
#include "codec/meta_update.h"
#include "codec/video.h"
#include "proto/stream_description.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace atlaswire::client::testing {

/// A stream of one square, 2 m wide, 2 m in front of a camera at the origin, on a 64 x 64 atlas of one
/// colour.
inline proto::StreamDescription square_stream() {
  proto::StreamDescription s;
  s.scene = "square";
  s.picture = s.atlas = {64, 64};
  s.grid = PositionGrid::over({-2, -2, -3}, {2, 2, 1}, 10);
  s.max_vertices = 16;
  s.max_patches = 16;
  return s;
}

inline codec::MetaLimits square_limits() {
  return {.max_vertices = 16, .max_patches = 16, .grid_bits = 10, .atlas = {64, 64}};
}

/// The update that brings the square; later frames change nothing.
inline codec::MetaUpdate square_update(FrameId frame, bool first) {
  codec::MetaUpdate u{
      .frame = frame, .reset = first, .removed = {}, .vertices = {}, .added = {}, .moved = {}};
  if (!first) return u;
  const PositionGrid grid = square_stream().grid;
  const glm::dvec3 corners[4] = {{-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {-1, 1, -2}};
  codec::AddedPatch patch{.id = PatchId{0}, .triangles = 2, .draw = {}, .corners = {}, .block = {0, 0, 6, 6}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    u.vertices.push_back({VertexId{i}, grid.quantize(corners[i])});
    patch.corners[i] = VertexId{i};
  }
  u.added.push_back(patch);
  return u;
}

/// Makes what the network thread would hand over, one frame after the other.
class SquareServer {
 public:
  explicit SquareServer(codec::MetaCodecKind kind = codec::MetaCodecKind::kPlain)
      : kind_(kind), meta_(codec::make_meta_encoder(kind, square_limits())) {
    codec::VideoEncoderSettings settings;
    settings.extent = {64, 64};
    settings.encoder = "libx264";
    settings.intra_interval = 0;
    video_ = std::make_unique<codec::VideoEncoder>(settings);
  }

  [[nodiscard]] codec::MetaCodecKind meta_codec() const { return kind_; }

  /// A picture of one luma value: grey.
  Arrival picture(std::uint32_t n, std::uint8_t luma, bool idr) {
    const std::vector<std::uint8_t> y(64 * 64, luma);
    const std::vector<std::uint8_t> uv(32 * 32, 128);
    const codec::EncodedPicture encoded = video_
                                              ->encode({.extent = {64, 64},
                                                        .y = y.data(),
                                                        .u = uv.data(),
                                                        .v = uv.data(),
                                                        .y_stride = 64,
                                                        .uv_stride = 32},
                                                       idr)
                                              .value();
    auto frame = std::make_unique<proto::AssembledFrame>();
    frame->frame = FrameId{n};
    frame->access_unit = encoded.bytes;
    frame->idr = encoded.idr;
    frame->last_arrival = steady_now();
    return {.frame = std::move(frame), .update = nullptr};
  }

  Arrival update(std::uint32_t n, bool first) {
    auto arrival = std::make_unique<UpdateArrival>();
    arrival->update.meta.frame = FrameId{n};
    arrival->update.arrival = steady_now();
    meta_->encode(square_update(FrameId{n}, first), arrival->update.meta.meta);
    return {.frame = nullptr, .update = std::move(arrival)};
  }

 private:
  codec::MetaCodecKind kind_;
  std::unique_ptr<codec::VideoEncoder> video_;
  std::unique_ptr<codec::MetaEncoder> meta_;
};

}  // namespace atlaswire::client::testing
