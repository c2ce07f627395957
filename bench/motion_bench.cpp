// What motion costs: ours beside public codecs on the same frames of the parade, in one run, as a table.
#include "base/program.h"
#include "bench/motion_peers.h"
#include "bench/moving_surface.h"
#include "codec/motion.h"
#include "render/scene/parade.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <ctime>
#include <functional>

using namespace atlaswire;

namespace {

struct Options {
  std::uint32_t figures = 4;
  std::uint32_t cloths = 0;
  std::uint32_t orbiters = 0;
  double rate = 60;
  double seconds = 4;
  std::uint32_t grid_bits = 16;
  std::uint32_t rotation_bits = 14;
};

/// Everything that is told, frame by frame.
struct Frames {
  std::vector<std::vector<glm::dvec3>> positions;
  std::vector<std::vector<codec::RigidTransform>> transforms;
};

/// Of one codec over all frames but the first, in which nothing has a past yet.
struct Cost {
  std::size_t bits = 0;
  double encoding = 0;  ///< seconds of processor time
  double decoding = 0;
};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void print(const std::string& name, const Cost& cost, std::size_t frames, std::size_t things) {
  const double each = static_cast<double>(frames);
  fmt::print("| {} | {:.2f} | {:.0f} | {:.2f} / {:.2f} |\n", name,
             static_cast<double>(cost.bits) / each / static_cast<double>(things),
             static_cast<double>(cost.bits) / 8 / each, 1e3 * cost.encoding / each,
             1e3 * cost.decoding / each);
}

/// Encodes and decodes every frame; `encode` and `decode` are timed.
Cost measure(std::size_t frames, const std::function<void(std::size_t, ByteBuffer&)>& encode,
             const std::function<void(std::size_t, ByteView)>& decode) {
  Cost cost;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    ByteBuffer message;
    const double start = processor_seconds();
    encode(frame, message);
    const double encoded = processor_seconds();
    decode(frame, message);
    const double decoded = processor_seconds();
    if (frame == 0) continue;
    cost.bits += 8 * message.size();
    cost.encoding += encoded - start;
    cost.decoding += decoded - encoded;
  }
  return cost;
}

void check(bool good) {
  if (!good) throw ProgramError(ExitCode::kInternal, "what was decoded is not what was told");
}

void measure_peers(std::uint32_t width, const std::vector<std::vector<std::int32_t>>& numbers) {
  for (const auto& peer : bench::make_motion_peers(width)) {
    std::vector<std::int32_t> heard(numbers[0].size());
    const Cost cost = measure(
        numbers.size(), [&](std::size_t f, ByteBuffer& out) { peer->encode(numbers[f], out); },
        [&](std::size_t f, ByteView bytes) {
          peer->decode(bytes, heard);
          check(heard == numbers[f]);
        });
    print(peer->name(), cost, numbers.size() - 1, heard.size() / width);
  }
}

void measure_ours(const codec::MotionSettings& settings, const codec::MotionScope& scope,
                  const Frames& frames) {
  for (const bool fits : {false, true}) {
    codec::MotionEncoder encoder(settings, fits);
    codec::MotionDecoder decoder(settings);
    const std::size_t count = std::max(frames.positions.size(), frames.transforms.size());
    if (!fits && scope.vertices.empty()) continue;
    const Cost cost = measure(
        count,
        [&](std::size_t f, ByteBuffer& out) {
          codec::MotionTargets targets;
          if (!scope.vertices.empty()) targets.positions = frames.positions[f];
          if (!scope.objects.empty()) targets.transforms = frames.transforms[f];
          encoder.encode(scope, targets, out).value();
        },
        [&](std::size_t, ByteView bytes) { decoder.decode(scope, bytes).value(); });
    for (std::size_t i = 0; i < scope.vertices.size(); ++i) {
      check(glm::distance(decoder.position(*scope.surface, scope.vertices[i]), frames.positions.back()[i]) <=
            settings.grid.max_error() * (1 + 1e-9));
    }
    print(fits ? "ours" : "ours, weights fixed", cost, count - 1,
          scope.vertices.size() + scope.objects.size());
  }
}

void run(const Options& options) {
  const render::SceneSource source = render::make_parade(
      {.figures = options.figures, .cloths = options.cloths, .orbiters = options.orbiters});
  render::Animator animator(source);
  codec::MotionSettings settings;
  settings.grid = PositionGrid::over(glm::dvec3(-7.0), glm::dvec3(7.0), options.grid_bits);
  settings.transforms = {.step = settings.grid.step, .rotation_bits = options.rotation_bits};
  bench::MovingSurface moving(source, settings.grid);
  std::vector<std::uint32_t> rigid;
  for (std::uint32_t i = 0; i < source.instances.size(); ++i) {
    if (!animator.deforms(i)) rigid.push_back(i);
  }
  Frames frames;
  std::vector<std::vector<std::int32_t>> positions;
  std::vector<std::vector<std::int32_t>> transforms;
  for (int frame = 0; frame < options.seconds * options.rate; ++frame) {
    animator.pose(frame / options.rate);
    moving.positions(animator, frames.positions.emplace_back());
    auto& row = positions.emplace_back();
    for (const glm::dvec3& p : frames.positions.back()) {
      for (int axis = 0; axis < 3; ++axis) {
        row.push_back(static_cast<std::int32_t>(
            std::round((p[axis] - settings.grid.origin[axis]) / settings.grid.step)));
      }
    }
    auto& told = frames.transforms.emplace_back();
    auto& grid_row = transforms.emplace_back();
    for (const std::uint32_t instance : rigid) {
      const Pose motion = animator.rigid_motion(instance).value();
      told.push_back({motion.position, motion.orientation});
      const codec::GridTransform g = settings.transforms.quantize(told.back()).value();
      grid_row.insert(grid_row.end(), {g.translation.x, g.translation.y, g.translation.z});
      grid_row.insert(grid_row.end(), g.rotation.begin(), g.rotation.end());
    }
  }
  fmt::print("\n{} frames at {} Hz; steps of {:.3f} mm and {:.3f} mrad\n\n", positions.size(), options.rate,
             1e3 * settings.grid.step, std::ldexp(1e3, -static_cast<int>(options.rotation_bits)));
  if (!moving.all().empty()) {
    fmt::print("| {} vertices | bits a vertex | bytes a frame | encode / decode ms |\n|---|---|---|---|\n",
               moving.all().size());
    measure_peers(3, positions);
    measure_ours(settings, {&moving.surface(), moving.all(), {}}, frames);
  }
  if (options.orbiters > 0) {
    std::vector<std::uint32_t> numbers(rigid.size());
    for (std::uint32_t i = 0; i < rigid.size(); ++i) numbers[i] = i;
    fmt::print("\n| {} objects | bits an object | bytes a frame | encode / decode ms |\n|---|---|---|---|\n",
               rigid.size());
    measure_peers(7, transforms);
    measure_ours(settings, {nullptr, {}, numbers}, frames);
  }
}

int body(int argc, char** argv) {
  Options options;
  CLI::App app("Bits and milliseconds of motion: ours beside public codecs, on the parade.");
  app.add_option("--figures", options.figures, "walking, skinned")->check(CLI::Range(0, 64));
  app.add_option("--cloths", options.cloths, "waving, morphed")->check(CLI::Range(0, 64));
  app.add_option("--orbiters", options.orbiters, "circling as rigid objects")->check(CLI::Range(0, 64));
  app.add_option("--rate", options.rate, "frames a second")->check(CLI::Range(1.0, 240.0));
  app.add_option("--seconds", options.seconds, "how long")->check(CLI::Range(0.1, 60.0));
  app.add_option("--grid-bits", options.grid_bits, "an axis, over 14 m")->check(CLI::Range(8, 20));
  app.add_option("--rotation-bits", options.rotation_bits, "of an object's orientation")
      ->check(CLI::Range(8, 20));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
  }
  if (options.figures + options.cloths + options.orbiters == 0)
    throw ProgramError(ExitCode::kUsage, "nothing moves: give --figures, --cloths or --orbiters");
  run(options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_program("motion_bench", argc, argv, body); }
