#include "proto/datagram.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::from_hex;
using test::to_hex;

constexpr std::array<std::byte, 16> secret(unsigned first) {
  std::array<std::byte, 16> out{};
  for (unsigned i = 0; i < 16; ++i) out[i] = static_cast<std::byte>(first + i);
  return out;
}

TEST(Classify, FollowsRfc5761) {
  EXPECT_EQ(classify(from_hex("80 60 0000")), DatagramKind::kRtp);
  EXPECT_EQ(classify(from_hex("90 e0 0000")), DatagramKind::kRtp);  // marker and type 96: 224
  EXPECT_EQ(classify(from_hex("80 c8 0000")), DatagramKind::kRtcp);
  EXPECT_EQ(classify(from_hex("81 ce 0000")), DatagramKind::kRtcp);
  EXPECT_EQ(classify(from_hex("bf bf")), DatagramKind::kRtp);
  EXPECT_EQ(classify(from_hex("80 df")), DatagramKind::kRtcp);
}

TEST(Classify, TellsOurOwnMessages) {
  EXPECT_EQ(classify(from_hex("c1 01")), DatagramKind::kPose);
  EXPECT_EQ(classify(from_hex("c2 01")), DatagramKind::kProbe);
  EXPECT_EQ(classify(from_hex("c3 01")), DatagramKind::kChallenge);
  EXPECT_EQ(classify(from_hex("c4 01")), DatagramKind::kConfirm);
  EXPECT_EQ(classify(from_hex("c5 01")), DatagramKind::kSyncRequest);
  EXPECT_EQ(classify(from_hex("c6 01")), DatagramKind::kSyncResponse);
}

TEST(Classify, EverythingElseIsUnknown) {
  for (const char* bytes : {"", "80", "00 00", "7f 60", "c0 01", "c7 01", "ff ff"}) {
    EXPECT_EQ(classify(from_hex(bytes)), DatagramKind::kUnknown) << bytes;
  }
}

TEST(Datagrams, GoldenBytes) {
  ByteBuffer out;
  encode(Probe{SessionId{0x01020304}, secret(0x10)}, out);
  EXPECT_EQ(to_hex(out),
            "c20101020304"
            "101112131415161718191a1b1c1d1e1f" +
                std::string(52, '0'));
  encode(Challenge{SessionId{1}, secret(0x20)}, out);
  EXPECT_EQ(to_hex(out),
            "c30100000001"
            "202122232425262728292a2b2c2d2e2f");
  encode(Confirm{SessionId{1}, secret(0x10), secret(0x20)}, out);
  EXPECT_EQ(to_hex(out),
            "c40100000001"
            "101112131415161718191a1b1c1d1e1f"
            "202122232425262728292a2b2c2d2e2f");
  encode(SyncRequest{SessionId{1}, 7, -2}, out);
  EXPECT_EQ(to_hex(out),
            "c50100000001"
            "00000007"
            "fffffffffffffffe"
            "00000000000000000000000000000000");
  encode(SyncResponse{SessionId{1}, 7, 1, 2, 3}, out);
  EXPECT_EQ(to_hex(out),
            "c60100000001"
            "00000007"
            "0000000000000001"
            "0000000000000002"
            "0000000000000003");
}

TEST(Datagrams, ComeBackAsSent) {
  ByteBuffer out;
  encode(Probe{SessionId{5}, secret(1)}, out);
  EXPECT_EQ(parse_probe(out).value().token, secret(1));
  EXPECT_EQ(session_of(out).value(), SessionId{5});
  encode(Challenge{SessionId{6}, secret(2)}, out);
  EXPECT_EQ(parse_challenge(out).value().nonce, secret(2));
  encode(Confirm{SessionId{7}, secret(3), secret(4)}, out);
  EXPECT_EQ(parse_confirm(out).value().token, secret(3));
  EXPECT_EQ(parse_confirm(out).value().nonce, secret(4));
  encode(SyncRequest{SessionId{8}, 9, 10}, out);
  EXPECT_EQ(parse_sync_request(out).value().client_sent, 10);
  encode(SyncResponse{SessionId{8}, 9, 10, 11, 12}, out);
  EXPECT_EQ(parse_sync_response(out).value().session, SessionId{8});
  EXPECT_EQ(parse_sync_response(out).value().sequence, 9U);
  EXPECT_EQ(parse_sync_response(out).value().client_sent, 10);
  EXPECT_EQ(parse_sync_response(out).value().server_received, 11);
  EXPECT_EQ(parse_sync_response(out).value().server_sent, 12);
}

TEST(Datagrams, AnswersAreNeverLargerThanWhatAsksForThem) {
  EXPECT_LE(kChallengeSize, kProbeSize);
  ByteBuffer request;
  ByteBuffer response;
  encode(SyncRequest{SessionId{1}, 1, 1}, request);
  encode(SyncResponse{SessionId{1}, 1, 1, 1, 1}, response);
  EXPECT_EQ(response.size(), request.size());
}

TEST(Datagrams, RefuseWrongTypesVersionsSizesAndSessions) {
  ByteBuffer good;
  encode(Challenge{SessionId{1}, secret(1)}, good);
  ByteBuffer bad = good;
  bad[0] = std::byte{0xC4};
  EXPECT_EQ(parse_challenge(bad).error().code, WireError::kBadType);
  bad = good;
  bad[1] = std::byte{2};
  EXPECT_EQ(parse_challenge(bad).error().code, WireError::kBadVersion);
  EXPECT_EQ(session_of(bad).error().code, WireError::kBadVersion);
  bad = good;
  bad.push_back({});
  EXPECT_EQ(parse_challenge(bad).error().code, WireError::kTrailingBytes);
  bad = good;
  bad[5] = {};
  EXPECT_EQ(parse_challenge(bad).error().code, WireError::kBadValue);
  EXPECT_EQ(session_of(bad).error().code, WireError::kBadValue);
  EXPECT_EQ(session_of(from_hex("80600000 00000001")).error().code, WireError::kBadType);
  EXPECT_TRUE(test::every_truncation_fails(good, [](ByteView b) { return parse_challenge(b); }));
}

TEST(Datagrams, RefuseCoveredDataInThePadding) {
  ByteBuffer probe;
  encode(Probe{SessionId{1}, secret(1)}, probe);
  probe.back() = std::byte{1};
  EXPECT_EQ(parse_probe(probe).error().code, WireError::kBadValue);
  ByteBuffer request;
  encode(SyncRequest{SessionId{1}, 1, 1}, request);
  request.back() = std::byte{1};
  EXPECT_EQ(parse_sync_request(request).error().code, WireError::kBadValue);
}

TEST(Datagrams, RefuseTimesThatCouldOverflow) {
  ByteBuffer out;
  encode(SyncRequest{SessionId{1}, 1, kMaxWireNanos}, out);
  EXPECT_EQ(parse_sync_request(out).error().code, WireError::kBadValue);
  encode(SyncResponse{SessionId{1}, 1, 0, -kMaxWireNanos, 0}, out);
  EXPECT_EQ(parse_sync_response(out).error().code, WireError::kBadValue);
  encode(SyncResponse{SessionId{1}, 1, 0, 0, kMaxWireNanos - 1}, out);
  EXPECT_TRUE(parse_sync_response(out).has_value());
}

TEST(Datagrams, SurviveEveryDamage) {
  ByteBuffer out;
  encode(Confirm{SessionId{7}, secret(3), secret(4)}, out);
  test::for_each_damage(out, [](const ByteBuffer& bytes) {
    static_cast<void>(classify(bytes));
    static_cast<void>(session_of(bytes));
    static_cast<void>(parse_probe(bytes));
    static_cast<void>(parse_challenge(bytes));
    static_cast<void>(parse_confirm(bytes));
    static_cast<void>(parse_sync_request(bytes));
    static_cast<void>(parse_sync_response(bytes));
  });
}

}  // namespace
}  // namespace atlaswire::proto
