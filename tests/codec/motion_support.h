#pragma once

#include "codec/motion.h"

#include <cstdint>
#include <numeric>
#include <vector>

namespace atlaswire::codec {

/// A cloth of `side` x `side` vertices, a metre square, waving about (0, 0, 0): what motion tests move.
class WavingSheet {
 public:
  explicit WavingSheet(std::uint32_t side);

  [[nodiscard]] const MotionSurface& surface() const { return surface_; }
  [[nodiscard]] const std::vector<std::uint32_t>& all() const { return all_; }
  /// 16 bits over 4 metres.
  [[nodiscard]] static MotionSettings settings();
  /// Where the vertices are at a time, seconds.
  [[nodiscard]] std::vector<glm::dvec3> at(double seconds) const;

 private:
  std::uint32_t side_;
  MotionSurface surface_;
  std::vector<std::uint32_t> all_;
};

/// A body on an orbit of `radius` metres that turns as it goes.
RigidTransform orbit(double radius, double seconds);

/// Both ends of a motion stream.
struct MotionStream {
  explicit MotionStream(const MotionSettings& settings)
      : encoder(settings), decoder(settings), settings_(settings) {}

  /// Encodes, decodes, and holds what comes out against what went in: within the bounds. Gives the message.
  ByteBuffer pass(const MotionScope& scope, const MotionTargets& targets);

  MotionEncoder encoder;
  MotionDecoder decoder;

 private:
  MotionSettings settings_;
};

}  // namespace atlaswire::codec
