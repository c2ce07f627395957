#include "base/assert.h"
#include "base/bytes.h"
#include "proto/frame_assembler.h"
#include "proto/rtcp_stats.h"
#include "proto/rtp.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

/// A media flow: records of u8 milliseconds since the last one, u16 size, packet.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace atlaswire;
  proto::FrameAssembler::Settings settings;
  settings.max_packets = 1024;
  settings.max_octets = 1U << 14U;
  proto::FrameAssembler assembler(settings);
  proto::ReceptionStats stats;
  ByteReader reader(std::as_bytes(std::span(data, size)));
  Time now{};
  std::uint64_t popped = 0;
  while (reader.remaining() >= 3) {
    now += std::chrono::milliseconds(reader.read<std::uint8_t>());
    const std::size_t wanted = reader.read<std::uint16_t>();
    const ByteView datagram = reader.read_bytes(std::min(wanted, reader.remaining()));
    const auto packet = proto::parse_rtp(datagram);
    if (packet.has_value()) {
      stats.on_packet(packet->header, now);
      assembler.add(*packet, datagram.size(), now);
    }
    assembler.poll(now);
    if (const auto deadline = assembler.next_deadline()) AW_ASSERT(*deadline > now);
    while (const auto frame = assembler.pop()) {
      AW_ASSERT(!frame->access_unit.empty() && frame->first_arrival <= frame->last_arrival);
      AW_ASSERT(popped > 0 || frame->idr);
      ++popped;
    }
  }
  AW_ASSERT(assembler.counts().frames == popped);
  static_cast<void>(stats.report(now));
  return 0;
}
