#include "base/assert.h"
#include "codec/paper_meta.h"

#include <span>

using namespace atlaswire;
using namespace atlaswire::codec;

/// Any bytes are refused or decode to an update that encodes and decodes to itself.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MetaLimits limits{
      .max_vertices = 40'000, .max_patches = 20'000, .grid_bits = 16, .atlas = {1024, 512}};
  PaperMetaDecoder decoder(limits);
  const auto update = decoder.decode(std::as_bytes(std::span(data, size)));
  if (!update) return 0;
  ByteBuffer bytes;
  PaperMetaEncoder(limits).encode(*update, bytes);
  const auto again = decoder.decode(bytes);
  AW_ASSERT(again);
  AW_ASSERT(again->frame == update->frame && again->reset == update->reset);
  AW_ASSERT(again->removed == update->removed && again->vertices.size() == update->vertices.size());
  AW_ASSERT(again->added.size() == update->added.size() && again->moved.size() == update->moved.size());
  return 0;
}
