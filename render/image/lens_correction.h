#pragma once

#include "base/error_enum.h"
#include "base/result.h"

#include <array>
#include <string>
#include <string_view>

namespace atlaswire::render {

/// Where one colour channel of a displayed pixel comes from: at radius r on the display lies what is at
/// r' = r (1 + k1 r^2 + k2 r^4) in the picture that was rendered for the eye. Radii are from the picture's
/// centre, in halves of its height. Positive coefficients shrink the picture towards its corners (barrel),
/// which undoes what a magnifying lens does (pincushion); 0 and 0 change nothing.
struct RadialCorrection {
  double k1 = 0;
  double k2 = 0;
  bool operator==(const RadialCorrection&) const = default;
};

/// Correction of an eye's lens, for each channel by itself, since glass refracts them differently
/// ([SAS] 3.6).
struct LensCorrection {
  std::array<RadialCorrection, 3> channels;  ///< red, green, blue
  bool operator==(const LensCorrection&) const = default;
};

/// "none"; "generic", about as strong as the lenses of the first consumer headsets; "K1,K2" for all three
/// channels; or six numbers, K1,K2 of red, green and blue in turn. Coefficients are within +-10.
Result<LensCorrection> parse_lens(std::string_view text);
/// What parse_lens() reads as the same correction.
std::string to_string(const LensCorrection& lens);

/// Why a text is no lens.
enum class LensError { kBadLens = 1 };
const char* error_text(LensError e);

}  // namespace atlaswire::render
ATLASWIRE_ERROR_ENUM(render, LensError);
