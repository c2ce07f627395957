#include "render/scene/chunk_order.h"

#include "render/scene/walk_order.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <tuple>

namespace atlaswire::render {

namespace {

struct Item {
  std::uint8_t draw_class = 0;
  std::uint8_t triangles = 0;
  std::uint16_t material = 0;
  std::uint32_t instance = 0;  ///< 1 + the one that moves it, or 0
  std::uint32_t group = 0;
  glm::vec3 middle{0.0F};
};

std::uint8_t class_rank(const PatchClass& c) {
  return static_cast<std::uint8_t>(static_cast<unsigned>(c.alpha) * 2 + (c.double_sided ? 1 : 0));
}

std::vector<Item> items_of(const FlatMesh& flat, const std::vector<TriangleGroup>& groups,
                           const std::vector<Material>& materials) {
  std::vector<Item> items;
  items.reserve(groups.size());
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    const TriangleGroup& group = groups[g];
    const std::uint16_t material = flat.materials[group.triangle];
    items.push_back(
        {class_rank(materials[material].draw), group.count, material,
         flat.instances.empty() ? 0 : flat.instances[group.triangle], g,
         0.5F * (flat.vertices[group.corners[0]].position + flat.vertices[group.corners[2]].position)});
  }
  return items;
}

int longest_axis(std::span<const Item> items) {
  glm::vec3 low(std::numeric_limits<float>::max());
  glm::vec3 high(-std::numeric_limits<float>::max());
  for (const Item& item : items) {
    low = glm::min(low, item.middle);
    high = glm::max(high, item.middle);
  }
  const glm::vec3 side = high - low;
  return side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
}

/// Numbers patches by walks over the surface. Parts that do not touch are walked object by object, and within
/// an object in the order of chunks, so that near ones follow each other.
class Numberer {
 public:
  Numberer(const FlatMesh& flat, const std::vector<TriangleGroup>& groups)
      : flat_(flat), groups_(groups), walk_(positions_of(flat), groups), numbers_(groups.size()) {}

  /// Numbers a run from `first` on, and puts it in order within its chunks.
  void number(std::span<OrderedGroup> run, std::uint32_t first) {
    part_.clear();
    for (const OrderedGroup& o : run) part_.push_back(o.group);
    std::ranges::stable_sort(part_, {}, [&](std::uint32_t group) { return object_of(group); });
    walk_.arrange(part_);
    for (const std::uint32_t group : part_) numbers_[group] = first++;
    for (OrderedGroup& o : run) o.patch = numbers_[o.group];
    std::ranges::sort(run, [](const OrderedGroup& x, const OrderedGroup& y) {
      return std::tie(x.chunk, x.patch) < std::tie(y.chunk, y.patch);
    });
  }

 private:
  static std::vector<glm::vec3> positions_of(const FlatMesh& flat) {
    std::vector<glm::vec3> positions;
    positions.reserve(flat.vertices.size());
    for (const ShadingVertex& v : flat.vertices) positions.push_back(v.position);
    return positions;
  }
  [[nodiscard]] std::uint32_t object_of(std::uint32_t group) const {
    return flat_.objects[groups_[group].triangle];
  }

  const FlatMesh& flat_;
  const std::vector<TriangleGroup>& groups_;
  WalkOrder walk_;
  std::vector<std::uint32_t> part_;
  std::vector<std::uint32_t> numbers_;  ///< by group
};

class Cutter {
 public:
  Cutter(std::uint32_t most_triangles, std::vector<OrderedGroup>& out) : most_(most_triangles), out_(out) {}

  void cut(std::span<Item> items) {
    std::uint64_t triangles = 0;
    for (const Item& item : items) triangles += item.triangles;
    if (triangles <= most_ || items.size() == 1) {
      emit(items);
      return;
    }
    // Full chunks on the left: halving the count alone would leave most chunks three quarters full. A little
    // less than full, as patches differ in their triangles.
    const std::uint64_t chunks = triangles * 100 / (std::uint64_t{most_} * 97) + 1;
    const std::size_t left = std::clamp<std::size_t>(
        items.size() * (chunks / 2) / std::max<std::uint64_t>(chunks, 2), 1, items.size() - 1);
    const int axis = longest_axis(items);
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(left), items.end(),
                     [axis](const Item& a, const Item& b) {
                       return std::tie(a.middle[axis], a.group) < std::tie(b.middle[axis], b.group);
                     });
    cut(items.first(left));
    cut(items.subspan(left));
  }

 private:
  void emit(std::span<Item> items) {
    std::ranges::sort(items, {}, &Item::group);
    for (const Item& item : items) out_.push_back({item.group, 0, chunks_, item.material});
    ++chunks_;
  }

  std::uint32_t most_;
  std::uint32_t chunks_ = 0;
  std::vector<OrderedGroup>& out_;
};

}  // namespace

std::vector<OrderedGroup> order_by_chunk(const FlatMesh& flat, const std::vector<TriangleGroup>& groups,
                                         const std::vector<Material>& materials,
                                         std::uint32_t most_triangles) {
  std::vector<Item> items = items_of(flat, groups, materials);
  const auto key = [](const Item& item) {
    return std::tie(item.draw_class, item.material, item.instance, item.group);
  };
  std::sort(items.begin(), items.end(), [&](const Item& a, const Item& b) { return key(a) < key(b); });
  std::vector<OrderedGroup> out;
  out.reserve(items.size());
  Numberer numberer(flat, groups);
  Cutter cutter(most_triangles, out);
  for (std::size_t first = 0; first < items.size();) {
    std::size_t last = first + 1;
    while (last < items.size() && items[last].material == items[first].material &&
           items[last].instance == items[first].instance)
      ++last;
    cutter.cut(std::span(items).subspan(first, last - first));
    numberer.number(std::span(out).subspan(first), static_cast<std::uint32_t>(first));
    first = last;
  }
  return out;
}

}  // namespace atlaswire::render
