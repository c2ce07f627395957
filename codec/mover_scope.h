#pragma once

#include "codec/flat_index.h"
#include "codec/motion.h"
#include "codec/mover_watch.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// Who takes part in a stream's motion messages: the objects of which a patch is visible, and the vertices of
/// visible patches that deform. Both ends follow the same changes and so have the same scope and surface.
/// docs/PROTOCOL.md, "Motion in a stream". Safe on any changes: memory is bounded by the patches told.
class MoverScope {
 public:
  /// `seed`: FlatIndex's.
  MoverScope(std::span<const Mover> movers, std::uint64_t seed);

  /// The changes of one meta update. Every one, in order.
  void follow(const MoverChange& change);

  /// Valid until the next change.
  [[nodiscard]] MotionScope scope() const { return {&surface_, vertices_, objects_}; }
  [[nodiscard]] const MotionSurface& surface() const { return surface_; }
  /// The id under which a vertex of the surface came first.
  [[nodiscard]] VertexId id(std::uint32_t vertex) const { return ids_[vertex]; }
  /// The surface's vertices at the corners of a patch that deforms; empty: it never came.
  [[nodiscard]] std::span<const std::uint32_t> corners(PatchId patch) const;

 private:
  struct Patch {
    std::uint32_t mover = 0;
    std::uint32_t count = 0;
    std::array<std::uint32_t, kMaxPatchCorners> corners{};  ///< of the surface
    bool visible = false;
  };

  void forget();
  void come(const MoverPatch& patch);
  void hide(Patch& patch);
  std::uint32_t vertex_of(const MoverPatch& patch, std::uint32_t corner);

  std::vector<Mover> movers_;
  std::uint64_t seed_;
  MotionSurface surface_;
  std::vector<VertexId> ids_;         ///< by vertex of the surface
  std::vector<std::uint32_t> shown_;  ///< by vertex of the surface: visible patches that it is of
  std::vector<std::uint32_t> seen_;   ///< by object: visible patches
  std::vector<FlatIndex> positions_;  ///< by mover: rest position to vertex of the surface
  FlatIndex numbers_;                 ///< patch id to number
  std::vector<Patch> patches_;
  std::vector<std::uint32_t> vertices_;
  std::vector<std::uint32_t> objects_;
};

}  // namespace atlaswire::codec
