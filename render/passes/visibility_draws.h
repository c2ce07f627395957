#pragma once

#include "render/scene/scene.h"
#include "shaders/visibility_layout.h"

#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::render {

/// How the id pass draws a chunk.
enum class IdClass : std::uint8_t { kOpaque, kMasked, kBlended };

/// Commands that one pipeline and material draw together.
struct DrawRange {
  IdClass id_class = IdClass::kOpaque;
  bool double_sided = false;
  std::uint16_t material = 0;  ///< of the first chunk; opaque ranges span materials
  std::uint32_t first_command = 0;
  std::uint32_t command_count = 0;
};

/// Which chunks a view draws, as ranges of consecutive commands in chunk order: opaque, masked, blended.
struct DrawList {
  std::vector<visibility::ChunkCandidate> candidates;
  std::vector<DrawRange> ranges;
};

/// A masked material without a texture has no holes unless its own alpha is below its cutoff: then it is
/// all hole. So only textured ones need the fragment test, but all of them take it: it is the same picture.
IdClass id_class(const Material& material);

/// The list that draws the chunks `chunks` (ascending), which are where `boxes` (by chunk) say. With `merge`,
/// neighbours of one range become one command.
DrawList list_draws(const Scene& scene, std::span<const Box> boxes, std::span<const std::uint32_t> chunks,
                    bool merge);

}  // namespace atlaswire::render
