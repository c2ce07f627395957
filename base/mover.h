#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace atlaswire {

/// A run of patches that moves as one: rigidly, or with every vertex on its own way. Of a list the runs
/// ascend and do not touch each other's patches.
struct Mover {
  std::uint32_t first_patch = 0;
  std::uint32_t patch_count = 0;  ///< at least 1
  bool deforms = false;           ///< else all of it follows its object
  std::uint32_t object = 0;       ///< of a rigid one: into what rigid objects there are

  [[nodiscard]] std::uint32_t end() const { return first_patch + patch_count; }
  bool operator==(const Mover&) const = default;
};

/// No list has more.
inline constexpr std::uint32_t kMostMovers = 2048;

}  // namespace atlaswire
