#pragma once

#include "codec/video.h"
#include "render/atlas/usage_overlay.h"
#include "server/encoded_frame.h"
#include "server/intra_schedule.h"
#include "server/motion_teller.h"
#include "server/replica_tracker.h"
#include "server/settings.h"

#include <memory>
#include <optional>
#include <vector>

namespace atlaswire::server {

/// One scene view as a stream of frames: a method that renders, an H.264 encoder, a meta encoder, and what
/// the clients know. See FrameMaker for threads and order.
class AtlasStream final : public FrameMaker {
 public:
  /// Throws ProgramError when the method or the encoder cannot be made.
  AtlasStream(const StreamSettings& settings, std::shared_ptr<const render::Scene> scene,
              std::unique_ptr<render::Method> method);

  PreparedFrame render(const ViewRequest& request) override;
  Result<EncodedFrame> encode(PreparedFrame prepared) override;

  [[nodiscard]] Extent2D picture_extent() const { return method_->picture_extent(); }
  /// For clients that know it: the settings', or the best after it that suits the method; a restart may
  /// choose another that does.
  [[nodiscard]] codec::MetaCodecKind preferred_meta_codec() const { return preferred_meta_codec_; }
  /// For clients that derive where blocks lie; nullopt: the method's layout cannot be derived.
  [[nodiscard]] std::optional<render::AllocatorSettings> memory() const { return method_->memory(); }
  [[nodiscard]] const PositionGrid& grid() const { return tracker_.grid(); }
  /// For clients that show motion; nullopt: nothing moves.
  [[nodiscard]] std::optional<proto::MotionDescription> motion() const {
    return motion_ ? std::optional(motion_->description()) : std::nullopt;
  }
  /// SPS and PPS, Annex B; empty before the first frame. Encoding thread.
  [[nodiscard]] const ByteBuffer& parameter_sets() const { return video_.parameter_sets(); }
  /// The encoder that opened.
  [[nodiscard]] const std::string& encoder_name() const { return video_.name(); }

 private:
  [[nodiscard]] codec::MetaUpdate update_for(const render::RenderedFrame& rendered, bool restart);

  // Rendering thread.
  std::unique_ptr<render::Method> method_;
  const codec::MetaCodecKind preferred_meta_codec_;
  ReplicaTracker tracker_;
  IntraSchedule schedule_;
  FrameId next_frame_{};
  bool told_ = false;               ///< clients have been told the whole once
  codec::MetaCodecKind told_as_{};  ///< since they were
  const std::optional<render::LayoutColours> layout_colours_;
  std::optional<render::UsageOverlay> layout_;  ///< with layout_colours_
  std::optional<MotionTeller> motion_;          ///< of a scene that moves; tells on the encoding thread
  // Encoding thread.
  codec::VideoEncoder video_;
  codec::MetaLimits limits_;
  codec::MetaCodecKind meta_codec_;
  std::unique_ptr<codec::MetaEncoder> meta_;
  std::size_t last_meta_bytes_ = 0;
};

/// What clients must be told of a stream before its first frame; SSRC and codec are the session's to fill.
proto::StreamDescription describe(const render::Scene& scene, const AtlasStream& stream,
                                  const StreamSettings& settings);

}  // namespace atlaswire::server
