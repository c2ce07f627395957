#include "proto/pose_packet.h"

#include "base/assert.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace atlaswire::proto {

namespace {

constexpr std::uint8_t kPoseType = 0xC1;

void write_floats(const glm::dvec3& v, ByteWriter& writer) {
  writer.write(static_cast<float>(v.x));
  writer.write(static_cast<float>(v.y));
  writer.write(static_cast<float>(v.z));
}

glm::dvec3 read_floats(ByteReader& reader) {
  const auto x = reader.read<float>();
  const auto y = reader.read<float>();
  const auto z = reader.read<float>();
  return {x, y, z};
}

void write_pose(const StampedPose& stamped, ByteWriter& writer) {
  const Pose& pose = stamped.pose;
  writer.write(value(stamped.id));
  writer.write(to_nanos(stamped.sampled));
  writer.write(pose.position.x);
  writer.write(pose.position.y);
  writer.write(pose.position.z);
  writer.write(static_cast<float>(pose.orientation.w));
  write_floats({pose.orientation.x, pose.orientation.y, pose.orientation.z}, writer);
  write_floats(pose.velocity, writer);
  write_floats(pose.angular_velocity, writer);
}

StampedPose read_pose(ByteReader& reader) {
  StampedPose out;
  out.id = PoseId{reader.read<std::uint32_t>()};
  out.sampled = from_nanos(reader.read<std::int64_t>());
  out.pose.position.x = reader.read<double>();
  out.pose.position.y = reader.read<double>();
  out.pose.position.z = reader.read<double>();
  const auto w = reader.read<float>();
  const glm::dvec3 axis = read_floats(reader);
  out.pose.orientation = glm::dquat(w, axis.x, axis.y, axis.z);
  out.pose.velocity = read_floats(reader);
  out.pose.angular_velocity = read_floats(reader);
  return out;
}

}  // namespace

void encode(const PosePacket& packet, ByteBuffer& out) {
  AW_ASSERT(packet.count >= 1 && packet.count <= kMaxPosesPerPacket);
  out.clear();
  ByteWriter writer(out);
  writer.write(kPoseType);
  writer.write(static_cast<std::uint8_t>(kWireVersion));
  writer.write(value(packet.session));
  writer.write(static_cast<std::uint8_t>(packet.count));
  for (const StampedPose& pose : packet.view()) write_pose(pose, writer);
}

Result<PosePacket> parse_pose_packet(ByteView datagram) {
  PosePacket out;
  ByteReader reader(datagram);
  const auto type = reader.read<std::uint8_t>();
  const auto version = reader.read<std::uint8_t>();
  out.session = SessionId{reader.read<std::uint32_t>()};
  out.count = reader.read<std::uint8_t>();
  if (!reader.ok()) return WireError::kTruncated;
  if (type != kPoseType) return WireError::kBadType;
  if (version != kWireVersion) return WireError::kBadVersion;
  if (value(out.session) == 0 || out.count < 1 || out.count > kMaxPosesPerPacket) return WireError::kBadValue;
  if (reader.remaining() != out.count * kPoseRecordSize) return WireError::kBadLength;
  for (std::size_t i = 0; i < out.count; ++i) {
    StampedPose pose = read_pose(reader);
    if (value(pose.id) == 0 || !is_sane(pose.pose) || !is_wire_time(to_nanos(pose.sampled)))
      return WireError::kBadValue;
    if (i > 0 && !is_newer(out.poses[i - 1].id, pose.id)) return WireError::kBadValue;
    pose.pose.orientation = glm::normalize(pose.pose.orientation);
    out.poses[i] = pose;
  }
  return out;
}

PoseId PoseOutbox::push(const Pose& pose, Time sampled) {
  last_ = next(last_);
  if (value(last_) == 0) last_ = next(last_);  // 0 means "none yet", also after a wrap
  for (std::size_t i = kMaxPosesPerPacket - 1; i > 0; --i) packet_.poses[i] = packet_.poses[i - 1];
  packet_.poses[0] = {last_, sampled, pose};
  if (packet_.count < kMaxPosesPerPacket) ++packet_.count;
  return last_;
}

}  // namespace atlaswire::proto
