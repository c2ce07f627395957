#pragma once

#include <cstdint>

namespace atlaswire::render {

/// Binary logarithms of a block's sides; landscape: width_log2 >= height_log2 ([SAS] 4.3 calls it level).
struct Level {
  std::uint8_t width_log2 = 0;
  std::uint8_t height_log2 = 0;
  bool operator==(const Level&) const = default;
  /// log2 of the area in texels.
  [[nodiscard]] std::uint32_t area_log2() const { return std::uint32_t{width_log2} + height_log2; }
  [[nodiscard]] std::uint64_t area() const { return std::uint64_t{1} << area_log2(); }
};

/// Half the area, still landscape: the longer side halves, of a square the height.
constexpr Level halved(Level level) {
  if (level.width_log2 > level.height_log2) return {std::uint8_t(level.width_log2 - 1), level.height_log2};
  return {level.width_log2, std::uint8_t(level.height_log2 - 1)};
}

/// Numbers the levels between a smallest and a largest side: by width, then by height. Descending numbers
/// are the order of provisioning, and `halved` always lowers the number.
class LevelNumbers {
 public:
  /// Sides from 2^0 to 2^12.
  static constexpr std::uint32_t kMost = 91;

  constexpr LevelNumbers(std::uint32_t min_log2, std::uint32_t max_log2)
      : min_log2_(min_log2), sides_(max_log2 - min_log2 + 1) {}

  [[nodiscard]] constexpr std::uint32_t count() const { return sides_ * (sides_ + 1) / 2; }
  [[nodiscard]] constexpr std::uint32_t number(Level level) const {
    const std::uint32_t w = level.width_log2 - min_log2_;
    return w * (w + 1) / 2 + level.height_log2 - min_log2_;
  }
  [[nodiscard]] constexpr Level level(std::uint32_t number) const {
    std::uint32_t w = 0;
    while ((w + 1) * (w + 2) / 2 <= number) ++w;
    return {std::uint8_t(w + min_log2_), std::uint8_t(number - w * (w + 1) / 2 + min_log2_)};
  }
  [[nodiscard]] constexpr std::uint32_t min_log2() const { return min_log2_; }
  [[nodiscard]] constexpr std::uint32_t max_log2() const { return min_log2_ + sides_ - 1; }

 private:
  std::uint32_t min_log2_;
  std::uint32_t sides_;
};

}  // namespace atlaswire::render
