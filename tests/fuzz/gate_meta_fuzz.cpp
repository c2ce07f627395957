#include "base/assert.h"
#include "codec/gate_meta.h"
#include "tests/codec/scene_walk.h"

#include <array>
#include <span>

using namespace atlaswire;
using namespace atlaswire::codec;

namespace {

constexpr std::uint32_t kSide = 6;  // of a scene so small that its state is reached fast

/// A decoder in step with an encoder, some frames into a walk.
GateMetaDecoder walked(std::uint32_t frames) {
  SceneWalk walk(1, kSide);
  GateMetaEncoder encoder(walk.limits());
  GateMetaDecoder decoder(walk.limits(), BlockPositions::kSent, true);
  ByteBuffer bytes;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    bytes.clear();
    encoder.encode(walk.next(), bytes);
    AW_ASSERT(decoder.decode(bytes));
  }
  return decoder;
}

}  // namespace

/// Any messages, after a few honest ones, are refused or decode to updates that another pair of ends carries.
/// The first octet: how many are honest; then each message behind an octet that says its length.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const MetaLimits limits = SceneWalk(1, kSide).limits();
  static const std::array all_walked{walked(0), walked(1), walked(2), walked(3)};
  const std::uint32_t honest = data[0] % 4U;
  GateMetaDecoder decoder = all_walked[honest];
  GateMetaEncoder encoder(limits);
  GateMetaDecoder mirror(limits);
  ByteView rest = std::as_bytes(std::span(data + 1, size - 1));
  bool whole = honest == 0;  // the second pair has seen everything
  while (!rest.empty()) {
    const std::size_t length = std::min(rest.size() - 1, std::to_integer<std::size_t>(rest[0]) * 4);
    const auto update = decoder.decode(rest.subspan(1, length));
    rest = rest.subspan(1 + length);
    if (!update) {
      whole = false;
      continue;
    }
    whole = whole || update->reset;
    if (!whole) continue;
    ByteBuffer bytes;
    encoder.encode(*update, bytes);
    const auto again = mirror.decode(bytes);
    AW_ASSERT(again);
    AW_ASSERT(again->frame == update->frame && again->reset == update->reset);
    AW_ASSERT(again->added.size() + update->removed.size() >= update->added.size());
  }
  return 0;
}
