#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace atlaswire {

/// A host, by name or address, and a port there.
struct HostPort {
  std::string host;
  std::uint16_t port = 0;
};

/// "HOST:PORT" or "[IPV6]:PORT", port 0..65535; empty when it is none of these. Hosts are not looked up.
std::optional<HostPort> parse_host_port(std::string_view text);

/// The way back: brackets around an IPv6 address.
std::string to_string(const HostPort& at);

}  // namespace atlaswire
