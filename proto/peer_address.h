#pragma once

#include <array>
#include <compare>
#include <cstdint>

namespace atlaswire::proto {

/// An IP address and port without a socket library: IPv6 octets, IPv4 as ::ffff:a.b.c.d.
struct PeerAddress {
  std::array<std::uint8_t, 16> ip{};
  std::uint16_t port = 0;
  auto operator<=>(const PeerAddress&) const = default;
};

/// a.b.c.d:port.
constexpr PeerAddress ipv4_address(std::array<std::uint8_t, 4> ip, std::uint16_t port) {
  return {{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, ip[0], ip[1], ip[2], ip[3]}, port};
}

}  // namespace atlaswire::proto
