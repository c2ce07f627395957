#include "render/atlas/atlas_demand.h"

#include "base/program.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace atlaswire::render {

bool reset_is_urgent(const AtlasAllocator& allocator, Extent2D atlas) {
  constexpr std::uint64_t kScarce = 20;  // free superblocks are less than 1 / this of the atlas
  return allocator.wants_reset() && allocator.usage().free * kScarce < atlas.area();
}

std::uint64_t high_water_texels(const AllocatorSettings& settings) {
  return static_cast<std::uint64_t>(settings.high_water * static_cast<double>(settings.atlas.area()));
}

AtlasDemand::AtlasDemand(const AllocatorSettings& s)
    : numbers_(s.min_block_log2, s.superblock_log2),
      superblocks_(static_cast<std::uint32_t>(s.atlas.area() >> (2 * s.superblock_log2))),
      high_superblocks_(static_cast<std::uint32_t>(std::floor(s.high_water * superblocks_))),
      capacity_(static_cast<std::uint32_t>(s.atlas.area() >> (2 * s.min_block_log2))) {}

std::uint32_t AtlasDemand::area_cap(const PerLevel& requested, std::uint64_t room) const {
  const std::uint32_t least = 2 * numbers_.min_log2();
  for (std::uint32_t cap = 2 * numbers_.max_log2(); cap > least; --cap) {
    std::uint64_t texels = 0;
    for (std::uint32_t i = 0; i < numbers_.count(); ++i) {
      texels += std::uint64_t{requested[i]} << std::min(cap, numbers_.level(i).area_log2());
    }
    if (texels <= room) return cap;
  }
  return least;
}

bool AtlasDemand::reset_helps(const PerLevel& wanted, const AtlasOutcome& outcome) {
  const std::uint32_t least = 2 * numbers_.min_log2();
  const std::uint32_t superblock_log2 = 2 * numbers_.max_log2() - least;
  std::uint64_t total = 0;
  std::uint64_t packed = 0;  // superblocks, were every width packed tightly
  for (std::uint32_t w = numbers_.min_log2(); w <= numbers_.max_log2(); ++w) {
    std::uint64_t of_width = 0;
    for (std::uint32_t h = numbers_.min_log2(); h <= w; ++h) {
      const std::uint32_t count = wanted[numbers_.number({std::uint8_t(w), std::uint8_t(h)})];
      of_width = std::min<std::uint64_t>(kSaturated, of_width + (std::uint64_t{count} << (w + h - least)));
    }
    packed += (of_width + (std::uint64_t{1} << superblock_log2) - 1) >> superblock_log2;
    total = std::min<std::uint64_t>(kSaturated, total + of_width);
  }
  const auto wants = static_cast<std::uint32_t>(total);
  if (outcome.reset) {
    futile_ = outcome.shrunken + outcome.refused != 0 ? wants - wants / 16 : kSaturated;
  }
  const bool high = outcome.used_superblocks > high_superblocks_;
  if (high && packed + std::max(1U, superblocks_ / 32) <= outcome.used_superblocks) return true;
  if (outcome.shrunken != 0 && wants <= capacity_ && wants < futile_) return true;
  return outcome.visible - outcome.refused < std::min(outcome.visible, capacity_);
}

void check_allocator_settings(const AllocatorSettings& settings) {
  if (settings.superblock_log2 > 12 || settings.min_block_log2 > settings.superblock_log2) {
    throw ProgramError(ExitCode::kUsage, "atlas memory: superblock side 2^" +
                                             std::to_string(settings.superblock_log2) +
                                             " must be at most 4096 and no smaller than the smallest block");
  }
  if (!(settings.high_water >= 0 && settings.high_water <= 1)) {
    throw ProgramError(ExitCode::kUsage, "atlas memory: the high-water mark must be in [0, 1]");
  }
  const std::uint32_t side = 1U << settings.superblock_log2;
  const Extent2D atlas = settings.atlas;
  if (atlas.area() == 0 || atlas.width % side != 0 || atlas.height % side != 0 || atlas.width > 32768 ||
      atlas.height > 32768) {
    throw ProgramError(ExitCode::kUsage, "atlas memory: the atlas is " + std::to_string(atlas.width) + "x" +
                                             std::to_string(atlas.height) +
                                             "; its sides must be multiples of " + std::to_string(side) +
                                             " up to 32768");
  }
}

}  // namespace atlaswire::render
