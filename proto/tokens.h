#pragma once

#include <array>
#include <cstddef>

namespace atlaswire::proto {

/// Secret of one session, given on the reliable channel; a client's datagrams prove with it whose they
/// are. The shells fill it from a cryptographic generator.
using UdpToken = std::array<std::byte, 16>;
/// Server's challenge to one address, from a cryptographic generator.
using Nonce = std::array<std::byte, 16>;

/// Equality in time that does not depend on where the first difference is.
[[nodiscard]] inline bool equal_secret(const std::array<std::byte, 16>& a,
                                       const std::array<std::byte, 16>& b) {
  std::byte difference{};
  for (std::size_t i = 0; i < a.size(); ++i) difference |= a[i] ^ b[i];
  return difference == std::byte{};
}

}  // namespace atlaswire::proto
