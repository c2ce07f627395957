#pragma once

#include "bench/meta_recording.h"

namespace atlaswire::bench {

/// A strip of 20 quads that waves and one quad that turns as an object, beside one that rests. From frame 4
/// on the strip's first half and the object are out of sight, from frame 7 on back; frame 10 begins anew.
/// Every update has a cue.
MetaRecording moving_recording(std::uint32_t frames);

}  // namespace atlaswire::bench
