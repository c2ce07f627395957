#pragma once

#include "base/mover.h"
#include "base/result.h"
#include "codec/meta_update.h"
#include "codec/motion.h"
#include "proto/stream_description.h"

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace atlaswire::bench {

/// Where the movers in scope are to be in one frame. Who they are and their order follow from the updates
/// (codec::MoverScope).
struct MoverPlaces {
  std::vector<glm::dvec3> positions;  ///< of the scope's vertices, in the scene, metres
  std::vector<codec::RigidTransform> transforms;
};

/// What moves in a recorded stream.
struct RecordedMotion {
  codec::MotionSettings settings;
  std::vector<Mover> movers;
  std::vector<MoverPlaces> frames;  ///< one an update
};

/// The meta updates of one stream, frame after frame, as its server made them: what codecs are compared on.
struct MetaRecording {
  codec::MetaLimits limits;
  proto::AtlasMemory memory;               ///< for updates with cues
  std::vector<codec::MetaUpdate> updates;  ///< all with cues or none
  std::optional<RecordedMotion> motion;    ///< of a scene that moves
};

/// The file: a magic number, limits, memory and movers, then each update in the plain form of
/// docs/PROTOCOL.md behind its cue and length, and behind it its movers' places.
void write_recording(const MetaRecording& recording, const std::filesystem::path& file);
/// Error: not such a file, or cut off.
Result<MetaRecording> read_recording(const std::filesystem::path& file);

}  // namespace atlaswire::bench
