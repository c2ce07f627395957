#include "base/assert.h"
#include "proto/address_gate.h"
#include "proto/clock_sync.h"
#include "proto/datagram.h"
#include "proto/pose_inbox.h"
#include "proto/pose_packet.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace {

using namespace atlaswire;

/// What parses must encode to the same octets.
template <class Message>
void expect_same(const Result<Message>& message, ByteView datagram) {
  if (message.has_error()) return;
  ByteBuffer out;
  proto::encode(*message, out);
  AW_ASSERT(std::equal(out.begin(), out.end(), datagram.begin(), datagram.end()));
}

void take_pose(ByteView datagram) {
  const auto packet = proto::parse_pose_packet(datagram);
  if (packet.has_error()) return;
  proto::PoseInbox inbox;
  AW_ASSERT(inbox.add(*packet, Time{}) && is_sane(inbox.newest()->stamped.pose));
  ByteBuffer out;
  proto::encode(*packet, out);  // not the same octets: orientations come out with unit length
  AW_ASSERT(proto::parse_pose_packet(out).has_value());
}

void take_sync(ByteView datagram) {
  const auto response = proto::parse_sync_response(datagram);
  expect_same(response, datagram);
  if (response.has_error()) return;
  // The answer to the request it claims to answer, at the first moment that it could be true.
  proto::ClockSync sync(response->session);
  static_cast<void>(sync.poll(from_nanos(response->client_sent)));
  sync.on_response(*response, from_nanos(response->client_sent));
  static_cast<void>(sync.to_client(response->server_sent));
  static_cast<void>(sync.error_bound(Time{}));
}

}  // namespace

/// Any datagram on the shared UDP flow, at either end.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView datagram = std::as_bytes(std::span(data, size));
  static_cast<void>(proto::classify(datagram));
  static_cast<void>(proto::session_of(datagram));
  take_pose(datagram);
  take_sync(datagram);
  const auto probe = proto::parse_probe(datagram);
  expect_same(probe, datagram);
  expect_same(proto::parse_challenge(datagram), datagram);
  expect_same(proto::parse_confirm(datagram), datagram);
  expect_same(proto::parse_sync_request(datagram), datagram);
  if (probe.has_value()) {
    proto::AddressGate gate(probe->token);
    const auto home = proto::ipv4_address({127, 0, 0, 1}, 1);
    const auto nonce = gate.on_datagram(home, size, probe->token, proto::Nonce{}, Time{});
    AW_ASSERT(nonce && !gate.media_address());
    AW_ASSERT(gate.on_confirm(home, proto::kConfirmSize, probe->token, *nonce, Time{}));
  }
  return 0;
}
