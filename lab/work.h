#pragma once

#include "base/time.h"

namespace atlaswire::lab {

/// What a stage took, or what was taken since some zero: time on the wall, and processor time of all threads
/// of this process, which other load on the machine changes little. A device that is no CPU is not in `cpu`.
struct Work {
  Duration wall{};
  Duration cpu{};

  Work& operator+=(const Work& other) {
    wall += other.wall;
    cpu += other.cpu;
    return *this;
  }
  friend Work operator-(const Work& a, const Work& b) {
    return {.wall = a.wall - b.wall, .cpu = a.cpu - b.cpu};
  }
};

/// Both clocks of this process.
Work work_now();

}  // namespace atlaswire::lab
