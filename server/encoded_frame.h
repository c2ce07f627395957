#pragma once

#include "base/bytes.h"
#include "base/ids.h"
#include "base/result.h"
#include "base/time.h"
#include "codec/meta_update.h"
#include "proto/messages.h"
#include "render/image/picture.h"
#include "render/method.h"
#include "server/motion_teller.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace atlaswire::server {

/// What a stream is asked for next.
struct ViewRequest {
  render::Camera camera;  ///< with the newest pose
  PoseId pose{};          ///< its number at the client it came from
  Time pose_received{};
  Duration cover{};
  bool refresh = false;  ///< somebody lost a picture: make an I-frame, however recent the last
  bool restart = false;  ///< somebody knows nothing yet: an I-frame, and a meta update that tells all
  bool layout = false;   ///< somebody wants a picture of the frame's layout
  std::optional<codec::MetaCodecKind> meta_codec;  ///< from a `restart` on; nullopt: the settings'
  std::optional<BitRate> bit_rate;                 ///< from this frame on
  std::optional<Emphasis> emphasis;                ///< from this frame on: Method::set_emphasis
  /// For how long what moves has been moving; nullopt: everything is to be shown at rest, and no motion told.
  /// Between two restarts always or never.
  std::optional<Duration> scene_time;
  Duration scene_ahead{};  ///< so much later than `scene_time` is shown: when the picture will be on display
  render::ViewHints hints;
};

/// The time into its clips at which a method is to show the scene.
inline std::optional<double> scene_seconds(const ViewRequest& request) {
  if (!request.scene_time) return std::nullopt;
  return to_seconds(*request.scene_time + request.scene_ahead);
}

/// A frame between rendering and encoding. `rendered.picture` borrows from the method's ring.
struct PreparedFrame {
  PoseId pose{};
  Duration cover{};
  bool intra = false;
  render::RenderedFrame rendered;  ///< without `change` and `requests`: `update` has them
  codec::MetaUpdate update;
  std::optional<Duration> scene_time;
  Duration scene_ahead{};
  std::optional<MovedFrame> moved;                 ///< if the scene has motion, and it is to be told
  std::optional<codec::MetaCodecKind> meta_codec;  ///< from this update on
  std::optional<BitRate> bit_rate;
  std::optional<render::Picture> layout;  ///< ViewRequest::layout, where the stream follows its layout
  proto::StageStamps stamps;              ///< filled by whoever owns a clock
};

/// What one frame cost, for statistics.
struct FrameReport {
  render::RenderTimings render;
  Duration meta{};    ///< making the update's bytes
  Duration encode{};  ///< H.264
  render::AtlasUsage usage;
  render::LayoutCounts layout;
  std::uint32_t visible_patches = 0;
  std::uint32_t waiting_patches = 0;  ///< visible, but told in later frames
  std::uint32_t added_patches = 0;
  std::uint32_t removed_patches = 0;
  std::uint32_t new_vertices = 0;     ///< told in this frame
  std::uint32_t added_triangles = 0;  ///< of the patches added
  std::uint64_t shaded_texels = 0;
  double bias = 0;
};

/// A frame ready to leave, shared by every session that gets it.
struct EncodedFrame {
  FrameId frame{};
  PoseId pose{};  ///< 0 for a session whose pose it is not
  Duration cover{};
  bool idr = false;
  ByteBuffer video;        ///< Annex B access unit
  ByteBuffer meta;         ///< of the stream's meta codec
  Duration scene_time{};   ///< ViewRequest::scene_time
  Duration scene_ahead{};  ///< ViewRequest::scene_ahead
  ByteBuffer motion;       ///< where what moves is, behind `meta`; empty: none is told
  proto::StageStamps stamps;
  FrameReport report;
};

using FramePtr = std::shared_ptr<const EncodedFrame>;

/// Makes frames in two steps that may overlap: one thread renders frame n + 1 while another encodes n.
/// Every rendered frame must be encoded, once and in order. Before frame n is rendered, frame n - 2 must
/// have been encoded. No clock: the caller stamps.
class FrameMaker {
 public:
  virtual ~FrameMaker() = default;
  /// Rendering thread. Throws ProgramError or vk errors when the device fails: the stream is over then.
  virtual PreparedFrame render(const ViewRequest& request) = 0;
  /// Encoding thread. An Error ends the stream.
  virtual Result<EncodedFrame> encode(PreparedFrame prepared) = 0;
};

}  // namespace atlaswire::server
