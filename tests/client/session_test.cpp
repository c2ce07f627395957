#include "client/session.h"

#include "base/random.h"
#include "tests/client/fake_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace atlaswire::client {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::FakeServer;
using ::testing::HasSubstr;
using testing::World;

using Kind = SessionEnd::Kind;

void expect_end(const World& w, Kind kind, const std::string& words) {
  ASSERT_TRUE(w.session.end()) << "the session goes on";
  EXPECT_EQ(w.session.end()->kind, kind) << w.session.end()->text;
  EXPECT_THAT(w.session.end()->text, HasSubstr(words));
}

proto::FrameMeta some_frame() {
  proto::FrameMeta meta;
  meta.frame = FrameId{1};
  meta.meta = ByteBuffer(30);
  return meta;
}

Pose pose_at(double x) {
  Pose pose;
  pose.position = {x, 1.7, 0};
  return pose;
}

TEST(Session, ShakesHandsProvesItsAddressAndSynchronizesClocks) {
  World w;
  w.run(seconds(1));
  ASSERT_TRUE(w.server.hello);
  ASSERT_TRUE(w.session.answer());
  EXPECT_EQ(w.session.answer()->stream.scene, "atrium");
  EXPECT_TRUE(w.server.proven);
  EXPECT_TRUE(w.session.is_udp_established());
  ASSERT_TRUE(w.session.clock()->is_synchronized());
  EXPECT_EQ(w.session.clock()->offset(), FakeServer::kSkew);
  EXPECT_EQ(w.session.clock()->round_trip(), 2 * World::kDelay);
  EXPECT_FALSE(w.session.end());
  EXPECT_FALSE(w.stuck);
}

TEST(Session, DeliversFramesAndUpdatesWithTheirArrivals) {
  World w;
  w.run(milliseconds(200));
  w.server.send_frame(0, true, 5000, w.now());
  w.run(milliseconds(50));
  w.server.send_frame(1, false, 300, w.now());
  const Time sent = w.now();
  w.run(milliseconds(50));
  ASSERT_EQ(w.frames.size(), 2U);
  ASSERT_EQ(w.updates.size(), 2U);
  EXPECT_TRUE(w.frames[0].idr);
  EXPECT_EQ(w.frames[0].access_unit.size(), 5000U);
  EXPECT_EQ(w.frames[1].frame, FrameId{1});
  EXPECT_EQ(w.frames[1].last_arrival, sent + World::kDelay);
  EXPECT_EQ(w.updates[1].meta.frame, FrameId{1});
  EXPECT_EQ(w.updates[1].arrival, sent + World::kDelay);
  EXPECT_GT(w.session.traffic().video, 5300U);
  EXPECT_GT(w.session.traffic().meta, 200U);
  EXPECT_EQ(w.session.packets().lost, 0);
}

TEST(Session, SendsEachPoseWithTheTwoBeforeIt) {
  World w;
  EXPECT_FALSE(w.session.on_pose(pose_at(0), w.now())) << "nobody to send it to yet";
  w.run(milliseconds(100));
  for (int i = 1; i <= 3; ++i) {
    EXPECT_EQ(w.session.on_pose(pose_at(i), w.now()), PoseId{static_cast<std::uint32_t>(i)});
    w.flush();
    w.run(milliseconds(16));
  }
  ASSERT_EQ(w.server.poses.size(), 3U);
  EXPECT_EQ(w.server.poses[2].id, PoseId{3});
  EXPECT_DOUBLE_EQ(w.server.poses[2].pose.position.x, 3.0);
}

TEST(Session, AsksForAnIdrAfterLossUntilOneComes) {
  World w;
  w.run(milliseconds(200));
  w.server.send_frame(0, true, 5000, w.now());
  w.run(milliseconds(50));
  w.server.send_frame(1, false, 5000, w.now(), [](std::size_t i) { return i == 1; });
  w.run(milliseconds(50));
  w.server.send_frame(2, false, 1000, w.now());
  w.run(milliseconds(100));
  EXPECT_EQ(w.frames.size(), 1U) << "frame 2 would decode to garbage";
  EXPECT_GE(w.server.refresh_requests, 1);
  EXPECT_LE(w.server.refresh_requests, 5) << "requests are rate limited";
  const int before = w.server.refresh_requests;
  w.server.send_frame(3, true, 1000, w.now());
  w.run(milliseconds(20));
  const int until_idr = w.server.refresh_requests;
  w.run(seconds(1));
  EXPECT_LE(w.server.refresh_requests, until_idr + 1);
  EXPECT_GE(until_idr, before);
  ASSERT_EQ(w.frames.size(), 2U);
  EXPECT_EQ(w.frames[1].frame, FrameId{3});
  EXPECT_EQ(w.updates.size(), 4U) << "updates of lost frames still come";
  EXPECT_GE(w.session.frames().lost, 1U);
  EXPECT_EQ(w.session.packets().lost, 1);
}

TEST(Session, AsksForAnIdrWhenTheDecoderFails) {
  World w;
  w.run(milliseconds(200));
  w.server.send_frame(0, true, 500, w.now());
  w.run(milliseconds(20));
  w.session.on_decode_failed();
  w.server.send_frame(1, false, 500, w.now());
  w.run(milliseconds(50));
  EXPECT_EQ(w.frames.size(), 1U);
  EXPECT_GE(w.server.refresh_requests, 1);
}

TEST(Session, AsksToBeToldAllAnew) {
  World w;
  w.session.request_restart(FrameId{1}, "too early");
  w.run(milliseconds(200));
  w.session.request_restart(FrameId{8}, "out of step");
  w.run(milliseconds(50));
  ASSERT_EQ(w.server.restarts.size(), 1U);
  EXPECT_EQ(w.server.restarts[0].frame, FrameId{8});
  EXPECT_EQ(w.server.restarts[0].text, "out of step");
}

TEST(Session, ReportsReceptionAndProgressEachSecond) {
  World w;
  w.run(milliseconds(200));
  w.session.set_progress({.newest_frame = FrameId{5},
                          .paired = 6,
                          .displayed = 60,
                          .display_rate = 60,
                          .motion_to_photon = milliseconds(12)});
  for (std::uint32_t n = 0; n < 50; ++n) {
    w.server.send_frame(n, n % 5 == 0, 800, w.now());
    w.run(milliseconds(100));
  }
  EXPECT_GE(w.server.receiver_reports, 4);
  EXPECT_LE(w.server.receiver_reports, 6);
  ASSERT_GE(w.server.reports.size(), 4U);
  EXPECT_EQ(w.server.reports.back().frames_paired, 6U);
}

TEST(Session, SaysGoodbye) {
  World w;
  w.run(milliseconds(200));
  w.session.finish();
  w.flush();
  w.run(milliseconds(50));
  ASSERT_TRUE(w.server.goodbye);
  EXPECT_EQ(w.server.goodbye->reason, proto::Goodbye::Reason::kDone);
  EXPECT_EQ(w.session.end()->kind, Kind::kFinished);
  EXPECT_FALSE(w.session.next_deadline());
}

TEST(Session, PassesOnARefusal) {
  World w;
  w.server.answers = false;
  w.run(milliseconds(20));
  w.server.send(proto::Refusal{.code = proto::Refusal::Code::kCapacity, .text = "8 of 8 sessions taken"});
  w.run(milliseconds(20));
  expect_end(w, Kind::kRefused, "8 of 8 sessions taken");
  EXPECT_EQ(exit_code(w.session.end()->kind), ExitCode::kRefused);
}

TEST(Session, EndsWithTheServersGoodbye) {
  World w;
  w.run(milliseconds(100));
  w.server.send(proto::Goodbye{.reason = proto::Goodbye::Reason::kDraining, .text = "shutting down"});
  w.run(milliseconds(20));
  expect_end(w, Kind::kServerDone, "shutting down");
}

TEST(Session, LosesPatienceWithASilentListener) {
  World w;
  w.server.answers = false;
  w.run(seconds(30));
  expect_end(w, Kind::kNoAnswer, "did not answer within 10.0 s");
  EXPECT_EQ(exit_code(w.session.end()->kind), ExitCode::kCannotConnect);
}

TEST(Session, SaysThatDatagramsDoNotPass) {
  World w;
  w.server.echoes_datagrams = false;
  w.run(milliseconds(100));
  for (int i = 0; i < 30; ++i) {
    w.server.send_frame(static_cast<std::uint32_t>(i), true, 100, w.now(), [](std::size_t) { return true; });
    w.run(milliseconds(250));
  }
  expect_end(w, Kind::kServerGone, "let UDP pass");
}

TEST(Session, NoticesAServerThatVanishedMidFrame) {
  World w;
  w.run(milliseconds(200));
  w.server.send_frame(0, true, 20'000, w.now(), [](std::size_t i) { return i > 3; });
  w.server_is_there = false;
  w.run(seconds(4));
  EXPECT_FALSE(w.session.end());
  w.run(seconds(3));
  expect_end(w, Kind::kServerGone, "nothing came from the server");
  EXPECT_EQ(exit_code(w.session.end()->kind), ExitCode::kPeerLost);
  EXPECT_FALSE(w.stuck);
}

TEST(Session, NoticesAClosedConnection) {
  World early;
  early.session.on_stream_closed(early.now());
  expect_end(early, Kind::kNoAnswer, "without an answer");
  World late;
  late.run(milliseconds(100));
  late.session.on_stream_closed(late.now());
  expect_end(late, Kind::kServerGone, "without a goodbye");
}

TEST(Session, RefusesGarbageOnTheReliableChannel) {
  World length;
  length.session.on_stream_bytes(ByteBuffer(64, std::byte{0xFF}), length.now());
  expect_end(length, Kind::kNoAnswer, "illegal length");

  World message;
  message.run(milliseconds(100));
  ByteBuffer bytes{std::byte{0}, std::byte{0}, std::byte{0}, std::byte{4}};
  bytes.resize(8, std::byte{0xEE});
  message.session.on_stream_bytes(bytes, message.now());
  message.flush();
  expect_end(message, Kind::kProtocolError, "malformed");
  message.run(milliseconds(50));
  ASSERT_TRUE(message.server.goodbye);
  EXPECT_EQ(message.server.goodbye->reason, proto::Goodbye::Reason::kProtocolError);
}

TEST(Session, RefusesMessagesOutOfPlace) {
  World early;
  early.server.answers = false;
  early.run(milliseconds(20));
  early.server.send(proto::FrameMeta{});
  early.run(milliseconds(20));
  expect_end(early, Kind::kNoAnswer, "before it answered");

  World twice;
  twice.run(milliseconds(100));
  twice.server.send(twice.server.answer);
  twice.run(milliseconds(20));
  expect_end(twice, Kind::kProtocolError, "twice");

  World mirrored;
  mirrored.run(milliseconds(100));
  mirrored.server.send(proto::ClientHello{});
  mirrored.run(milliseconds(20));
  expect_end(mirrored, Kind::kProtocolError, "only clients send");
}

TEST(Session, RefusesAnAnswerBeyondItsHello) {
  SessionSettings settings;
  settings.hello.max_picture = {128, 128};
  World w(settings);
  w.run(milliseconds(100));
  expect_end(w, Kind::kNoAnswer, "does not fit our hello");
}

TEST(Session, RefusesAPictureThatIsNotJustTheAtlas) {
  World wide;
  wide.server.answer.stream.picture = {512, 128};
  wide.run(milliseconds(100));
  expect_end(wide, Kind::kNoAnswer, "more than the atlas");

  World covered;
  covered.server.answer.stream.picture = {256, 256};
  covered.server.answer.stream.has_coverage = true;
  covered.run(milliseconds(100));
  EXPECT_FALSE(covered.session.end());
}

TEST(Session, IgnoresGarbageDatagrams) {
  World w;
  w.run(milliseconds(200));
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    ByteBuffer garbage(random.below(1300));
    for (std::byte& b : garbage) b = static_cast<std::byte>(random.bits());
    if (!garbage.empty() && i % 2 == 0) garbage[0] = std::byte{0x80};
    w.session.on_datagram(garbage, w.now());
  }
  w.flush();
  w.server.send_frame(0, true, 3000, w.now());
  w.run(milliseconds(100));
  EXPECT_EQ(w.frames.size(), 1U);
  EXPECT_GE(w.session.packets().refused, 1990U);
  EXPECT_FALSE(w.session.end());
}

TEST(Session, GarbageDoesNotKeepADeadServerAlive) {
  World w;
  w.run(milliseconds(200));
  w.server_is_there = false;
  for (int i = 0; i < 60 && !w.session.end(); ++i) {
    w.session.on_datagram(ByteBuffer(40, std::byte{0x11}), w.now());
    w.run(milliseconds(100));
  }
  expect_end(w, Kind::kServerGone, "nothing came");
}

TEST(Session, SaysItsEmphasisWhenItIsDueAndEachNewOneOnce) {
  SessionSettings settings;
  settings.emphasis = Emphasis{.foveation = 1.5};
  settings.emphasis_after = seconds(1);
  World w(settings);
  w.run(milliseconds(900));
  EXPECT_TRUE(w.server.emphases.empty());
  w.run(milliseconds(200));
  ASSERT_EQ(w.server.emphases.size(), 1U);
  EXPECT_EQ(w.server.emphases[0], settings.emphasis);
  w.session.set_emphasis({.priorities = {{"lamp", 2}}}, w.now());
  w.run(milliseconds(100));
  ASSERT_EQ(w.server.emphases.size(), 2U);
  EXPECT_EQ(w.server.emphases[1], (Emphasis{.priorities = {{"lamp", 2}}}));
  w.run(seconds(2));
  EXPECT_EQ(w.server.emphases.size(), 2U);
  EXPECT_FALSE(w.stuck);
  EXPECT_FALSE(w.session.end());
}

TEST(Session, AnEmphasisSetBeforeTheHandshakeWaitsForIt) {
  World w;
  w.session.set_emphasis({.foveation = 0.5}, w.now());
  w.run(seconds(1));
  ASSERT_EQ(w.server.emphases.size(), 1U);
  EXPECT_FALSE(w.stuck);
}

TEST(Session, SurvivesEveryTruncationOfTheServersFirstWords) {
  ByteBuffer bytes;
  proto::append_message(FakeServer::default_answer(), bytes);
  proto::append_message(some_frame(), bytes);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    Session session(SessionSettings{}, Time{seconds(1)});
    session.on_stream_bytes(ByteView(bytes).first(cut), Time{seconds(1)});
    session.on_stream_bytes(ByteView(bytes).subspan(cut), Time{seconds(1)});
    EXPECT_FALSE(session.end());
    EXPECT_TRUE(session.pop_update());
  }
}

TEST(Session, SurvivesEveryFlippedByte) {
  ByteBuffer bytes;
  proto::append_message(FakeServer::default_answer(), bytes);
  proto::append_message(some_frame(), bytes);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const unsigned flip : {0x01U, 0x80U, 0xFFU}) {
      ByteBuffer broken = bytes;
      broken[at] ^= static_cast<std::byte>(flip);
      Session session(SessionSettings{}, Time{seconds(1)});
      session.on_stream_bytes(broken, Time{seconds(1)});
      session.poll(Time{seconds(2)});
    }
  }
}

}  // namespace
}  // namespace atlaswire::client
