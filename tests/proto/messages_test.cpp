#include "proto/messages.h"

#include "proto/envelope.h"
#include "proto/framing.h"
#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

#include <limits>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

ByteBuffer octets_of(const Message& message) {
  ByteBuffer out;
  append_message(message, out);
  return {out.begin() + 4, out.end()};
}

ByteBuffer octets_of(const wire::Envelope& envelope) {
  const std::string text = envelope.SerializeAsString();
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

template <class T>
T round_trip_of(const T& message) {
  return std::get<T>(parse_message(octets_of(Message{message})).value());
}

ClientHello hello() {
  ClientHello m;
  m.versions = {1, 3};
  m.client_name = "atlas-client";
  m.display = {960, 540};
  m.vertical_fov = 1.0;
  m.eye_separation = 0.064;
  m.max_picture = {2048, 4096};
  m.meta_codecs = {2, 1};
  m.wanted_atlas = Extent2D{1024, 512};
  m.wanted_bit_rate = BitRate{10'000'000};
  m.wanted_frame_rate = 15.0;
  return m;
}

ServerHello answer() {
  ServerHello m;
  m.session = SessionId{77};
  for (std::size_t i = 0; i < 16; ++i) m.udp_token[i] = static_cast<std::byte>(i * 16);
  m.stream.scene = "atrium";
  m.stream.picture = {1024, 2048};
  m.stream.atlas = {1024, 1024};
  m.stream.has_coverage = true;
  m.stream.grid = {{-1.5, 2.25, 1e6}, 0.001, 18};
  m.stream.ssrc = 0xDEADBEEF;
  m.stream.background = {0.25F, 0.5F, 4.0F};
  m.stream.alpha_mask = true;
  m.stream.memory = AtlasMemory{7, 1, 0.9};
  m.stream.motion = MotionDescription{.movers = {{0, 3, false, 1}, {3, 1000, true, 0}, {2000, 1, false, 0}},
                                      .pivots = {{1, 2, 3}, {0, (1U << 18U) - 1, 0}},
                                      .translation_step = 0.25,
                                      .rotation_bits = 17};
  return m;
}

/// An envelope that is right, for tests that spoil one field.
wire::Envelope parsed(const Message& message) { return parse_envelope(octets_of(message)).value(); }

TEST(Messages, ClientHelloComesBackAsSent) {
  const ClientHello m = round_trip_of(hello());
  EXPECT_EQ(m.versions.lowest, 1U);
  EXPECT_EQ(m.versions.highest, 3U);
  EXPECT_EQ(m.client_name, "atlas-client");
  EXPECT_EQ(m.display, (Extent2D{960, 540}));
  EXPECT_EQ(m.vertical_fov, 1.0);
  EXPECT_EQ(m.eye_separation, 0.064);
  EXPECT_EQ(m.max_picture, (Extent2D{2048, 4096}));
  EXPECT_EQ(m.meta_codecs, (std::vector<std::uint32_t>{2, 1}));
  EXPECT_EQ(m.wanted_atlas, (Extent2D{1024, 512}));
  EXPECT_EQ(m.wanted_bit_rate, BitRate{10'000'000});
  EXPECT_EQ(m.wanted_frame_rate, 15.0);
}

TEST(Messages, WishesMayBeAbsent) {
  ClientHello m = hello();
  m.wanted_atlas.reset();
  m.wanted_bit_rate.reset();
  m.wanted_frame_rate.reset();
  m = round_trip_of(m);
  EXPECT_FALSE(m.wanted_atlas || m.wanted_bit_rate || m.wanted_frame_rate);
}

TEST(Messages, ServerHelloComesBackAsSent) {
  const ServerHello m = round_trip_of(answer());
  EXPECT_EQ(m.session, SessionId{77});
  EXPECT_EQ(m.udp_token, answer().udp_token);
  EXPECT_EQ(m.stream.scene, "atrium");
  EXPECT_EQ(m.stream.picture, (Extent2D{1024, 2048}));
  EXPECT_EQ(m.stream.atlas, (Extent2D{1024, 1024}));
  EXPECT_TRUE(m.stream.has_coverage);
  EXPECT_EQ(m.stream.grid.origin, glm::dvec3(-1.5, 2.25, 1e6));
  EXPECT_EQ(m.stream.grid.step, 0.001);
  EXPECT_EQ(m.stream.grid.bits, 18U);
  EXPECT_EQ(m.stream.ssrc, 0xDEADBEEF);
  EXPECT_EQ(m.stream.payload_type, 96);
  EXPECT_EQ(m.stream.background, (std::array<float, 3>{0.25F, 0.5F, 4.0F}));
  EXPECT_EQ(m.stream.memory, (AtlasMemory{7, 1, 0.9}));
  EXPECT_EQ(m.stream.motion, answer().stream.motion);
  EXPECT_TRUE(m.stream.alpha_mask);
  EXPECT_FALSE(m.stream.alpha_blend);
  EXPECT_FALSE(m.stream.double_sided);
}

TEST(Messages, FrameMetaComesBackAsSent) {
  FrameMeta m;
  m.frame = FrameId{0xFFFFFFFF};
  m.pose = PoseId{3};
  m.stamps = {at(1ns), at(2ms), at(3s), at(-4s), at(5h)};
  m.cover = 150ms;
  m.meta = test::from_hex("00 ff 80 7f");
  m.scene_time = -3s;
  m.scene_ahead = 45ms;
  m.motion = test::from_hex("b2 01");
  const FrameMeta got = round_trip_of(m);
  EXPECT_EQ(got.frame, m.frame);
  EXPECT_EQ(got.pose, m.pose);
  EXPECT_EQ(got.stamps.pose_received, m.stamps.pose_received);
  EXPECT_EQ(got.stamps.render_start, m.stamps.render_start);
  EXPECT_EQ(got.stamps.render_end, m.stamps.render_end);
  EXPECT_EQ(got.stamps.encode_end, m.stamps.encode_end);
  EXPECT_EQ(got.stamps.sent, m.stamps.sent);
  EXPECT_EQ(got.cover, m.cover);
  EXPECT_EQ(got.meta, m.meta);
  EXPECT_EQ(got.scene_time, m.scene_time);
  EXPECT_EQ(got.scene_ahead, m.scene_ahead);
  EXPECT_EQ(got.motion, m.motion);
}

TEST(Messages, TheOthersComeBackAsSent) {
  const Refusal refusal = round_trip_of(Refusal{Refusal::Code::kDraining, "full"});
  EXPECT_EQ(refusal.code, Refusal::Code::kDraining);
  EXPECT_EQ(refusal.text, "full");
  const Goodbye goodbye = round_trip_of(Goodbye{Goodbye::Reason::kTooSlow, "bye"});
  EXPECT_EQ(goodbye.reason, Goodbye::Reason::kTooSlow);
  EXPECT_EQ(goodbye.text, "bye");
  const StatsReport stats = round_trip_of(StatsReport{FrameId{9}, 8, 7, 6, 59.5, 86ms});
  EXPECT_EQ(stats.newest_frame, FrameId{9});
  EXPECT_EQ(stats.frames_paired, 8U);
  EXPECT_EQ(stats.frames_lost, 7U);
  EXPECT_EQ(stats.frames_displayed, 6U);
  EXPECT_EQ(stats.display_rate, 59.5);
  EXPECT_EQ(stats.motion_to_photon, 86ms);
  const RestartRequest restart = round_trip_of(RestartRequest{FrameId{12}, "lost"});
  EXPECT_EQ(restart.frame, FrameId{12});
  EXPECT_EQ(restart.text, "lost");
}

TEST(Messages, AStreamMayRest) {
  ServerHello m = answer();
  m.stream.motion.reset();
  EXPECT_FALSE(round_trip_of(m).stream.motion);
  EXPECT_FALSE(round_trip_of(hello()).shows_motion);
  ClientHello moving = hello();
  moving.shows_motion = true;
  EXPECT_TRUE(round_trip_of(moving).shows_motion);
}

TEST(Messages, AsManyMoversAsThereMayBeFitTheAnswer) {
  ServerHello m = answer();
  m.stream.max_patches = 1U << 26U;
  m.stream.grid.bits = 20;
  MotionDescription& motion = *m.stream.motion;
  motion.movers.clear();
  motion.pivots.assign(kMostMovers, GridPosition((1U << 20U) - 1));
  for (std::uint32_t i = 0; i < kMostMovers; ++i)
    motion.movers.push_back({i * ((1U << 26U) / kMostMovers) + 10'000, 20'000, false, kMostMovers - 1 - i});
  EXPECT_LE(octets_of(Message{m}).size(), kMaxEnvelopeBeforeHello);
  EXPECT_EQ(round_trip_of(m).stream.motion, m.stream.motion);
}

TEST(Messages, AStreamMayHaveNoMemory) {
  ServerHello m = answer();
  m.stream.memory.reset();
  EXPECT_FALSE(round_trip_of(m).stream.memory);
}

TEST(Messages, TextsAreMadeSendable) {
  const Goodbye goodbye =
      round_trip_of(Goodbye{Goodbye::Reason::kDone, "two\nlines \xFF" + std::string(5000, 'x')});
  EXPECT_EQ(goodbye.text.substr(0, 12), "two lines ?x");
  EXPECT_EQ(goodbye.text.size(), 1024U);
}

TEST(Messages, GoldenBytesOfAFrameMeta) {
  FrameMeta m;
  m.frame = FrameId{300};
  m.pose = PoseId{2};
  m.stamps.sent = at(258ns);
  m.cover = 5ns;
  m.meta = test::from_hex("abcd");
  ByteBuffer out;
  append_message(m, out);
  EXPECT_EQ(test::to_hex(out),
            "00000016"  // length
            "1a14"      // envelope field 3, 20 octets
            "08ac02"
            "1002"                // frame 300, pose 2
            "390201000000000000"  // sent, little-endian fixed64
            "4005"
            "4a02abcd");  // cover 5, meta
}

TEST(Messages, GoldenBytesOfWhatMoves) {
  const wire::Envelope envelope = parsed(answer());
  const std::string motion = envelope.server_hello().stream().motion().SerializeAsString();
  EXPECT_EQ(test::to_hex(std::as_bytes(std::span(motion))),
            "0a040000e507"          // gaps 0, 0, 997
            "120403e80701"          // counts 3, 1000, 1
            "1a03020001"            // kinds: object 1, deforms, object 0
            "220801020300ffff0f00"  // pivots (1, 2, 3), (0, 2^18 - 1, 0)
            "29000000000000d03f"    // steps of 0.25 m
            "3011");                // 17 bits
}

TEST(Messages, EmphasisComesBackAsSent) {
  EXPECT_EQ(round_trip_of(Emphasis{}), Emphasis{});
  const Emphasis zero{.foveation = 0.0};
  EXPECT_EQ(round_trip_of(zero), zero) << "0 is not absent";
  Emphasis full{.foveation = 8.0};
  for (std::size_t i = 0; i < Emphasis::kMostPriorities; ++i) {
    full.priorities.push_back({std::string(Emphasis::kMostName, 'n'), -8});
  }
  EXPECT_EQ(round_trip_of(full), full);
}

TEST(Messages, GoldenBytesOfAnEmphasis) {
  const Emphasis m{.foveation = 1.5, .priorities = {{"lamp", -2}}};
  EXPECT_EQ(octets_of(m), test::from_hex("421a 09 000000000000f83f 120f 0a04 6c616d70 11 00000000000000c0"));
}

TEST(Messages, GoldenBytesOfARefusal) {
  ByteBuffer out;
  append_message(Refusal{Refusal::Code::kVersion, "no"}, out);
  EXPECT_EQ(test::to_hex(out), "000000082206080112026e6f");
}

TEST(ParseEnvelope, RefusesAnEmptyEnvelope) {
  EXPECT_EQ(parse_envelope({}).error().code, WireError::kMissingField);
}

TEST(ParseEnvelope, RefusesGarbage) {
  EXPECT_EQ(parse_envelope(test::from_hex("ffffffff")).error().code, WireError::kMalformed);
}

TEST(ParseEnvelope, TheLastOfTwoMessagesCounts) {  // protobuf's rule for a oneof
  ByteBuffer both = octets_of(Refusal{Refusal::Code::kVersion, "a"});
  const ByteBuffer second = octets_of(Goodbye{Goodbye::Reason::kDone, "b"});
  both.insert(both.end(), second.begin(), second.end());
  EXPECT_EQ(std::get<Goodbye>(parse_message(both).value()).text, "b");
}

/// Spoils one field of a right envelope and expects the refusal to name it.
template <class Spoil>
void expect_refused(const Message& message, const char* field, const Spoil& spoil) {
  wire::Envelope envelope = parsed(message);
  spoil(envelope);
  const auto result = parse_message(octets_of(envelope));
  ASSERT_TRUE(result.has_error()) << field;
  EXPECT_EQ(result.error().detail, field);
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(ParseEnvelope, RefusesBadClientHellos) {
  const auto check = [](const char* field, auto spoil) {
    expect_refused(hello(), field, [&](wire::Envelope& e) { spoil(*e.mutable_client_hello()); });
  };
  check("client_hello.version", [](auto& m) { m.set_version_min(0); });
  check("client_hello.version", [](auto& m) { m.set_version_min(4); });
  check("client_hello.client_name", [](auto& m) { m.set_client_name(std::string(129, 'x')); });
  check("client_hello.client_name", [](auto& m) { m.set_client_name("\x1B[2J"); });
  check("client_hello.client_name", [](auto& m) { m.set_client_name("\xFF"); });
  check("client_hello.display", [](auto& m) { m.clear_display(); });
  check("client_hello.display", [](auto& m) { m.mutable_display()->set_width(15); });
  check("client_hello.display", [](auto& m) { m.mutable_display()->set_height(16385); });
  for (const double fov : {0.0, -1.0, 3.2, kNaN, kInf}) {
    check("client_hello.vertical_fov", [fov](auto& m) { m.set_vertical_fov(fov); });
  }
  for (const double metres : {-0.001, 1.001, kNaN, kInf}) {
    check("client_hello.eye_separation", [metres](auto& m) { m.set_eye_separation(metres); });
  }
  check("client_hello.max_atlas", [](auto& m) { m.clear_max_atlas(); });
  check("client_hello.meta_codecs", [](auto& m) { m.clear_meta_codecs(); });
  check("client_hello.meta_codecs", [](auto& m) {
    for (int i = 0; i < 20; ++i) m.add_meta_codecs(1);
  });
  check("client_hello.wanted_atlas", [](auto& m) { m.mutable_wanted_atlas()->set_width(1); });
  check("client_hello.wanted_bit_rate", [](auto& m) { m.set_wanted_bit_rate(0); });
  check("client_hello.wanted_frame_rate", [](auto& m) { m.set_wanted_frame_rate(kNaN); });
}

TEST(ParseEnvelope, RefusesBadServerHellos) {
  const auto check = [](const char* field, auto spoil) {
    expect_refused(answer(), field, [&](wire::Envelope& e) { spoil(*e.mutable_server_hello()); });
  };
  check("server_hello.version", [](auto& m) { m.set_version(0); });
  check("server_hello.session", [](auto& m) { m.set_session(0); });
  check("server_hello.udp_token", [](auto& m) { m.set_udp_token("short"); });
  check("server_hello.stream", [](auto& m) { m.clear_stream(); });
  check("stream.picture", [](auto& m) { m.mutable_stream()->mutable_picture()->set_height(2047); });
  check("stream.atlas", [](auto& m) { m.mutable_stream()->mutable_atlas()->set_width(0); });
  check("stream.grid_origin", [](auto& m) { m.mutable_stream()->set_grid_origin_z(kNaN); });
  check("stream.grid_step", [](auto& m) { m.mutable_stream()->set_grid_step(0); });
  check("stream.grid_step", [](auto& m) { m.mutable_stream()->set_grid_step(kInf); });
  check("stream.grid_bits", [](auto& m) { m.mutable_stream()->set_grid_bits(21); });
  check("stream.meta_codec", [](auto& m) { m.mutable_stream()->set_meta_codec(0); });
  const auto memory = [](auto& m) { return m.mutable_stream()->mutable_memory(); };
  check("stream.memory.superblock_log2", [&](auto& m) { memory(m)->set_superblock_log2(3); });
  check("stream.memory.superblock_log2", [&](auto& m) { memory(m)->set_superblock_log2(13); });
  check("stream.memory.superblock_log2", [&](auto& m) { memory(m)->set_superblock_log2(11); });
  check("stream.memory.min_block_log2", [&](auto& m) { memory(m)->set_min_block_log2(8); });
  check("stream.memory.high_water", [&](auto& m) { memory(m)->set_high_water(kNaN); });
  const auto motion = [](auto& m) { return m.mutable_stream()->mutable_motion(); };
  check("stream.motion.gaps", [&](auto& m) { motion(m)->clear_gaps(); });
  check("stream.motion.gaps", [&](auto& m) {
    for (std::uint32_t i = 0; i < kMostMovers; ++i) motion(m)->add_gaps(0);
  });
  check("stream.motion.gaps", [&](auto& m) { motion(m)->set_gaps(2, (1U << 22U) - 1003); });
  check("stream.motion.gaps", [&](auto& m) { motion(m)->set_gaps(0, 0xFFFFFFFF); });
  check("stream.motion.counts", [&](auto& m) { motion(m)->add_counts(1); });
  check("stream.motion.counts", [&](auto& m) { motion(m)->set_counts(1, 0); });
  check("stream.motion.kinds", [&](auto& m) { motion(m)->mutable_kinds()->RemoveLast(); });
  check("stream.motion.kinds", [&](auto& m) { motion(m)->set_kinds(0, 3); });
  check("stream.motion.pivots", [&](auto& m) { motion(m)->add_pivots(0); });
  check("stream.motion.pivots", [&](auto& m) { motion(m)->set_pivots(5, 1U << 18U); });
  check("stream.motion.pivots", [&](auto& m) {
    for (int i = 0; i < 6; ++i) motion(m)->add_pivots(0);
  });
  check("stream.motion.translation_step", [&](auto& m) { motion(m)->set_translation_step(kNaN); });
  check("stream.motion.rotation_bits", [&](auto& m) { motion(m)->set_rotation_bits(21); });
  check("stream.max_vertices", [](auto& m) { m.mutable_stream()->set_max_vertices(0xFFFFFFFF); });
  check("stream.max_patches", [](auto& m) { m.mutable_stream()->set_max_patches(0); });
  check("stream.payload_type", [](auto& m) { m.mutable_stream()->set_payload_type(72); });
  check("stream.frame_rate", [](auto& m) { m.mutable_stream()->set_frame_rate(kNaN); });
  check("stream.near_plane", [](auto& m) { m.mutable_stream()->set_near_plane(0); });
  check("stream.background", [](auto& m) { m.mutable_stream()->set_background_green(-1); });
}

TEST(ParseEnvelope, RefusesOtherBadMessages) {
  expect_refused(FrameMeta{}, "frame_meta.cover",
                 [](wire::Envelope& e) { e.mutable_frame_meta()->set_cover(-1); });
  expect_refused(FrameMeta{}, "frame_meta.stamps", [](wire::Envelope& e) {
    e.mutable_frame_meta()->set_encode_end(std::numeric_limits<std::int64_t>::min());
  });
  expect_refused(FrameMeta{}, "frame_meta.scene_ahead",
                 [](wire::Envelope& e) { e.mutable_frame_meta()->set_scene_ahead(-1); });
  expect_refused(FrameMeta{}, "frame_meta.scene_time", [](wire::Envelope& e) {
    e.mutable_frame_meta()->set_scene_time(std::numeric_limits<std::int64_t>::max());
  });
  expect_refused(Refusal{}, "refusal.code",
                 [](wire::Envelope& e) { e.mutable_refusal()->set_code(wire::Refusal::UNSPECIFIED); });
  expect_refused(Refusal{}, "refusal.code", [](wire::Envelope& e) {
    e.mutable_refusal()->set_code(static_cast<wire::Refusal::Code>(99));
  });
  expect_refused(Goodbye{}, "goodbye.text",
                 [](wire::Envelope& e) { e.mutable_goodbye()->set_text(std::string(1025, 'x')); });
  expect_refused(StatsReport{}, "stats_report.display_rate",
                 [](wire::Envelope& e) { e.mutable_stats_report()->set_display_rate(kInf); });
}

TEST(ParseEnvelope, RefusesBadEmphases) {
  const auto check = [](const char* field, auto spoil) {
    expect_refused(Emphasis{.foveation = 1.0, .priorities = {{"lamp", 2}}}, field,
                   [&](wire::Envelope& e) { spoil(*e.mutable_emphasis()); });
  };
  check("emphasis.foveation", [](auto& m) { m.set_foveation(8.01); });
  check("emphasis.foveation", [](auto& m) { m.set_foveation(kNaN); });
  check("emphasis.foveation", [](auto& m) { m.set_foveation(-0.1); });
  check("emphasis.priorities.surface", [](auto& m) { m.mutable_priorities(0)->clear_surface(); });
  check("emphasis.priorities.surface", [](auto& m) { m.mutable_priorities(0)->set_surface("two\nlines"); });
  check("emphasis.priorities.surface",
        [](auto& m) { m.mutable_priorities(0)->set_surface(std::string(129, 'x')); });
  check("emphasis.priorities.octaves", [](auto& m) { m.mutable_priorities(0)->set_octaves(-8.01); });
  check("emphasis.priorities.octaves", [](auto& m) { m.mutable_priorities(0)->set_octaves(kNaN); });
  check("emphasis.priorities", [](auto& m) {
    while (m.priorities_size() <= 256) *m.add_priorities() = m.priorities(0);
  });
}

TEST(ParseEnvelope, SurvivesEveryDamage) {
  for (const Message& message : {Message{hello()}, Message{answer()}, Message{FrameMeta{}},
                                 Message{Emphasis{.foveation = 1.5, .priorities = {{"lamp", -2}}}}}) {
    test::for_each_damage(octets_of(message), [](const ByteBuffer& bytes) {
      const auto result = parse_message(bytes);
      if (result.has_value()) {  // what passes must be sendable again
        ByteBuffer out;
        append_message(*result, out);
      }
    });
  }
}

}  // namespace
}  // namespace atlaswire::proto
