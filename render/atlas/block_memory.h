#pragma once

#include "base/block.h"
#include "render/atlas/allocator.h"
#include "render/atlas/block_level.h"
#include "render/atlas/superblock_store.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace atlaswire::render {

/// Memory that gives and takes one block at a time: what the comparators of [SAS] 5.3 and 5.4 differ in.
class BlockMemory {
 public:
  virtual ~BlockMemory() = default;
  /// Everything free again.
  virtual void clear() = 0;
  virtual std::optional<TexelPosition> take(Level level) = 0;
  virtual void release(const Block& block) = 0;
  [[nodiscard]] virtual AtlasUsage usage() const = 0;
};

/// [SAS] 5.4 without columns: a superblock holds blocks of one level only. With stacks freed blocks are used
/// again (S1); without, their texels are lost until the whole superblock is free (S2, S3).
std::unique_ptr<BlockMemory> make_level_superblocks(const AllocatorSettings& settings, bool stacks);

/// [SAS] 5.3: a tree of squares, each cut in two halves and these in two squares, or a half in thinner
/// strips; what is free merges at once with its other half. The lowest address first.
std::unique_ptr<BlockMemory> make_quadtree(const AllocatorSettings& settings);

}  // namespace atlaswire::render
