#include "base/program.h"
#include "bench/level_stream.h"
#include "render/atlas/strategy.h"
#include "render/atlas_gpu/device_allocator.h"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <memory>

/// [SAS] table 2: one frame's memory management, by the device (with ranked and with atomically drawn slots),
/// the sequential reference and a quadtree, on the same requests: a walk through the built-in scene, or what
/// ATLASWIRE_LEVELS names (a file that atlas_memory records), for the atlas of ATLASWIRE_ATLAS texels a side
/// (2048). Iterations are frames; the walk goes back and forth. `device_ms` is the device's own clock.

namespace atlaswire::bench {
namespace {

using Requests = std::vector<std::vector<render::BlockRequest>>;

struct Load {
  render::AllocatorSettings settings;
  std::uint32_t patch_count = 0;
  Requests requests;
};

Load make_load() {
  const char* file = std::getenv("ATLASWIRE_LEVELS");
  const char* side = std::getenv("ATLASWIRE_ATLAS");
  const auto texels = static_cast<std::uint32_t>(side == nullptr ? 2048 : std::atoi(side));
  const LevelStream stream = file == nullptr ? record_levels("atrium", "atrium", 60) : load_levels(file);
  if (stream.frames.empty()) throw ProgramError(ExitCode::kBadScene, "the level stream has no frame");
  render::LevelSettings levels;
  levels.allocator = daemon_atlas({texels, texels}, stream.patch_count);
  return {levels.allocator, stream.patch_count, requests_of(stream, levels)};
}

const Load& load() {
  static const Load made = make_load();
  return made;
}

/// The frame at a step of a walk back and forth.
const std::vector<render::BlockRequest>& frame_at(const Requests& requests, std::size_t step) {
  const std::size_t turn = requests.size() == 1 ? 1 : 2 * requests.size() - 2;
  const std::size_t at = step % turn;
  return requests[at < requests.size() ? at : turn - at];
}

template <class Allocator>
std::size_t walk(benchmark::State& state, Allocator& allocator) {
  const Requests& requests = load().requests;
  allocator.update(frame_at(requests, 0), true);
  std::size_t step = 1;
  std::size_t changes = 0;
  for (auto _ : state) {
    const auto& change = allocator.update(frame_at(requests, step), step % 5 == 0);
    changes += change.added.size() + change.moved.size() + change.removed.size();
    ++step;
  }
  const auto frames = static_cast<double>(state.iterations());
  state.counters["visible"] = static_cast<double>(allocator.blocks().size());
  state.counters["changes"] = static_cast<double>(changes) / frames;
  return step;
}

void host(benchmark::State& state, render::Strategy strategy) {
  const auto allocator = render::make_allocator(strategy, load().settings, load().patch_count);
  walk(state, *allocator);
}

void device(benchmark::State& state, render::SlotOrder order) {
  static const std::shared_ptr<render::Device> opened = render::open_device({});
  render::DeviceAllocator allocator(*opened, load().settings, load().patch_count, order);
  const std::size_t steps = walk(state, allocator);
  state.counters["device_ms"] = 1000 * to_seconds(allocator.device_time()) / static_cast<double>(steps);
}

/// The same frames for each, so that their mean work is the same.
void same_frames(benchmark::internal::Benchmark* bench) {
  bench->Iterations(600)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(host, sequential, render::Strategy::kS0)->Apply(same_frames);
BENCHMARK_CAPTURE(host, quadtree, render::Strategy::kQuadtree)->Apply(same_frames);
BENCHMARK_CAPTURE(device, ranked, render::SlotOrder::kRanked)->Apply(same_frames);
BENCHMARK_CAPTURE(device, drawn, render::SlotOrder::kDrawn)->Apply(same_frames);

}  // namespace
}  // namespace atlaswire::bench

BENCHMARK_MAIN();
