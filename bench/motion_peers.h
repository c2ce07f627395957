#pragma once

#include "base/bytes.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace atlaswire::bench {

/// Numbers on a grid that change from frame to frame, in rows of `width`, by some public means. Both ends in
/// one; each remembers its own past.
class MotionPeer {
 public:
  virtual ~MotionPeer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  virtual void encode(std::span<const std::int32_t> numbers, ByteBuffer& out) = 0;
  /// What comes out has as many numbers as went in.
  virtual void decode(ByteView bytes, std::span<std::int32_t> numbers) = 0;
};

/// What packs the differences: zstd (which remembers earlier frames), meshoptimizer's vertex codec and zstd,
/// or a Draco point cloud in order, of rows of 3.
enum class MotionPacking { kZstd, kMeshopt, kDraco };

/// Differences in time of an order, packed. Rows may be added behind those before; they start from zeros.
/// `order` 0: the numbers as they are; 1 and 2: less what the last one or two frames let expect.
std::unique_ptr<MotionPeer> make_motion_peer(MotionPacking packing, int order, std::uint32_t width);

/// Every peer: differences in time of first and second order with zstd (which remembers earlier frames),
/// those with meshoptimizer's vertex codec and zstd, and (for width 3) Draco point clouds in order, of
/// positions and of second-order differences.
std::vector<std::unique_ptr<MotionPeer>> make_motion_peers(std::uint32_t width);

}  // namespace atlaswire::bench
