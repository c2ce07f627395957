#include "base/assert.h"
#include "codec/motion.h"
#include "codec/mover_scope.h"
#include "codec/mover_watch.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

using namespace atlaswire;
using namespace atlaswire::codec;

namespace {

const std::array<Mover, 4> kMovers{Mover{4, 20, true, 0}, Mover{24, 4, false, 1}, Mover{28, 4, false, 0},
                                   Mover{40, 20, true, 0}};
constexpr std::uint32_t kVertices = 32;

MotionSettings settings() {
  MotionSettings s;
  s.grid = {.origin = glm::dvec3(0.0), .step = 0.25, .bits = 8};
  s.transforms = {.step = 0.25, .rotation_bits = 8};
  return s;
}

/// Octets, zeros once they are used up.
class Octets {
 public:
  explicit Octets(ByteView bytes) : rest_(bytes) {}
  [[nodiscard]] bool empty() const { return rest_.empty(); }
  std::uint32_t next() {
    if (rest_.empty()) return 0;
    const auto octet = std::to_integer<std::uint32_t>(rest_[0]);
    rest_ = rest_.subspan(1);
    return octet;
  }
  ByteView take(std::size_t count) {
    const ByteView taken = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }

 private:
  ByteView rest_;
};

/// Any update: ids that no stream has, corners that were never told, patches that come twice.
MetaUpdate update_from(Octets& octets) {
  MetaUpdate update;
  const std::uint32_t head = octets.next();
  update.reset = head % 16 == 0;
  for (std::uint32_t i = 0; i < head / 64; ++i) update.removed.push_back(PatchId{octets.next() % 80});
  for (std::uint32_t i = 0; i < head / 16 % 4; ++i) {
    const std::uint32_t id = octets.next() % kVertices;
    update.vertices.push_back({VertexId{id}, {octets.next(), octets.next() % 4, 0}});
  }
  for (std::uint32_t i = 0; i < head / 4 % 4; ++i) {
    AddedPatch patch{.id = PatchId{octets.next() % 80}};
    patch.triangles = static_cast<std::uint8_t>(1 + octets.next() % 3);
    for (VertexId& corner : patch.corners) corner = VertexId{octets.next() % (kVertices + 8)};
    update.added.push_back(patch);
  }
  return update;
}

/// The same for an end that numbers vertices otherwise and lists patches the other way round.
MetaUpdate renumbered(MetaUpdate update) {
  const auto other = [](VertexId id) { return VertexId{1000 - value(id)}; };
  for (NewVertex& vertex : update.vertices) vertex.id = other(vertex.id);
  for (AddedPatch& patch : update.added) {
    for (VertexId& corner : patch.corners) corner = other(corner);
  }
  std::ranges::reverse(update.removed);
  std::ranges::stable_sort(update.added, std::ranges::greater{}, &AddedPatch::id);
  return update;
}

struct End {
  MoverWatch watch{kMovers};
  MoverScope scope;
  explicit End(std::uint64_t seed) : scope(kMovers, seed) {}
  void follow(const MetaUpdate& update) { scope.follow(watch.take(update)); }
};

}  // namespace

/// Any updates leave two ends that number vertices differently with one scope and one surface, and any
/// message is refused or decodes on both alike. Per round: an update, an octet for a message's length, the
/// message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Octets octets(std::as_bytes(std::span(data, size)));
  End one(1);
  End two(0x9E3779B97F4A7C15U);
  MotionDecoder first(settings(), true);
  MotionDecoder second(settings(), true);
  for (int round = 0; round < 64 && !octets.empty(); ++round) {
    const MetaUpdate update = update_from(octets);
    // A patch that is told twice in one update is whichever comes last: no codec gives that.
    std::vector<std::uint32_t> ids;
    for (const AddedPatch& patch : update.added) ids.push_back(value(patch.id));
    std::ranges::sort(ids);
    if (std::ranges::adjacent_find(ids) != ids.end()) return 0;
    one.follow(update);
    two.follow(renumbered(update));
    const MotionScope a = one.scope.scope();
    const MotionScope b = two.scope.scope();
    AW_ASSERT(std::ranges::equal(a.vertices, b.vertices) && std::ranges::equal(a.objects, b.objects));
    AW_ASSERT(a.surface->size() == b.surface->size());
    for (std::uint32_t v = 0; v < a.surface->size(); ++v) {
      AW_ASSERT(a.surface->rest(v) == b.surface->rest(v));
      AW_ASSERT(std::ranges::equal(a.surface->neighbours(v), b.surface->neighbours(v)));
    }
    const ByteView message = octets.take(octets.next());
    const auto heard = first.decode(a, message);
    AW_ASSERT(heard.has_value() == second.decode(b, message).has_value());
    if (!heard) continue;
    for (const std::uint32_t v : a.vertices)
      AW_ASSERT(first.position(*a.surface, v) == second.position(*b.surface, v));
  }
  return 0;
}
