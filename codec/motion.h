#pragma once

#include "base/bytes.h"
#include "base/error_enum.h"
#include "base/grid.h"
#include "base/result.h"
#include "codec/motion_fit.h"
#include "codec/motion_state.h"
#include "codec/motion_surface.h"
#include "codec/transform_grid.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace atlaswire::codec {

/// What both ends of a motion stream agree on beforehand.
struct MotionSettings {
  PositionGrid grid;         ///< of vertices; displaced ones may leave it by its own size on every side
  TransformGrid transforms;  ///< of objects
};

/// Who may move in a frame. Both ends know it from elsewhere; each list ascends strictly.
struct MotionScope {
  const MotionSurface* surface = nullptr;
  std::span<const std::uint32_t> vertices;  ///< of the surface
  std::span<const std::uint32_t> objects;   ///< numbers below kMostObjects

  static constexpr std::uint32_t kMostObjects = 1U << 20U;
};

/// Where they are to be: one for each in the scope.
struct MotionTargets {
  bool reset = false;  ///< forget the past of all first
  std::span<const glm::dvec3> positions;
  std::span<const RigidTransform> transforms;
};

/// No message has more octets.
inline constexpr std::size_t kMaxMotionBody = std::size_t{64} << 20U;

/// Why there is no motion: bytes that are none, or (encoding) targets that cannot be told.
enum class MotionError {
  kTruncated = 1,
  kTrailingBytes,
  kBadVersion,
  kTooLarge,
  kBadWeights,
  kBadPosition,
  kBadRotation,
  kBadTranslation,
  kOutOfStep,
  kNotFinite
};
const char* error_text(MotionError e);

/// Tells where moving vertices and rigid objects are, frame by frame: positions on the grid of those that
/// take part, predicted from their own past and from neighbours told before them; resting ones cost next to
/// nothing. What the other end has is always the nearest grid point, so errors stay within
/// PositionGrid::max_error and TransformGrid's bounds for ever. One that joins starts from rest, moved as its
/// neighbours are; one that left and comes back likewise. docs/PROTOCOL.md, "Motion". Keeps state: the other
/// end must get every message, in order. Not thread-safe; equal calls give equal bytes.
class MotionEncoder {
 public:
  /// `fits`: finds the weights of its predictions; without, they stay second order in time minus the
  /// neighbours' difference, which is a little faster and takes more bytes.
  explicit MotionEncoder(const MotionSettings& settings, bool fits = true);

  /// Appends the message. On an error nothing is appended and the state stays: kNotFinite, kBadPosition
  /// (beyond the grid's margin), kBadTranslation, kBadRotation; the detail names the vertex or object.
  Result<void> encode(const MotionScope& scope, const MotionTargets& targets, ByteBuffer& out);

 private:
  Result<void> quantize(const MotionScope& scope, const MotionTargets& targets);

  MotionSettings settings_;
  MotionState state_;
  MotionFit fit_;
  bool fits_;
  std::vector<glm::ivec3> positions_;
  std::vector<GridTransform> transforms_;
};

/// The other end. Safe on any bytes: time and memory are bounded by the scope. A stream out of step, by a
/// message lost or bent or another scope, is noticed at the first message that does not match (2^-16 of them
/// pass) and refused with kOutOfStep until one with reset comes; what it has then is not to be shown.
class MotionDecoder {
 public:
  /// `believes_all`: goes on although a message does not match, for a fuzzer cannot guess hashes.
  explicit MotionDecoder(const MotionSettings& settings, bool believes_all = false);

  Result<void> decode(const MotionScope& scope, ByteView bytes);

  /// Where a vertex of the scope's surface is in the scene, metres: as last told; at rest before that.
  [[nodiscard]] glm::dvec3 position(const MotionSurface& surface, std::uint32_t vertex) const;
  /// Where an object is, as last told; at rest before that.
  [[nodiscard]] RigidTransform transform(std::uint32_t object) const;

 private:
  MotionSettings settings_;
  MotionState state_;
  bool believes_all_;
  bool broken_ = false;
};

}  // namespace atlaswire::codec
ATLASWIRE_ERROR_ENUM(codec, MotionError);
