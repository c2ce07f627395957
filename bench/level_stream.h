#pragma once

#include "render/atlas/allocator.h"
#include "render/atlas/level_selection.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace atlaswire::bench {

/// What the visibility pass says of a walk through a scene: each frame's visible patches with their level
/// words (shaders/level_layout.h), ascending by patch. Independent of the atlas.
struct LevelStream {
  using Frame = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  std::uint32_t patch_count = 0;
  std::vector<Frame> frames;
};

/// Walks `path` through `scene` at 30 frames a second, 960x540 pixels, with 100 ms of prediction in two
/// views. Throws ProgramError.
LevelStream record_levels(const std::string& scene, const std::string& path, std::uint32_t frames);

/// Throw ProgramError. A stream is a few MB a hundred frames.
void save_levels(const LevelStream& stream, const std::filesystem::path& file);
LevelStream load_levels(const std::filesystem::path& file);

/// The requests that allocators get for a stream: one list a frame.
std::vector<std::vector<render::BlockRequest>> requests_of(const LevelStream& stream,
                                                           const render::LevelSettings& settings);

/// Allocator settings as the daemon has them.
render::AllocatorSettings daemon_atlas(Extent2D atlas, std::uint32_t patch_count);

}  // namespace atlaswire::bench
