#pragma once

#include "base/block.h"
#include "base/ids.h"
#include "base/units.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace atlaswire::render {

/// What a visible patch wants: the level of [SAS] 4.3, already biased, rounded and clamped.
struct BlockRequest {
  PatchId patch{};
  std::uint8_t width_log2 = 0;
  std::uint8_t height_log2 = 0;
  bool transposed = false;
};

/// What changes from one frame's requests to the next's. Both ascend by patch; no patch is in both.
struct RequestChange {
  std::span<const PatchId> gone;        ///< asked in the frame before, and no longer
  std::span<const BlockRequest> asked;  ///< new, or of another size; a request that stands may be repeated
};

/// A patch and its block.
struct PlacedPatch {
  PatchId patch{};
  Block block;
};

/// What one frame changed in the atlas. Lists ascend by patch.
struct LayoutChange {
  bool reset = false;  ///< every block was placed anew; the lists still name only real differences
  std::vector<PlacedPatch> added;
  std::vector<PlacedPatch> moved;
  std::vector<PatchId> removed;  ///< hidden, or refused: they held a block
  std::vector<PatchId> refused;  ///< visible, but the atlas was full: they hold no block
};

/// A change in numbers, for statistics.
struct LayoutCounts {
  bool reset = false;
  std::uint32_t moved = 0;
  std::uint32_t refused = 0;
};
inline LayoutCounts counts_of(const LayoutChange& change) {
  return {change.reset, static_cast<std::uint32_t>(change.moved.size()),
          static_cast<std::uint32_t>(change.refused.size())};
}

/// Where the atlas's texels are ([SAS] fig. 11); the members sum to its area.
struct AtlasUsage {
  std::uint64_t allocated = 0;
  std::uint64_t partial_tail = 0;  ///< at the end of partly filled superblocks
  std::uint64_t on_stacks = 0;     ///< free blocks waiting on a stack
  std::uint64_t inaccessible = 0;  ///< lost until a reset
  std::uint64_t free = 0;          ///< whole free superblocks
};

/// Settings of every allocator.
struct AllocatorSettings {
  Extent2D atlas{1024, 1024};         ///< multiples of the superblock side
  std::uint32_t superblock_log2 = 6;  ///< side 2^n, also the largest block's side
  std::uint32_t min_block_log2 = 1;   ///< smallest side 2^n; 1 keeps 4:2:0 chroma of neighbours apart
  double high_water = 0.8;            ///< share of texels outside free superblocks that asks for a reset
};

/// The superblock side that suits an atlas: an eighth of the atlas's side (64 superblocks), so that large
/// triangles find blocks of their own size without whole superblocks standing open for each width; a power of
/// two from 2^5 to 2^8 that divides both sides, which must be multiples of 64.
std::uint32_t suited_superblock_log2(Extent2D atlas);

/// The smallest block's side that suits an atlas and a scene: 2^1, unless the atlas has fewer texels than the
/// scene patches. About a sixth of a scene's patches are visible at once; 2x2 texels for each would then fill
/// the atlas or exceed it, and a patch without a block is a hole, which is worse than chroma shared with
/// neighbours.
std::uint32_t suited_min_block_log2(Extent2D atlas, std::uint32_t patch_count);

/// The atlas's memory: a block for each visible patch, stable while it stays visible at one size. A
/// deterministic function of its inputs. Implementations: the sequential three-layer reference here;
/// others (device, quadtree, the paper's S1..S3) move in behind this interface.
class AtlasAllocator {
 public:
  virtual ~AtlasAllocator() = default;
  /// One frame: `visible` ascends by patch. Patches not in it are released. `may_reset`: this frame is an
  /// I-frame, so blocks may all move if memory asks for it.
  virtual const LayoutChange& update(std::span<const BlockRequest> visible, bool may_reset) = 0;
  /// Makes the next update() a reset, whatever memory says: its layout, and all that follow, are then a
  /// function of the requests from there on, and a new allocator that restarts with them arrives at the same.
  virtual void restart() = 0;
  /// Every live block, ascending by patch.
  [[nodiscard]] virtual std::vector<PlacedPatch> blocks() const = 0;
  [[nodiscard]] virtual AtlasUsage usage() const = 0;
  /// The next I-frame should be early: memory is above the high-water mark, or a patch was refused or got
  /// less than it wanted, and a reset would help.
  [[nodiscard]] virtual bool wants_reset() const = 0;
};

/// An allocator that can be told a frame by what changes, and whose work then follows from that: for a
/// receiver, who hears nothing else.
class IncrementalAllocator : public AtlasAllocator {
 public:
  /// As `update` with the requests that come about; frames may come in either way.
  virtual const LayoutChange& update_by(const RequestChange& change, bool may_reset) = 0;
};

/// A reset would help and should not wait for the next I-frame by rule, because next to no superblock is
/// free: an early I-frame is worth its bytes.
bool reset_is_urgent(const AtlasAllocator& allocator, Extent2D atlas);

/// The sequential model of [SAS] 4.2: request, provisioning and assignment phases, in patch order.
std::unique_ptr<IncrementalAllocator> make_sequential_allocator(const AllocatorSettings& settings,
                                                                std::uint32_t patch_count);

}  // namespace atlaswire::render
