#pragma once

#include "lab/point.h"
#include "lab/point_result.h"

namespace atlaswire::lab {

/// Runs one point: real rendering, coding and redrawing in virtual time over a modelled network. Throws
/// ProgramError for what prevents it (no device, a scene or path that does not load) and Interrupted when
/// told to stop.
PointResult run_point(const PointSettings& settings, const PointOutputs& outputs);

}  // namespace atlaswire::lab
