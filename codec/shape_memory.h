#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace atlaswire::codec {

/// A gate as a frame of reference: along its edge, away from the patch behind it, and across both; so that
/// what lies beyond can be told alike wherever such a gate is and however it is turned. All arithmetic in
/// IEEE doubles, as docs/PROTOCOL.md, "Shapes remembered", has it: both ends must come to the same.
class GateFrame {
 public:
  /// A place in the frame.
  using Place = std::array<float, 3>;

  /// Vertices' grid positions, as in codec::Gate. nullopt: the patch behind has no area to speak of.
  static std::optional<GateFrame> over(const glm::ivec3& from, const glm::ivec3& to,
                                       const glm::ivec3& behind_from, const glm::ivec3& behind_to);

  [[nodiscard]] Place place(const glm::ivec3& position) const;
  /// Rounded, and clamped to 0..top on each axis.
  [[nodiscard]] glm::ivec3 position(const Place& place, std::int32_t top) const;
  /// The lengths of the edge and of those beside it, in 32nds of an octave: below 2^30.
  [[nodiscard]] std::uint32_t lengths() const { return lengths_; }

 private:
  struct Axis {
    glm::dvec3 along{0.0};
    double squared = 0;
  };
  glm::dvec3 origin_{0.0};
  std::array<Axis, 3> axes_;
  std::uint32_t lengths_ = 0;
};

/// A corner of a patch beyond a gate.
struct GateCorner {
  GateFrame frame;
  std::uint32_t situation = 0;  ///< below 32: which corner of which patch beyond which
};

/// What surfaces did beyond gates of given lengths: a scene's repeated parts, whether instances or not, are
/// foretold by the first that was told. As many places as kSize; a newer one takes an older one's.
class ShapeMemory {
 public:
  /// Where such a corner was last; null: unknown, or it was not where the one before had it.
  [[nodiscard]] const GateFrame::Place* recall(const GateCorner& corner) const;
  void learn(const GateCorner& corner, const glm::ivec3& position);
  void clear() { entries_.clear(); }

 private:
  static constexpr std::uint32_t kSizeLog2 = 15;
  static constexpr std::uint32_t kSize = 1U << kSizeLog2;
  static constexpr std::uint32_t kMostMissed = 15;  ///< steps, L1
  struct Entry {
    GateFrame::Place place{};
    std::uint16_t check = 0;
    bool known = false;
    bool holds = false;
  };
  /// Where a corner's entry is, and what tells it from others there.
  struct Key {
    std::uint32_t entry;
    std::uint16_t check;
  };

  static Key key_of(const GateCorner& corner) {
    const std::uint64_t key = std::uint64_t{corner.frame.lengths()} << 5U | corner.situation;
    const std::uint64_t scattered = key * 0x9E3779B97F4A7C15U;
    return {static_cast<std::uint32_t>(scattered >> (64U - kSizeLog2)),
            static_cast<std::uint16_t>(scattered >> 32U)};
  }

  std::vector<Entry> entries_;  ///< kSize; none before anything is learned
};

}  // namespace atlaswire::codec
