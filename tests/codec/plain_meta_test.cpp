#include "codec/plain_meta.h"

#include "tests/codec/meta_support.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <initializer_list>
#include <limits>

namespace atlaswire::codec {
namespace {

ByteBuffer bytes_of(std::initializer_list<int> octets) {
  ByteBuffer out;
  for (const int octet : octets) out.push_back(static_cast<std::byte>(octet));
  return out;
}

ByteBuffer encoded(const MetaUpdate& update) {
  ByteBuffer out;
  PlainMetaEncoder().encode(update, out);
  return out;
}

Result<MetaUpdate> decoded(ByteView bytes) { return PlainMetaDecoder(test_limits()).decode(bytes); }

std::error_code refusal(ByteView bytes) {
  const auto result = decoded(bytes);
  return result ? std::error_code{} : result.error().code;
}

/// The update behind the golden bytes.
MetaUpdate small_update() {
  MetaUpdate update;
  update.frame = FrameId{0x01020304};
  update.removed = {PatchId{2}, PatchId{3}, PatchId{300}};
  update.vertices = {{VertexId{5}, {10, 0, 300}}, {VertexId{6}, {9, 1, 300}}};
  update.added = {{.id = PatchId{7},
                   .triangles = 2,
                   .draw = {.alpha = PatchClass::Alpha::kMask, .double_sided = true},
                   .corners = {VertexId{5}, VertexId{6}, VertexId{4}, VertexId{4}},
                   .block = {.x = 128, .y = 8, .width_log2 = 3, .height_log2 = 2, .transposed = true}}};
  update.moved = {{PatchId{1}, {.x = 1, .y = 2, .width_log2 = 1, .height_log2 = 0, .transposed = false}}};
  return update;
}

ByteBuffer small_bytes() {
  return bytes_of({
      0xA1, 0x00,                                // form 1, no flags
      0x01, 0x02, 0x03, 0x04,                    // frame
      0x03, 0x02, 0x00, 0xA8, 0x02,              // removed: 2, +1, +297
      0x02, 0x05, 0x14, 0x00, 0xD8, 0x04,        // vertices: 5 at (10, 0, 300)
      0x00, 0x01, 0x02, 0x00,                    //   +1 at (-1, +1, 0) from it
      0x01, 0x07, 0x36, 0x32, 0x80, 0x01, 0x08,  // added: 7, drawing, sides 3 and 2, (128, 8)
      0x0A, 0x02, 0x03, 0x00,                    //   corners +5 +1 -2 0
      0x01, 0x01, 0x00, 0x10, 0x01, 0x02,        // moved: 1, upright, sides 1 and 0, (1, 2)
  });
}

/// A body with valid empty lists but for what `octets` say after the frame number.
ByteBuffer with_body(std::initializer_list<int> octets) {
  ByteBuffer out = bytes_of({0xA1, 0x00, 0, 0, 0, 0});
  const ByteBuffer rest = bytes_of(octets);
  out.insert(out.end(), rest.begin(), rest.end());
  return out;
}

TEST(PlainMetaEncode, WritesGoldenBytes) { EXPECT_EQ(encoded(small_update()), small_bytes()); }

TEST(PlainMetaDecode, ReadsGoldenBytes) {
  const auto update = decoded(small_bytes());
  ASSERT_TRUE(update) << update.error().message();
  EXPECT_TRUE(same(*update, small_update()));
}

TEST(PlainMetaEncode, EmptyUpdateTakesTenOctets) { EXPECT_EQ(encoded({}).size(), 10U); }

TEST(PlainMetaRoundTrip, KeepsRandomUpdates) {
  Random random(7);
  PlainMetaEncoder encoder;
  PlainMetaDecoder decoder(test_limits());
  ByteBuffer bytes;
  for (int i = 0; i < 60; ++i) {
    const MetaUpdate update = random_update(random, random.below(400));
    bytes.clear();
    encoder.encode(update, bytes);
    const auto back = decoder.decode(bytes);
    ASSERT_TRUE(back) << back.error().message();
    ASSERT_TRUE(same(update, *back)) << "update " << i;
  }
}

TEST(PlainMetaRoundTrip, AppendsBehindWhatTheBufferHolds) {
  ByteBuffer out = bytes_of({9, 9});
  PlainMetaEncoder().encode(small_update(), out);
  EXPECT_EQ(out.size(), small_bytes().size() + 2);
  EXPECT_TRUE(decoded(ByteView(out).subspan(2)));
}

TEST(PlainMetaRoundTrip, SortsListsThatDoNotAscend) {
  Random random(11);
  const MetaUpdate sorted = random_update(random, 50);
  MetaUpdate reversed = sorted;
  std::reverse(reversed.removed.begin(), reversed.removed.end());
  std::reverse(reversed.vertices.begin(), reversed.vertices.end());
  std::reverse(reversed.added.begin(), reversed.added.end());
  std::reverse(reversed.moved.begin(), reversed.moved.end());
  EXPECT_EQ(encoded(reversed), encoded(sorted));
}

TEST(PlainMetaRoundTrip, ReachesEveryLimit) {
  const MetaLimits limits = test_limits();
  MetaUpdate update;
  update.frame = FrameId{std::numeric_limits<std::uint32_t>::max()};
  update.reset = true;
  update.removed = {PatchId{0}, PatchId{limits.max_patches - 1}};
  update.vertices = {{VertexId{0}, GridPosition(65535)}, {VertexId{limits.max_vertices - 1}, {0, 65535, 0}}};
  AddedPatch patch{.id = PatchId{limits.max_patches - 1}, .triangles = 3};
  patch.corners = {VertexId{0}, VertexId{limits.max_vertices - 1}, VertexId{0}, VertexId{1}, VertexId{0}};
  patch.block = {.x = 1024 - 64, .y = 512 - 64, .width_log2 = 6, .height_log2 = 6};
  update.added = {patch};
  const auto back = decoded(encoded(update));
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_TRUE(same(update, *back));
}

TEST(PlainMetaEncode, PacksOnlyWhenThatIsSmaller) {
  MetaUpdate regular;
  for (std::uint32_t id = 0; id < 2000; ++id) regular.removed.push_back(PatchId{3 * id});
  const ByteBuffer packed = encoded(regular);
  EXPECT_LT(packed.size(), 100U);
  EXPECT_EQ(std::to_integer<int>(packed[1]), 2);
  Random random(3);
  MetaUpdate noise;
  for (std::uint32_t id = 0; id < 40; ++id) {
    const auto axis = [&] { return static_cast<std::uint32_t>(random.below(65536)); };
    noise.vertices.push_back({VertexId{id}, {axis(), axis(), axis()}});
  }
  EXPECT_EQ(std::to_integer<int>(encoded(noise)[1]), 0);
}

TEST(PlainMetaDecode, RejectsEveryTruncation) {
  Random random(5);
  for (const MetaUpdate& update : {small_update(), random_update(random, 60)}) {
    const ByteBuffer whole = encoded(update);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_FALSE(decoded(ByteView(whole).first(size))) << size << " of " << whole.size();
    }
  }
}

TEST(PlainMetaDecode, RejectsTrailingBytes) {
  ByteBuffer plain = small_bytes();
  plain.push_back(std::byte{0});
  EXPECT_EQ(refusal(plain), MetaError::kTrailingBytes);
  Random random(5);
  ByteBuffer packed = encoded(random_update(random, 200));
  ASSERT_EQ(std::to_integer<int>(packed[1]) & 2, 2);
  packed.push_back(std::byte{0});
  EXPECT_EQ(refusal(packed), MetaError::kTrailingBytes);
}

TEST(PlainMetaDecode, EveryFlippedByteIsRefusedOrStaysWithinLimits) {
  Random random(9);
  for (const MetaUpdate& update : {small_update(), random_update(random, 40)}) {
    const ByteBuffer whole = encoded(update);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const unsigned mask : {0x01U, 0x80U, 0xFFU, 0x10U}) {
        ByteBuffer bent = whole;
        bent[at] ^= static_cast<std::byte>(mask);
        const auto result = decoded(bent);
        if (!result) continue;
        // What is accepted must be something an encoder could have said.
        const auto again = decoded(encoded(*result));
        ASSERT_TRUE(again) << again.error().message();
        ASSERT_TRUE(same(*result, *again));
      }
    }
  }
}

TEST(PlainMetaDecode, RejectsOtherForms) {
  EXPECT_EQ(refusal(bytes_of({0xA2, 0, 0, 0, 0, 0, 0, 0, 0, 0})), MetaError::kBadVersion);
  EXPECT_EQ(refusal(bytes_of({0xA1, 4, 0, 0, 0, 0, 0, 0, 0, 0})), MetaError::kBadVersion);
  EXPECT_EQ(refusal(bytes_of({0xA1})), MetaError::kTruncated);
}

TEST(PlainMetaDecode, RejectsIdsOutOfRange) {
  EXPECT_FALSE(refusal(with_body({1, 0x9F, 0x9C, 0x01, 0, 0, 0})));                            // 19999
  EXPECT_EQ(refusal(with_body({1, 0xA0, 0x9C, 0x01, 0, 0, 0})), MetaError::kIdOutOfRange);     // 20000
  EXPECT_EQ(refusal(with_body({2, 0x9F, 0x9C, 0x01, 0, 0, 0, 0})), MetaError::kIdOutOfRange);  // one more
  EXPECT_EQ(refusal(with_body({0, 1, 0xC0, 0xB8, 0x02, 0, 0, 0, 0, 0})), MetaError::kIdOutOfRange);  // 40000
  EXPECT_EQ(refusal(with_body({1, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01, 0, 0, 0})),
            MetaError::kIdOutOfRange);  // 2^64 - 1
}

TEST(PlainMetaDecode, RejectsPositionsOffTheGrid) {
  EXPECT_FALSE(refusal(with_body({0, 1, 0, 0xFE, 0xFF, 0x07, 0, 0, 0, 0})));                        // 65535
  EXPECT_EQ(refusal(with_body({0, 1, 0, 0x80, 0x80, 0x08, 0, 0, 0, 0})), MetaError::kBadPosition);  // 65536
  EXPECT_EQ(refusal(with_body({0, 1, 0, 0x01, 0, 0, 0, 0})), MetaError::kBadPosition);              // -1
}

TEST(PlainMetaDecode, RejectsImpossiblePatches) {
  const auto with_draw = [](int draw) { return with_body({0, 0, 1, 0, draw, 0, 0, 0, 2, 2, 2, 0, 0, 0}); };
  EXPECT_EQ(refusal(with_draw(0x00)), MetaError::kBadPatch);       // no triangle
  EXPECT_EQ(refusal(with_draw(0x0D)), MetaError::kBadPatch);       // alpha 3
  EXPECT_EQ(refusal(with_draw(0x41)), MetaError::kBadPatch);       // unused bit
  EXPECT_EQ(refusal(with_draw(0x01)), MetaError::kTrailingBytes);  // fine, but one triangle has 3 corners
  EXPECT_EQ(refusal(with_body({0, 0, 1, 0, 1, 0, 0, 0, 2, 2, 5, 0})), MetaError::kIdOutOfRange);  // corner -1
}

TEST(PlainMetaDecode, RejectsBadBlocks) {
  const auto moved = [](std::initializer_list<int> block) {
    ByteBuffer out = with_body({0, 0, 0, 1, 0});
    const ByteBuffer rest = bytes_of(block);
    out.insert(out.end(), rest.begin(), rest.end());
    return out;
  };
  EXPECT_FALSE(refusal(moved({0, 0x00, 0xFF, 0x07, 0xFF, 0x03})));               // (1023, 511)
  EXPECT_EQ(refusal(moved({0, 0x00, 0x80, 0x08, 0x00})), MetaError::kBadBlock);  // x = 1024
  EXPECT_EQ(refusal(moved({0, 0x00, 0x00, 0x80, 0x04})), MetaError::kBadBlock);  // y = 512
  EXPECT_EQ(refusal(moved({0, 0x10, 0xFF, 0x07, 0x00})), MetaError::kBadBlock);  // 2 wide at 1023
  EXPECT_EQ(refusal(moved({0, 0x01, 0x00, 0x00})), MetaError::kBadBlock);        // portrait
  EXPECT_EQ(refusal(moved({0, 0xF0, 0x00, 0x00})), MetaError::kBadBlock);        // 32768 wide
  EXPECT_EQ(refusal(moved({2, 0x00, 0x00, 0x00})), MetaError::kBadBlock);        // flag
  EXPECT_EQ(refusal(moved({0, 0x00, 0x80, 0x80, 0x80, 0x80, 0x10, 0})), MetaError::kBadBlock);  // x = 2^32
}

TEST(PlainMetaDecode, RejectsMovesOfWhatTheUpdateAddsOrRemoves) {
  EXPECT_EQ(refusal(with_body({2, 1, 0, 0, 0, 1, 2, 0, 0, 0, 0})), MetaError::kBadOrder);
  EXPECT_FALSE(refusal(with_body({2, 1, 0, 0, 0, 1, 3, 0, 0, 0, 0})));
  EXPECT_EQ(refusal(with_body({0, 0, 1, 4, 1, 0, 0, 0, 0, 0, 0, 1, 4, 0, 0, 0, 0})), MetaError::kBadOrder);
}

TEST(PlainMetaDecode, BelievesNoCountBeyondTheOctetsLeft) {
  // 2^28 removed patches in five octets: must be refused by arithmetic, not by running out of memory.
  EXPECT_EQ(refusal(with_body({0x80, 0x80, 0x80, 0x80, 0x01})), MetaError::kTruncated);
  EXPECT_EQ(refusal(with_body({0, 0x02, 0, 0, 0, 0, 0, 0})), MetaError::kTruncated);
  EXPECT_EQ(refusal(with_body({0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01})),
            MetaError::kTruncated);
}

/// A packed update whose body is `size` zero octets.
ByteBuffer packed_zeros(std::size_t size) {
  const ByteBuffer zeros(size);
  ByteBuffer out = bytes_of({0xA1, 0x02});
  out.resize(2 + ZSTD_compressBound(size));
  out.resize(2 + ZSTD_compress(out.data() + 2, out.size() - 2, zeros.data(), size, 1));
  return out;
}

TEST(PlainMetaDecode, RefusesLargeBodiesBeforeUnpacking) {
  EXPECT_EQ(refusal(packed_zeros(kMaxPlainMetaBody + 1)), MetaError::kTooLarge);
  EXPECT_EQ(refusal(packed_zeros(9)), MetaError::kTrailingBytes);
  EXPECT_FALSE(refusal(packed_zeros(8)));
}

TEST(MetaCodecs, AreMadeByKind) {
  ASSERT_NE(make_meta_encoder(MetaCodecKind::kPlain, test_limits()), nullptr);
  ASSERT_NE(make_meta_decoder(MetaCodecKind::kPlain, test_limits()), nullptr);
  EXPECT_EQ(make_meta_decoder(MetaCodecKind{77}, test_limits()), nullptr);
}

}  // namespace
}  // namespace atlaswire::codec
