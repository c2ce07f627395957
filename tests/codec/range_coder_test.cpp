#include "codec/range_coder.h"

#include "base/random.h"
#include "codec/adaptive_models.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace atlaswire::codec {
namespace {

TEST(AdaptiveBit, ApproachesHowOftenItIsFalse) {
  AdaptiveBit model;
  EXPECT_EQ(model.probability_of_false(), AdaptiveBit::kOne / 2);
  for (int i = 0; i < 4000; ++i) model.update(false);
  EXPECT_GT(model.probability_of_false(), AdaptiveBit::kOne - 64);
  for (int i = 0; i < 4000; ++i) model.update(true);
  EXPECT_EQ(model.probability_of_false(), 16U);  // never surer than that
}

TEST(RangeCoder, WritesGoldenBytes) {
  ByteBuffer out;
  RangeEncoder encoder(out);
  std::array<AdaptiveBit, 2> models;
  for (int i = 0; i < 40; ++i) encoder.code(models[i % 2], i % 3 == 0);
  encoder.code_raw(0x5A5A5, 20);
  encoder.finish();
  const std::vector<int> golden{140, 182, 181, 184, 203, 54, 117, 90};
  std::vector<int> got;
  for (const std::byte octet : out) got.push_back(std::to_integer<int>(octet));
  EXPECT_EQ(got, golden);
}

/// Decisions of a coin whose bias each model has to learn, and raw bits between them.
TEST(RangeCoder, KeepsDecisionsAtTheCostOfTheirEntropy) {
  constexpr int kDecisions = 200'000;
  for (const double bias : {0.5, 0.1, 0.01, 0.999, 0.0}) {
    Random random(17);
    std::vector<bool> bits;
    for (int i = 0; i < kDecisions; ++i) bits.push_back(random.uniform() < bias);
    ByteBuffer out;
    AdaptiveBit model;
    RangeEncoder encoder(out);
    for (const bool bit : bits) encoder.code(model, bit);
    encoder.finish();
    const auto h = [](double p) { return p <= 0 ? 0.0 : -p * std::log2(p); };
    const double entropy = kDecisions * (h(bias) + h(1 - bias)) / 8;
    EXPECT_LT(static_cast<double>(out.size()), entropy * 1.05 + 80) << bias;
    RangeDecoder decoder(out);
    AdaptiveBit mirror;
    for (int i = 0; i < kDecisions; ++i)
      ASSERT_EQ(decoder.code(mirror), bits[static_cast<std::size_t>(i)]) << i;
    EXPECT_EQ(decoder.unread(), 0U);
  }
}

TEST(RangeCoder, CarriesThroughRunsOfFullOctets) {
  // Sure "true" pushes the low end up against the top, raw ones keep it there: long runs of 0xFF, some
  // carried.
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> words;
    for (int i = 0; i < 60; ++i) {
      const auto count = static_cast<std::uint32_t>(random.below(33));
      const std::uint32_t ones = count == 0 ? 0 : 0xFFFFFFFFU >> (32 - count);
      words.emplace_back(random.below(8) == 0 ? static_cast<std::uint32_t>(random.below(ones + 1ULL)) : ones,
                         count);
    }
    ByteBuffer out;
    RangeEncoder encoder(out);
    AdaptiveBit model;
    for (const auto& [word, count] : words) {
      encoder.code_raw(word, count);
      encoder.code(model, true);
    }
    encoder.finish();
    RangeDecoder decoder(out);
    AdaptiveBit mirror;
    for (const auto& [word, count] : words) {
      ASSERT_EQ(decoder.code_raw(0, count), word) << seed;
      ASSERT_TRUE(decoder.code(mirror));
    }
  }
}

TEST(RangeCoder, LeavesOutZerosAtItsEnd) {
  ByteBuffer out;
  RangeEncoder encoder(out);
  encoder.code_raw(0, 32);
  encoder.finish();
  EXPECT_TRUE(out.empty());
  RangeDecoder decoder(out);
  EXPECT_EQ(decoder.code_raw(0, 32), 0U);
}

TEST(RangeCoder, AppendsBehindWhatTheBufferHolds) {
  ByteBuffer out(3);
  RangeEncoder encoder(out);
  encoder.code_raw(0xFFFF, 16);
  encoder.finish();
  ASSERT_GT(out.size(), 3U);
  EXPECT_EQ(RangeDecoder(ByteView(out).subspan(3)).code_raw(0, 16), 0xFFFFU);
}

TEST(AdaptiveModels, KeepEveryLengthOfNumber) {
  std::vector<std::uint32_t> numbers{0, 1, 2, 3};
  for (std::uint32_t bits = 2; bits < 31; ++bits) {
    for (const std::uint32_t number : {1U << bits, (1U << bits) + 1, (2U << bits) - 1})
      numbers.push_back(number);
  }
  ByteBuffer out;
  RangeEncoder encoder(out);
  const auto model = std::make_unique<AdaptiveUnsigned>();
  AdaptiveTree<5> tree;
  for (const std::uint32_t number : numbers) {
    EXPECT_EQ(model->code(encoder, number), number);
    tree.code(encoder, number % 32);
  }
  encoder.finish();
  RangeDecoder decoder(out);
  *model = {};
  tree = {};
  for (const std::uint32_t number : numbers) {
    ASSERT_EQ(model->code(decoder), number);
    ASSERT_EQ(tree.code(decoder), number % 32);
  }
}

}  // namespace
}  // namespace atlaswire::codec
