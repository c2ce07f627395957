#pragma once

#include "base/error_enum.h"
#include "base/result.h"
#include "lab/curve_fit.h"

#include <span>

namespace atlaswire::lab {

/// One measured point of a rate-quality curve.
struct RatePoint {
  double rate = 0;     ///< > 0, in any unit that both curves share
  double quality = 0;  ///< PSNR in dB, MSSIM or another index: larger is better
};

/// Bjontegaard's rate difference (VCEG-M33, 2001): how much more rate, in percent, `test` needs than
/// `anchor` for the same quality, as a mean of log rate over the qualities that both reach. -20: a fifth
/// less. The points of a curve may come in any order.
///
/// Errors (BdError), `detail` naming the curve: kTooFewPoints below four; kBadPoint for a rate that is not
/// positive or a value that is not finite; kNotMonotone where quality does not rise with rate, for then
/// rate is no function of quality; kNoOverlap where no quality is reached by both.
Result<double> bd_rate(std::span<const RatePoint> anchor, std::span<const RatePoint> test,
                       CurveFit fit = CurveFit::kCubic);

/// Bjontegaard's quality difference: how much better `test` is than `anchor` at the same rate, in units of
/// quality, as a mean over the log rates that both cover. Errors as above, but quality may fall: only two
/// points of one rate are kNotMonotone.
Result<double> bd_quality(std::span<const RatePoint> anchor, std::span<const RatePoint> test,
                          CurveFit fit = CurveFit::kCubic);

/// Why two curves have no Bjontegaard difference.
enum class BdError { kTooFewPoints = 1, kBadPoint, kNotMonotone, kNoOverlap };
const char* error_text(BdError e);

}  // namespace atlaswire::lab
ATLASWIRE_ERROR_ENUM(lab, BdError);
