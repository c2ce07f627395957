#include "bench/side_columns.h"

#include <functional>

namespace atlaswire::bench {

namespace {

void write_runs(const std::vector<std::uint32_t>& places, ByteBuffer& out) {
  ByteWriter writer(out);
  ByteBuffer lengths;
  ByteWriter length_writer(lengths);
  std::uint32_t expected = 0;
  for (std::size_t i = 0; i < places.size();) {
    std::size_t end = i + 1;
    while (end < places.size() && places[end] == places[end - 1] + 1) ++end;
    writer.write_varint(places[i] - expected + 1);
    length_writer.write_varint(end - i);
    expected = places[end - 1] + 1;
    i = end;
  }
  writer.write_varint(0);
  writer.write_bytes(lengths);
}

}  // namespace

void write_removals(const Increment& increment, ByteBuffer& out) { write_runs(increment.removed, out); }

void write_blocks(const Increment& increment, ByteBuffer& out) {
  const codec::MetaUpdate& update = *increment.update;
  std::uint32_t expected = 0;
  ByteWriter writer(out);
  writer.write_varint(update.moved.size());
  for (const std::uint32_t place : increment.moved) {
    writer.write_signed_varint(std::int64_t{place} - expected);
    expected = place + 1;
  }
  const auto column = [&](auto octet_of) {
    for (const codec::MovedPatch& patch : update.moved)
      out.push_back(static_cast<std::byte>(octet_of(patch.block)));
    for (const codec::AddedPatch& patch : update.added)
      out.push_back(static_cast<std::byte>(octet_of(patch.block)));
  };
  column([](const Block& b) { return b.width_log2 << 4 | b.height_log2; });
  column([](const Block& b) { return static_cast<int>(b.transposed); });
  column([](const Block& b) { return b.x >> 8; });
  column([](const Block& b) { return b.x & 255; });
  column([](const Block& b) { return b.y >> 8; });
  column([](const Block& b) { return b.y & 255; });
  for (const codec::AddedPatch& patch : update.added) {
    out.push_back(static_cast<std::byte>(static_cast<unsigned>(patch.draw.alpha) << 1U |
                                         static_cast<unsigned>(patch.draw.double_sided)));
  }
}

}  // namespace atlaswire::bench
