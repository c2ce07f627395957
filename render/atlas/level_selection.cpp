#include "render/atlas/level_selection.h"

#include "base/assert.h"
#include "base/program.h"
#include "shaders/level_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace atlaswire::render {

namespace {

constexpr std::int32_t kOctave = static_cast<std::int32_t>(kLevelSteps);  // of a packed projection
constexpr std::int32_t kStepsPerOctave = 8;                               // of the bias and the histogram
constexpr std::int32_t kStep = kOctave / kStepsPerOctave;
constexpr std::int32_t kHeadroom = 16;  // octaves above the largest block in which areas still differ

std::int32_t packed_area(std::uint32_t packed) {
  return static_cast<std::int32_t>(packed & 0xFFFFU) - kLevelAreaBias;
}

std::int32_t packed_aspect(std::uint32_t packed) { return static_cast<std::int16_t>(packed >> 16U); }

std::int32_t smallest(const AllocatorSettings& s) { return 2 * static_cast<std::int32_t>(s.min_block_log2); }
std::int32_t largest(const AllocatorSettings& s) { return 2 * static_cast<std::int32_t>(s.superblock_log2); }

std::int32_t highest_bin(const AllocatorSettings& s) { return (largest(s) + kHeadroom) * kStepsPerOctave; }

/// How elongated a block of log2 area `area` can be, as |log2 aspect|; of the area's parity.
std::int32_t aspect_limit(std::int32_t area, const AllocatorSettings& s) {
  return std::min(largest(s) - area, area - smallest(s));
}

/// log2 area of the block for a biased area in 256ths.
std::int32_t rounded_area(std::int32_t area, const AllocatorSettings& s) {
  return std::clamp((area + kOctave / 2) >> 8, smallest(s), largest(s));
}

std::uint16_t remembered(const BlockRequest& r) {
  return static_cast<std::uint16_t>(0x8000 | (r.transposed ? 0x100 : 0) | (r.width_log2 << 4) |
                                    r.height_log2);
}

BlockRequest recalled(std::uint32_t patch, std::uint16_t level) {
  return {.patch = PatchId{patch},
          .width_log2 = static_cast<std::uint8_t>((level >> 4) & 15),
          .height_log2 = static_cast<std::uint8_t>(level & 15),
          .transposed = (level & 0x100) != 0};
}

std::uint64_t texels_of(const BlockRequest& r) { return std::uint64_t{1} << (r.width_log2 + r.height_log2); }

}  // namespace

std::uint32_t pack_projection(double area_pixels, double aspect) {
  const auto octaves = [](double ratio, double low, double high) {
    const double log = ratio > 0 ? std::log2(ratio) * kOctave : -std::numeric_limits<double>::infinity();
    return static_cast<std::int32_t>(std::lround(std::clamp(log, low, high)));
  };
  const std::int32_t area =
      octaves(area_pixels, 1 - kLevelAreaBias, 0xFFFF - kLevelAreaBias) + kLevelAreaBias;
  const std::int32_t shape = octaves(aspect, -32768, 32767);
  return (static_cast<std::uint32_t>(shape) << 16U) | static_cast<std::uint32_t>(area);
}

double memory_bias(double ideal, double fixed, double atlas) {
  if (atlas <= fixed) return std::numeric_limits<double>::infinity();
  if (ideal <= fixed) return -std::numeric_limits<double>::infinity();
  return std::log2((ideal - fixed) / (atlas - fixed));
}

BlockRequest round_level(PatchId patch, std::int32_t area, std::int32_t aspect, const AllocatorSettings& s) {
  const std::int32_t area_log2 = rounded_area(area, s);
  const std::int32_t parity = area_log2 & 1;
  const std::int32_t nearest = 2 * ((aspect - parity * kOctave + kOctave) >> 9) + parity;
  const std::int32_t limit = aspect_limit(area_log2, s);
  const std::int32_t aspect_log2 = std::clamp(nearest, -limit, limit);
  const std::int32_t elongation = std::abs(aspect_log2);
  return {.patch = patch,
          .width_log2 = static_cast<std::uint8_t>((area_log2 + elongation) / 2),
          .height_log2 = static_cast<std::uint8_t>((area_log2 - elongation) / 2),
          .transposed = aspect_log2 < 0};
}

LevelRange level_range(const LevelSettings& settings) {
  const AllocatorSettings& a = settings.allocator;
  if (!(settings.target_fill > 0 && settings.target_fill <= 1) ||
      !(settings.max_oversampling >= 1 && settings.max_oversampling <= 65536) ||
      !(settings.hysteresis >= 0 && settings.hysteresis <= 1) || a.superblock_log2 > 12 ||
      a.min_block_log2 > a.superblock_log2) {
    throw ProgramError(ExitCode::kUsage,
                       "level selection: fill must be in (0, 1], oversampling in [1, 65536], hysteresis in "
                       "[0, 1] octaves, block sides at most 4096");
  }
  const auto lowest_step =
      -static_cast<std::int32_t>(std::floor(std::log2(settings.max_oversampling) * kStepsPerOctave));
  return {.smallest = smallest(a),
          .largest = largest(a),
          .lowest_bin = smallest(a) * kStepsPerOctave + lowest_step,
          .highest_bin = highest_bin(a),
          .lowest_step = lowest_step,
          .highest_step = highest_bin(a) - smallest(a) * kStepsPerOctave,
          .margin = static_cast<std::int32_t>(std::lround(settings.hysteresis * kOctave)),
          .target = static_cast<std::uint64_t>(settings.target_fill * static_cast<double>(a.atlas.area()))};
}

LevelSelector::LevelSelector(const LevelSettings& settings, std::uint32_t patch_count)
    : settings_(settings),
      range_(level_range(settings)),
      gathered_(std::size_t{patch_count} + 1),
      levels_(patch_count) {
  histogram_.resize(static_cast<std::size_t>(range_.highest_bin - range_.lowest_bin + 1));
}

const LevelStats& LevelSelector::select(std::span<const std::uint32_t> packed,
                                        std::vector<BlockRequest>& out) {
  AW_ASSERT(packed.size() == levels_.size());
  scan(packed);
  stats_ = {};
  stats_.visible = static_cast<std::uint32_t>(found_);
  if (found_ != 0) choose_bias();
  stats_.bias = static_cast<double>(step_) / kStepsPerOctave;
  assign(out);
  if (stats_.texels > range_.target) demote(out);
  return stats_;
}

/// Gathers without branches: which patches are visible is anything but predictable.
void LevelSelector::scan(std::span<const std::uint32_t> packed) {
  std::size_t found = 0;
  const auto count = static_cast<std::uint32_t>(packed.size());
  for (std::uint32_t patch = 0; patch < count; ++patch) {
    gathered_[found] = {patch, packed[patch]};
    found += packed[patch] != 0 ? 1 : 0;
  }
  found_ = found;

  static_assert(kStep == 1 << 5);
  std::ranges::fill(histogram_, 0U);
  const std::int32_t high = highest_bin(settings_.allocator);
  for (const Visible& v : visible()) {
    const std::int32_t bin = std::clamp(packed_area(v.packed) >> 5, range_.lowest_bin, high);
    ++histogram_[static_cast<std::size_t>(bin - range_.lowest_bin)];
  }
}

/// Texels of all blocks at a bias, after rounding and clamping. Exact without hysteresis, because rounding
/// boundaries lie on bin boundaries at every step. Never rises with the bias.
std::uint64_t LevelSelector::predicted(std::int32_t bias_step) const {
  std::uint64_t texels = 0;
  for (std::size_t i = 0; i < histogram_.size(); ++i) {
    const std::int32_t area = (range_.lowest_bin + static_cast<std::int32_t>(i) - bias_step) * kStep;
    texels += std::uint64_t{histogram_[i]} << rounded_area(area, settings_.allocator);
  }
  return texels;
}

/// From eq. 3 to the smallest bias that fits, then hysteresis in time.
void LevelSelector::choose_bias() {
  const double floor_area = std::exp2(smallest(settings_.allocator));
  const double ceiling = std::exp2(largest(settings_.allocator));
  double ideal = 0;
  double fixed = 0;
  for (std::size_t i = 0; i < histogram_.size(); ++i) {
    const double centre = (range_.lowest_bin + static_cast<double>(i) + 0.5) / kStepsPerOctave;
    const double area = std::clamp(std::exp2(centre), floor_area, ceiling) * histogram_[i];
    ideal += area;
    if (centre <= smallest(settings_.allocator)) fixed += area;
  }
  stats_.one_step_bias = memory_bias(ideal, fixed, static_cast<double>(range_.target));

  auto fits =
      static_cast<std::int32_t>(std::clamp(std::round(stats_.one_step_bias * kStepsPerOctave),
                                           double{1} * range_.lowest_step, double{1} * range_.highest_step));
  while (fits < range_.highest_step && predicted(fits) > range_.target) ++fits;
  while (fits > range_.lowest_step && predicted(fits - 1) <= range_.target) --fits;

  if (!has_bias_ || fits > step_) {
    step_ = fits;
  } else if (fits <= step_ - 2) {
    step_ -= std::max(1, (step_ - fits) / 4);
  }
  has_bias_ = true;
}

void LevelSelector::assign(std::vector<BlockRequest>& out) {
  out.resize(found_);
  const std::int32_t cap = highest_bin(settings_.allocator) * kStep;
  std::uint64_t texels = 0;
  for (std::size_t i = 0; i < found_; ++i) {
    const Visible& v = gathered_[i];
    const std::int32_t area = std::min(packed_area(v.packed), cap) - step_ * kStep;
    const std::int32_t aspect = packed_aspect(v.packed);
    const std::uint16_t before = levels_[v.patch];
    BlockRequest& request = out[i];
    request = recalled(v.patch, before);
    if (before == 0 || !keeps(request, area, aspect)) {
      request = round_level(PatchId{v.patch}, area, aspect, settings_.allocator);
      levels_[v.patch] = remembered(request);
    }
    texels += texels_of(request);
  }
  stats_.texels = texels;
}

/// Takes hysteresis back, in patch order, from patches it keeps too large, until memory suffices.
void LevelSelector::demote(std::vector<BlockRequest>& out) {
  const std::int32_t cap = highest_bin(settings_.allocator) * kStep;
  for (std::size_t i = 0; i < out.size() && stats_.texels > range_.target; ++i) {
    const Visible& v = gathered_[i];
    const std::int32_t area = std::min(packed_area(v.packed), cap) - step_ * kStep;
    const auto request = round_level(out[i].patch, area, packed_aspect(v.packed), settings_.allocator);
    if (texels_of(request) >= texels_of(out[i])) continue;
    stats_.texels -= texels_of(out[i]) - texels_of(request);
    ++stats_.demoted;
    out[i] = request;
    levels_[v.patch] = remembered(request);
  }
}

/// Whether a patch's previous level is still near enough: half a rounding step plus the margin.
bool LevelSelector::keeps(const BlockRequest& previous, std::int32_t area, std::int32_t aspect) const {
  const AllocatorSettings& s = settings_.allocator;
  const std::int32_t area_log2 = previous.width_log2 + previous.height_log2;
  const std::int32_t legal = std::clamp(area, smallest(s) * kOctave, largest(s) * kOctave);
  if (std::abs(legal - area_log2 * kOctave) > kOctave / 2 + range_.margin) return false;
  const std::int32_t limit = aspect_limit(area_log2, s) * kOctave;
  std::int32_t aspect_log2 = previous.width_log2 - previous.height_log2;
  if (previous.transposed) aspect_log2 = -aspect_log2;
  return std::abs(std::clamp(aspect, -limit, limit) - aspect_log2 * kOctave) <= kOctave + 2 * range_.margin;
}

}  // namespace atlaswire::render
