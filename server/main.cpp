#include "base/log.h"
#include "base/program.h"
#include "render/gpu/open_device.h"
#include "render/scene/load.h"
#include "render/scene/surface_priorities.h"
#include "server/atlas_source.h"
#include "server/daemon.h"
#include "server/mirror.h"
#include "server/ready_file.h"
#include "server/replica_tracker.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace atlaswire;

std::shared_ptr<const render::Scene> open_scene(const std::string& name) {
  auto scene = render::load_scene(name);
  if (!scene) throw ProgramError(ExitCode::kBadScene, "--scene " + name + ": " + scene.error().message());
  return std::make_shared<const render::Scene>(std::move(*scene));
}

void print_devices() {
  const auto devices = render::list_devices();
  if (devices.empty()) {
    throw ProgramError(ExitCode::kNoDevice,
                       "no Vulkan device: install mesa-vulkan-drivers or a GPU's driver");
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto& device = devices[i];
    const std::string state = device.missing.empty() ? "" : ", unusable: lacks " + device.missing;
    std::printf("%zu: %s (%s%s)\n", i, device.name.c_str(), device.kind.c_str(), state.c_str());
  }
}

template <class Named>
void print_names(const char* what, const std::vector<Named>& all) {
  std::set<std::string> names;
  for (const Named& one : all) names.insert(one.name);
  names.erase("");
  std::printf("  %zu named %s: %s\n", names.size(), what, fmt::format("{}", fmt::join(names, ", ")).c_str());
}

std::string explain(const PositionGrid& grid) {
  return fmt::format("position grid: {} bits an axis, a step of {:.3g} mm, error at most {:.3g} m", grid.bits,
                     1e3 * grid.step, grid.max_error());
}

void explain_scene(const std::string& name, std::uint32_t grid_bits) {
  const auto scene = open_scene(name);
  std::printf("scene '%s'\n", scene->name.c_str());
  std::printf("  %s\n", explain(server::scene_grid(*scene, grid_bits)).c_str());
  for (const std::string& line : render::explain(scene->requirements)) std::printf("  %s\n", line.c_str());
  print_names("materials", scene->materials);
  print_names("objects", scene->objects);
}

void warn_of_unknown(const render::Scene& scene, const Emphasis& emphasis) {
  for (const std::string& name : render::unknown_surfaces(scene, emphasis)) {
    spdlog::warn("--priority {}: the scene has no such material or object; --explain-scene lists them", name);
  }
}

void serve(const server::DaemonSettings& settings, const std::function<Emphasis()>& reread) {
  // In the order of what fails cheapest: the port, the scene, the device, the encoder.
  const server::ReadyFile ready(settings.ready_file);
  server::Daemon daemon(settings);
  const Time begun = steady_now();
  const auto scene = open_scene(settings.scene);
  const auto device = render::open_device({settings.device, settings.validation});
  spdlog::info("scene '{}': {} patches of {} triangles; device '{}'", scene->name, scene->patches.size(),
               scene->requirements.triangles, render::device_name(*device));
  server::AtlasSource source(settings.stream, *device, scene);
  spdlog::info("{}", explain(source.description().grid));
  spdlog::info("warm after {:.1f} s, encoder {}", to_seconds(steady_now() - begun), source.encoder_name());
  if (settings.print_sdp) {
    std::fputs(server::mirror_sdp(*settings.mirror, scene->name, source.parameter_sets()).c_str(), stdout);
    std::fflush(stdout);
  }
  warn_of_unknown(*scene, settings.stream.render.emphasis);
  daemon.serve(source, {.on_ready = [&] { ready.write(daemon.port()); }, .reread = reread});
  const auto complaints = render::validation_messages(*device);
  if (!complaints.empty()) {
    throw ProgramError(ExitCode::kInternal, "Vulkan validation found " + std::to_string(complaints.size()) +
                                                " faults, first: " + complaints.front());
  }
}

int body(int argc, char** argv) {
  const server::Options options = server::parse_options(argc, argv);
  if (options.mode == server::Mode::kPrint) {
    std::fputs(options.text.c_str(), stdout);
    return 0;
  }
  set_up_logging("atlasd", options.settings.log);
  if (options.mode == server::Mode::kListDevices) {
    print_devices();
  } else if (options.mode == server::Mode::kExplainScene) {
    explain_scene(options.settings.scene, options.settings.stream.grid_bits);
  } else {
    std::function<Emphasis()> reread;
    if (options.has_config) {
      reread = [=] { return server::parse_options(argc, argv).settings.stream.render.emphasis; };
    }
    serve(options.settings, reread);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // Whoever reads our output may go before us.
  std::signal(SIGPIPE, SIG_IGN);
  return run_program("atlasd", argc, argv, body);
}
