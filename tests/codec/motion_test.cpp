#include "codec/motion.h"

#include "base/random.h"
#include "tests/codec/motion_support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

namespace atlaswire::codec {
namespace {

constexpr double kFrame = 1.0 / 60;

MotionScope whole(const WavingSheet& sheet) { return {&sheet.surface(), sheet.all(), {}}; }

MotionError refusal(const Result<void>& result) {
  EXPECT_TRUE(result.has_error());
  return result.has_error() ? static_cast<MotionError>(result.error().code.value()) : MotionError{};
}

TEST(MotionRoundTrip, KeepsAWavingSheetForThousandsOfFrames) {
  const WavingSheet sheet(12);
  MotionStream stream(WavingSheet::settings());
  std::size_t bytes = 0;
  constexpr int kFrames = 4000;
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto positions = sheet.at(frame * kFrame);
    bytes += stream.pass(whole(sheet), {.positions = positions}).size();
    ASSERT_FALSE(HasFailure()) << frame;
  }
  // 48 bits as they stand.
  EXPECT_LT(8.0 * static_cast<double>(bytes) / (kFrames * 144), 8.0);
}

TEST(MotionRoundTrip, FittedWeightsTakeFewerBytes) {
  const WavingSheet sheet(20);
  MotionEncoder fitting(WavingSheet::settings());
  MotionEncoder fixed(WavingSheet::settings(), false);
  MotionDecoder decoder(WavingSheet::settings());
  ByteBuffer fitted_bytes;
  ByteBuffer fixed_bytes;
  for (int frame = 0; frame < 120; ++frame) {
    const auto positions = sheet.at(frame * kFrame);
    ASSERT_TRUE(fitting.encode(whole(sheet), {.positions = positions}, fitted_bytes));
    const std::size_t before = fixed_bytes.size();
    ASSERT_TRUE(fixed.encode(whole(sheet), {.positions = positions}, fixed_bytes));
    ASSERT_TRUE(decoder.decode(whole(sheet), ByteView(fixed_bytes).subspan(before)));
  }
  EXPECT_LT(1.3 * static_cast<double>(fitted_bytes.size()), static_cast<double>(fixed_bytes.size()));
}

TEST(MotionRoundTrip, KeepsRandomWalksStopsAndTeleports) {
  const WavingSheet sheet(7);
  Random random(5);
  MotionStream stream(WavingSheet::settings());
  auto positions = sheet.at(0);
  for (int frame = 0; frame < 1500; ++frame) {
    const auto what = random.below(20);
    for (glm::dvec3& p : positions) {
      if (what < 5) break;                              // a rest
      if (what < 15 && random.below(3) == 0) continue;  // some rest
      const double reach = what == 19 ? 5.0 : 1e-4 * static_cast<double>(1U << random.below(8));
      const auto step = [&](double from) {
        return std::clamp(from + reach * (2 * random.uniform() - 1), -5.9, 5.9);
      };
      p = {step(p.x), step(p.y), step(p.z)};
    }
    stream.pass(whole(sheet), {.positions = positions});
    ASSERT_FALSE(HasFailure()) << frame;
  }
}

TEST(MotionRoundTrip, KeepsThoseWhoComeAndGo) {
  const WavingSheet sheet(9);
  Random random(6);
  MotionStream stream(WavingSheet::settings());
  std::vector<std::uint32_t> there;
  std::vector<std::uint32_t> objects;
  for (int frame = 0; frame < 600; ++frame) {
    if (frame % 7 == 0) {
      there.clear();
      objects.clear();
      for (const std::uint32_t v : sheet.all()) {
        if (random.below(3) != 0) there.push_back(v);
      }
      for (std::uint32_t o = 0; o < 40; ++o) {
        if (random.below(3) != 0) objects.push_back(3 * o);
      }
    }
    const auto all = sheet.at(frame * kFrame);
    std::vector<glm::dvec3> positions;
    for (const std::uint32_t v : there) positions.push_back(all[v]);
    std::vector<RigidTransform> transforms;
    for (const std::uint32_t o : objects) transforms.push_back(orbit(o, frame * kFrame * (o % 2)));
    stream.pass({&sheet.surface(), there, objects},
                {.reset = frame == 300, .positions = positions, .transforms = transforms});
    ASSERT_FALSE(HasFailure()) << frame;
  }
}

TEST(MotionRoundTrip, KeepsASurfaceThatGrows) {
  MotionSurface surface;
  MotionStream stream(WavingSheet::settings());
  std::vector<std::uint32_t> all;
  std::vector<glm::dvec3> positions;
  for (std::uint32_t frame = 0; frame < 200; ++frame) {
    const glm::dvec3 rest(0.01 * (frame % 10), 0.01 * (frame / 10), 0);
    all.push_back(surface.add(WavingSheet::settings().grid.quantize(rest)));
    if (frame > 0) surface.connect(frame, frame - 1);
    positions.push_back(rest + glm::dvec3(1, 0, 0));
    for (glm::dvec3& p : positions) p.y += 0.001;
    stream.pass({&surface, all, {}}, {.positions = positions});
    ASSERT_FALSE(HasFailure()) << frame;
  }
}

TEST(MotionRoundTrip, KeepsAllOfTheFinestGridAndItsMargin) {
  MotionSettings settings;
  settings.grid = {.origin = glm::dvec3(1e6, -1e6, 0), .step = 1e-3, .bits = 20};
  MotionSurface surface;
  std::vector<std::uint32_t> all;
  for (int i = 0; i < 64; ++i) all.push_back(surface.add(GridPosition(0xFFFFF)));
  for (std::uint32_t i = 1; i < 64; ++i) surface.connect(i, i - 1);
  MotionStream stream(settings);
  Random random(8);
  for (int frame = 0; frame < 100; ++frame) {
    std::vector<glm::dvec3> positions;
    for (int i = 0; i < 64; ++i) {
      const auto end = [&] { return (random.below(2) == 0 ? -1048576.0 : 2097151.0) * 1e-3; };
      positions.push_back(settings.grid.origin + glm::dvec3(end(), end(), end()));
    }
    stream.pass({&surface, all, {}}, {.positions = positions});
    ASSERT_FALSE(HasFailure()) << frame;
  }
}

TEST(MotionRoundTrip, KeepsNothingAndOneAndAMillion) {
  MotionStream empty(WavingSheet::settings());
  EXPECT_LE(empty.pass({}, {}).size(), 3U);
  const WavingSheet one(1);
  MotionStream single(WavingSheet::settings());
  for (int frame = 0; frame < 10; ++frame) {
    const std::vector<glm::dvec3> there{glm::dvec3(0.1 * frame, 0, 0)};
    single.pass(whole(one), {.positions = there});
  }
  const WavingSheet many(1024);
  MotionStream stream(WavingSheet::settings());
  for (int frame = 0; frame < 3; ++frame) {
    const auto positions = many.at(0.1 + frame * kFrame);
    stream.pass(whole(many), {.positions = positions});
  }
}

TEST(MotionRoundTrip, RestCostsNextToNothing) {
  const WavingSheet sheet(100);
  MotionStream stream(WavingSheet::settings());
  std::vector<std::uint32_t> objects(1000);
  std::iota(objects.begin(), objects.end(), 0U);
  const std::vector<RigidTransform> transforms(1000, orbit(2, 1));
  const MotionScope scope{&sheet.surface(), sheet.all(), objects};
  const auto positions = sheet.at(0.3);
  ByteBuffer message;
  for (int frame = 0; frame < 60; ++frame)
    message = stream.pass(scope, {.positions = positions, .transforms = transforms});
  EXPECT_LT(message.size(), 20U);
}

TEST(MotionRoundTrip, KeepsObjectsThatOrbitBounceAndJump) {
  MotionStream stream(WavingSheet::settings());
  const std::vector<std::uint32_t> objects{0, 1, 2, 3, 9};
  Random random(4);
  for (int frame = 0; frame < 3000; ++frame) {
    const double t = frame * kFrame;
    RigidTransform bouncing;
    bouncing.translation.y = std::abs(std::sin(3 * t));
    RigidTransform jumping;
    jumping.translation = 1e4 * glm::dvec3(random.uniform(), random.uniform(), random.uniform());
    jumping.orientation = {random.normal(), random.normal(), random.normal(), random.normal()};
    const double length = glm::length(jumping.orientation);
    if (length < 0.5 || length > 2) jumping.orientation = {1, 0, 0, 0};
    const std::vector<RigidTransform> transforms{orbit(3, t), orbit(0.1, 20 * t), bouncing, jumping, {}};
    stream.pass({nullptr, {}, objects}, {.transforms = transforms});
    ASSERT_FALSE(HasFailure()) << frame;
  }
}

TEST(MotionEncode, RefusesWhatCannotBeTold) {
  const WavingSheet sheet(3);
  const std::vector<std::uint32_t> objects{7};
  MotionStream stream(WavingSheet::settings());
  const MotionScope scope{&sheet.surface(), sheet.all(), objects};
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto positions = sheet.at(0);
  const auto refuse = [&](std::size_t vertex, double x, const RigidTransform& transform) {
    auto bent = positions;
    bent[vertex].x += x;
    ByteBuffer out;
    const auto told =
        stream.encoder.encode(scope, {.positions = bent, .transforms = std::span(&transform, 1)}, out);
    EXPECT_TRUE(out.empty());
    EXPECT_NE(told.error().detail.find(x != 0 ? "vertex 4" : "object 7"), std::string::npos);
    return refusal(told);
  };
  EXPECT_EQ(refuse(4, kNaN, {}), MotionError::kNotFinite);
  EXPECT_EQ(refuse(4, -kInfinity, {}), MotionError::kNotFinite);
  EXPECT_EQ(refuse(4, 7.0, {}), MotionError::kBadPosition);
  EXPECT_EQ(refuse(0, 0, {.translation = {0, kNaN, 0}}), MotionError::kNotFinite);
  EXPECT_EQ(refuse(0, 0, {.translation = {0, 0, 1e9}}), MotionError::kBadTranslation);
  EXPECT_EQ(refuse(0, 0, {.orientation = {kInfinity, 0, 0, 0}}), MotionError::kNotFinite);
  EXPECT_EQ(refuse(0, 0, {.orientation = {0, 0, 0, 0}}), MotionError::kBadRotation);
  // Nothing of it was remembered.
  stream.pass(scope, {.positions = positions, .transforms = std::vector<RigidTransform>(1)});
}

/// A few honest messages over a small sheet and two objects.
struct Conversation {
  Conversation() : sheet(4), scope{&sheet.surface(), sheet.all(), objects} {
    MotionEncoder encoder(WavingSheet::settings());
    for (int frame = 0; frame < 8; ++frame) {
      const auto positions = sheet.at(frame * kFrame);
      const std::vector<RigidTransform> transforms{orbit(1, frame * kFrame), {}};
      EXPECT_TRUE(
          encoder.encode(scope, {.positions = positions, .transforms = transforms}, messages.emplace_back()));
    }
  }
  WavingSheet sheet;
  std::vector<std::uint32_t> objects{0, 5};
  MotionScope scope;
  std::vector<ByteBuffer> messages;
};

/// Everything a decoder shows after the messages; empty: one was refused.
std::vector<double> shown_after(const Conversation& talk, std::span<const ByteBuffer> messages) {
  MotionDecoder decoder(WavingSheet::settings());
  for (const ByteBuffer& message : messages) {
    if (decoder.decode(talk.scope, message).has_error()) return {};
  }
  std::vector<double> out;
  const auto add = [&out](const glm::dvec3& v) { out.insert(out.end(), {v.x, v.y, v.z}); };
  for (const std::uint32_t v : talk.scope.vertices) add(decoder.position(talk.sheet.surface(), v));
  for (const std::uint32_t o : talk.scope.objects) {
    const RigidTransform t = decoder.transform(o);
    add(t.translation);
    add({t.orientation.x, t.orientation.y, t.orientation.z});
  }
  return out;
}

TEST(MotionDecode, RefusesTruncationsAndFlips) {
  const Conversation talk;
  for (std::size_t last = 0; last < talk.messages.size(); ++last) {
    std::vector<ByteBuffer> messages(talk.messages.begin(),
                                     talk.messages.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    const auto shown = shown_after(talk, messages);
    ASSERT_FALSE(shown.empty());
    const ByteBuffer whole_message = messages.back();
    for (std::size_t at = 0; at < whole_message.size(); ++at) {
      messages.back().resize(at);
      EXPECT_TRUE(shown_after(talk, messages).empty()) << last << ": " << at;
      for (unsigned bit = 0; bit < 8; ++bit) {
        messages.back() = whole_message;
        messages.back()[at] ^= static_cast<std::byte>(1U << bit);
        // The last octet may have bits that no decision depends on; the first may ask for a reset of nothing.
        const auto bent = shown_after(talk, messages);
        EXPECT_TRUE(bent.empty() || bent == shown) << last << ": " << at << "." << bit;
      }
      messages.back() = whole_message;
    }
  }
}

TEST(MotionDecode, NoticesALostMessageUntilAReset) {
  const WavingSheet sheet(5);
  MotionStream stream(WavingSheet::settings());
  const auto message_at = [&](int frame, bool reset) {
    ByteBuffer message;
    EXPECT_TRUE(stream.encoder.encode(whole(sheet), {.reset = reset, .positions = sheet.at(frame * kFrame)},
                                      message));
    return message;
  };
  EXPECT_TRUE(stream.decoder.decode(whole(sheet), message_at(0, false)));
  message_at(1, false);
  EXPECT_TRUE(stream.decoder.decode(whole(sheet), message_at(2, false)).has_error());
  EXPECT_EQ(refusal(stream.decoder.decode(whole(sheet), message_at(3, false))), MotionError::kOutOfStep);
  EXPECT_TRUE(stream.decoder.decode(whole(sheet), message_at(4, true)));
  stream.pass(whole(sheet), {.positions = sheet.at(5 * kFrame)});
}

TEST(MotionDecode, NoticesAnotherScope) {
  const Conversation talk;
  MotionDecoder decoder(WavingSheet::settings());
  MotionScope other = talk.scope;
  other.vertices = other.vertices.first(15);
  EXPECT_TRUE(decoder.decode(other, talk.messages[0]).has_error());
}

TEST(MotionDecode, RefusesOtherForms) {
  const Conversation talk;
  MotionDecoder decoder(WavingSheet::settings());
  EXPECT_EQ(refusal(decoder.decode(talk.scope, {})), MotionError::kTruncated);
  EXPECT_EQ(refusal(decoder.decode(talk.scope, ByteBuffer(1, std::byte{0xA2}))), MotionError::kBadVersion);
  EXPECT_EQ(refusal(decoder.decode(talk.scope, ByteBuffer(kMaxMotionBody + 1))), MotionError::kTooLarge);
  ByteBuffer longer = talk.messages[0];
  longer.insert(longer.end(), 8, std::byte{0});
  EXPECT_TRUE(decoder.decode(talk.scope, longer));
  longer = talk.messages[1];
  longer.insert(longer.end(), 8, std::byte{1});
  EXPECT_EQ(refusal(decoder.decode(talk.scope, longer)), MotionError::kTrailingBytes);
}

TEST(MotionDecode, ShowsRestBeforeAnythingIsTold) {
  const WavingSheet sheet(2);
  const MotionDecoder decoder(WavingSheet::settings());
  EXPECT_LE(glm::distance(decoder.position(sheet.surface(), 3), sheet.at(0)[3]),
            WavingSheet::settings().grid.max_error());
  EXPECT_EQ(decoder.transform(11).translation, glm::dvec3(0));
  EXPECT_EQ(decoder.transform(11).orientation, glm::dquat(1, 0, 0, 0));
}

std::string hex(const ByteBuffer& bytes) {
  std::string out;
  for (const std::byte b : bytes) {
    constexpr char kDigits[] = "0123456789ABCDEF";
    out += {kDigits[std::to_integer<unsigned>(b) >> 4U], kDigits[std::to_integer<unsigned>(b) & 15U], ' '};
  }
  if (!out.empty()) out.pop_back();
  return out;
}

/// The example of docs/PROTOCOL.md.
TEST(MotionEncode, GivesGoldenBytes) {
  MotionSettings settings;
  settings.grid = {.origin = glm::dvec3(0.0), .step = 1.0, .bits = 8};
  settings.transforms = {.step = 1.0, .rotation_bits = 8};
  MotionSurface surface;
  const std::vector<std::uint32_t> vertices{surface.add({10, 10, 10}), surface.add({20, 10, 10}),
                                            surface.add({10, 20, 10})};
  surface.connect_around(vertices);
  const std::vector<std::uint32_t> objects{0};
  MotionEncoder encoder(settings);
  const auto message = [&](double by, const RigidTransform& transform) {
    std::vector<glm::dvec3> positions;
    for (const std::uint32_t v : vertices)
      positions.emplace_back(glm::dvec3(surface.rest(v)) + glm::dvec3(by, 0, -2 * by));
    ByteBuffer out;
    EXPECT_TRUE(encoder.encode({&surface, vertices, objects},
                               {.positions = positions, .transforms = std::span(&transform, 1)}, out));
    return hex(out);
  };
  EXPECT_EQ(message(3, {.translation = {5, 0, -1}}), "B2 2C BC 87 CF 54 7B B2");
  EXPECT_EQ(message(4, {.translation = {5, 0, -1}, .orientation = {0.8, 0, 0.6, 0}}),
            "B2 11 7D B7 C8 A9 D6 81");
  EXPECT_EQ(message(4, {.translation = {5, 0, -1}, .orientation = {0.8, 0, 0.6, 0}}), "B2 CE 34 D7 5B 8A");
}

/// FNV-1a over the messages of a longer talk in whole numbers: weights, joins, leaves, jumps, rests, a reset.
std::uint64_t fingerprint(bool fits) {
  MotionSettings settings;
  settings.grid = {.origin = glm::dvec3(0.0), .step = 1.0, .bits = 12};
  settings.transforms = {.step = 1.0, .rotation_bits = 10};
  constexpr std::uint32_t kSide = 16;
  MotionSurface surface;
  for (std::uint32_t v = 0; v < kSide * kSide; ++v) {
    surface.add({100 * (v % kSide), 100 * (v / kSide), 500});
    if (v % kSide > 0) surface.connect(v, v - 1);
    if (v >= kSide) surface.connect(v, v - kSide);
  }
  MotionEncoder encoder(settings, fits);
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  std::int64_t at = 0;
  std::int64_t speed = 0;
  for (int frame = 0; frame < 150; ++frame) {
    if (frame % 50 < 40) speed += frame % 14 < 7 ? 3 : -3;
    at += frame % 50 < 40 ? speed : 0;
    if (frame == 90) at += 1000;
    std::vector<std::uint32_t> vertices;
    std::vector<glm::dvec3> positions;
    for (std::uint32_t v = 0; v < surface.size(); ++v) {
      if ((v + static_cast<std::uint32_t>(frame) / 20) % 9 == 0) continue;
      vertices.push_back(v);
      const std::int64_t bent = at * (v % kSide) / 16 + at * at * (v / kSide) / 4000 % 300;
      positions.push_back(glm::dvec3(surface.rest(v)) + glm::dvec3(at / 4, -bent / 3, bent));
    }
    const std::vector<std::uint32_t> objects{0, 1, 4};
    const auto turn = static_cast<double>(at % 900);
    const std::vector<RigidTransform> transforms{
        {.translation = {static_cast<double>(at), 3.0 * frame, 0}, .orientation = {0.8, 0, 0.6, 0}},
        {.orientation = glm::dquat(900 - turn, turn, 0, 10) / 1000.0},
        {}};
    ByteBuffer message;
    const auto told =
        encoder.encode({&surface, vertices, objects},
                       {.reset = frame == 120, .positions = positions, .transforms = transforms}, message);
    EXPECT_TRUE(told) << told.error().message();
    for (const std::byte b : message) hash = (hash ^ std::to_integer<std::uint64_t>(b)) * 0x100000001B3ULL;
  }
  return hash;
}

TEST(MotionEncode, SaysTheSameAsEver) {
  EXPECT_EQ(fingerprint(false), 6369215412813251259ULL);
  EXPECT_EQ(fingerprint(true), 4806190380464900275ULL)
      << "the fit's floating point differs here, or the format changed";
}

}  // namespace
}  // namespace atlaswire::codec
