#include "netsim/pcapng.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace atlaswire::netsim {

namespace {

constexpr std::uint32_t kSectionHeader = 0x0A0D0D0A;
constexpr std::uint32_t kInterface = 1;
constexpr std::uint32_t kEnhancedPacket = 6;
constexpr std::uint16_t kOptionComment = 1;
constexpr std::uint16_t kOptionName = 2;
constexpr std::uint16_t kOptionTimeResolution = 9;
constexpr std::uint16_t kLinkTypeRaw = 101;
constexpr std::size_t kIpHeader = 20;
constexpr std::size_t kUdpHeader = 8;
constexpr std::size_t kMostIpOctets = 65'535;

/// pcapng is written in the machine's order, which its magic number tells; ours is little-endian always.
template <class T>
void put(ByteBuffer& out, T v) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out.push_back(static_cast<std::byte>((v >> (8 * i)) & 0xFFU));
  }
}

void pad(ByteBuffer& out) {
  while (out.size() % 4 != 0) out.push_back(std::byte{0});
}

void put_option(ByteBuffer& out, std::uint16_t code, std::string_view text) {
  put(out, code);
  put(out, static_cast<std::uint16_t>(text.size()));
  const auto bytes = std::as_bytes(std::span(text));
  out.insert(out.end(), bytes.begin(), bytes.end());
  pad(out);
}

void put_block(ByteBuffer& out, std::uint32_t type, const ByteBuffer& body) {
  const auto length = static_cast<std::uint32_t>(body.size() + 12);
  put(out, type);
  put(out, length);
  out.insert(out.end(), body.begin(), body.end());
  put(out, length);
}

void put_interface(ByteBuffer& out, std::string_view name) {
  ByteBuffer body;
  put(body, kLinkTypeRaw);
  put(body, std::uint16_t{0});
  put(body, std::uint32_t{0});  // no snap length
  put_option(body, kOptionName, name);
  put_option(body, kOptionTimeResolution, "\x09");
  put(body, std::uint32_t{0});  // end of options
  put_block(out, kInterface, body);
}

std::uint16_t ip_checksum(ByteView header) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i + 1 < header.size(); i += 2) {
    sum += std::to_integer<std::uint32_t>(header[i]) << 8U | std::to_integer<std::uint32_t>(header[i + 1]);
  }
  while (sum > 0xFFFF) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

ByteBuffer ip_packet(const DirectedDecision& d, ByteView payload, bool stream) {
  constexpr std::uint32_t kClient = 0x0A000001;
  constexpr std::uint32_t kServer = 0x0A000002;
  const std::size_t headers = kIpHeader + (stream ? 0 : kUdpHeader);
  payload = payload.first(std::min(payload.size(), kMostIpOctets - headers));
  const bool up = d.direction == Direction::kUp;
  ByteBuffer ip;
  ByteWriter w(ip);
  w.write(std::uint8_t{0x45});
  w.write(static_cast<std::uint8_t>(d.decision.marked ? Ecn::kCongestion : d.decision.ecn));
  w.write(static_cast<std::uint16_t>(headers + payload.size()));
  w.write(static_cast<std::uint16_t>(d.decision.packet));  // identification
  w.write(std::uint16_t{0});
  w.write(std::uint8_t{64});
  w.write(static_cast<std::uint8_t>(stream ? 253 : 17));
  w.write(std::uint16_t{0});
  w.write(up ? kClient : kServer);
  w.write(up ? kServer : kClient);
  const std::uint16_t sum = ip_checksum(ip);
  ip[10] = static_cast<std::byte>(sum >> 8U);
  ip[11] = static_cast<std::byte>(sum & 0xFFU);
  if (!stream) {
    const auto client =
        static_cast<std::uint16_t>(1024 + static_cast<std::uint32_t>(d.decision.flow) % 60'000);
    constexpr std::uint16_t kServerPort = 7400;
    w.write(up ? client : kServerPort);
    w.write(up ? kServerPort : client);
    w.write(static_cast<std::uint16_t>(kUdpHeader + payload.size()));
    w.write(std::uint16_t{0});  // no checksum
  }
  w.write_bytes(payload);
  return ip;
}

}  // namespace

ByteBuffer pcapng_opening() {
  ByteBuffer out;
  ByteBuffer body;
  put(body, std::uint32_t{0x1A2B3C4D});
  put(body, std::uint16_t{1});
  put(body, std::uint16_t{0});
  put(body, ~std::uint64_t{0});  // length of the section: not known
  put_block(out, kSectionHeader, body);
  put_interface(out, "up");
  put_interface(out, "down");
  return out;
}

ByteBuffer pcapng_packet(const DirectedDecision& d, ByteView payload, bool stream, std::uint64_t stamp) {
  const ByteBuffer packet = ip_packet(d, payload, stream);
  ByteBuffer body;
  put(body, static_cast<std::uint32_t>(d.direction));
  put(body, static_cast<std::uint32_t>(stamp >> 32U));
  put(body, static_cast<std::uint32_t>(stamp));
  put(body, static_cast<std::uint32_t>(packet.size()));
  put(body, static_cast<std::uint32_t>(packet.size()));
  body.insert(body.end(), packet.begin(), packet.end());
  pad(body);
  put_option(body, kOptionComment, describe(d));
  put(body, std::uint32_t{0});
  ByteBuffer out;
  put_block(out, kEnhancedPacket, body);
  return out;
}

std::string describe(const DirectedDecision& d) {
  const Decision& x = d.decision;
  std::string text = d.direction == Direction::kUp ? "up" : "down";
  if (d.path != PathId{0}) text += fmt::format(" path {}", static_cast<std::uint32_t>(d.path));
  text +=
      fmt::format(" packet {}, flow {}: {}", x.packet, static_cast<std::uint32_t>(x.flow), fate_name(x.fate));
  const double queued = to_ms(x.left_queue - x.arrived);
  if (x.fate == Fate::kDelivered) {
    text +=
        fmt::format(" after {:.3f} ms, {:.3f} ms of it in the queue", to_ms(x.delivered - x.arrived), queued);
  } else if (queued > 0) {
    text += fmt::format(" after {:.3f} ms in the queue", queued);
  }
  if (x.duplicate) text += ", a copy";
  if (x.corrupted) text += ", one bit flipped";
  if (x.marked) text += ", marked congestion experienced";
  if (x.reordered) text += ", free to overtake";
  return text;
}

}  // namespace atlaswire::netsim
