#include "codec/paper_meta.h"

#include "codec/octree.h"
#include "tests/codec/meta_support.h"
#include "tests/codec/scene_walk.h"
#include "tests/codec/shown_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

namespace atlaswire::codec {
namespace {

ByteBuffer encoded(const MetaUpdate& update, const MetaLimits& limits = test_limits()) {
  ByteBuffer out;
  PaperMetaEncoder(limits).encode(update, out);
  return out;
}

Result<MetaUpdate> decoded(ByteView bytes, const MetaLimits& limits = test_limits()) {
  return PaperMetaDecoder(limits).decode(bytes);
}

std::error_code refusal(ByteView bytes) {
  const auto result = decoded(bytes);
  return result ? std::error_code{} : result.error().code;
}

/// Vertices by id, as other forms have them.
MetaUpdate tidied(MetaUpdate update) {
  std::ranges::sort(update.vertices, {}, &NewVertex::id);
  return update;
}

/// Bits of an update behind its form and frame 0.
class Body {
 public:
  Body() : bytes_{std::byte{0xB1}}, writer_(bytes_) { writer_.write(0, 32); }
  Body& count(std::uint32_t n) { return code(n, 5); }
  Body& code(std::uint32_t n, std::uint32_t order) {
    writer_.write_golomb(n, order);
    return *this;
  }
  Body& bits(std::uint32_t value, std::uint32_t count) {
    writer_.write(value, count);
    return *this;
  }
  /// A column of order 0.
  Body& column(std::initializer_list<std::uint32_t> numbers) {
    bits(0, 4);
    for (const std::uint32_t n : numbers) code(n, 0);
    return *this;
  }
  ByteBuffer end() {
    writer_.finish();
    return bytes_;
  }

 private:
  ByteBuffer bytes_;
  BitWriter writer_;
};

/// One update with a bit of everything, and its bytes.
MetaUpdate small_update() {
  MetaUpdate update;
  update.frame = FrameId{0x01020304};
  update.removed = {PatchId{2}, PatchId{3}};
  update.vertices = {{VertexId{5}, {10, 0, 300}}, {VertexId{6}, {9, 1, 300}}};
  update.added = {{.id = PatchId{7},
                   .triangles = 1,
                   .draw = {.alpha = PatchClass::Alpha::kMask, .double_sided = true},
                   .corners = {VertexId{5}, VertexId{6}, VertexId{4}},
                   .block = {.x = 128, .y = 8, .width_log2 = 3, .height_log2 = 2, .transposed = true}}};
  update.moved = {{PatchId{1}, {.x = 1, .y = 2, .width_log2 = 1, .height_log2 = 0}}};
  return update;
}

TEST(PaperMetaEncode, WritesGoldenBytes) {
  std::string hex;
  for (const std::byte octet : encoded(small_update())) {
    constexpr char kDigits[] = "0123456789ABCDEF";
    hex += kDigits[std::to_integer<unsigned>(octet) >> 4U];
    hex += kDigits[std::to_integer<unsigned>(octet) & 15U];
  }
  EXPECT_EQ(hex, "B101020304881E20340028000004B00024000404B213F3689C5B9F0B3B006C611C18418B00");
}

TEST(PaperMetaRoundTrip, KeepsASmallUpdate) {
  const auto back = decoded(encoded(small_update()));
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_TRUE(same(*back, small_update()));
}

TEST(PaperMetaRoundTrip, KeepsRandomUpdates) {
  Random random(11);
  for (const std::size_t size : {0, 1, 5, 29, 31, 200, 3000}) {
    for (int i = 0; i < 4; ++i) {
      const MetaUpdate update = random_update(random, size);
      const auto back = decoded(encoded(update));
      ASSERT_TRUE(back) << back.error().message();
      EXPECT_TRUE(same(tidied(*back), update));
    }
  }
}

TEST(PaperMetaRoundTrip, KeepsWhatAWalkShows) {
  SceneWalk walk(5);
  PaperMetaEncoder encoder(walk.limits());
  PaperMetaDecoder decoder(walk.limits());
  ShownPatches wanted;
  ShownPatches got;
  for (int frame = 0; frame < 60; ++frame) {
    const MetaUpdate update = walk.next(frame == 40);
    ByteBuffer bytes;
    encoder.encode(update, bytes);
    const auto back = decoder.decode(bytes);
    ASSERT_TRUE(back) << back.error().message();
    wanted.apply(update);
    got.apply(*back);
    ASSERT_TRUE(wanted == got) << frame;
  }
}

TEST(PaperMetaRoundTrip, KeepsListsInAnyOrder) {
  Random random(12);
  MetaUpdate update = random_update(random, 100);
  const MetaUpdate in_order = update;
  std::ranges::reverse(update.removed);
  std::ranges::reverse(update.vertices);
  std::ranges::reverse(update.added);
  std::ranges::reverse(update.moved);
  const auto back = decoded(encoded(update));
  ASSERT_TRUE(back);
  EXPECT_TRUE(same(tidied(*back), in_order));
}

TEST(PaperMetaRoundTrip, KeepsAMillionVerticesAndManyAtOnePlace) {
  MetaLimits limits = test_limits();
  limits.max_vertices = 1U << 20U;
  limits.grid_bits = 20;
  Random random(13);
  for (const bool equal : {false, true}) {
    MetaUpdate update;
    for (std::uint32_t i = 0; i < limits.max_vertices; ++i) {
      const auto axis = [&] { return static_cast<std::uint32_t>(equal ? 5 : random.below(1U << 20U)); };
      update.vertices.push_back({VertexId{i}, {axis(), axis(), axis()}});
    }
    const auto back = decoded(encoded(update, limits), limits);
    ASSERT_TRUE(back);
    EXPECT_TRUE(same(tidied(*back), update));
  }
}

TEST(PaperMetaDecode, RefusesTruncationsAndTellsFlips) {
  Random random(14);
  for (const std::size_t size : {3, 60}) {
    const ByteBuffer whole = encoded(random_update(random, size));
    for (std::size_t at = 0; at < whole.size(); ++at) {
      EXPECT_FALSE(decoded(ByteView(whole).first(at))) << at;
      for (const unsigned mask : {0x01U, 0x80U, 0xFFU}) {
        ByteBuffer bent = whole;
        bent[at] ^= static_cast<std::byte>(mask);
        // Refused, or another update that is as good as any.
        const auto update = decoded(bent);
        if (!update) continue;
        const auto again = decoded(encoded(*update));
        ASSERT_TRUE(again) << at;
        EXPECT_TRUE(same(tidied(*again), tidied(*update)));
      }
    }
  }
}

TEST(PaperMetaDecode, RefusesWhatFollowsTheEnd) {
  ByteBuffer bytes = encoded(small_update());
  bytes.push_back(std::byte{0});
  EXPECT_EQ(refusal(bytes), MetaError::kTrailingBytes);
  EXPECT_EQ(refusal(Body().count(0).count(0).count(0).count(0).bits(1, 1).end()), MetaError::kTrailingBytes);
}

TEST(PaperMetaDecode, RefusesOtherForms) {
  EXPECT_EQ(refusal({}), MetaError::kTruncated);
  EXPECT_EQ(refusal(ByteBuffer(9, std::byte{0xA1})), MetaError::kBadVersion);
  EXPECT_EQ(refusal(ByteBuffer(kMaxMetaBody + 1, std::byte{0xB1})), MetaError::kTooLarge);
}

TEST(PaperMetaDecode, BelievesNoCountBeyondTheBitsLeft) {
  EXPECT_EQ(refusal(Body().count(1U << 28U).end()), MetaError::kTruncated);
  EXPECT_EQ(refusal(Body().count(0).count(0xFFFFFFFF).end()), MetaError::kTruncated);
  EXPECT_EQ(refusal(Body().count(0).count(0).count(5).bits(0, 32).end()), MetaError::kTruncated);
}

TEST(PaperMetaDecode, RefusesIdsOutOfRange) {
  EXPECT_FALSE(refusal(Body().count(1).column({19'999}).count(0).count(0).count(0).end()));
  EXPECT_EQ(refusal(Body().count(1).column({20'000}).count(0).count(0).count(0).end()),
            MetaError::kIdOutOfRange);
  EXPECT_EQ(refusal(Body().count(2).column({19'999, 0}).count(0).count(0).count(0).end()),
            MetaError::kIdOutOfRange);
  EXPECT_EQ(refusal(Body().count(0).count(1).column({40'000}).bits(0, 32).bits(0, 32).end()),
            MetaError::kIdOutOfRange);
}

TEST(PaperMetaDecode, RefusesVerticesThatComeTwice) {
  Body body;
  body.count(0).count(31).bits(0, 4);
  for (int i = 0; i < 31; ++i) body.code(0, 0);  // vertex 0, again and again
  EXPECT_EQ(refusal(body.bits(0, 32).end()), MetaError::kBadOrder);
}

TEST(PaperMetaDecode, RefusesImpossiblePatchesAndBlocks) {
  const auto patch = [](std::uint32_t number) {
    return Body()
        .count(0)
        .count(0)
        .count(1)
        .column({0})
        .column({zigzag(static_cast<std::int32_t>(number))})
        .bits(0, 32)
        .end();
  };
  EXPECT_EQ(refusal(patch(5)), MetaError::kBadPatch);
  EXPECT_EQ(refusal(patch(24)), MetaError::kBadPatch);
  const auto moved = [](std::uint32_t w, std::uint32_t h, std::uint32_t x, std::uint32_t y) {
    return Body()
        .count(0)
        .count(0)
        .count(0)
        .count(1)
        .column({0})
        .column({2 * w})
        .column({2 * h})
        .column({2 * x})
        .column({2 * y})
        .bits(0, 1)
        .end();
  };
  EXPECT_FALSE(refusal(moved(0, 0, 1023, 511)));
  EXPECT_EQ(refusal(moved(0, 0, 1024, 0)), MetaError::kBadBlock);
  EXPECT_EQ(refusal(moved(0, 0, 0, 512)), MetaError::kBadBlock);
  EXPECT_EQ(refusal(moved(0, 1, 0, 0)), MetaError::kBadBlock);
  EXPECT_EQ(refusal(moved(16, 0, 0, 0)), MetaError::kBadBlock);
  EXPECT_EQ(refusal(moved(0, 0, 0x10000, 0)), MetaError::kBadBlock);
}

TEST(PaperMetaDecode, RefusesMovesOfWhatTheUpdateRemoves) {
  const auto both = [](std::uint32_t id) {
    return Body()
        .count(1)
        .column({3})
        .count(0)
        .count(0)
        .count(1)
        .column({id})
        .column({0})
        .column({0})
        .column({0})
        .column({0})
        .bits(0, 1)
        .end();
  };
  EXPECT_EQ(refusal(both(3)), MetaError::kBadOrder);
  EXPECT_FALSE(refusal(both(4)));
}

TEST(MetaCodecs, HaveNamesThatFindThem) {
  for (const MetaCodecKind kind : kMetaCodecs) {
    EXPECT_EQ(find_meta_codec(name(kind)), kind);
    EXPECT_NE(make_meta_encoder(kind, test_limits()), nullptr);
    EXPECT_NE(make_meta_decoder(kind, test_limits()), nullptr);
  }
  EXPECT_FALSE(find_meta_codec("draco"));
}

}  // namespace
}  // namespace atlaswire::codec
