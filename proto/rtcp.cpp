#include "proto/rtcp.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::proto {

namespace {

constexpr std::uint8_t kSr = 200;
constexpr std::uint8_t kRr = 201;
constexpr std::uint8_t kSdes = 202;
constexpr std::uint8_t kBye = 203;
constexpr std::uint8_t kPsfb = 206;
constexpr unsigned kPliFormat = 1;
constexpr std::uint8_t kCname = 1;
constexpr std::size_t kMaxPackets = 64;
constexpr std::size_t kMaxBlocks = 31;

// --- composing ---

/// Writes a packet's header now and its length when the packet is complete.
class PacketWriter {
 public:
  PacketWriter(std::uint8_t type, std::size_t count, ByteBuffer& out)
      : out_(&out), start_(out.size()), writer_(out) {
    writer_.write(static_cast<std::uint8_t>(0x80U | count));
    writer_.write(type);
    writer_.write(std::uint16_t{0});
  }
  ByteWriter& writer() { return writer_; }
  void finish() {
    while ((out_->size() - start_) % 4 != 0) out_->push_back(std::byte{0});
    const std::size_t words = (out_->size() - start_) / 4 - 1;
    (*out_)[start_ + 2] = static_cast<std::byte>(words >> 8U);
    (*out_)[start_ + 3] = static_cast<std::byte>(words & 0xFFU);
  }

 private:
  ByteBuffer* out_;
  std::size_t start_;
  ByteWriter writer_;
};

void write_block(const ReportBlock& block, ByteWriter& writer) {
  const std::int32_t lost = std::clamp(block.cumulative_lost, -0x800000, 0x7FFFFF);
  writer.write(block.ssrc);
  writer.write((std::uint32_t{block.fraction_lost} << 24U) | (static_cast<std::uint32_t>(lost) & 0xFFFFFFU));
  writer.write(block.highest_sequence);
  writer.write(block.jitter);
  writer.write(block.last_report);
  writer.write(block.delay_since_last);
}

void write_text(const std::string& text, ByteWriter& writer) {
  AW_ASSERT(text.size() <= 255);
  writer.write(static_cast<std::uint8_t>(text.size()));
  writer.write_bytes(std::as_bytes(std::span(text)));
}

void compose(const SenderReport& p, ByteBuffer& out) {
  AW_ASSERT(p.blocks.size() <= kMaxBlocks);
  PacketWriter packet(kSr, p.blocks.size(), out);
  packet.writer().write(p.ssrc);
  packet.writer().write(p.time);
  packet.writer().write(p.rtp_time);
  packet.writer().write(p.packets);
  packet.writer().write(p.octets);
  for (const auto& block : p.blocks) write_block(block, packet.writer());
  packet.finish();
}

void compose(const ReceiverReport& p, ByteBuffer& out) {
  AW_ASSERT(p.blocks.size() <= kMaxBlocks);
  PacketWriter packet(kRr, p.blocks.size(), out);
  packet.writer().write(p.ssrc);
  for (const auto& block : p.blocks) write_block(block, packet.writer());
  packet.finish();
}

void compose(const SourceDescription& p, ByteBuffer& out) {
  PacketWriter packet(kSdes, 1, out);
  packet.writer().write(p.ssrc);
  packet.writer().write(kCname);
  write_text(p.cname, packet.writer());
  packet.writer().write(std::uint8_t{0});  // the list's end, then zeros to the next word
  packet.finish();
}

void compose(const PictureLoss& p, ByteBuffer& out) {
  PacketWriter packet(kPsfb, kPliFormat, out);
  packet.writer().write(p.sender);
  packet.writer().write(p.media);
  packet.finish();
}

void compose(const Bye& p, ByteBuffer& out) {
  PacketWriter packet(kBye, 1, out);
  packet.writer().write(p.ssrc);
  if (!p.reason.empty()) write_text(p.reason, packet.writer());
  packet.finish();
}

// --- parsing ---

std::string read_text(ByteReader& reader) {
  const auto size = reader.read<std::uint8_t>();
  const ByteView bytes = reader.read_bytes(size);
  std::string text(bytes.size(), '\0');
  std::transform(bytes.begin(), bytes.end(), text.begin(), [](std::byte b) { return static_cast<char>(b); });
  return text;
}

std::vector<ReportBlock> read_blocks(unsigned count, ByteReader& reader) {
  std::vector<ReportBlock> blocks;
  for (unsigned i = 0; i < count && reader.ok(); ++i) {
    ReportBlock block;
    block.ssrc = reader.read<std::uint32_t>();
    const auto losses = reader.read<std::uint32_t>();
    block.fraction_lost = static_cast<std::uint8_t>(losses >> 24U);
    block.cumulative_lost = static_cast<std::int32_t>(losses << 8U) >> 8;
    block.highest_sequence = reader.read<std::uint32_t>();
    block.jitter = reader.read<std::uint32_t>();
    block.last_report = reader.read<std::uint32_t>();
    block.delay_since_last = reader.read<std::uint32_t>();
    blocks.push_back(block);
  }
  return blocks;
}

SenderReport read_sender_report(unsigned count, ByteReader& reader) {
  SenderReport p;
  p.ssrc = reader.read<std::uint32_t>();
  p.time = reader.read<std::uint64_t>();
  p.rtp_time = reader.read<std::uint32_t>();
  p.packets = reader.read<std::uint32_t>();
  p.octets = reader.read<std::uint32_t>();
  p.blocks = read_blocks(count, reader);
  return p;
}

/// One chunk: items until a zero octet, then zeros to a word's end (RFC 3550 section 6.5).
void read_chunk(ByteReader& reader, std::vector<RtcpPacket>& out) {
  SourceDescription p;
  p.ssrc = reader.read<std::uint32_t>();
  bool named = false;
  while (reader.ok()) {
    const auto type = reader.read<std::uint8_t>();
    if (type == 0) break;
    std::string text = read_text(reader);
    if (type != kCname) continue;
    p.cname = std::move(text);
    named = true;
  }
  while (reader.ok() && reader.remaining() % 4 != 0) reader.read<std::uint8_t>();
  if (named) out.emplace_back(std::move(p));
}

void read_bye(unsigned count, ByteReader& reader, std::vector<RtcpPacket>& out) {
  const std::size_t first = out.size();
  for (unsigned i = 0; i < count && reader.ok(); ++i) out.emplace_back(Bye{reader.read<std::uint32_t>(), {}});
  if (!reader.ok() || reader.remaining() == 0) return;
  const std::string reason = read_text(reader);
  for (std::size_t i = first; i < out.size(); ++i) std::get<Bye>(out[i]).reason = reason;
}

/// One packet of the compound; false when its body is shorter than its fields.
bool read_packet(std::uint8_t type, unsigned count, ByteView body, std::vector<RtcpPacket>& out) {
  ByteReader reader(body);
  switch (type) {
    case kSr:
      out.emplace_back(read_sender_report(count, reader));
      break;
    case kRr: {
      const auto ssrc = reader.read<std::uint32_t>();
      out.emplace_back(ReceiverReport{ssrc, read_blocks(count, reader)});
      break;
    }
    case kSdes:
      for (unsigned i = 0; i < count && reader.ok(); ++i) read_chunk(reader, out);
      break;
    case kBye:
      read_bye(count, reader, out);
      break;
    case kPsfb:
      if (count == kPliFormat) {
        const auto sender = reader.read<std::uint32_t>();
        out.emplace_back(PictureLoss{sender, reader.read<std::uint32_t>()});
      }
      break;
    default:
      break;
  }
  return reader.ok();
}

}  // namespace

void encode_rtcp(std::span<const RtcpPacket> packets, ByteBuffer& out) {
  AW_ASSERT(!packets.empty() && packets[0].index() <= 1);
  out.clear();
  for (const auto& packet : packets) {
    std::visit([&](const auto& p) { compose(p, out); }, packet);
  }
}

Result<std::vector<RtcpPacket>> parse_rtcp(ByteView datagram) {
  std::vector<RtcpPacket> out;
  ByteReader reader(datagram);
  bool first = true;
  while (reader.remaining() > 0 || first) {
    const unsigned head = reader.read<std::uint8_t>();
    const auto type = reader.read<std::uint8_t>();
    const std::size_t words = reader.read<std::uint16_t>();
    ByteView body = reader.read_bytes(words * 4);
    if (!reader.ok()) return WireError::kTruncated;
    if (head >> 6U != 2) return WireError::kBadVersion;
    if (first && type != kSr && type != kRr) return WireError::kBadType;
    first = false;
    if ((head & 0x20U) != 0) {
      const std::size_t padding = body.empty() ? 0 : std::to_integer<std::size_t>(body.back());
      if (reader.remaining() > 0 || padding == 0 || padding % 4 != 0 || padding > body.size()) {
        return WireError::kBadLength;
      }
      body = body.first(body.size() - padding);
    }
    if (!read_packet(type, head & 0x1FU, body, out)) return WireError::kTruncated;
    if (out.size() > kMaxPackets) return WireError::kBadLength;
  }
  return out;
}

}  // namespace atlaswire::proto
