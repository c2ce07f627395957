// atlas-lab with a stand-in for rendering: figures are simple functions of the settings. Two seeds misbehave.
#include "lab/program.h"

#include <poll.h>

#include <fstream>

namespace {

using namespace atlaswire;
using namespace atlaswire::lab;

constexpr std::uint64_t kFailingSeed = 13;
constexpr std::uint64_t kWaitingSeed = 99;

PointResult measure(const PointSettings& s, const PointOutputs& outputs) {
  if (s.seed == kFailingSeed) throw ProgramError(ExitCode::kNoDevice, "no device of this kind");
  outputs.progress(0.5);
  if (s.seed == kWaitingSeed) {
    std::ofstream(outputs.pictures / "waiting") << "until told to stop";
    while (!outputs.should_stop()) poll(nullptr, 0, 5);
    throw Interrupted{};
  }
  const bool sas = s.method == "sas";
  const double mssim = sas ? 0.95 - 0.0002 * s.latency_ms : 0.99 - 0.001 * s.latency_ms;
  const double mbps = s.bitrate_mbps == 0 ? 20 : s.bitrate_mbps;
  PointResult result;
  result.figures = {
      {"mssim", mssim - 0.1 / mbps}, {"total_mbps", mbps}, {"atlas_used", sas ? 0.5 : kNotApplicable}};
  result.timings = {{"server_frame_ms", 10}};
  result.frames = {{.t_s = 0.5, .mssim = mssim}, {.t_s = 1, .mssim = mssim, .holes = 0}};
  result.facts = {{"device", "paper and pencil"}};
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("atlas-lab", argc, argv,
                     [](int count, char** words) { return run_lab(count, words, measure); });
}
