#pragma once

#include "base/random.h"
#include "codec/meta_update.h"

#include <array>
#include <cstdint>
#include <vector>

namespace atlaswire::codec {

/// A made-up scene that is walked through: a hilly sheet of triangles and quads in rows, and a soup of
/// patches of every kind at random places, some degenerate. Updates are consistent with those before;
/// deterministic.
class SceneWalk {
 public:
  explicit SceneWalk(std::uint64_t seed, std::uint32_t side = 24);

  [[nodiscard]] const MetaLimits& limits() const { return limits_; }
  /// The next frame's update: the first tells some of the scene, later ones what changed. `reset`: tells all
  /// that is visible from nothing.
  MetaUpdate next(bool reset = false);

 private:
  struct Shape {
    std::uint8_t triangles = 1;
    PatchClass draw;
    std::array<VertexId, kMaxPatchCorners> corners{};
  };

  void make_sheet(std::uint32_t side);
  void make_soup(std::uint32_t count);
  void add(const Shape& shape) { shapes_.push_back(shape); }
  [[nodiscard]] bool sees(std::uint32_t patch);
  Block block_for(std::uint32_t patch);
  void tell(std::uint32_t patch, MetaUpdate& update);

  Random random_;
  MetaLimits limits_;
  std::vector<GridPosition> positions_;
  std::vector<Shape> shapes_;
  std::vector<bool> known_;    ///< by vertex
  std::vector<bool> visible_;  ///< by patch
  std::uint32_t frame_ = 0;
};

}  // namespace atlaswire::codec
