#pragma once

#include "base/bytes.h"
#include "netsim/emulator.h"

#include <string>

namespace atlaswire::netsim {

/// The opening of a pcapng file (draft-ietf-opsawg-pcapng): a section header and two interfaces, "up" and
/// "down", raw IP, nanosecond timestamps.
ByteBuffer pcapng_opening();

/// An enhanced packet block: `payload` behind an IPv4 header, and a UDP one for datagrams, with the decision
/// as its comment. Addresses are invented: the client is 10.0.0.1, the server 10.0.0.2, the client's port
/// says the flow. Segments of streams, whose TCP headers the relay never sees, are IPv4 protocol 253 (RFC
/// 3692, for experiments). `stamp`: the packet's entry, nanoseconds since 1970.
ByteBuffer pcapng_packet(const DirectedDecision& d, ByteView payload, bool stream, std::uint64_t stamp);

/// A decision in words: "up packet 7, flow 2: delivered after 21.250 ms, 0.300 ms of it in the queue".
std::string describe(const DirectedDecision& d);

}  // namespace atlaswire::netsim
