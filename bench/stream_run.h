#pragma once

#include "bench/codec_rival.h"
#include "bench/meta_recording.h"

#include <string>

namespace atlaswire::bench {

/// What one codec takes for one stream: the first update, and the means of those behind it. Octets; ms of
/// this thread's processor time.
struct Row {
  std::string stream;
  std::string codec;
  UpdateCost first;
  double first_motion = 0;
  double first_encode = 0;  ///< motion included, here and below
  double first_decode = 0;
  double mesh = 0;  ///< a frame
  double blocks = 0;
  double motion = 0;
  double bits_a_triangle = 0;  ///< of mesh octets, first update included
  double encode = 0;
  double encode_p95 = 0;
  double decode = 0;
  double decode_p95 = 0;
  double motion_encode = 0;  ///< of it motion's
  double motion_decode = 0;

  [[nodiscard]] double first_all() const {
    return static_cast<double>(first.mesh + first.blocks) + first_motion;
  }
  [[nodiscard]] double all() const { return mesh + blocks + motion; }
};

/// Sends a recording through a codec and checks what comes out. Throws std::runtime_error where it differs
/// from what went in.
Row run_stream(CodecRival& rival, const std::string& stream, const MetaRecording& recording);

}  // namespace atlaswire::bench
