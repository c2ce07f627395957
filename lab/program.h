#pragma once

#include "lab/point_process.h"

namespace atlaswire::lab {

/// atlas-lab whole, but for what measures one point: that is given, so that tests put a stand-in. For
/// run_program().
int run_lab(int argc, char** argv, const PointRunner& measure);

}  // namespace atlaswire::lab
