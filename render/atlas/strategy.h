#pragma once

#include "render/atlas/allocator.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace atlaswire::render {

/// The ways to manage the atlas's memory: those that [SAS] 5.3 and 5.4 compare, and what stable blocks are
/// for.
enum class Strategy : std::uint8_t {
  kS0,        ///< superblocks, columns, block stacks, resets: what is recommended
  kS1,        ///< no columns
  kS2,        ///< no columns, no block stacks
  kS3,        ///< no columns, no block stacks, no resets
  kQuadtree,  ///< one block at a time on the CPU, with resets
  kRepack,    ///< the quadtree, cleared before each frame: dense, but hardly a block stays where it was
};

/// All, in order, and their names: "S0" to "S3", "quadtree", "repack".
std::span<const Strategy> strategies();
std::string_view name_of(Strategy strategy);
std::optional<Strategy> find_strategy(std::string_view name);

/// All but kS0, which is the sequential reference, refuse what does not fit at the level it wants.
/// Throws ProgramError for settings that do not fit together.
std::unique_ptr<AtlasAllocator> make_allocator(Strategy strategy, const AllocatorSettings& settings,
                                               std::uint32_t patch_count);

}  // namespace atlaswire::render
