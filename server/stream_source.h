#pragma once

#include "base/bytes.h"
#include "proto/stream_description.h"
#include "server/encoded_frame.h"

#include <memory>

namespace atlaswire::server {

/// Where the daemon gets streams from. Thread-safe; must outlive every runner.
class StreamSource {
 public:
  virtual ~StreamSource() = default;
  /// A stream, warm if one was given back. Throws when none can be made.
  virtual std::unique_ptr<FrameMaker> make() = 0;
  /// A stream whose session ended; may be kept for the next.
  virtual void give_back(std::unique_ptr<FrameMaker> maker) = 0;
  /// What clients are told; the session fills SSRC and codec.
  [[nodiscard]] virtual const proto::StreamDescription& description() const = 0;
  /// SPS and PPS for the SDP, Annex B; empty when not known.
  [[nodiscard]] virtual ByteBuffer parameter_sets() const = 0;
};

}  // namespace atlaswire::server
