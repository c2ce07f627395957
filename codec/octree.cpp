#include "codec/octree.h"

#include "base/assert.h"

#include <algorithm>
#include <array>
#include <bit>

namespace atlaswire::codec {

namespace {

constexpr std::uint32_t kMaskOrder = 3;  // of the Golomb code: the eight masks of one child are cheapest

/// Masks of children by how many they are, then by number; and the place of each.
struct MaskOrder {
  std::array<std::uint8_t, 255> masks{};
  std::array<std::uint8_t, 256> places{};
};
constexpr MaskOrder kMasks = [] {
  MaskOrder order;
  std::uint32_t place = 0;
  for (int children = 1; children <= 8; ++children) {
    for (std::uint32_t mask = 1; mask < 256; ++mask) {
      if (std::popcount(mask) != children) continue;
      order.masks[place] = static_cast<std::uint8_t>(mask);
      order.places[mask] = static_cast<std::uint8_t>(place);
      ++place;
    }
  }
  return order;
}();

/// Which child of a cell with sides of 2^(level + 1) a point is in.
std::uint32_t child_of(const GridPosition& at, std::uint32_t level) {
  return (at.x >> level & 1U) << 2U | (at.y >> level & 1U) << 1U | (at.z >> level & 1U);
}

class Writer {
 public:
  explicit Writer(BitWriter& out) : out_(&out) {}

  /// A cell with sides of 2^level, and its points, at least one.
  void write(std::span<const GridPosition> points, std::uint32_t level) {
    const bool single = points.size() == 1;
    out_->write(single ? 1 : 0, 1);
    if (single) {
      for (const std::uint32_t axis : {points[0].x, points[0].y, points[0].z}) out_->write(axis, level);
    } else if (level == 0) {
      out_->write_golomb(static_cast<std::uint32_t>(points.size()) - 2, 0);
    } else {
      split(points, level - 1);
    }
  }

 private:
  void split(std::span<const GridPosition> points, std::uint32_t level) {
    std::uint32_t mask = 0;
    for (const GridPosition& at : points) mask |= 1U << child_of(at, level);
    out_->write_golomb(kMasks.places[mask], kMaskOrder);
    while (!points.empty()) {
      const std::uint32_t child = child_of(points[0], level);
      std::size_t size = 1;
      while (size < points.size() && child_of(points[size], level) == child) ++size;
      write(points.first(size), level);
      points = points.subspan(size);
    }
  }

  BitWriter* out_;
};

class Reader {
 public:
  Reader(BitReader& in, std::uint32_t count) : in_(&in), count_(count) { points_.reserve(count); }

  /// False: nonsense.
  bool read(const GridPosition& corner, std::uint32_t level) {
    if (in_->read(1) == 1) {
      GridPosition at;
      for (int axis = 0; axis < 3; ++axis) at[axis] = corner[axis] | in_->read(level);
      return add(at, 1);
    }
    if (!in_->ok()) return false;
    if (level == 0) return add(corner, std::uint64_t{in_->read_golomb(0)} + 2);
    return split(corner, level - 1);
  }
  [[nodiscard]] bool complete() const { return points_.size() == count_; }
  std::vector<GridPosition> take() { return std::move(points_); }

 private:
  bool split(const GridPosition& corner, std::uint32_t level) {
    const std::uint32_t place = in_->read_golomb(kMaskOrder);
    if (place >= kMasks.masks.size()) return false;
    for (std::uint32_t child = 0; child < 8; ++child) {
      if ((kMasks.masks[place] >> child & 1U) == 0) continue;
      const GridPosition inside(child >> 2U, child >> 1U & 1U, child & 1U);
      if (!read(corner | inside << level, level)) return false;
    }
    return true;
  }
  bool add(const GridPosition& at, std::uint64_t times) {
    if (!in_->ok() || times > count_ - points_.size()) return false;
    points_.insert(points_.end(), static_cast<std::size_t>(times), at);
    return true;
  }

  BitReader* in_;
  std::uint32_t count_;
  std::vector<GridPosition> points_;
};

}  // namespace

std::uint64_t octree_order(const GridPosition& at) {
  const auto spread = [](std::uint64_t v) {
    v = (v | v << 32U) & 0x1F00000000FFFF;
    v = (v | v << 16U) & 0x1F0000FF0000FF;
    v = (v | v << 8U) & 0x100F00F00F00F00F;
    v = (v | v << 4U) & 0x10C30C30C30C30C3;
    return (v | v << 2U) & 0x1249249249249249;
  };
  return spread(at.x) << 2U | spread(at.y) << 1U | spread(at.z);
}

void write_octree(std::span<const GridPosition> points, std::uint32_t bits, BitWriter& out) {
  AW_ASSERT(bits <= 20);
  if (!points.empty()) Writer(out).write(points, bits);
}

std::optional<std::vector<GridPosition>> read_octree(BitReader& in, std::uint32_t count, std::uint32_t bits) {
  Reader reader(in, count);
  if (count != 0 && !(reader.read(GridPosition(0), bits) && reader.complete())) return std::nullopt;
  return reader.take();
}

}  // namespace atlaswire::codec
