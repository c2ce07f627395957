#include "codec/gate_meta.h"

#include "codec/plain_meta.h"
#include "tests/codec/gate_stream.h"
#include "tests/codec/meta_support.h"
#include "tests/codec/scene_walk.h"
#include "tests/codec/shown_patches.h"

#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <vector>

namespace atlaswire::codec {
namespace {

std::error_code refusal(const Result<MetaUpdate>& result) {
  return result ? std::error_code{} : result.error().code;
}

TEST(GateMetaRoundTrip, KeepsWhatAWalkShows) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SceneWalk walk(seed);
    GateStream stream(walk.limits());
    for (int frame = 0; frame < 120; ++frame) {
      ASSERT_NO_FATAL_FAILURE(stream.pass(walk.next(frame == 70))) << "seed " << seed << " frame " << frame;
    }
  }
}

TEST(GateMetaRoundTrip, TakesHalfOfThePlainForm) {
  SceneWalk walk(4, 40);
  GateStream stream(walk.limits());
  PlainMetaEncoder plain;
  ByteBuffer plain_bytes;
  for (int frame = 0; frame < 90; ++frame) {
    const MetaUpdate update = walk.next();
    plain.encode(update, plain_bytes);
    ASSERT_NO_FATAL_FAILURE(stream.pass(update));
  }
  // Blocks at random places are most of what is left.
  EXPECT_LT(stream.bytes * 2, plain_bytes.size());
}

TEST(GateMetaRoundTrip, KeepsEmptyUpdates) {
  GateStream stream(test_limits());
  for (std::uint32_t frame : {7U, 8U, 9U, 4U, 0xFFFFFFFFU, 0U}) {
    MetaUpdate update;
    update.frame = FrameId{frame};
    ASSERT_NO_FATAL_FAILURE(stream.pass(update));
  }
}

/// `count` patches of one triangle, by a rule that gives each corner's position.
template <class Position>
MetaUpdate triangles(std::uint32_t count, Position position) {
  MetaUpdate update;
  update.reset = true;
  for (std::uint32_t i = 0; i < count; ++i) {
    AddedPatch patch{.id = PatchId{i}};
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      patch.corners[corner] = VertexId{3 * i + corner};
      update.vertices.push_back({VertexId{3 * i + corner}, position(i, corner)});
    }
    patch.block = {.x = static_cast<std::uint16_t>(i % 512 * 2),
                   .y = static_cast<std::uint16_t>(i / 512 % 256 * 2),
                   .width_log2 = 1,
                   .height_log2 = 1};
    update.added.push_back(patch);
  }
  return update;
}

MetaLimits roomy_limits(std::uint32_t grid_bits) {
  return {.max_vertices = 1U << 22U, .max_patches = 1U << 20U, .grid_bits = grid_bits, .atlas = {1024, 512}};
}

TEST(GateMetaRoundTrip, KeepsManyTrianglesAtOnePlace) {
  // Nearly nothing is left to say of each: the message is padded up to what a decoder allows.
  GateStream stream(roomy_limits(16));
  const MetaUpdate update =
      triangles(300'000, [](std::uint32_t, std::uint32_t) { return GridPosition(5, 6, 7); });
  ASSERT_NO_FATAL_FAILURE(stream.pass(update));
  EXPECT_LT(stream.bytes, 700'000U);
}

TEST(GateMetaRoundTrip, KeepsTheCornersOfTheFinestGrid) {
  constexpr std::uint32_t kTop = (1U << 20U) - 1;
  GateStream stream(roomy_limits(20));
  const MetaUpdate update = triangles(2000, [](std::uint32_t i, std::uint32_t corner) {
    const std::uint32_t bits = i * 7 + corner * 3;
    return GridPosition((bits & 1U) * kTop, (bits >> 1U & 1U) * kTop, (bits >> 2U & 1U) * kTop);
  });
  ASSERT_NO_FATAL_FAILURE(stream.pass(update));
}

TEST(GateMetaRoundTrip, KeepsSoup) {
  Random random(3);
  GateStream stream(roomy_limits(20));
  const auto axis = [&] { return static_cast<std::uint32_t>(random.below(1U << 20U)); };
  ASSERT_NO_FATAL_FAILURE(stream.pass(
      triangles(5000, [&](std::uint32_t, std::uint32_t) { return GridPosition(axis(), axis(), axis()); })));
}

TEST(GateMetaRoundTrip, KeepsAPatchThatComesBackInAnotherShape) {
  GateStream stream(test_limits());
  MetaUpdate update;
  update.vertices = {
      {VertexId{0}, {1, 1, 1}}, {VertexId{1}, {9, 1, 1}}, {VertexId{2}, {1, 9, 1}}, {VertexId{3}, {9, 9, 1}}};
  const AddedPatch one{.id = PatchId{4}, .corners = {VertexId{0}, VertexId{1}, VertexId{2}}};
  const AddedPatch two{.id = PatchId{5}, .corners = {VertexId{1}, VertexId{3}, VertexId{2}}};
  update.added = {one, two};
  ASSERT_NO_FATAL_FAILURE(stream.pass(update));
  // In one go, and after it was hidden for a while; and once unchanged.
  AddedPatch other = one;
  other.corners[1] = VertexId{3};
  ASSERT_NO_FATAL_FAILURE(stream.pass({.frame = FrameId{1}, .removed = {one.id}, .added = {other}}));
  ASSERT_NO_FATAL_FAILURE(stream.pass({.frame = FrameId{2}, .removed = {one.id}}));
  other.draw.double_sided = true;
  ASSERT_NO_FATAL_FAILURE(stream.pass({.frame = FrameId{3}, .added = {other}}));
  ASSERT_NO_FATAL_FAILURE(stream.pass({.frame = FrameId{4}, .removed = {two.id}, .added = {two}}));
}

TEST(GateMetaRoundTrip, ForgetsWhatWasHiddenLong) {
  // Far more patches than are kept for later come and go.
  constexpr std::uint32_t kEach = 20'000;
  GateStream stream(roomy_limits(16));
  MetaUpdate update;
  for (std::uint32_t wave = 0; wave < 12; ++wave) {
    update.removed.clear();
    for (const AddedPatch& patch : update.added) update.removed.push_back(patch.id);
    update.added.clear();
    update.vertices.clear();
    for (std::uint32_t i = wave * kEach; i < (wave + 1) * kEach; ++i) {
      AddedPatch patch{.id = PatchId{i}};
      for (std::uint32_t corner = 0; corner < 3; ++corner) patch.corners[corner] = VertexId{i + corner};
      update.added.push_back(patch);
    }
    for (std::uint32_t v = wave == 0 ? 0 : wave * kEach + 2; v < (wave + 1) * kEach + 2; ++v) {
      update.vertices.push_back({VertexId{v}, {v % 400 * 100, v / 400 * 10, v % 2 * 50}});
    }
    update.frame = FrameId{wave};
    if (wave >= 10) {  // the first are back
      for (std::uint32_t i = 0; i < 100; ++i)
        update.added.push_back(
            {.id = PatchId{i}, .corners = {VertexId{i}, VertexId{i + 1}, VertexId{i + 2}}});
    }
    ASSERT_NO_FATAL_FAILURE(stream.pass(update)) << wave;
  }
}

/// Blocks as sizes that are asked for, and a cue.
MetaUpdate asked(MetaUpdate update, std::uint32_t frame) {
  for (AddedPatch& patch : update.added) patch.block.x = patch.block.y = 0;
  for (MovedPatch& patch : update.moved) patch.block.x = patch.block.y = 0;
  update.cue = LayoutCue{.reset = frame % 9 == 0, .check = static_cast<std::uint16_t>(frame * 40'503)};
  return update;
}

TEST(GateMetaRoundTrip, LeavesPositionsToTheReceiver) {
  SceneWalk walk(2);
  GateMetaEncoder encoder(walk.limits(), BlockPositions::kDerived);
  GateMetaEncoder with_positions(walk.limits());
  GateMetaDecoder decoder(walk.limits(), BlockPositions::kDerived);
  ShownPatches wanted;
  ShownPatches got;
  std::size_t bytes = 0;
  std::size_t bytes_with_positions = 0;
  for (std::uint32_t frame = 0; frame < 60; ++frame) {
    const MetaUpdate update = walk.next(frame == 40);
    const MetaUpdate cued = asked(update, frame);
    ByteBuffer message;
    with_positions.encode(update, message);
    bytes_with_positions += message.size();
    message.clear();
    encoder.encode(cued, message);
    bytes += message.size();
    const auto back = decoder.decode(message);
    ASSERT_TRUE(back) << back.error().message();
    ASSERT_TRUE(back->cue);
    EXPECT_EQ(back->cue->reset, cued.cue->reset);
    EXPECT_EQ(back->cue->check, cued.cue->check);
    wanted.apply(cued);
    got.apply(*back);
    ASSERT_TRUE(wanted == got) << frame;
  }
  EXPECT_LT(bytes * 3, bytes_with_positions * 2);
}

TEST(GateMetaDecode, NoticesALostUpdate) {
  SceneWalk walk(6);
  GateStream stream(walk.limits());
  for (int frame = 0; frame < 5; ++frame) ASSERT_NO_FATAL_FAILURE(stream.pass(walk.next()));
  stream.encoded(walk.next());
  EXPECT_FALSE(stream.decoder.decode(stream.encoded(walk.next())));
  // From here on nothing is believed until a restart, not even what is whole.
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(refusal(stream.decoder.decode(stream.encoded(walk.next()))), MetaError::kOutOfStep);
  }
  const MetaUpdate restart = walk.next(true);
  ASSERT_NO_FATAL_FAILURE(stream.pass(restart));
  ASSERT_NO_FATAL_FAILURE(stream.pass(walk.next()));
}

TEST(GateMetaDecode, NoticesThatItCameLate) {
  SceneWalk walk(6);
  GateMetaEncoder encoder(walk.limits());
  ByteBuffer bytes;
  for (int frame = 0; frame < 3; ++frame) {
    bytes.clear();
    encoder.encode(walk.next(), bytes);
  }
  EXPECT_FALSE(GateMetaDecoder(walk.limits()).decode(bytes));
}

TEST(GateMetaDecode, RefusesOtherForms) {
  GateMetaDecoder decoder(test_limits());
  EXPECT_EQ(refusal(decoder.decode({})), MetaError::kTruncated);
  EXPECT_EQ(refusal(decoder.decode(ByteBuffer(1, std::byte{0xA1}))), MetaError::kBadVersion);
  EXPECT_EQ(refusal(decoder.decode(ByteBuffer(kMaxMetaBody + 1))), MetaError::kTooLarge);
  EXPECT_EQ(refusal(decoder.decode(ByteBuffer(1, std::byte{0xA5}))), MetaError::kBadVersion);
  GateMetaDecoder derives(test_limits(), BlockPositions::kDerived);
  EXPECT_EQ(refusal(derives.decode(ByteBuffer(1, std::byte{0xA3}))), MetaError::kBadVersion);
}

TEST(GateMetaDecode, RefusesWhatFollowsTheEnd) {
  SceneWalk walk(8, 6);
  GateStream stream(walk.limits());
  ByteBuffer bytes = stream.encoded(walk.next());
  bytes.insert(bytes.end(), 8, std::byte{0});
  EXPECT_TRUE(stream.decoder.decode(bytes));
  bytes.push_back(std::byte{1});
  EXPECT_EQ(refusal(stream.decoder.decode(bytes)), MetaError::kTrailingBytes);
}

/// What a client shows after the messages; nullopt: one was refused.
std::optional<ShownPatches> shown_after(const MetaLimits& limits, std::span<const ByteBuffer> messages) {
  GateMetaDecoder decoder(limits);
  ShownPatches shown;
  for (const ByteBuffer& message : messages) {
    const auto update = decoder.decode(message);
    if (!update) return std::nullopt;
    shown.apply(*update);
  }
  return shown;
}

TEST(GateMetaDecode, RefusesTruncationsAndFlips) {
  SceneWalk walk(9, 5);
  GateMetaEncoder encoder(walk.limits());
  std::vector<ByteBuffer> messages;
  for (int i = 0; i < 3; ++i) {
    encoder.encode(walk.next(), messages.emplace_back());
    const auto shown = shown_after(walk.limits(), messages);
    ASSERT_TRUE(shown);
    const ByteBuffer whole = messages.back();
    for (std::size_t at = 0; at < whole.size(); ++at) {
      messages.back().resize(at);
      EXPECT_FALSE(shown_after(walk.limits(), messages)) << i << ": " << at << " of " << whole.size();
      for (const unsigned mask : {0x01U, 0x80U, 0xFFU}) {
        messages.back() = whole;
        messages.back()[at] ^= static_cast<std::byte>(mask);
        // The last octet may have bits that no decision depends on.
        const auto bent = shown_after(walk.limits(), messages);
        EXPECT_TRUE(!bent || *bent == *shown) << i << ": " << at << " of " << whole.size();
      }
      messages.back() = whole;
    }
  }
}

TEST(GateMetaDecode, BoundsWhatFewOctetsMayBring) {
  // Whatever zeros decode to, it is soon over.
  for (std::size_t size = 1; size < 2000; size += 37) {
    ByteBuffer bytes(size, std::byte{0xFF});
    bytes[0] = std::byte{0xA3};
    GateMetaDecoder decoder(roomy_limits(16));
    const auto update = decoder.decode(bytes);
    EXPECT_LE(update ? update->added.size() : 0, 64 * size);
  }
}

}  // namespace
}  // namespace atlaswire::codec
