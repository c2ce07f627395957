#pragma once

#include "base/bytes.h"

#include <cstdint>
#include <optional>

namespace atlaswire::codec {

/// Tells whether a picture's reference is the one before it: frame_num (H.264 7.4.3) goes up by one from
/// each reference picture to the next. libavcodec conceals a missing reference without any flag, so a
/// decoder that must not show wrong texels asks here first. Safe on any bytes.
class GapDetector {
 public:
  enum class Verdict { kContinues, kGap, kNoReference };

  /// Looks at one access unit in Annex B form. kNoReference: no IDR came since the start or the last reset.
  Verdict inspect(ByteView access_unit);
  /// Forgets the reference: only an IDR continues.
  void reset() { reference_.reset(); }

 private:
  std::uint32_t frame_number_bits_ = 0;     // of the last sequence parameter set; 0: none understood
  std::optional<std::uint32_t> reference_;  // frame_num of the last reference picture
};

}  // namespace atlaswire::codec
