#pragma once

#include "base/result.h"
#include "codec/meta_update.h"

#include <filesystem>
#include <vector>

namespace atlaswire::bench {

/// The meta updates of one stream, frame after frame, as its server made them: what codecs are compared on.
struct MetaRecording {
  codec::MetaLimits limits;
  std::vector<codec::MetaUpdate> updates;
};

/// The file: limits, then each update in the plain form of docs/PROTOCOL.md behind its length.
void write_recording(const MetaRecording& recording, const std::filesystem::path& file);
/// Error: not such a file.
Result<MetaRecording> read_recording(const std::filesystem::path& file);

}  // namespace atlaswire::bench
