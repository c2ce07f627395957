#pragma once

#include "base/bytes.h"
#include "bench/increment.h"

namespace atlaswire::bench {

/// What codecs of meshes alone leave open, as columns of octets that a general compressor can take on.
/// Which patches go: varints of places skipped and run lengths.
void write_removals(const Increment& increment, ByteBuffer& out);
/// Which patches move, and each moved and added patch's block and drawing class.
void write_blocks(const Increment& increment, ByteBuffer& out);

}  // namespace atlaswire::bench
