#pragma once

#include "render/scene/rig.h"

#include <span>

namespace atlaswire::render {

/// A channel's value at a time in seconds, `channel.width` numbers: glTF 2.0, appendix C. Before the first
/// key and after the last it stays theirs. Rotations are unit; linear ones go the shorter way round at even
/// speed.
void sample(const RigChannel& channel, double seconds, std::span<double> out);

}  // namespace atlaswire::render
