#pragma once

#include "base/random.h"
#include "render/atlas/allocator.h"

#include <map>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace atlaswire::render {

/// Follows an allocator frame by frame, as a client would from its changes alone, and says what is wrong.
class LayoutChecker {
 public:
  explicit LayoutChecker(const AllocatorSettings& settings) : settings_(settings) {}

  /// Empty if the frame keeps every promise of AtlasAllocator, else the broken one.
  std::string check(const AtlasAllocator& allocator, std::span<const BlockRequest> visible,
                    const LayoutChange& change);

  /// Live blocks by patch.
  [[nodiscard]] const std::map<PatchId, Block>& live() const { return live_; }

 private:
  std::string apply(const LayoutChange& change);
  std::string check_visible(std::span<const BlockRequest> visible, const LayoutChange& change) const;
  std::string check_geometry() const;
  std::string check_usage(const AtlasAllocator& allocator) const;

  AllocatorSettings settings_;
  std::map<PatchId, Block> live_;
  std::map<PatchId, BlockRequest> requests_;  ///< of the frame before
};

/// A request with sides 2^width and 2^height.
inline BlockRequest request(std::uint32_t patch, std::uint32_t width, std::uint32_t height,
                            bool transposed = false) {
  return {PatchId{patch}, static_cast<std::uint8_t>(width), static_cast<std::uint8_t>(height), transposed};
}

inline AllocatorSettings small_atlas(std::uint32_t side = 256, std::uint32_t superblock = 5,
                                     std::uint32_t least = 1) {
  return {.atlas = {side, side}, .superblock_log2 = superblock, .min_block_log2 = least};
}

/// What a DriftingScene is walked with, for parameterized tests.
struct DriftLoad {
  const char* name;
  AllocatorSettings settings;
  std::uint32_t patches;
  double churn;
  double visible;
  std::uint32_t largest_log2;
  int frames;
};
inline void PrintTo(const DriftLoad& load, std::ostream* out) { *out << load.name; }

/// A visible set that drifts: each frame a share of patches appears, goes or changes size.
class DriftingScene {
 public:
  DriftingScene(std::uint64_t seed, std::uint32_t patches, const AllocatorSettings& settings);
  /// `churn`: chance per patch to change. `visible`: chance to be visible after a change. `growth` octaves
  /// are added to each side's log.
  const std::vector<BlockRequest>& step(double churn, double visible, std::uint32_t largest_log2);

 private:
  Random random_;
  AllocatorSettings settings_;
  std::vector<BlockRequest> wish_;
  std::vector<bool> shown_;
  std::vector<BlockRequest> visible_;
};

}  // namespace atlaswire::render
