#pragma once

#include "codec/gate_plan.h"
#include "codec/gate_state.h"
#include "codec/meta_update.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace atlaswire::bench {

/// What the gate form's bits are spent on.
enum class GateTopic : std::uint8_t {
  kHead,      ///< frame, forgotten patches, state hash
  kPresence,  ///< known patches that come and go
  kIds,
  kGrouping,  ///< triangles a patch, turn within it
  kGates,
  kCorners,  ///< border vertices taken
  kResiduals,
  kClasses,
  kLevels,     ///< block sizes, and which change
  kPositions,  ///< blocks' places
};
inline constexpr std::array<std::string_view, 10> kGateTopics{
    "head", "presence", "ids", "grouping", "gates", "corners", "residuals", "classes", "levels", "positions"};

/// Encodes as GateMetaEncoder does, counting bits by topic: each decision costs what its model's probability
/// says.
class GateProfile {
 public:
  explicit GateProfile(const codec::MetaLimits& limits);
  using Bits = std::array<double, kGateTopics.size()>;
  /// Of one update.
  Bits encode(const codec::MetaUpdate& update);

 private:
  codec::MetaLimits limits_;
  codec::GateState state_;
  codec::GatePlan plan_;
};

/// Octets of additions and removals, the rest being blocks and classes.
double mesh_octets(const GateProfile::Bits& bits);

}  // namespace atlaswire::bench
