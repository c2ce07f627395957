#include "proto/pose_packet.h"

#include "proto/pose_inbox.h"
#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

#include <limits>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

Pose pose(double x) {
  Pose p;
  p.position = {x, 2.0, -3.0};
  p.orientation = glm::dquat(0.5, 0.5, -0.5, 0.5);
  p.velocity = {1.0, 0.0, -1.5};
  p.angular_velocity = {0.0, 0.25, 0.0};
  return p;
}

PosePacket packet_of(std::initializer_list<std::uint32_t> ids) {
  PosePacket packet;
  packet.session = SessionId{1};
  for (const auto id : ids) packet.poses[packet.count++] = {PoseId{id}, at(1ms * id), pose(id)};
  return packet;
}

TEST(PosePacket, GoldenBytes) {
  ByteBuffer out;
  encode(packet_of({1}), out);
  EXPECT_EQ(test::to_hex(out),
            "c10100000001"
            "01"
            "00000001"
            "00000000000f4240"
            "3ff0000000000000"
            "4000000000000000"
            "c008000000000000"
            "3f000000"
            "3f000000"
            "bf000000"
            "3f000000"
            "3f800000"
            "00000000"
            "bfc00000"
            "00000000"
            "3e800000"
            "00000000");
}

TEST(PosePacket, ComesBackAsSent) {
  ByteBuffer out;
  encode(packet_of({9, 8, 7}), out);
  EXPECT_EQ(out.size(), 7 + 3 * kPoseRecordSize);
  const auto got = parse_pose_packet(out).value();
  ASSERT_EQ(got.count, 3U);
  EXPECT_EQ(got.session, SessionId{1});
  EXPECT_EQ(got.poses[1].id, PoseId{8});
  EXPECT_EQ(got.poses[1].sampled, at(8ms));
  EXPECT_EQ(got.poses[1].pose.position, pose(8).position);
  EXPECT_EQ(got.poses[1].pose.orientation, pose(8).orientation);
  EXPECT_EQ(got.poses[1].pose.velocity, pose(8).velocity);
  EXPECT_EQ(got.poses[1].pose.angular_velocity, pose(8).angular_velocity);
}

TEST(PosePacket, OrientationsComeOutWithUnitLength) {
  PosePacket packet = packet_of({1});
  packet.poses[0].pose.orientation = glm::dquat(1.0009, 0.0, 0.0, 0.0);
  ByteBuffer out;
  encode(packet, out);
  EXPECT_EQ(parse_pose_packet(out).value().poses[0].pose.orientation.w, 1.0);
}

TEST(PosePacket, RefusesPosesThatAreNone) {
  const auto refused = [](auto spoil) {
    PosePacket packet = packet_of({3, 2});
    spoil(packet.poses[1]);
    ByteBuffer out;
    encode(packet, out);
    const auto result = parse_pose_packet(out);
    return result.has_error() && result.error().code == WireError::kBadValue;
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(refused([](StampedPose&) {}));
  EXPECT_TRUE(refused([](StampedPose& p) { p.id = PoseId{0}; }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.id = PoseId{3}; }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.id = PoseId{4}; }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.sampled = from_nanos(kMaxWireNanos); }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.pose.position.x = kNaN; }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.pose.position.y = 2e9; }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.pose.orientation.w = 0.9; }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.pose.orientation.z = kNaN; }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.pose.velocity.z = kInf; }));
  EXPECT_TRUE(refused([](StampedPose& p) { p.pose.angular_velocity.x = 1e5; }));
}

TEST(PosePacket, RefusesWrongCountsAndSizes) {
  ByteBuffer good;
  encode(packet_of({3, 2}), good);
  EXPECT_TRUE(test::every_truncation_fails(good, [](ByteView b) { return parse_pose_packet(b); }));
  for (const unsigned count : {0U, 1U, 3U, 4U, 255U}) {
    ByteBuffer bad = good;
    bad[6] = static_cast<std::byte>(count);
    EXPECT_TRUE(parse_pose_packet(bad).has_error()) << count;
  }
  ByteBuffer longer = good;
  longer.push_back({});
  EXPECT_EQ(parse_pose_packet(longer).error().code, WireError::kBadLength);
  test::for_each_damage(good, [](const ByteBuffer& bytes) { static_cast<void>(parse_pose_packet(bytes)); });
}

TEST(PoseOutbox, KeepsTheLastThreeNewestFirst) {
  PoseOutbox outbox(SessionId{4});
  EXPECT_EQ(outbox.packet().count, 0U);
  for (std::uint32_t i = 1; i <= 5; ++i) EXPECT_EQ(outbox.push(pose(i), at(1ms * i)), PoseId{i});
  const PosePacket& packet = outbox.packet();
  ASSERT_EQ(packet.count, 3U);
  EXPECT_EQ(packet.poses[0].id, PoseId{5});
  EXPECT_EQ(packet.poses[1].id, PoseId{4});
  EXPECT_EQ(packet.poses[2].id, PoseId{3});
  ByteBuffer out;
  encode(packet, out);
  EXPECT_EQ(session_of(out).value(), SessionId{4});
  EXPECT_TRUE(parse_pose_packet(out).has_value());
}

TEST(PoseInbox, KeepsTheNewestWhateverTheOrder) {
  PoseInbox inbox;
  EXPECT_FALSE(inbox.newest());
  EXPECT_TRUE(inbox.add(packet_of({2, 1}), at(10ms)));
  EXPECT_TRUE(inbox.add(packet_of({4, 3, 2}), at(20ms)));
  EXPECT_FALSE(inbox.add(packet_of({3, 2, 1}), at(30ms)));
  EXPECT_FALSE(inbox.add(packet_of({4, 3, 2}), at(40ms)));
  EXPECT_EQ(inbox.newest()->stamped.id, PoseId{4});
  EXPECT_EQ(inbox.newest()->received, at(20ms));
  EXPECT_EQ(inbox.packets(), 4U);
  EXPECT_EQ(inbox.stale_packets(), 2U);
  EXPECT_EQ(inbox.missed_poses(), 0U);
}

TEST(PoseInbox, OneLostPacketLosesNoPose) {
  PoseInbox inbox;
  inbox.add(packet_of({3, 2, 1}), at(1ms));
  inbox.add(packet_of({6, 5, 4}), at(2ms));
  EXPECT_EQ(inbox.missed_poses(), 0U);
  inbox.add(packet_of({11, 10, 9}), at(3ms));
  EXPECT_EQ(inbox.missed_poses(), 2U);
}

TEST(PoseInbox, FollowsIdsAroundTheirWrap) {
  PoseInbox inbox;
  inbox.add(packet_of({0xFFFFFFFF, 0xFFFFFFFE}), at(1ms));
  EXPECT_TRUE(inbox.add(packet_of({1, 0xFFFFFFFF}), at(2ms)));
  EXPECT_FALSE(inbox.add(packet_of({0xFFFFFFFF}), at(3ms)));
  EXPECT_EQ(inbox.newest()->stamped.id, PoseId{1});
}

}  // namespace
}  // namespace atlaswire::proto
