// Measures the atlas's memory on recorded walks: what [SAS] 5.4 and fig. 11 show, what hysteresis keeps
// still, and pictures of the layout. `atlas_memory --help` lists the commands; docs/EXPERIMENTS.md has the
// tables.
#include "base/program.h"
#include "bench/level_stream.h"
#include "codec/video.h"
#include "render/atlas/strategy.h"
#include "render/atlas/usage_overlay.h"
#include "render/image/png.h"
#include "server/intra_schedule.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <map>

namespace {

using namespace atlaswire;
using render::Strategy;

struct Options {
  std::string scene = "atrium";
  std::string path = "atrium";
  std::uint32_t frames = 300;
  std::string out;
  std::vector<std::string> levels;
  std::uint32_t side = 2048;
  std::uint32_t intra = codec::VideoEncoderSettings{}.intra_interval;
  double fill = render::LevelSettings{}.target_fill;
  double high_water = render::AllocatorSettings{}.high_water;
  std::string strategy = "S0";
  std::string colours = "level";
};

render::LevelSettings level_settings(const Options& o, std::uint32_t patch_count) {
  render::LevelSettings s;
  s.allocator = bench::daemon_atlas({o.side, o.side}, patch_count);
  s.allocator.high_water = o.high_water;
  s.target_fill = o.fill;
  return s;
}

std::string stem(const std::string& file) { return std::filesystem::path(file).stem().string(); }

/// Whether a patch has no block, or a smaller one than it asked for.
bool out_of_memory(const std::vector<render::BlockRequest>& requests,
                   const std::vector<render::PlacedPatch>& blocks) {
  if (blocks.size() != requests.size()) return true;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::uint32_t wanted = requests[i].width_log2 + std::uint32_t{requests[i].height_log2};
    if (blocks[i].block.width_log2 + std::uint32_t{blocks[i].block.height_log2} != wanted) return true;
  }
  return false;
}

/// I-frames as a stream has them: by rule, and early ones where memory needs them.
class IntraFrames {
 public:
  explicit IntraFrames(const Options& o) : atlas_{o.side, o.side}, schedule_({.interval = o.intra}) {}

  /// Is the next frame of this allocator one?
  bool next(const render::AtlasAllocator& allocator) {
    if (render::reset_is_urgent(allocator, atlas_)) schedule_.ask_for_memory();
    const bool intra = schedule_.next();
    count_ += intra ? 1 : 0;
    return intra;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  Extent2D atlas_;
  server::IntraSchedule schedule_;
  std::uint32_t count_ = 0;
};

struct Classes {
  std::array<double, 5> shares{};  ///< allocated, tails, stacks, inaccessible, free; percent of the atlas
  std::uint32_t short_frames = 0;
  std::uint32_t resets = 0;
  std::uint32_t intra_frames = 0;
};

Classes measure_classes(const std::vector<std::vector<render::BlockRequest>>& frames, std::uint32_t patches,
                        Strategy strategy, const Options& o) {
  const render::LevelSettings settings = level_settings(o, patches);
  const auto allocator = render::make_allocator(strategy, settings.allocator, patches);
  Classes sum;
  IntraFrames intra(o);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    sum.resets += allocator->update(frames[i], intra.next(*allocator)).reset ? 1 : 0;
    sum.short_frames += out_of_memory(frames[i], allocator->blocks()) ? 1 : 0;
    const render::AtlasUsage u = allocator->usage();
    const std::array texels{u.allocated, u.partial_tail, u.on_stacks, u.inaccessible, u.free};
    for (std::size_t k = 0; k < texels.size(); ++k) {
      sum.shares[k] += 100.0 * static_cast<double>(texels[k]) / static_cast<double>(frames.size()) /
                       static_cast<double>(settings.allocator.atlas.area());
    }
  }
  sum.intra_frames = intra.count();
  return sum;
}

void classes(const Options& o) {
  std::printf(
      "scene,strategy,allocated,tails,stacks,inaccessible,free,out_of_memory_frames,resets,intra_frames,"
      "frames\n");
  for (const std::string& file : o.levels) {
    const bench::LevelStream stream = bench::load_levels(file);
    const auto frames = bench::requests_of(stream, level_settings(o, stream.patch_count));
    for (const Strategy strategy : render::strategies()) {
      if (strategy == Strategy::kRepack) continue;  // needs no memory management
      const Classes c = measure_classes(frames, stream.patch_count, strategy, o);
      std::printf("%s,%s", stem(file).c_str(), std::string(render::name_of(strategy)).c_str());
      for (const double share : c.shares) std::printf(",%.1f", share);
      std::printf(",%u,%u,%u,%zu\n", c.short_frames, c.resets, c.intra_frames, frames.size());
    }
  }
}

/// Blocks that a walk moves: patches that stay visible, but are given another place or size.
void moves(const Options& o) {
  std::printf(
      "scene,hysteresis,moved_per_frame,kept_visible_per_frame,unmoved_percent,unmoved_texels_percent\n");
  for (const std::string& file : o.levels) {
    const bench::LevelStream stream = bench::load_levels(file);
    for (const double hysteresis : {0.0, 0.125, 0.25, 0.5, 1.0}) {
      render::LevelSettings settings = level_settings(o, stream.patch_count);
      settings.hysteresis = hysteresis;
      const auto frames = bench::requests_of(stream, settings);
      const auto allocator = render::make_allocator(Strategy::kS0, settings.allocator, stream.patch_count);
      IntraFrames intra(o);
      std::map<PatchId, Block> before;
      double moved = 0;
      double kept = 0;
      double unmoved_texels = 0;
      double texels = 0;
      for (const auto& frame : frames) {
        allocator->update(frame, intra.next(*allocator));
        std::map<PatchId, Block> now;
        for (const render::PlacedPatch& p : allocator->blocks()) {
          now.emplace_hint(now.end(), p.patch, p.block);
          const auto was = before.find(p.patch);
          if (was == before.end()) continue;
          const bool same = was->second == p.block;
          moved += same ? 0 : 1;
          kept += 1;
          texels += p.block.area();
          unmoved_texels += same ? p.block.area() : 0;
        }
        before = std::move(now);
      }
      const auto n = static_cast<double>(frames.size() - 1);
      std::printf("%s,%.3f,%.1f,%.0f,%.2f,%.2f\n", stem(file).c_str(), hysteresis, moved / n, kept / n,
                  100 * (1 - moved / kept), 100 * unmoved_texels / texels);
    }
  }
}

void overlay(const Options& o) {
  const bench::LevelStream stream = bench::load_levels(o.levels.front());
  const render::LevelSettings settings = level_settings(o, stream.patch_count);
  const auto frames = bench::requests_of(stream, settings);
  const auto strategy = render::find_strategy(o.strategy);
  if (!strategy) throw ProgramError(ExitCode::kUsage, "--strategy: S0, S1, S2, S3, quadtree or repack");
  const auto allocator = render::make_allocator(*strategy, settings.allocator, stream.patch_count);
  render::UsageOverlay picture(settings.allocator.atlas, settings.allocator.superblock_log2);
  IntraFrames intra(o);
  for (const auto& frame : frames) {
    picture.observe(allocator->update(frame, intra.next(*allocator)));
  }
  const std::map<std::string, render::LayoutColours> colours{{"class", render::LayoutColours::kClass},
                                                             {"level", render::LayoutColours::kLevel},
                                                             {"age", render::LayoutColours::kAge}};
  const auto written = render::write_png(picture.picture(colours.at(o.colours)), o.out);
  if (!written) throw ProgramError(ExitCode::kCannotWrite, written.error().message());
}

int body(int argc, char** argv) {
  Options o;
  CLI::App app("Measures the atlas's memory on recorded walks");
  app.require_subcommand(1);
  auto* record = app.add_subcommand("record", "Walk through a scene and keep what its patches want");
  record->add_option("--scene", o.scene, "Built-in scene or glTF file");
  record->add_option("--path", o.path, "Built-in path or CSV");
  record->add_option("--frames", o.frames, "At 30 a second; the path is walked back and forth");
  record->add_option("--out", o.out, "File")->required();
  const auto measuring = [&](const char* name, const char* what) {
    auto* command = app.add_subcommand(name, what);
    command->add_option("levels", o.levels, "Recorded walks")->required();
    command->add_option("--atlas", o.side, "Texels a side, a multiple of 64")->check(CLI::Range(64U, 16384U));
    command->add_option("--intra", o.intra, "Frames from one I-frame to the next")
        ->check(CLI::Range(1U, 1000U));
    command->add_option("--fill", o.fill, "Share of the atlas that the bias aims at");
    command->add_option("--high-water", o.high_water, "Share of superblocks in use that asks for a reset");
    return command;
  };
  auto* classes_command = measuring("classes", "Memory classes by strategy ([SAS] fig. 11), as CSV");
  auto* moves_command = measuring("moves", "Blocks moved by hysteresis, as CSV");
  auto* overlay_command = measuring("overlay", "Picture of the layout at the walk's end");
  overlay_command->add_option("--strategy", o.strategy, "S0, S1, S2, S3, quadtree or repack");
  overlay_command->add_option("--colours", o.colours, "By level, age or class")
      ->check(CLI::IsMember({"level", "age", "class"}));
  overlay_command->add_option("--out", o.out, "PNG")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
  }
  if (*record) bench::save_levels(bench::record_levels(o.scene, o.path, o.frames), o.out);
  if (*classes_command) classes(o);
  if (*moves_command) moves(o);
  if (*overlay_command) overlay(o);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_program("atlas_memory", argc, argv, body); }
