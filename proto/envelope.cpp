#include "proto/envelope.h"

#include "base/emphasis.h"
#include "base/mover.h"
#include "proto/datagram.h"
#include "proto/framing.h"
#include "proto/plain_text.h"

#include <algorithm>

namespace atlaswire::proto {

namespace {

Error bad(const char* field) { return {WireError::kBadValue, field}; }
Error missing(const char* field) { return {WireError::kMissingField, field}; }

/// False for NaN and infinities too.
bool in_range(double v, double low, double high) { return v >= low && v <= high; }

bool extent_in(const wire::Extent& e, std::uint32_t low, std::uint32_t high) {
  return e.width() >= low && e.width() <= high && e.height() >= low && e.height() <= high;
}

bool is_text(const std::string& text, std::size_t limit) {
  return text.size() <= limit && is_plain_text(text);
}

/// Collects the first rule that is broken, so that a message's rules read as a table.
class Rules {
 public:
  void require(bool holds, const char* field) {
    if (!holds && result_.has_value()) result_ = bad(field);
  }
  void present(bool holds, const char* field) {
    if (!holds && result_.has_value()) result_ = missing(field);
  }
  [[nodiscard]] const Result<void>& result() const { return result_; }

 private:
  Result<void> result_;
};

constexpr std::uint32_t kMaxSide = 16384;
constexpr std::uint32_t kMaxIds = 1U << 26U;
constexpr std::int64_t kSecond = 1'000'000'000;

Result<void> check(const wire::ClientHello& m) {
  Rules rules;
  rules.require(m.version_min() >= 1 && m.version_min() <= m.version_max(), "client_hello.version");
  rules.require(is_text(m.client_name(), 128), "client_hello.client_name");
  rules.present(m.has_display(), "client_hello.display");
  rules.require(extent_in(m.display(), 16, kMaxSide), "client_hello.display");
  rules.require(in_range(m.vertical_fov(), 0.1, 3.0), "client_hello.vertical_fov");
  rules.require(in_range(m.eye_separation(), 0, 1), "client_hello.eye_separation");
  rules.present(m.has_max_atlas(), "client_hello.max_atlas");
  rules.require(extent_in(m.max_atlas(), 64, kMaxSide), "client_hello.max_atlas");
  rules.require(m.meta_codecs_size() >= 1 && m.meta_codecs_size() <= 16, "client_hello.meta_codecs");
  rules.require(!m.has_wanted_atlas() || extent_in(m.wanted_atlas(), 64, kMaxSide),
                "client_hello.wanted_atlas");
  rules.require(
      !m.has_wanted_bit_rate() || (m.wanted_bit_rate() >= 1'000 && m.wanted_bit_rate() <= 10'000'000'000),
      "client_hello.wanted_bit_rate");
  rules.require(!m.has_wanted_frame_rate() || in_range(m.wanted_frame_rate(), 1, 240),
                "client_hello.wanted_frame_rate");
  return rules.result();
}

void check(const wire::SceneMotion& m, const wire::StreamInfo& stream, Rules& rules) {
  const int movers = m.gaps_size();
  rules.require(movers >= 1 && static_cast<std::uint32_t>(movers) <= kMostMovers, "stream.motion.gaps");
  rules.require(m.counts_size() == movers, "stream.motion.counts");
  rules.require(m.kinds_size() == movers, "stream.motion.kinds");
  const int objects = m.pivots_size() / 3;
  rules.require(m.pivots_size() % 3 == 0 && objects <= movers, "stream.motion.pivots");
  if (rules.result().has_error()) return;
  std::uint64_t end = 0;
  for (int i = 0; i < movers; ++i) {
    rules.require(m.counts(i) >= 1, "stream.motion.counts");
    end += std::uint64_t{m.gaps(i)} + m.counts(i);
    rules.require(m.kinds(i) <= static_cast<std::uint32_t>(objects), "stream.motion.kinds");
  }
  rules.require(end <= stream.max_patches(), "stream.motion.gaps");
  for (const std::uint32_t coordinate : m.pivots())
    rules.require(coordinate < 1U << std::min(stream.grid_bits(), 20U), "stream.motion.pivots");
  rules.require(m.translation_step() > 0 && m.translation_step() <= 1e6, "stream.motion.translation_step");
  rules.require(m.rotation_bits() >= 8 && m.rotation_bits() <= 20, "stream.motion.rotation_bits");
}

Result<void> check(const wire::StreamInfo& m) {
  Rules rules;
  rules.require(is_text(m.scene(), 256), "stream.scene");
  rules.require(extent_in(m.picture(), 1, kMaxSide), "stream.picture");
  rules.require(extent_in(m.atlas(), 1, kMaxSide), "stream.atlas");
  const std::uint64_t planes = m.has_coverage() ? 2 : 1;
  rules.require(
      m.picture().width() >= m.atlas().width() && m.picture().height() >= planes * m.atlas().height(),
      "stream.picture");
  constexpr double kFar = 1e9;
  rules.require(in_range(m.grid_origin_x(), -kFar, kFar) && in_range(m.grid_origin_y(), -kFar, kFar) &&
                    in_range(m.grid_origin_z(), -kFar, kFar),
                "stream.grid_origin");
  rules.require(m.grid_step() > 0 && m.grid_step() <= 1e6, "stream.grid_step");
  rules.require(m.grid_bits() >= 8 && m.grid_bits() <= 20, "stream.grid_bits");
  rules.require(m.meta_codec() >= 1 && m.meta_codec() <= 255, "stream.meta_codec");
  if (m.has_memory()) {
    rules.require(
        m.memory().superblock_log2() >= 4 && m.memory().superblock_log2() <= 12 &&
            ((m.atlas().width() | m.atlas().height()) & ((1U << m.memory().superblock_log2()) - 1)) == 0,
        "stream.memory.superblock_log2");
    rules.require(m.memory().min_block_log2() <= m.memory().superblock_log2(),
                  "stream.memory.min_block_log2");
    rules.require(in_range(m.memory().high_water(), 0, 1), "stream.memory.high_water");
  }
  rules.require(m.max_vertices() >= 1 && m.max_vertices() <= kMaxIds, "stream.max_vertices");
  rules.require(m.max_patches() >= 1 && m.max_patches() <= kMaxIds, "stream.max_patches");
  rules.require(m.payload_type() >= 96 && m.payload_type() <= 127, "stream.payload_type");
  rules.require(in_range(m.frame_rate(), 0.1, 1000), "stream.frame_rate");
  rules.require(m.near_plane() > 0 && m.near_plane() <= 1000, "stream.near_plane");
  for (const float c : {m.background_red(), m.background_green(), m.background_blue()}) {
    rules.require(in_range(c, 0, 65504), "stream.background");
  }
  if (m.has_motion()) check(m.motion(), m, rules);
  return rules.result();
}

Result<void> check(const wire::ServerHello& m) {
  Rules rules;
  rules.require(m.version() >= 1, "server_hello.version");
  rules.require(m.session() != 0, "server_hello.session");
  rules.require(m.udp_token().size() == 16, "server_hello.udp_token");
  rules.present(m.has_stream(), "server_hello.stream");
  if (rules.result().has_error()) return rules.result();
  return check(m.stream());
}

Result<void> check(const wire::FrameMeta& m) {
  Rules rules;
  for (const std::int64_t stamp :
       {m.pose_received(), m.render_start(), m.render_end(), m.encode_end(), m.sent()}) {
    rules.require(is_wire_time(stamp), "frame_meta.stamps");
  }
  rules.require(m.cover() >= 0 && m.cover() <= 10 * kSecond, "frame_meta.cover");
  rules.require(is_wire_time(m.scene_time()), "frame_meta.scene_time");
  rules.require(m.scene_ahead() >= 0 && m.scene_ahead() <= 10 * kSecond, "frame_meta.scene_ahead");
  return rules.result();
}

Result<void> check(const wire::Refusal& m) {
  Rules rules;
  rules.require(m.code() != wire::Refusal::UNSPECIFIED && wire::Refusal::Code_IsValid(m.code()),
                "refusal.code");
  rules.require(is_text(m.text(), 1024), "refusal.text");
  return rules.result();
}

Result<void> check(const wire::Goodbye& m) {
  Rules rules;
  rules.require(m.reason() != wire::Goodbye::UNSPECIFIED && wire::Goodbye::Reason_IsValid(m.reason()),
                "goodbye.reason");
  rules.require(is_text(m.text(), 1024), "goodbye.text");
  return rules.result();
}

Result<void> check(const wire::RestartRequest& m) {
  Rules rules;
  rules.require(is_text(m.text(), 1024), "restart_request.text");
  return rules.result();
}

Result<void> check(const wire::StatsReport& m) {
  Rules rules;
  rules.require(in_range(m.display_rate(), 0, 10'000), "stats_report.display_rate");
  rules.require(m.motion_to_photon() >= 0 && m.motion_to_photon() <= 60 * kSecond,
                "stats_report.motion_to_photon");
  return rules.result();
}

Result<void> check(const wire::Emphasis& m) {
  Rules rules;
  rules.require(!m.has_foveation() || in_range(m.foveation(), 0, atlaswire::Emphasis::kMostFoveation),
                "emphasis.foveation");
  const auto count = static_cast<std::size_t>(m.priorities_size());
  rules.require(count <= atlaswire::Emphasis::kMostPriorities, "emphasis.priorities");
  constexpr double kMost = atlaswire::Emphasis::kMostOctaves;
  for (const wire::SurfacePriority& p : m.priorities()) {
    if (rules.result().has_error()) break;
    rules.require(!p.surface().empty() && is_text(p.surface(), atlaswire::Emphasis::kMostName),
                  "emphasis.priorities.surface");
    rules.require(in_range(p.octaves(), -kMost, kMost), "emphasis.priorities.octaves");
  }
  return rules.result();
}

}  // namespace

Result<void> check_envelope(const wire::Envelope& envelope) {
  switch (envelope.message_case()) {
    case wire::Envelope::kClientHello:
      return check(envelope.client_hello());
    case wire::Envelope::kServerHello:
      return check(envelope.server_hello());
    case wire::Envelope::kFrameMeta:
      return check(envelope.frame_meta());
    case wire::Envelope::kRefusal:
      return check(envelope.refusal());
    case wire::Envelope::kGoodbye:
      return check(envelope.goodbye());
    case wire::Envelope::kStatsReport:
      return check(envelope.stats_report());
    case wire::Envelope::kRestartRequest:
      return check(envelope.restart_request());
    case wire::Envelope::kEmphasis:
      return check(envelope.emphasis());
    case wire::Envelope::MESSAGE_NOT_SET:
      break;
  }
  return missing("envelope.message");
}

Result<wire::Envelope> parse_envelope(ByteView bytes) {
  if (bytes.size() > kMaxEnvelope) return WireError::kBadLength;
  wire::Envelope envelope;
  if (!envelope.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return Error(WireError::kMalformed, "envelope");
  }
  const auto checked = check_envelope(envelope);
  if (checked.has_error()) return checked.error();
  return envelope;
}

}  // namespace atlaswire::proto
