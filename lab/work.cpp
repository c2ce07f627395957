#include "lab/work.h"

#include <ctime>

namespace atlaswire::lab {

Work work_now() {
  std::timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return {.wall = steady_now().time_since_epoch(),
          .cpu = std::chrono::seconds(used.tv_sec) + std::chrono::nanoseconds(used.tv_nsec)};
}

}  // namespace atlaswire::lab
