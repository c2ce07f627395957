#pragma once

#include "base/block.h"

#include <cstdint>

namespace atlaswire {

/// A hash of what was taken in, in order: how two ends of a stream tell that they know the same. It guards
/// against accidents, not against a peer who wants a collision. docs/PROTOCOL.md, "Hash".
class RunningHash {
 public:
  void take_in(std::uint32_t v) {
    value_ = (value_ ^ v) * 0x9E3779B1U;
    value_ ^= value_ >> 15U;
  }
  void take_in(const Block& block) {
    take_in(std::uint32_t{block.x} << 16U | block.y);
    take_in(std::uint32_t{block.width_log2} << 8U | std::uint32_t{block.height_log2} << 1U |
            static_cast<std::uint32_t>(block.transposed));
  }
  [[nodiscard]] std::uint32_t value() const { return value_; }
  /// The half that is compared on the wire.
  [[nodiscard]] std::uint16_t upper() const { return static_cast<std::uint16_t>(value_ >> 16U); }

 private:
  std::uint32_t value_ = 0x1D872B41;  ///< not 0, so that a message of zeros does not look as if it belonged
};

}  // namespace atlaswire
