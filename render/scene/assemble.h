#pragma once

#include "base/result.h"
#include "render/scene/patch_grouping.h"
#include "render/scene/source.h"

namespace atlaswire::render {

/// How a scene is put together.
struct AssembleSettings {
  PatchSettings patches;
  bool split_huge_triangles = true;     ///< see subdivide.h
  std::uint32_t chunk_triangles = 256;  ///< at most; smaller culls finer and costs more draws
};

/// Flattens instances, welds, groups triangles to patches, orders and chunks them, lists lights per chunk,
/// and finds what the scene requires. Degenerate triangles are dropped and counted. Deterministic. Errors:
/// kNotFinite, kEmpty, kTooLarge.
Result<Scene> assemble(SceneSource source, const AssembleSettings& settings = {});

}  // namespace atlaswire::render
