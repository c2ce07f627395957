#pragma once

#include "base/ids.h"
#include "base/running_hash.h"
#include "codec/gate_models.h"
#include "codec/gate_table.h"
#include "codec/resident_set.h"
#include "codec/shape_memory.h"
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
    shapes.clear();
    frame = {};
    hash = {};
  }
  /// Folds something that both sides know into the state's hash.
  void mix(std::uint32_t v) { hash.take_in(v); }
  void mix(const Block& block) { hash.take_in(block); }

  GateModels models;
  ResidentSet residents;
  VertexTable vertices;
  GateTable gates;
  ShapeMemory shapes;
  FrameId frame{};
  RunningHash hash;
};

}  // namespace atlaswire::codec
