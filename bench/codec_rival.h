#pragma once

#include "bench/increment.h"
#include "bench/meta_recording.h"
#include "bench/motion_rival.h"
#include "codec/meta_update.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace atlaswire::bench {

/// Octets of one update: additions and removals, and apart from them what says where and how patches are
/// shaded and drawn (blocks, drawing classes).
struct UpdateCost {
  std::size_t mesh = 0;
  std::size_t blocks = 0;
};

using MotionRivals = std::vector<std::unique_ptr<MotionRival>>;

/// One codec in the comparison: both ends of one stream.
class CodecRival {
 public:
  virtual ~CodecRival() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// The next update, kept for `decode`.
  virtual void encode(const Increment& increment) = 0;
  /// Of the last update; of a message that holds both all is mesh, until `split`.
  [[nodiscard]] virtual UpdateCost cost() const = 0;
  /// Parts what each update of the run took, for a codec whose messages hold both. Behind the run: it is work
  /// of its own, and would push the codec out of the caches.
  virtual void split(const std::vector<codec::MetaUpdate>&, std::vector<UpdateCost>&) const {}
  /// Decodes the last update. Throws std::runtime_error where that fails.
  virtual void decode() = 0;
  /// What was decoded, until `place`; of a codec of meshes alone what was told.
  [[nodiscard]] virtual const codec::MetaUpdate& heard() const = 0;
  /// Throws std::runtime_error unless what was decoded is what was told. Once an update, before `place`.
  virtual void check() = 0;
  /// What a receiver does besides to know where blocks lie. Throws std::runtime_error where that fails.
  virtual void place() {}
  /// How it tells motion; of several it has the one that takes the fewest bytes.
  [[nodiscard]] virtual MotionRivals motions(const RecordedMotion& motion) const = 0;
};

/// Structs as a program holds them: a vertex is an id and three floats, a corner and a patch an id of 32
/// bits.
std::unique_ptr<CodecRival> make_naive_rival();
/// Draco at its smallest (edgebreaker, speed 0, whole numbers), each increment a mesh; removals, blocks and
/// classes as columns through zstd-19 with history. How the faces of its reordered mesh form patches is not
/// counted: a bound from below.
std::unique_ptr<CodecRival> make_draco_rival();
/// meshoptimizer's vertex and index codecs, each increment a mesh, and the columns, through zstd-19 with
/// history; the grouping of faces not counted either.
std::unique_ptr<CodecRival> make_meshopt_rival();
/// One of the stream's own forms. kMirror decodes and runs the atlas's memory, which must come to the layout
/// that the server had.
std::unique_ptr<CodecRival> make_own_rival(codec::MetaCodecKind kind, const MetaRecording& recording);

/// Octets of a mesh at Draco's smallest.
std::size_t draco_size(const std::vector<GridPosition>& positions, const std::vector<std::uint32_t>& indices);

}  // namespace atlaswire::bench
