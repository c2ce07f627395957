#include "tests/codec/scene_walk.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::codec {

SceneWalk::SceneWalk(std::uint64_t seed, std::uint32_t side) : random_(seed) {
  make_sheet(side);
  make_soup(side * side / 8);
  known_.resize(positions_.size());
  visible_.resize(shapes_.size());
  limits_ = {.max_vertices = static_cast<std::uint32_t>(positions_.size()),
             .max_patches = static_cast<std::uint32_t>(shapes_.size()),
             .grid_bits = 16,
             .atlas = {1024, 512}};
}

void SceneWalk::make_sheet(std::uint32_t side) {
  for (std::uint32_t row = 0; row <= side; ++row) {
    for (std::uint32_t column = 0; column <= side; ++column) {
      const double hill = 400 * std::sin(0.3 * column) * std::cos(0.2 * row) + 3 * random_.normal();
      positions_.push_back(
          {1000 + 700 * column, static_cast<std::uint32_t>(30'000 + hill), 2000 + 650 * row});
    }
  }
  const auto vertex = [&](std::uint32_t row, std::uint32_t column) {
    return VertexId{row * (side + 1) + column};
  };
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t c = 0; c < side; ++c) {
      const VertexId a = vertex(row, c);
      const VertexId b = vertex(row, c + 1);
      const VertexId d = vertex(row + 1, c);
      const VertexId e = vertex(row + 1, c + 1);
      if (random_.below(5) != 0) {
        add({.triangles = 2, .corners = {a, d, e, b}});
      } else {
        add({.triangles = 1, .corners = {a, d, e}});
        add({.triangles = 1, .draw = {.double_sided = true}, .corners = {e, b, a}});
      }
    }
  }
}

void SceneWalk::make_soup(std::uint32_t count) {
  const auto axis = [&] { return static_cast<std::uint32_t>(random_.below(1U << 16U)); };
  for (std::uint32_t i = 0; i < 2 * count; ++i) positions_.push_back({axis(), axis(), axis()});
  positions_.push_back(positions_.front());  // two vertices at one place
  for (std::uint32_t i = 0; i < count; ++i) {
    Shape shape;
    shape.triangles = static_cast<std::uint8_t>(1 + random_.below(3));
    shape.draw.alpha = static_cast<PatchClass::Alpha>(random_.below(3));
    for (VertexId& corner : shape.corners) {
      corner = VertexId{static_cast<std::uint32_t>(random_.below(positions_.size()))};
    }
    if (i % 10 == 0) shape.corners[1] = shape.corners[0];
    if (i % 30 == 0) shape.corners.fill(shape.corners[0]);
    add(shape);
  }
}

/// A window that wanders over the patches, with flicker.
bool SceneWalk::sees(std::uint32_t patch) {
  const auto count = static_cast<std::uint32_t>(shapes_.size());
  const std::uint32_t start = frame_ * count / 90 % count;
  const bool inside = (patch + count - start) % count < count / 3;
  return inside != (random_.below(12) == 0);
}

Block SceneWalk::block_for(std::uint32_t patch) {
  Block block;
  block.width_log2 = static_cast<std::uint8_t>(1 + (patch / 16 + random_.below(8) / 7) % 5);
  block.height_log2 = static_cast<std::uint8_t>(random_.below(block.width_log2 + 1U));
  block.transposed = random_.below(2) == 1;
  const bool aligned = random_.below(50) != 0;
  const std::uint32_t unit_x = aligned ? block.width() : 1;
  const std::uint32_t unit_y = aligned ? block.height() : 1;
  block.x =
      static_cast<std::uint16_t>(unit_x * random_.below((limits_.atlas.width - block.width()) / unit_x + 1));
  block.y = static_cast<std::uint16_t>(unit_y *
                                       random_.below((limits_.atlas.height - block.height()) / unit_y + 1));
  return block;
}

void SceneWalk::tell(std::uint32_t patch, MetaUpdate& update) {
  const Shape& shape = shapes_[patch];
  update.added.push_back({.id = PatchId{patch},
                          .triangles = shape.triangles,
                          .draw = shape.draw,
                          .corners = shape.corners,
                          .block = block_for(patch)});
  for (std::uint32_t i = 0; i < corner_count(shape.triangles); ++i) {
    const std::uint32_t vertex = value(shape.corners[i]);
    if (known_[vertex]) continue;
    known_[vertex] = true;
    update.vertices.push_back({VertexId{vertex}, positions_[vertex]});
  }
}

MetaUpdate SceneWalk::next(bool reset) {
  MetaUpdate update;
  ++frame_;
  update.frame = FrameId{frame_ + frame_ / 7};
  update.reset = reset || frame_ == 1;
  if (update.reset) known_.assign(known_.size(), false);
  for (std::uint32_t patch = 0; patch < shapes_.size(); ++patch) {
    const bool was = visible_[patch];
    visible_[patch] = sees(patch);
    if (update.reset ? visible_[patch] : visible_[patch] && !was) {
      tell(patch, update);
    } else if (!update.reset && was && !visible_[patch]) {
      update.removed.push_back(PatchId{patch});
    } else if (visible_[patch] && random_.below(40) == 0) {
      update.moved.push_back({PatchId{patch}, block_for(patch)});
    }
  }
  std::ranges::sort(update.vertices, {}, &NewVertex::id);
  return update;
}

}  // namespace atlaswire::codec
