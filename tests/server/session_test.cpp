#include "proto/ntp_time.h"
#include "tests/server/session_fixture.h"

#include <gmock/gmock.h>

namespace atlaswire::server {
namespace {

using ::testing::HasSubstr;
using Reason = proto::Goodbye::Reason;
using Code = proto::Refusal::Code;

using SessionHandshake = SessionTest;
using SessionAddress = SessionTest;
using SessionFeedback = SessionTest;
using SessionDelivery = SessionTest;
using SessionEnd = SessionTest;

TEST_F(SessionHandshake, AnswersAHelloWithTheStreamAndItsKeys) {
  start();
  greet();
  EXPECT_EQ(hello.session, SessionId{7});
  EXPECT_EQ(hello.udp_token[0], std::byte{0x5A});
  EXPECT_EQ(hello.stream.ssrc, 0x1234U);
  EXPECT_EQ(hello.stream.scene, "test");
  EXPECT_EQ(session->state(), SessionState::kWaitingAddress);
}

TEST_F(SessionHandshake, AgreesOnTheBestFormOfMetaUpdatesThatBothKnow) {
  proto::StreamDescription offered = stream();
  offered.meta_codec = static_cast<std::uint32_t>(codec::MetaCodecKind::kMirror);
  offered.memory.emplace();
  for (const std::vector<std::uint32_t>& known : {std::vector<std::uint32_t>{1, 2, 4}, {1, 2}, {1}}) {
    start();
    proto::ClientHello client;
    client.meta_codecs = known;
    feed(client);
    session->accept(offered, now);
    const auto answer = replies();
    ASSERT_EQ(answer.size(), 1U);
    const auto& info = std::get<proto::ServerHello>(answer[0]).stream;
    EXPECT_EQ(info.meta_codec, known.back());
    EXPECT_EQ(static_cast<std::uint32_t>(session->meta_codec()), known.back());
    EXPECT_EQ(info.memory.has_value(), known.back() == 4) << "only who mirrors it needs it";
  }
}

TEST_F(SessionHandshake, TellsWhatMovesToThoseOnlyWhoShowIt) {
  proto::StreamDescription moving = stream();
  moving.motion = proto::MotionDescription{.movers = {{0, 5, true, 0}}, .pivots = {}};
  for (const bool shows : {false, true}) {
    start();
    feed(proto::ClientHello{.shows_motion = shows});
    session->accept(moving, now);
    const auto answer = replies();
    ASSERT_EQ(answer.size(), 1U);
    EXPECT_EQ(std::get<proto::ServerHello>(answer[0]).stream.motion.has_value(), shows);
  }
}

TEST_F(SessionHandshake, RefusesAnotherVersionAndNamesBoth) {
  start();
  proto::ClientHello future;
  future.versions = {90, 91};
  feed(future);
  session->accept(stream(), now);
  const auto answer = replies();
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_EQ(std::get<proto::Refusal>(answer[0]).code, Code::kVersion);
  EXPECT_THAT(std::get<proto::Refusal>(answer[0]).text, HasSubstr("90"));
  EXPECT_EQ(session->state(), SessionState::kClosed);
}

TEST_F(SessionHandshake, RefusesPicturesTheClientCannotDecode) {
  start();
  proto::ClientHello small;
  small.max_picture = {128, 128};
  feed(small);
  session->accept(stream(), now);
  const auto answer = replies();
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<proto::Refusal>(answer[0]));
}

TEST_F(SessionHandshake, RefusesGarbage) {
  start();
  const ByteBuffer garbage{std::byte{0}, std::byte{0},    std::byte{0},
                           std::byte{2}, std::byte{0xFF}, std::byte{0xFF}};
  session->on_stream_bytes(garbage, now);
  const auto answer = replies();
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_EQ(std::get<proto::Refusal>(answer[0]).code, Code::kBadHello);
  EXPECT_EQ(session->state(), SessionState::kClosed);
}

TEST_F(SessionHandshake, OversizeLengthClosesBeforeAnythingIsRead) {
  start();
  const ByteBuffer huge{std::byte{0x7F}, std::byte{0xFF}, std::byte{0xFF}, std::byte{0xFF}};
  session->on_stream_bytes(huge, now);
  EXPECT_EQ(session->state(), SessionState::kClosing);
  replies();
  EXPECT_EQ(session->state(), SessionState::kClosed);
  EXPECT_THAT(session->end_reason(), HasSubstr("refused"));
}

TEST_F(SessionHandshake, OtherMessagesBeforeTheHelloAreRefused) {
  start();
  feed(proto::StatsReport{});
  EXPECT_EQ(session->state(), SessionState::kClosing);
}

TEST_F(SessionHandshake, SilenceTimesOut) {
  start();
  run_until(now + 4999ms);
  EXPECT_EQ(session->state(), SessionState::kWaitingHello);
  run_until(now + 1ms);
  const auto answer = replies();
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_THAT(std::get<proto::Refusal>(answer[0]).text, HasSubstr("no hello"));
  EXPECT_EQ(session->state(), SessionState::kClosed);
}

TEST_F(SessionHandshake, BlockedUdpTimesOutWithAHint) {
  start();
  greet();
  run_until(now + 5s);
  const auto answer = replies();
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_EQ(std::get<proto::Goodbye>(answer[0]).reason, Reason::kTimeout);
  EXPECT_THAT(std::get<proto::Goodbye>(answer[0]).text, HasSubstr("UDP"));
}

TEST_F(SessionAddress, ProbeChallengeConfirmStartsTheStream) { stream_to(home); }

TEST_F(SessionAddress, WrongTokenGetsNothing) {
  start();
  greet();
  proto::UdpToken wrong{};
  send(proto::Probe{hello.session, wrong}, home);
  EXPECT_TRUE(datagrams().empty());
  send(proto::Confirm{hello.session, wrong, {}}, home);
  EXPECT_EQ(session->state(), SessionState::kWaitingAddress);
}

TEST_F(SessionAddress, NeverAmplifiesMoreThanThreefold) {
  start();
  greet();
  std::size_t in = 0;
  std::size_t out = 0;
  for (int i = 0; i < 200; ++i) {
    proto::PosePacket packet;
    packet.session = hello.session;
    packet.count = 1;
    packet.poses[0].id = PoseId{1};
    ByteBuffer bytes;
    encode(packet, bytes);
    bytes.resize(7);  // short enough that every answer would be too much
    in += bytes.size();
    session->on_datagram(away, bytes, now);
    for (const auto& sent : datagrams()) out += sent.bytes.size();
    ASSERT_LE(out, 3 * in);
  }
}

TEST_F(SessionAddress, NoMediaLeavesBeforeTheAddressIsProven) {
  start();
  greet();
  session->deliver(frame(0, 5000, true), now);
  EXPECT_TRUE(run_until(now + 1s).empty());
}

TEST_F(SessionAddress, AnotherAddressMustProveItselfToo) {
  stream_to(home);
  send_pose(1, home);
  send_pose(9, away);
  ASSERT_TRUE(session->newest_pose());
  EXPECT_EQ(session->newest_pose()->stamped.id, PoseId{1}) << "a pose from elsewhere must not count";
  const auto nonce = challenged(away);
  session->deliver(frame(0, 500, true), now);
  for (const auto& sent : datagrams()) EXPECT_EQ(sent.to, home);
  send(proto::Confirm{hello.session, hello.udp_token, nonce}, away);
  send_pose(9, away);
  EXPECT_EQ(session->newest_pose()->stamped.id, PoseId{9});
  now += 1s;
  session->deliver(frame(1, 500, false), now);
  for (const auto& sent : datagrams()) EXPECT_EQ(sent.to, away);
}

TEST_F(SessionAddress, GarbageIsIgnoredAndCounted) {
  stream_to(home);
  const auto before = session->counts().ignored_datagrams;
  for (unsigned first = 0; first < 256; ++first) {
    const ByteBuffer garbage(40, static_cast<std::byte>(first));
    session->on_datagram(home, garbage, now);
    session->on_datagram(home, {}, now);
  }
  EXPECT_EQ(session->state(), SessionState::kStreaming);
  EXPECT_EQ(session->counts().ignored_datagrams - before, 512U);
  EXPECT_FALSE(session->newest_pose());
}

TEST_F(SessionFeedback, PictureLossOfOurStreamAsksForRefreshOnce) {
  stream_to(home);
  send_rtcp({proto::ReceiverReport{9, {}}, proto::PictureLoss{9, 0x9999}}, home);
  EXPECT_FALSE(session->take_refresh_request()) << "another stream's";
  send_rtcp({proto::ReceiverReport{9, {}}, proto::PictureLoss{9, 0x1234}}, away);
  EXPECT_FALSE(session->take_refresh_request()) << "from an unproven address";
  send_rtcp({proto::ReceiverReport{9, {}}, proto::PictureLoss{9, 0x1234}}, home);
  EXPECT_TRUE(session->take_refresh_request());
  EXPECT_FALSE(session->take_refresh_request());
}

TEST_F(SessionFeedback, RoundTripAndLossComeFromReports) {
  stream_to(home);
  const std::uint32_t sent = proto::middle(proto::to_ntp(now));
  now += 80ms;
  proto::ReportBlock block;
  block.ssrc = 0x1234;
  block.fraction_lost = 64;
  block.last_report = sent;
  block.delay_since_last = 65536 / 20;  // 50 ms
  send_rtcp({proto::ReceiverReport{9, {block}}}, home);
  EXPECT_NEAR(to_ms(session->round_trip()), 30, 0.1);
  EXPECT_DOUBLE_EQ(session->loss(), 0.25);
}

TEST_F(SessionFeedback, SyncRequestsAreAnsweredWithServerTimes) {
  stream_to(home);
  send(proto::SyncRequest{hello.session, 5, 123}, home);
  const auto out = datagrams();
  ASSERT_EQ(out.size(), 1U);
  const auto answer = proto::parse_sync_response(out[0].bytes).value();
  EXPECT_EQ(answer.sequence, 5U);
  EXPECT_EQ(answer.client_sent, 123);
  EXPECT_EQ(answer.server_received, to_nanos(now));
}

TEST_F(SessionFeedback, SenderReportsLeaveEachSecond) {
  stream_to(home);
  session->deliver(frame(0, 500, true), now);
  unsigned reports = 0;
  for (int second = 0; second < 5; ++second) {
    send_pose(static_cast<std::uint32_t>(second) + 1, home);
    for (const auto& sent : run_until(now + 1s)) {
      if (!sent.media) reports += proto::parse_rtcp(sent.bytes).has_value() ? 1U : 0U;
    }
  }
  EXPECT_GE(reports, 5U);
  EXPECT_LE(reports, 6U);
}

TEST_F(SessionDelivery, MetaGoesOnTcpAndThePicturePaced) {
  stream_to(home);
  session->deliver(frame(3, 60'000, true), now);
  const auto messages = replies();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(std::get<proto::FrameMeta>(messages[0]).frame, FrameId{3});
  const Time begun = now;
  const std::size_t at_once = datagrams().size();
  EXPECT_LT(at_once, 15U) << "a burst of 12 kB at most";
  EXPECT_GT(run_until(now + 15ms).size() + at_once, 20U);
  run_until(begun + 100ms);
  const auto departures = session->take_departures();
  ASSERT_EQ(departures.size(), 1U);
  // 48 kB beyond the burst at 2.5 times 8 Mbit/s.
  EXPECT_NEAR(to_ms(departures[0].left - begun), 20, 3);
}

TEST_F(SessionDelivery, PicturesThatDoNotFitAreDroppedWholeAndRefreshed) {
  settings.bit_rate.bits_per_second = 80'000;  // 25 kB/s when paced
  stream_to(home);
  session->deliver(frame(0, 30'000, true), now);
  EXPECT_TRUE(session->is_congested());
  session->deliver(frame(1, 30'000, false), now);
  EXPECT_EQ(session->counts().frames_dropped, 1U);
  EXPECT_TRUE(session->take_refresh_request());
  EXPECT_EQ(replies().size(), 2U) << "meta updates are never dropped";
}

TEST_F(SessionDelivery, AFullTcpQueuePausesThenEndsTheSession) {
  settings.delivery.tcp_queue_bytes = 100'000;
  stream_to(home);
  session->deliver(frame(0, 500, true, 60'000), now);
  EXPECT_FALSE(session->is_congested());
  session->deliver(frame(1, 500, false, 60'000), now);
  EXPECT_TRUE(session->is_congested());
  for (int i = 0; i < 9; ++i) {
    run_until(now + 1s);
    send_pose(static_cast<std::uint32_t>(i) + 1, home);
  }
  EXPECT_EQ(session->state(), SessionState::kStreaming);
  run_until(now + 1s);
  EXPECT_EQ(session->state(), SessionState::kClosed);
  EXPECT_THAT(session->end_reason(), HasSubstr("too slow"));
}

TEST_F(SessionDelivery, AQueueThatDrainsResumes) {
  settings.delivery.tcp_queue_bytes = 100'000;
  stream_to(home);
  session->deliver(frame(0, 500, true, 120'000), now);
  EXPECT_TRUE(session->is_congested());
  run_until(now + 50ms);
  session->stream_sent(session->stream_output().size() / 2, now);
  EXPECT_FALSE(session->is_congested());
  for (int i = 0; i < 12; ++i) {
    send_pose(static_cast<std::uint32_t>(i) + 1, home);
    run_until(now + 1s);
  }
  EXPECT_EQ(session->state(), SessionState::kStreaming);
}

TEST_F(SessionDelivery, WhoeverIsFarOverTheBoundIsCutOffAtOnce) {
  settings.delivery.tcp_queue_bytes = 10'000;
  stream_to(home);
  session->deliver(frame(0, 500, true, 60'000), now);
  session->poll(now);
  EXPECT_EQ(session->state(), SessionState::kClosed);
}

TEST_F(SessionEnd, IdleClientsTimeOutAndReportsKeepThemAlive) {
  stream_to(home);
  for (int i = 0; i < 3; ++i) {
    run_until(now + 9s);
    send_rtcp({proto::ReceiverReport{9, {}}}, home);
  }
  EXPECT_EQ(session->state(), SessionState::kStreaming);
  run_until(now + 10s);
  const auto last = replies();
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(std::get<proto::Goodbye>(last[0]).reason, Reason::kTimeout);
}

TEST_F(SessionEnd, ClientGoodbyeClosesAtOnce) {
  stream_to(home);
  feed(proto::Goodbye{Reason::kDone, "path ended"});
  EXPECT_EQ(session->state(), SessionState::kClosed);
  EXPECT_THAT(session->end_reason(), HasSubstr("path ended"));
}

TEST_F(SessionEnd, DrainSaysGoodbyeAndWaitsForItToLeave) {
  stream_to(home);
  session->close(Reason::kDraining, "shutting down", now);
  EXPECT_EQ(session->state(), SessionState::kClosing);
  session->deliver(frame(0, 500, true), now);
  const auto last = replies();
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(std::get<proto::Goodbye>(last[0]).reason, Reason::kDraining);
  EXPECT_EQ(session->state(), SessionState::kClosed);
}

TEST_F(SessionEnd, DrainGivesUpOnAClientThatReadsNothing) {
  stream_to(home);
  session->close(Reason::kDraining, "shutting down", now);
  run_until(now + 1999ms);
  EXPECT_EQ(session->state(), SessionState::kClosing);
  run_until(now + 1ms);
  EXPECT_EQ(session->state(), SessionState::kClosed);
}

TEST_F(SessionEnd, ReasonsAreMadeFitForTheWire) {
  stream_to(home);
  session->close(Reason::kInternal, "two\nlines, \x01, \xFF" + std::string(2000, 'x'), now);
  const auto last = replies();
  ASSERT_EQ(last.size(), 1U) << "the client's parser takes it";
  EXPECT_THAT(std::get<proto::Goodbye>(last[0]).text, HasSubstr("two lines,  , ?xxx"));
}

TEST_F(SessionFeedback, PassesOnAtMostOneRestartASecond) {
  stream_to(home);
  EXPECT_FALSE(session->take_restart_request(now));
  feed(proto::RestartRequest{FrameId{9}, "bent"});
  feed(proto::RestartRequest{FrameId{10}, "bent still"});
  EXPECT_EQ(session->take_restart_request(now), "frame 10: bent still");
  EXPECT_FALSE(session->take_restart_request(now));
  feed(proto::RestartRequest{FrameId{11}, "again"});
  EXPECT_FALSE(session->take_restart_request(now + 999ms));
  EXPECT_EQ(session->take_restart_request(now + 1s), "frame 11: again") << "late, not never";
  EXPECT_EQ(session->counts().restarts, 3U);
}

TEST_F(SessionFeedback, TheNewestEmphasisIsTakenOnce) {
  stream_to(home);
  EXPECT_FALSE(session->take_emphasis());
  feed(Emphasis{.foveation = 1.0});
  feed(Emphasis{.foveation = 2.0, .priorities = {{"lamp", 3}}});
  EXPECT_EQ(session->take_emphasis(), (Emphasis{.foveation = 2.0, .priorities = {{"lamp", 3}}}));
  EXPECT_FALSE(session->take_emphasis());
  EXPECT_EQ(session->state(), SessionState::kStreaming);
}

TEST_F(SessionHandshake, AnEmphasisBeforeTheHelloIsRefused) {
  start();
  feed(Emphasis{});
  EXPECT_EQ(session->state(), SessionState::kClosing);
}

TEST_F(SessionEnd, ServerMessagesFromAClientBreakTheProtocol) {
  stream_to(home);
  feed(proto::FrameMeta{});
  const auto last = replies();
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(std::get<proto::Goodbye>(last[0]).reason, Reason::kProtocolError);
}

}  // namespace
}  // namespace atlaswire::server
