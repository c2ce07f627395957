#include "proto/handshake.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

constexpr std::uint32_t kPlain[] = {1};

TEST(ChooseVersion, TakesTheHighestCommonOne) {
  EXPECT_EQ(choose_version({1, 5}, {2, 4}).value(), 4U);
  EXPECT_EQ(choose_version({2, 3}, {1, 9}).value(), 3U);
  EXPECT_EQ(choose_version({3, 3}, {3, 3}).value(), 3U);
}

TEST(ChooseVersion, NamesBothRangesWhenNothingIsCommon) {
  const auto result = choose_version({5, 6}, {1, 4});
  ASSERT_TRUE(result.has_error());
  EXPECT_EQ(result.error().code, WireError::kBadVersion);
  EXPECT_EQ(result.error().detail, "the client speaks versions 5 to 6, the server 1 to 4");
}

TEST(ChooseMetaCodec, FollowsTheServersPreference) {
  const std::uint32_t server[] = {3, 2, 1};
  const std::uint32_t client[] = {1, 2};
  EXPECT_EQ(choose_meta_codec(server, client).value(), 2U);
  EXPECT_EQ(choose_meta_codec(kPlain, std::span(client).subspan(1)).error().detail,
            "the client knows meta codecs 2, the server 1");
}

TEST(Agree, SettlesVersionAndCodec) {
  const auto terms = agree(ClientHello{}, kPlain, {4096, 4096});
  EXPECT_EQ(terms.value().version, 1U);
  EXPECT_EQ(terms.value().meta_codec, 1U);
}

TEST(Agree, RefusesAPictureThatTheClientCannotDecode) {
  const auto terms = agree(ClientHello{}, kPlain, {4096, 4098});
  ASSERT_TRUE(terms.has_error());
  EXPECT_EQ(terms.error().detail,
            "the stream's picture of 4096x4098 is larger than the 4096x4096 that the client decodes");
  EXPECT_EQ(refusal_for(terms.error()).code, Refusal::Code::kBadHello);
}

TEST(Agree, AVersionMismatchIsRefusedAsSuch) {
  ClientHello hello;
  hello.versions = {2, 3};
  const auto terms = agree(hello, kPlain, {64, 64});
  ASSERT_TRUE(terms.has_error());
  const Refusal refusal = refusal_for(terms.error());
  EXPECT_EQ(refusal.code, Refusal::Code::kVersion);
  EXPECT_NE(refusal.text.find("versions 2 to 3"), std::string::npos);
}

TEST(CheckAnswer, HoldsTheServerToTheOffer) {
  const ClientHello hello;
  ServerHello answer;
  answer.stream.picture = {1024, 1024};
  EXPECT_TRUE(check_answer(hello, answer).has_value());
  answer.version = 2;
  EXPECT_EQ(check_answer(hello, answer).error().code, WireError::kBadVersion);
  answer.version = 1;
  answer.stream.meta_codec = 9;
  EXPECT_TRUE(check_answer(hello, answer).has_error());
  answer.stream.meta_codec = 1;
  answer.stream.picture.width = 8192;
  EXPECT_TRUE(check_answer(hello, answer).has_error());
}

}  // namespace
}  // namespace atlaswire::proto
