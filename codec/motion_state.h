#pragma once

#include "codec/motion_models.h"
#include "codec/transform_grid.h"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <glm/vec3.hpp>
#include <vector>

namespace atlaswire::codec {

/// Sum of the sizes of a vector's members.
inline std::uint32_t manhattan(const glm::ivec3& v) {
  return static_cast<std::uint32_t>(std::abs(v.x)) + static_cast<std::uint32_t>(std::abs(v.y)) +
         static_cast<std::uint32_t>(std::abs(v.z));
}

/// Where a vertex was in the last frames in which it took part, in grid steps; one cache line.
struct alignas(64) VertexTrack {
  static constexpr std::uint8_t kOldest = 5;
  static constexpr std::uint32_t kLoudest = 255;

  std::array<glm::ivec3, kOldest> at{};  ///< the newest first
  std::uint8_t age = 0;                  ///< frames in a row, at most kOldest; 0: it does not take part
  std::uint8_t size = 0;                 ///< of its last difference, at most kLoudest
  bool jumped = false;                   ///< its past says nothing about its future

  /// It was twice at one place.
  [[nodiscard]] bool calm() const { return age >= 2 && at[0] == at[1]; }
  void push(const glm::ivec3& position) {
    for (std::size_t i = at.size() - 1; i > 0; --i) at[i] = at[i - 1];
    at[0] = position;
    if (age < kOldest) ++age;
  }
};
static_assert(sizeof(VertexTrack) == 64);

/// Where a rigid object was in the last frames in which it took part.
struct ObjectTrack {
  static constexpr std::uint32_t kHistory = 5;
  static constexpr std::uint32_t kPredictors = 6;

  std::array<GridTransform, kHistory> at{};  ///< the newest first
  std::uint8_t age = 0;                      ///< as of a vertex
  std::uint8_t calm = 0;                     ///< frames at rest in a row, at most 255
  std::uint16_t translation_size = 0;        ///< of the last differences, at most 255
  std::uint16_t rotation_size = 0;
  std::array<std::uint32_t, kPredictors> translation_faults{};  ///< how wrong each predictor was of late
  std::array<std::uint32_t, kPredictors> rotation_faults{};
};

/// Everything that both ends of a motion stream remember, the same after each frame.
struct MotionState {
  void clear() {
    models = {};
    weights = {};
    vertices.clear();
    objects.clear();
    moving.clear();
    moving_objects.clear();
    hash = kFreshHash;
  }
  /// Folds something that both sides know into the state's hash.
  void mix(std::uint32_t v) {
    hash = (hash ^ v) * 0x9E3779B1U;
    hash ^= hash >> 15U;
  }
  void mix(const glm::ivec3& v) {
    mix(static_cast<std::uint32_t>(v.x));
    mix(static_cast<std::uint32_t>(v.y));
    mix(static_cast<std::uint32_t>(v.z));
  }

  /// Not 0, so that a message of zeros does not look as if it belonged.
  static constexpr std::uint32_t kFreshHash = 0x3C6EF372;

  MotionModels models;
  std::array<MotionWeights, MotionModels::kWeightSets> weights;
  std::vector<VertexTrack> vertices;
  std::vector<ObjectTrack> objects;
  std::vector<std::uint32_t> moving;  ///< the vertices that took part in the last frame, ascending
  std::vector<std::uint32_t> moving_objects;
  std::uint32_t hash = kFreshHash;
};

}  // namespace atlaswire::codec
