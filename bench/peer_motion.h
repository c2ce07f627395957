#pragma once

#include "bench/motion_peers.h"
#include "bench/motion_rival.h"

namespace atlaswire::bench {

/// All known vertices as differences in time, packed; objects alike, with zstd, which packs them smallest.
std::unique_ptr<MotionRival> make_peer_motion(MotionPacking packing, int order);

}  // namespace atlaswire::bench
