#pragma once

#include "base/ids.h"
#include "codec/gate_models.h"
#include "codec/gate_table.h"
#include "codec/resident_set.h"
#include "codec/vertex_table.h"

#include <cstdint>

namespace atlaswire::codec {

/// Everything that encoder and decoder of the gate form remember, the same on both sides after each update.
struct GateState {
  explicit GateState(std::uint64_t seed) : vertices(seed), gates(seed) {}

  void clear() {
    models = {};
    residents.clear();
    vertices.clear();
    gates.clear();
    frame = {};
    hash = kFreshHash;
  }
  /// Folds something that both sides know into the state's hash.
  void mix(std::uint32_t v) {
    hash = (hash ^ v) * 0x9E3779B1U;
    hash ^= hash >> 15U;
  }
  void mix(const Block& block) {
    mix(std::uint32_t{block.x} << 16U | block.y);
    mix(std::uint32_t{block.width_log2} << 8U | std::uint32_t{block.height_log2} << 1U |
        static_cast<std::uint32_t>(block.transposed));
  }

  /// Not 0, so that a message of zeros does not look as if it belonged.
  static constexpr std::uint32_t kFreshHash = 0x1D872B41;

  GateModels models;
  ResidentSet residents;
  VertexTable vertices;
  GateTable gates;
  FrameId frame{};
  std::uint32_t hash = kFreshHash;
};

}  // namespace atlaswire::codec
