#include "proto/rtp.h"

#include "base/assert.h"

namespace atlaswire::proto {

namespace {

constexpr std::size_t kFixedHeader = 12;
constexpr std::uint16_t kOneByteProfile = 0xBEDE;  // RFC 8285 section 4.2

template <class T>
void write_element(RtpExtensionId id, T v, ByteWriter& writer) {
  writer.write(static_cast<std::uint8_t>((static_cast<unsigned>(id) << 4U) | (sizeof(T) - 1)));
  writer.write(v);
}

template <class T>
std::size_t element_size(const std::optional<T>& v) {
  return v ? 1 + sizeof(T) : 0;
}

std::size_t elements_size(const RtpExtensions& e) {
  return element_size(e.frame) + element_size(e.pose) + element_size(e.capture) +
         element_size(e.transport_sequence);
}

/// One element of a known kind; false when its size is wrong.
bool read_element(unsigned id, ByteView data, RtpExtensions& out) {
  ByteReader reader(data);
  switch (static_cast<RtpExtensionId>(id)) {
    case RtpExtensionId::kFrame:
      out.frame = FrameId{reader.read<std::uint32_t>()};
      break;
    case RtpExtensionId::kPose:
      out.pose = PoseId{reader.read<std::uint32_t>()};
      break;
    case RtpExtensionId::kCaptureTime:
      out.capture = reader.read<std::uint64_t>();
      break;
    case RtpExtensionId::kTransportSequence:
      out.transport_sequence = reader.read<std::uint16_t>();
      break;
    default:
      return true;
  }
  return reader.finished();
}

Result<void> read_elements(ByteView block, RtpExtensions& out) {
  ByteReader reader(block);
  while (reader.remaining() > 0) {
    const unsigned head = reader.read<std::uint8_t>();
    const unsigned id = head >> 4U;
    const unsigned length = head & 0xFU;
    if (head == 0) continue;             // padding
    if (id == 0 || id == 15) return {};  // RFC 8285 section 4.2: stop here, keep what came before
    const ByteView data = reader.read_bytes(length + 1);
    if (!reader.ok()) return WireError::kTruncated;
    if (!read_element(id, data, out)) return WireError::kBadLength;
  }
  return {};
}

}  // namespace

std::size_t rtp_header_size(const RtpExtensions& extensions) {
  const std::size_t elements = elements_size(extensions);
  return elements == 0 ? kFixedHeader : kFixedHeader + 4 + (elements + 3) / 4 * 4;
}

void append_rtp_header(const RtpHeader& header, ByteBuffer& out) {
  AW_ASSERT(header.payload_type < 128);
  const std::size_t end = out.size() + rtp_header_size(header.extensions);
  const std::size_t elements = elements_size(header.extensions);
  ByteWriter writer(out);
  writer.write(static_cast<std::uint8_t>(elements > 0 ? 0x90U : 0x80U));
  writer.write(static_cast<std::uint8_t>((header.marker ? 0x80U : 0U) | header.payload_type));
  writer.write(header.sequence);
  writer.write(header.timestamp);
  writer.write(header.ssrc);
  if (elements == 0) return;
  writer.write(kOneByteProfile);
  writer.write(static_cast<std::uint16_t>((elements + 3) / 4));
  const RtpExtensions& e = header.extensions;
  if (e.frame) write_element(RtpExtensionId::kFrame, value(*e.frame), writer);
  if (e.pose) write_element(RtpExtensionId::kPose, value(*e.pose), writer);
  if (e.capture) write_element(RtpExtensionId::kCaptureTime, *e.capture, writer);
  if (e.transport_sequence) {
    write_element(RtpExtensionId::kTransportSequence, *e.transport_sequence, writer);
  }
  out.resize(end);
}

Result<RtpPacketView> parse_rtp(ByteView datagram) {
  ByteReader reader(datagram);
  const unsigned first = reader.read<std::uint8_t>();
  const unsigned second = reader.read<std::uint8_t>();
  RtpPacketView out;
  out.header.sequence = reader.read<std::uint16_t>();
  out.header.timestamp = reader.read<std::uint32_t>();
  out.header.ssrc = reader.read<std::uint32_t>();
  reader.read_bytes(std::size_t{4} * (first & 0xFU));  // CSRC list
  if (!reader.ok()) return WireError::kTruncated;
  if (first >> 6U != 2) return WireError::kBadVersion;
  out.header.marker = (second & 0x80U) != 0;
  out.header.payload_type = static_cast<std::uint8_t>(second & 0x7FU);
  if ((first & 0x10U) != 0) {
    const auto profile = reader.read<std::uint16_t>();
    const auto words = reader.read<std::uint16_t>();
    const ByteView block = reader.read_bytes(std::size_t{4} * words);
    if (!reader.ok()) return WireError::kTruncated;
    if (profile == kOneByteProfile) {
      const auto elements = read_elements(block, out.header.extensions);
      if (elements.has_error()) return elements.error();
    }
  }
  out.payload = reader.read_bytes(reader.remaining());
  if ((first & 0x20U) != 0) {
    const std::size_t padding = out.payload.empty() ? 0 : std::to_integer<std::size_t>(out.payload.back());
    if (padding == 0 || padding > out.payload.size()) return WireError::kBadLength;
    out.payload = out.payload.first(out.payload.size() - padding);
  }
  return out;
}

std::int64_t SequenceUnwrapper::peek(std::uint16_t sequence) const {
  if (!last_) return sequence;
  const auto step = static_cast<std::int16_t>(static_cast<std::uint16_t>(
      sequence - static_cast<std::uint16_t>(static_cast<std::uint64_t>(*last_) & 0xFFFFU)));
  return *last_ + step;
}

std::int64_t SequenceUnwrapper::unwrap(std::uint16_t sequence) {
  last_ = peek(sequence);
  return *last_;
}

}  // namespace atlaswire::proto
