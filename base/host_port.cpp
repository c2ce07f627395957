#include "base/host_port.h"

#include <fmt/format.h>

#include <charconv>

namespace atlaswire {

std::optional<HostPort> parse_host_port(std::string_view text) {
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  const char* end = text.data() + text.size();
  unsigned port = 0;
  const auto parsed = std::from_chars(text.data() + colon + 1, end, port);
  if (host.empty() || parsed.ec != std::errc{} || parsed.ptr != end || port > 65'535) return std::nullopt;
  return HostPort{std::string(host), static_cast<std::uint16_t>(port)};
}

std::string to_string(const HostPort& at) {
  const bool six = at.host.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", six ? "[" : "", at.host, six ? "]" : "", at.port);
}

}  // namespace atlaswire
