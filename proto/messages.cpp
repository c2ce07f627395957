#include "proto/messages.h"

#include "base/assert.h"
#include "proto/envelope.h"
#include "proto/framing.h"
#include "proto/plain_text.h"

#include <algorithm>

namespace atlaswire::proto {

namespace {

Extent2D from_wire(const wire::Extent& e) { return {e.width(), e.height()}; }

void to_wire(const Extent2D& e, wire::Extent& out) {
  out.set_width(e.width);
  out.set_height(e.height);
}

ClientHello from_wire(const wire::ClientHello& m) {
  ClientHello out;
  out.versions = {m.version_min(), m.version_max()};
  out.client_name = m.client_name();
  out.display = from_wire(m.display());
  out.vertical_fov = m.vertical_fov();
  out.eye_separation = m.eye_separation();
  out.max_picture = from_wire(m.max_atlas());
  out.meta_codecs.assign(m.meta_codecs().begin(), m.meta_codecs().end());
  out.shows_motion = m.shows_motion();
  if (m.has_wanted_atlas()) out.wanted_atlas = from_wire(m.wanted_atlas());
  if (m.has_wanted_bit_rate()) out.wanted_bit_rate = BitRate{m.wanted_bit_rate()};
  if (m.has_wanted_frame_rate()) out.wanted_frame_rate = m.wanted_frame_rate();
  return out;
}

void to_wire(const ClientHello& m, wire::Envelope& envelope) {
  auto& out = *envelope.mutable_client_hello();
  out.set_version_min(m.versions.lowest);
  out.set_version_max(m.versions.highest);
  out.set_client_name(to_plain_text(m.client_name, 128));
  to_wire(m.display, *out.mutable_display());
  out.set_vertical_fov(m.vertical_fov);
  out.set_eye_separation(m.eye_separation);
  to_wire(m.max_picture, *out.mutable_max_atlas());
  for (const auto codec : m.meta_codecs) out.add_meta_codecs(codec);
  out.set_shows_motion(m.shows_motion);
  if (m.wanted_atlas) to_wire(*m.wanted_atlas, *out.mutable_wanted_atlas());
  if (m.wanted_bit_rate) out.set_wanted_bit_rate(m.wanted_bit_rate->bits_per_second);
  if (m.wanted_frame_rate) out.set_wanted_frame_rate(*m.wanted_frame_rate);
}

MotionDescription from_wire(const wire::SceneMotion& m) {
  MotionDescription out;
  std::uint32_t patch = 0;
  for (int i = 0; i < m.gaps_size(); ++i) {
    Mover& mover = out.movers.emplace_back();
    mover.first_patch = patch + m.gaps(i);
    mover.patch_count = m.counts(i);
    mover.deforms = m.kinds(i) == 0;
    mover.object = mover.deforms ? 0 : m.kinds(i) - 1;
    patch = mover.end();
  }
  for (int i = 0; i + 2 < m.pivots_size(); i += 3)
    out.pivots.emplace_back(m.pivots(i), m.pivots(i + 1), m.pivots(i + 2));
  out.translation_step = m.translation_step();
  out.rotation_bits = m.rotation_bits();
  return out;
}

void to_wire(const MotionDescription& m, wire::SceneMotion& out) {
  std::uint32_t patch = 0;
  for (const Mover& mover : m.movers) {
    out.add_gaps(mover.first_patch - patch);
    out.add_counts(mover.patch_count);
    out.add_kinds(mover.deforms ? 0 : 1 + mover.object);
    patch = mover.end();
  }
  for (const GridPosition& pivot : m.pivots) {
    for (int axis = 0; axis < 3; ++axis) out.add_pivots(pivot[axis]);
  }
  out.set_translation_step(m.translation_step);
  out.set_rotation_bits(m.rotation_bits);
}

StreamDescription from_wire(const wire::StreamInfo& m) {
  StreamDescription out;
  out.scene = m.scene();
  out.picture = from_wire(m.picture());
  out.atlas = from_wire(m.atlas());
  out.has_coverage = m.has_coverage();
  out.grid.origin = {m.grid_origin_x(), m.grid_origin_y(), m.grid_origin_z()};
  out.grid.step = m.grid_step();
  out.grid.bits = m.grid_bits();
  out.meta_codec = m.meta_codec();
  if (m.has_memory()) {
    out.memory = {m.memory().superblock_log2(), m.memory().min_block_log2(), m.memory().high_water()};
  }
  out.max_vertices = m.max_vertices();
  out.max_patches = m.max_patches();
  out.ssrc = m.ssrc();
  out.payload_type = static_cast<std::uint8_t>(m.payload_type());
  out.frame_rate = m.frame_rate();
  out.near_plane = m.near_plane();
  out.background = {m.background_red(), m.background_green(), m.background_blue()};
  out.alpha_mask = m.alpha_mask();
  out.alpha_blend = m.alpha_blend();
  out.double_sided = m.double_sided();
  if (m.has_motion()) out.motion = from_wire(m.motion());
  return out;
}

void to_wire(const StreamDescription& m, wire::StreamInfo& out) {
  out.set_scene(to_plain_text(m.scene, 256));
  to_wire(m.picture, *out.mutable_picture());
  to_wire(m.atlas, *out.mutable_atlas());
  out.set_has_coverage(m.has_coverage);
  out.set_grid_origin_x(m.grid.origin.x);
  out.set_grid_origin_y(m.grid.origin.y);
  out.set_grid_origin_z(m.grid.origin.z);
  out.set_grid_step(m.grid.step);
  out.set_grid_bits(m.grid.bits);
  out.set_meta_codec(m.meta_codec);
  if (m.memory) {
    out.mutable_memory()->set_superblock_log2(m.memory->superblock_log2);
    out.mutable_memory()->set_min_block_log2(m.memory->min_block_log2);
    out.mutable_memory()->set_high_water(m.memory->high_water);
  }
  out.set_max_vertices(m.max_vertices);
  out.set_max_patches(m.max_patches);
  out.set_ssrc(m.ssrc);
  out.set_payload_type(m.payload_type);
  out.set_frame_rate(m.frame_rate);
  out.set_near_plane(m.near_plane);
  out.set_background_red(m.background[0]);
  out.set_background_green(m.background[1]);
  out.set_background_blue(m.background[2]);
  out.set_alpha_mask(m.alpha_mask);
  out.set_alpha_blend(m.alpha_blend);
  out.set_double_sided(m.double_sided);
  if (m.motion) to_wire(*m.motion, *out.mutable_motion());
}

ServerHello from_wire(const wire::ServerHello& m) {
  ServerHello out;
  out.version = m.version();
  out.session = SessionId{m.session()};
  std::transform(m.udp_token().begin(), m.udp_token().end(), out.udp_token.begin(),
                 [](char c) { return static_cast<std::byte>(c); });
  out.stream = from_wire(m.stream());
  return out;
}

void to_wire(const ServerHello& m, wire::Envelope& envelope) {
  auto& out = *envelope.mutable_server_hello();
  out.set_version(m.version);
  out.set_session(value(m.session));
  out.set_udp_token(m.udp_token.data(), m.udp_token.size());
  to_wire(m.stream, *out.mutable_stream());
}

FrameMeta from_wire(const wire::FrameMeta& m) {
  FrameMeta out;
  out.frame = FrameId{m.frame()};
  out.pose = PoseId{m.pose()};
  out.stamps = {from_nanos(m.pose_received()), from_nanos(m.render_start()), from_nanos(m.render_end()),
                from_nanos(m.encode_end()), from_nanos(m.sent())};
  out.cover = Duration{m.cover()};
  const auto bytes = std::as_bytes(std::span(m.meta()));
  out.meta.assign(bytes.begin(), bytes.end());
  out.scene_time = Duration{m.scene_time()};
  out.scene_ahead = Duration{m.scene_ahead()};
  const auto motion = std::as_bytes(std::span(m.motion()));
  out.motion.assign(motion.begin(), motion.end());
  return out;
}

void to_wire(const FrameMeta& m, wire::Envelope& envelope) {
  auto& out = *envelope.mutable_frame_meta();
  out.set_frame(value(m.frame));
  out.set_pose(value(m.pose));
  out.set_pose_received(to_nanos(m.stamps.pose_received));
  out.set_render_start(to_nanos(m.stamps.render_start));
  out.set_render_end(to_nanos(m.stamps.render_end));
  out.set_encode_end(to_nanos(m.stamps.encode_end));
  out.set_sent(to_nanos(m.stamps.sent));
  out.set_cover(m.cover.count());
  out.set_meta(m.meta.data(), m.meta.size());
  out.set_scene_time(m.scene_time.count());
  out.set_scene_ahead(m.scene_ahead.count());
  if (!m.motion.empty()) out.set_motion(m.motion.data(), m.motion.size());
}

Refusal from_wire(const wire::Refusal& m) { return {static_cast<Refusal::Code>(m.code()), m.text()}; }

void to_wire(const Refusal& m, wire::Envelope& envelope) {
  auto& out = *envelope.mutable_refusal();
  out.set_code(static_cast<wire::Refusal::Code>(m.code));
  out.set_text(to_plain_text(m.text, 1024));
}

Goodbye from_wire(const wire::Goodbye& m) { return {static_cast<Goodbye::Reason>(m.reason()), m.text()}; }

void to_wire(const Goodbye& m, wire::Envelope& envelope) {
  auto& out = *envelope.mutable_goodbye();
  out.set_reason(static_cast<wire::Goodbye::Reason>(m.reason));
  out.set_text(to_plain_text(m.text, 1024));
}

StatsReport from_wire(const wire::StatsReport& m) {
  return {FrameId{m.newest_frame()}, m.frames_paired(), m.frames_lost(),
          m.frames_displayed(),      m.display_rate(),  Duration{m.motion_to_photon()}};
}

void to_wire(const StatsReport& m, wire::Envelope& envelope) {
  auto& out = *envelope.mutable_stats_report();
  out.set_newest_frame(value(m.newest_frame));
  out.set_frames_paired(m.frames_paired);
  out.set_frames_lost(m.frames_lost);
  out.set_frames_displayed(m.frames_displayed);
  out.set_display_rate(m.display_rate);
  out.set_motion_to_photon(m.motion_to_photon.count());
}

RestartRequest from_wire(const wire::RestartRequest& m) { return {FrameId{m.frame()}, m.text()}; }

void to_wire(const RestartRequest& m, wire::Envelope& envelope) {
  auto& out = *envelope.mutable_restart_request();
  out.set_frame(value(m.frame));
  out.set_text(to_plain_text(m.text, 1024));
}

Emphasis from_wire(const wire::Emphasis& m) {
  Emphasis out;
  if (m.has_foveation()) out.foveation = m.foveation();
  for (const wire::SurfacePriority& p : m.priorities()) out.priorities.push_back({p.surface(), p.octaves()});
  return out;
}

void to_wire(const Emphasis& m, wire::Envelope& envelope) {
  auto& out = *envelope.mutable_emphasis();
  if (m.foveation) out.set_foveation(*m.foveation);
  for (const SurfacePriority& p : m.priorities) {
    wire::SurfacePriority& added = *out.add_priorities();
    added.set_surface(to_plain_text(p.name, Emphasis::kMostName));
    added.set_octaves(p.octaves);
  }
}

}  // namespace

Result<Message> parse_message(ByteView bytes) {
  const auto envelope = parse_envelope(bytes);
  if (envelope.has_error()) return envelope.error();
  switch (envelope->message_case()) {
    case wire::Envelope::kClientHello:
      return Message{from_wire(envelope->client_hello())};
    case wire::Envelope::kServerHello:
      return Message{from_wire(envelope->server_hello())};
    case wire::Envelope::kFrameMeta:
      return Message{from_wire(envelope->frame_meta())};
    case wire::Envelope::kRefusal:
      return Message{from_wire(envelope->refusal())};
    case wire::Envelope::kGoodbye:
      return Message{from_wire(envelope->goodbye())};
    case wire::Envelope::kStatsReport:
      return Message{from_wire(envelope->stats_report())};
    case wire::Envelope::kRestartRequest:
      return Message{from_wire(envelope->restart_request())};
    case wire::Envelope::kEmphasis:
      return Message{from_wire(envelope->emphasis())};
    case wire::Envelope::MESSAGE_NOT_SET:
      break;
  }
  return WireError::kMissingField;
}

void append_message(const Message& message, ByteBuffer& out) {
  wire::Envelope envelope;
  std::visit([&](const auto& m) { to_wire(m, envelope); }, message);
  AW_ASSERT(check_envelope(envelope).has_value());
  const std::size_t size = envelope.ByteSizeLong();
  AW_ASSERT(size <= kMaxEnvelope);
  ByteWriter(out).write(static_cast<std::uint32_t>(size));
  const std::size_t start = out.size();
  out.resize(start + size);
  AW_ASSERT(envelope.SerializeToArray(out.data() + start, static_cast<int>(size)));
}

const char* message_name(const Message& message) {
  constexpr const char* kNames[] = {"client hello", "server hello", "frame meta",      "refusal",
                                    "goodbye",      "stats report", "restart request", "emphasis"};
  return kNames[message.index()];
}

const char* name(Refusal::Code code) {
  switch (code) {
    case Refusal::Code::kVersion:
      return "version";
    case Refusal::Code::kCapacity:
      return "capacity";
    case Refusal::Code::kBadHello:
      return "bad hello";
    case Refusal::Code::kDraining:
      return "draining";
  }
  return "unknown";
}

const char* name(Goodbye::Reason reason) {
  switch (reason) {
    case Goodbye::Reason::kDone:
      return "done";
    case Goodbye::Reason::kDraining:
      return "draining";
    case Goodbye::Reason::kProtocolError:
      return "protocol error";
    case Goodbye::Reason::kTimeout:
      return "timeout";
    case Goodbye::Reason::kTooSlow:
      return "too slow";
    case Goodbye::Reason::kInternal:
      return "internal error";
  }
  return "unknown";
}

}  // namespace atlaswire::proto
