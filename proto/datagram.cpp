#include "proto/datagram.h"

#include <algorithm>
#include <array>

namespace atlaswire::proto {

namespace {

constexpr unsigned kPoseType = 0xC1;
constexpr unsigned kProbeType = 0xC2;
constexpr unsigned kChallengeType = 0xC3;
constexpr unsigned kConfirmType = 0xC4;
constexpr unsigned kSyncRequestType = 0xC5;
constexpr unsigned kSyncResponseType = 0xC6;

ByteWriter begin(unsigned type, SessionId session, ByteBuffer& out) {
  out.clear();
  ByteWriter writer(out);
  writer.write(static_cast<std::uint8_t>(type));
  writer.write(static_cast<std::uint8_t>(kWireVersion));
  writer.write(value(session));
  return writer;
}

/// Checks size, type, version and session; gives a reader behind the header.
Result<ByteReader> open(ByteView datagram, unsigned type, std::size_t size, SessionId& session) {
  if (datagram.size() < size) return WireError::kTruncated;
  if (datagram.size() > size) return WireError::kTrailingBytes;
  ByteReader reader(datagram);
  if (reader.read<std::uint8_t>() != type) return WireError::kBadType;
  if (reader.read<std::uint8_t>() != kWireVersion) return WireError::kBadVersion;
  session = SessionId{reader.read<std::uint32_t>()};
  if (value(session) == 0) return WireError::kBadValue;
  return reader;
}

std::array<std::byte, 16> read_secret(ByteReader& reader) {
  std::array<std::byte, 16> secret{};
  const ByteView bytes = reader.read_bytes(secret.size());
  std::copy(bytes.begin(), bytes.end(), secret.begin());
  return secret;
}

bool rest_is_zero(ByteReader& reader) {
  const ByteView rest = reader.read_bytes(reader.remaining());
  return std::all_of(rest.begin(), rest.end(), [](std::byte b) { return b == std::byte{}; });
}

}  // namespace

DatagramKind classify(ByteView datagram) {
  if (datagram.size() < 2) return DatagramKind::kUnknown;
  const auto first = std::to_integer<unsigned>(datagram[0]);
  const auto second = std::to_integer<unsigned>(datagram[1]);
  if (first >= 128 && first <= 191) {
    return second >= 192 && second <= 223 ? DatagramKind::kRtcp : DatagramKind::kRtp;
  }
  switch (first) {
    case kPoseType:
      return DatagramKind::kPose;
    case kProbeType:
      return DatagramKind::kProbe;
    case kChallengeType:
      return DatagramKind::kChallenge;
    case kConfirmType:
      return DatagramKind::kConfirm;
    case kSyncRequestType:
      return DatagramKind::kSyncRequest;
    case kSyncResponseType:
      return DatagramKind::kSyncResponse;
    default:
      return DatagramKind::kUnknown;
  }
}

Result<SessionId> session_of(ByteView datagram) {
  if (datagram.size() < kDatagramHeader) return WireError::kTruncated;
  ByteReader reader(datagram);
  const auto type = reader.read<std::uint8_t>();
  if (type < kPoseType || type > kSyncResponseType) return WireError::kBadType;
  if (reader.read<std::uint8_t>() != kWireVersion) return WireError::kBadVersion;
  const SessionId session{reader.read<std::uint32_t>()};
  if (value(session) == 0) return WireError::kBadValue;
  return session;
}

void encode(const Probe& message, ByteBuffer& out) {
  auto writer = begin(kProbeType, message.session, out);
  writer.write_bytes(message.token);
  out.resize(kProbeSize);
}

void encode(const Challenge& message, ByteBuffer& out) {
  auto writer = begin(kChallengeType, message.session, out);
  writer.write_bytes(message.nonce);
}

void encode(const Confirm& message, ByteBuffer& out) {
  auto writer = begin(kConfirmType, message.session, out);
  writer.write_bytes(message.token);
  writer.write_bytes(message.nonce);
}

void encode(const SyncRequest& message, ByteBuffer& out) {
  auto writer = begin(kSyncRequestType, message.session, out);
  writer.write(message.sequence);
  writer.write(message.client_sent);
  out.resize(kSyncSize);
}

void encode(const SyncResponse& message, ByteBuffer& out) {
  auto writer = begin(kSyncResponseType, message.session, out);
  writer.write(message.sequence);
  writer.write(message.client_sent);
  writer.write(message.server_received);
  writer.write(message.server_sent);
}

Result<Probe> parse_probe(ByteView datagram) {
  Probe out;
  auto reader = open(datagram, kProbeType, kProbeSize, out.session);
  if (reader.has_error()) return reader.error();
  out.token = read_secret(*reader);
  if (!rest_is_zero(*reader)) return WireError::kBadValue;
  return out;
}

Result<Challenge> parse_challenge(ByteView datagram) {
  Challenge out;
  auto reader = open(datagram, kChallengeType, kChallengeSize, out.session);
  if (reader.has_error()) return reader.error();
  out.nonce = read_secret(*reader);
  return out;
}

Result<Confirm> parse_confirm(ByteView datagram) {
  Confirm out;
  auto reader = open(datagram, kConfirmType, kConfirmSize, out.session);
  if (reader.has_error()) return reader.error();
  out.token = read_secret(*reader);
  out.nonce = read_secret(*reader);
  return out;
}

Result<SyncRequest> parse_sync_request(ByteView datagram) {
  SyncRequest out;
  auto reader = open(datagram, kSyncRequestType, kSyncSize, out.session);
  if (reader.has_error()) return reader.error();
  out.sequence = reader->read<std::uint32_t>();
  out.client_sent = reader->read<std::int64_t>();
  if (!rest_is_zero(*reader) || !is_wire_time(out.client_sent)) return WireError::kBadValue;
  return out;
}

Result<SyncResponse> parse_sync_response(ByteView datagram) {
  SyncResponse out;
  auto reader = open(datagram, kSyncResponseType, kSyncSize, out.session);
  if (reader.has_error()) return reader.error();
  out.sequence = reader->read<std::uint32_t>();
  out.client_sent = reader->read<std::int64_t>();
  out.server_received = reader->read<std::int64_t>();
  out.server_sent = reader->read<std::int64_t>();
  if (!is_wire_time(out.client_sent) || !is_wire_time(out.server_received) ||
      !is_wire_time(out.server_sent)) {
    return WireError::kBadValue;
  }
  return out;
}

}  // namespace atlaswire::proto
