#pragma once

#include "codec/meta_update.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace atlaswire::codec {

/// What a client could draw: patches by id, with positions instead of vertices, so that two streams of
/// updates can be compared that number vertices differently.
class ShownPatches {
 public:
  struct Patch {
    std::uint8_t triangles = 1;
    PatchClass draw;
    std::vector<std::array<std::uint32_t, 3>> positions;
    Block block;
    bool operator==(const Patch&) const = default;
  };

  /// Fails the test where the update contradicts what is shown.
  void apply(const MetaUpdate& update);
  bool operator==(const ShownPatches& other) const { return patches_ == other.patches_; }
  [[nodiscard]] const std::map<PatchId, Patch>& patches() const { return patches_; }

 private:
  std::map<PatchId, Patch> patches_;
  std::map<VertexId, std::array<std::uint32_t, 3>> vertices_;
};

}  // namespace atlaswire::codec
