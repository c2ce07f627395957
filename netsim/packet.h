#pragma once

#include "base/bytes.h"
#include "base/time.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlaswire::netsim {

/// What became of a packet. A duplicate is a packet of its own with the same number.
enum class Fate : std::uint8_t {
  kDelivered = 0,
  kLost,       ///< by the loss model
  kBlackout,   ///< sent while the link was down
  kQueueFull,  ///< tail or head drop: the queue was at its bound
  kEarlyDrop,  ///< by CoDel or PIE
  kExpired,    ///< waited longer than the queue's time limit
  kUnsent,     ///< still waiting for the bottleneck when the run was finished
};
/// Stable lower-case name, for logs.
const char* fate_name(Fate fate);

/// A conversation through a link: a UDP peer, a TCP connection. Numbers are the sender's; the link only
/// carries them.
enum class FlowId : std::uint32_t {};

/// What a flow carries.
enum class FlowKind : std::uint8_t { kDatagram, kStream };

/// Which way a packet goes.
enum class Direction : std::uint8_t { kUp = 0, kDown = 1 };

/// Which of a profile's paths a flow takes: 0 is the one that flows share, n belongs to the n-th rule for
/// flows.
enum class PathId : std::uint32_t {};

/// The two ECN bits of an IP header, as they are on the wire (RFC 3168, section 5).
enum class Ecn : std::uint8_t { kNotCapable = 0, kCapable1 = 1, kCapable0 = 2, kCongestion = 3 };

/// One packet's way through one direction, complete when its fate is known. Equal arrivals, profile and
/// seed give equal decisions, byte for byte, live or in virtual time.
struct Decision {
  std::uint64_t packet = 0;  ///< number of the packet, counted from 0 in order of arrival
  FlowId flow{};             ///< as given to `send`
  std::uint32_t size = 0;    ///< octets of payload
  Time arrived{};            ///< when it was given to `send`
  Time left_queue{};         ///< when the bottleneck had served it; equals `arrived` when dropped before
  Time delivered{};          ///< when it reaches the far end; meaningless unless delivered
  Fate fate = Fate::kDelivered;
  Ecn ecn{};  ///< as given to `send`
  bool corrupted = false;
  bool duplicate = false;
  bool marked = false;     ///< ECN congestion experienced
  bool reordered = false;  ///< allowed to overtake
  bool operator==(const Decision&) const = default;
};

/// A payload at the far end.
struct Datagram {
  std::uint64_t packet = 0;
  FlowId flow{};
  Time arrival{};
  ByteBuffer payload;
  Ecn ecn{};  ///< as it leaves
};

}  // namespace atlaswire::netsim
