#include "base/assert.h"
#include "codec/motion.h"

#include <array>
#include <span>
#include <vector>

using namespace atlaswire;
using namespace atlaswire::codec;

namespace {

constexpr std::uint32_t kSide = 5;
constexpr std::array<std::uint32_t, 9> kObjects{0, 1, 2, 3, 4, 5, 6, 7, 31};

MotionSettings settings() {
  MotionSettings s;
  s.grid = {.origin = glm::dvec3(0.0), .step = 0.25, .bits = 8};
  s.transforms = {.step = 0.25, .rotation_bits = 8};
  return s;
}

/// A sheet so small that its state is reached fast.
const MotionSurface& surface() {
  static const MotionSurface made = [] {
    MotionSurface s;
    for (std::uint32_t v = 0; v < kSide * kSide; ++v) {
      s.add({8 * (v % kSide), 8 * (v / kSide), 3});
      if (v % kSide > 0) s.connect(v, v - 1);
      if (v >= kSide) s.connect(v, v - kSide);
    }
    return s;
  }();
  return made;
}

/// A scope by an octet: all, or those whose number it leaves out.
struct Choice {
  explicit Choice(unsigned octet) {
    for (std::uint32_t v = 0; v < kSide * kSide; ++v) {
      if (octet >= 0xF0 || (octet + v) % 3 != 0) vertices.push_back(v);
    }
    for (const std::uint32_t o : kObjects) {
      if (octet >= 0xF0 || (octet + o) % 4 != 0) objects.push_back(o);
    }
  }
  [[nodiscard]] MotionScope scope() const { return {&surface(), vertices, objects}; }
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> objects;
};

/// A decoder in step with an encoder, some frames into a motion.
MotionDecoder moved(unsigned frames) {
  MotionEncoder encoder(settings());
  MotionDecoder decoder(settings(), true);
  const Choice all(0xFF);
  for (unsigned frame = 0; frame < frames; ++frame) {
    std::vector<glm::dvec3> positions;
    for (const std::uint32_t v : all.vertices)
      positions.push_back(0.25 * glm::dvec3(surface().rest(v)) +
                          glm::dvec3(0.3 * frame, 0.01 * v * frame, 0));
    std::vector<RigidTransform> transforms(all.objects.size());
    transforms[2].translation.y = 0.4 * frame;
    transforms[8].orientation = {1, 0.1 * frame, 0, 0};
    ByteBuffer bytes;
    AW_ASSERT(encoder.encode(all.scope(), {.positions = positions, .transforms = transforms}, bytes));
    AW_ASSERT(decoder.decode(all.scope(), bytes));
  }
  return decoder;
}

/// What was decoded is told to another pair of ends, which must agree.
void tell_again(const MotionDecoder& from, const Choice& choice, MotionEncoder& encoder,
                MotionDecoder& mirror) {
  std::vector<glm::dvec3> positions;
  for (const std::uint32_t v : choice.vertices) positions.push_back(from.position(surface(), v));
  std::vector<RigidTransform> transforms;
  for (const std::uint32_t o : choice.objects) transforms.push_back(from.transform(o));
  ByteBuffer bytes;
  AW_ASSERT(encoder.encode(choice.scope(), {.positions = positions, .transforms = transforms}, bytes));
  AW_ASSERT(mirror.decode(choice.scope(), bytes));
  for (std::size_t i = 0; i < positions.size(); ++i)
    AW_ASSERT(mirror.position(surface(), choice.vertices[i]) == positions[i]);
  for (std::size_t i = 0; i < transforms.size(); ++i)
    AW_ASSERT(mirror.transform(choice.objects[i]).translation == transforms[i].translation);
}

}  // namespace

/// Any messages, after a few honest ones, are refused or decode to motion that can be told again. The first
/// octet: how many are honest; then each message behind an octet for its scope and one for its length.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const std::array all_moved{moved(0), moved(1), moved(3), moved(8)};
  MotionDecoder decoder = all_moved[data[0] % 4U];
  MotionEncoder encoder(settings());
  MotionDecoder mirror(settings());
  ByteView rest = std::as_bytes(std::span(data + 1, size - 1));
  while (rest.size() >= 2) {
    const Choice choice(std::to_integer<unsigned>(rest[0]));
    const std::size_t length = std::min(rest.size() - 2, std::to_integer<std::size_t>(rest[1]));
    const auto heard = decoder.decode(choice.scope(), rest.subspan(2, length));
    rest = rest.subspan(2 + length);
    if (heard) tell_again(decoder, choice, encoder, mirror);
  }
  return 0;
}
