#include "base/assert.h"
#include "client/layout_mirror.h"
#include "client/replica.h"
#include "codec/gate_meta.h"

#include <span>

using namespace atlaswire;
using namespace atlaswire::codec;

namespace {

constexpr MetaLimits kLimits{.max_vertices = 4096, .max_patches = 1024, .grid_bits = 10, .atlas = {256, 128}};

}  // namespace

/// Any messages to a client that derives where blocks lie are refused or lead to updates that its replica
/// takes whole: ids, blocks and order are right whatever was asked for. The first octet chooses the memory;
/// then each message behind an octet that says its length.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const proto::AtlasMemory memory{4U + data[0] % 4U, data[0] / 4U % 5U, (data[0] >> 5U) / 7.0};
  GateMetaDecoder decoder(kLimits, BlockPositions::kDerived, true);
  client::LayoutMirror mirror(memory, kLimits.atlas, kLimits.max_patches, true);
  client::Replica replica(kLimits);
  ByteView rest = std::as_bytes(std::span(data + 1, size - 1));
  while (!rest.empty()) {
    const std::size_t length = std::min(rest.size() - 1, std::to_integer<std::size_t>(rest[0]) * 4);
    auto update = decoder.decode(rest.subspan(1, length));
    rest = rest.subspan(1 + length);
    if (!update) continue;
    const auto placed = mirror.place(std::move(*update));
    if (!placed) continue;
    AW_ASSERT(replica.apply(*placed));
  }
  return 0;
}
