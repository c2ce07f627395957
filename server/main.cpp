#include "base/log.h"
#include "base/program.h"
#include "render/gpu/open_device.h"
#include "render/scene/load.h"
#include "server/atlas_source.h"
#include "server/daemon.h"
#include "server/mirror.h"
#include "server/ready_file.h"

#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <memory>

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

void explain_scene(const std::string& name) {
  const auto scene = open_scene(name);
  std::printf("scene '%s'\n", scene->name.c_str());
  for (const std::string& line : render::explain(scene->requirements)) std::printf("  %s\n", line.c_str());
}

void serve(const server::DaemonSettings& settings) {
  // In the order of what fails cheapest: the port, the scene, the device, the encoder.
  const server::ReadyFile ready(settings.ready_file);
  server::Daemon daemon(settings);
  const Time begun = steady_now();
  const auto scene = open_scene(settings.scene);
  const auto device = render::open_device({settings.device, settings.validation});
  spdlog::info("scene '{}': {} patches of {} triangles; device '{}'", scene->name, scene->patches.size(),
               scene->requirements.triangles, render::device_name(*device));
  server::AtlasSource source(settings.stream, *device, scene);
  spdlog::info("warm after {:.1f} s, encoder {}", to_seconds(steady_now() - begun), source.encoder_name());
  if (settings.print_sdp) {
    std::fputs(server::mirror_sdp(*settings.mirror, scene->name, source.parameter_sets()).c_str(), stdout);
    std::fflush(stdout);
  }
  daemon.serve(source, [&] { ready.write(daemon.port()); });
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
    explain_scene(options.settings.scene);
  } else {
    serve(options.settings);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // Whoever reads our output may go before us.
  std::signal(SIGPIPE, SIG_IGN);
  return run_program("atlasd", argc, argv, body);
}
