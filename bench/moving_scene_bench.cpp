#include "render/gpu/device.h"
#include "render/gpu/open_device.h"
#include "render/passes/scene_gpu.h"
#include "render/scene/assemble.h"
#include "render/scene/moved_scene.h"
#include "render/scene/parade.h"

#include <benchmark/benchmark.h>

#include <memory>

/// What animating a frame costs the server: posing on the host, and with it copying what moved to the device
/// and drawing the shadow map. Of the built-in parade (0), and of one with 8 figures, 4 cloths and 64 solids
/// (1). Processor time is the whole process's, so that a software device's threads count.

namespace atlaswire::bench {
namespace {

std::shared_ptr<const render::Scene> parade(const benchmark::State& state, bool sun) {
  render::ParadeOptions options;
  if (state.range(0) == 1) options = {.figures = 8, .cloths = 4, .orbiters = 64};
  render::SceneSource source = render::make_parade(options);
  if (!sun) source.sun.color = glm::vec3(0.0F);
  return std::make_shared<const render::Scene>(render::assemble(std::move(source)).value());
}

void count(benchmark::State& state, const render::Scene& scene) {
  std::size_t points = 0;
  std::size_t triangles = 0;
  for (const render::MovingPart& part : scene.motion->parts) {
    points += part.positions.count;
    triangles += part.triangles.count;
  }
  state.counters["moving_points"] = static_cast<double>(points);
  state.counters["moving_triangles"] = static_cast<double>(triangles);
}

void pose(benchmark::State& state) {
  const auto scene = parade(state, true);
  render::MovedScene moved(scene);
  double seconds = 0;
  for (auto _ : state) moved.pose(seconds += 1.0 / 30);
  count(state, *scene);
}

void move(benchmark::State& state, bool sun) {
  const auto scene = parade(state, sun);
  const auto device = render::open_device({});
  render::SceneGpu on_device(*device, scene);
  double seconds = 0;
  for (auto _ : state) on_device.move_to(seconds += 1.0 / 30);
  count(state, *scene);
}

BENCHMARK(pose)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(move, with_shadows, true)
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(move, without_sun, false)
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace atlaswire::bench

BENCHMARK_MAIN();
