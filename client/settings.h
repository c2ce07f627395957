#pragma once

#include "base/emphasis.h"
#include "base/host_port.h"
#include "base/log.h"
#include "base/time.h"
#include "base/units.h"
#include "render/image/lens_correction.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace atlaswire::client {

/// Everything atlas-client can be told.
struct ClientSettings {
  HostPort server{"127.0.0.1", 7400};
  Duration wait = std::chrono::seconds(5);  ///< for a server to listen

  std::string path;  ///< CSV file or built-in name; empty: the built-in one of the server's scene
  Extent2D size{960, 540};
  double vertical_fov = 1.0471975511965976;      ///< radians
  bool stereo = false;                           ///< two eyes, each with `size` pixels, side by side
  double ipd = 0.064;                            ///< metres between the eyes, with `stereo`
  render::LensCorrection lens;                   ///< of each eye
  double rate = 60;                              ///< displayed frames a second; 0: as many as can be
  double pose_rate = 60;                         ///< tracker samples sent a second
  Duration duration = std::chrono::seconds(10);  ///< from the first displayed pair; 0: until interrupted
  Duration warm_up = std::chrono::seconds(1);    ///< of it, left out of the statistics

  std::filesystem::path out;  ///< empty: no files
  std::uint32_t png_every = 0;
  std::string reference;  ///< scene; empty: no comparison
  std::uint32_t samples = 12;
  bool at_server_pose = false;

  std::optional<Extent2D> wanted_atlas;
  std::optional<BitRate> wanted_bit_rate;
  std::optional<double> wanted_frame_rate;
  std::optional<Emphasis> emphasis;  ///< nullopt: as the server has it
  Duration emphasis_after{};         ///< from the server's answer to telling it

  std::string device = "auto";
  bool validation = false;
  std::uint32_t decoder_threads = 1;

  bool json = false;   ///< summary as JSON on stdout
  bool quiet = false;  ///< no table, no progress
  bool verbose = false;
  LogSettings log;
};

/// What the command line asks for: a run, or a text to print.
struct Options {
  bool run = true;
  ClientSettings settings;
  std::string text;  ///< help or version
};

/// Throws ProgramError(kUsage) that names the option and what it allows.
Options parse_options(int argc, const char* const* argv);

}  // namespace atlaswire::client
