#include "base/assert.h"
#include "lab/experiment.h"
#include "lab/plan.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

/// Experiments are files from anywhere: what parses must also plan, or be refused in one line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace atlaswire;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto experiment = lab::parse_experiment(text, "fuzz");
  if (experiment.has_error()) {
    AW_ASSERT(!experiment.error().message().empty());
    return 0;
  }
  double points = 1;
  for (const lab::Axis& axis : experiment->sweep) points *= static_cast<double>(axis.values.size());
  if (points > 1000) return 0;
  for (const bool quick : {false, true}) {
    const auto plan = lab::make_plan(*experiment, {.quick = quick, .folder = "/nonexistent"});
    if (plan.has_error()) continue;
    for (const lab::PlannedPoint& point : plan->points) AW_ASSERT(!lab::label(point, *plan).empty());
  }
  return 0;
}
