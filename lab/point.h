#pragma once

#include "base/units.h"

#include <cstdint>
#include <string>

namespace atlaswire::lab {

/// Everything that decides one measured run: equal points give equal figures on one machine and commit. The
/// members are the keys of experiment files (docs/LAB.md), under the same names.
struct PointSettings {
  // What is seen, and how.
  std::string scene = "atrium";  ///< built-in name or .glb file
  std::string path = "atrium";   ///< built-in name or .csv file
  double seconds = 10;           ///< of the path, > 0
  Extent2D display{960, 540};    ///< pixels of one eye's view
  double horizontal_fov = 90;    ///< degrees ([SAS] 5), 1..170
  bool stereo = false;           ///< two eyes; every method's bytes then carry both ([SAS] 5.8)
  double ipd = 0.064;            ///< metres between the eyes
  std::string lens = "none";     ///< that view and truth are corrected for ([SAS] 3.6): render::parse_lens()
  // The method, and what it trades.
  std::string method = "sas";               ///< "sas", "atw", "mesh" or "iterative"
  std::string depth = "free";               ///< of mesh and iterative: "free" (exact, no bytes) or "coded"
  bool predict = false;                     ///< warps render for the pose expected at display time
  Extent2D atlas{2048, 2048};               ///< texels (sas)
  std::uint32_t views = 5;                  ///< visible sets united a frame, at most (sas)
  double prediction_step_ms = 1000.0 / 30;  ///< between them (sas)
  std::uint32_t hold_frames = 4;            ///< that a patch stays visible after it was last seen (sas)
  double fov_scale = 1.2;                   ///< enlargement of the server's view, >= 1
  double id_scale = 1;                      ///< id pixels per display pixel along a side (sas)
  double max_oversampling = 4;              ///< texels a pixel may get while the atlas has room, 1..8 (sas)
  double foveation = 0;                ///< octaves of atlas area lost per radian from the view axis (sas)
  std::string strategy = "S0";         ///< of the atlas's memory: render::strategies() (sas)
  std::uint32_t reshade_interval = 1;  ///< frames (sas)
  std::uint32_t grid_bits = 0;         ///< of the replica's grid; 0: suited to the scene (sas)
  std::string meta_codec = "mirror";   ///< how geometry travels: "mirror", "gate" or "plain" (sas)
  bool foresee_motion = false;         ///< what moves is shown where it will be at its picture's display
  std::uint32_t new_patches = 0;       ///< a frame may show for the first time; 0: all (sas)
  // Time and network.
  double server_hz = 30;   ///< frames a second
  double client_hz = 120;  ///< displayed frames a second
  double latency_ms = 0;   ///< from a pose to its frame on the client, processing included; without `profile`
  std::string profile;     ///< netsim profile: real sessions over a modelled network instead of `latency_ms`
  double server_ms = 0;    ///< processing time that a server frame takes; with `profile`
  double client_ms = 0;    ///< decoding time that a client frame takes; with `profile`
  std::uint64_t seed = 1;  ///< of the network
  // Coding.
  double bitrate_mbps = 0;  ///< of all channels together; 0: pictures are not coded
  int qp = -1;              ///< 0..51: constant quantizer instead of a bit rate; -1: by `bitrate_mbps`
  std::string preset = "ultrafast";   ///< of x264
  std::uint32_t intra_interval = 30;  ///< frames from I-frame to I-frame; [SAS] 5.8 has 5
  // What is measured.
  std::uint32_t measure_every = 8;  ///< displayed frames from one compared with the truth to the next
  bool measure_flip = true;         ///< FLIP as well, the slowest of the metrics
  // Causes switched off, one at a time, to tell how much each costs (sas).
  bool foresight = false;         ///< no holes: visible sets from the poses that will be displayed
  bool shade_at_display = false;  ///< no stale shading: shaded for the pose that will be displayed
};

}  // namespace atlaswire::lab
