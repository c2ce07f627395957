#pragma once

#include "bench/meta_recording.h"
#include "codec/mover_scope.h"
#include "codec/mover_watch.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace atlaswire::bench {

/// What moves in one frame, in each form that a rival may want. Everything is borrowed.
struct MotionStep {
  const codec::MetaUpdate* update = nullptr;
  const codec::MoverScope* scope = nullptr;  ///< after `update`
  const MoverPlaces* places = nullptr;       ///< of the scope
  /// 3 for each vertex known since the last reset, in or out of scope: grid steps from where it rests. Those
  /// out of scope stay as last told, so that nobody need be told who they are.
  std::vector<std::int32_t> vertices;
  std::vector<std::int32_t> objects;  ///< 7 for each object: codec::GridTransform's numbers
};

/// Follows a recording's movers; no codec's time is spent here.
class MotionFollower {
 public:
  /// Borrows the motion.
  explicit MotionFollower(const RecordedMotion& motion);
  /// The step of the next update; borrows it, valid until the next call. Throws std::runtime_error where the
  /// recording contradicts itself.
  const MotionStep& next(const codec::MetaUpdate& update);

 private:
  const RecordedMotion* motion_;
  codec::MoverWatch watch_;
  codec::MoverScope scope_;
  std::vector<std::int32_t> rest_;  ///< MotionStep::objects
  std::size_t frame_ = 0;
  MotionStep step_;
};

/// One way to tell what a mesh codec does not: where what moves is. Both ends of one stream.
class MotionRival {
 public:
  virtual ~MotionRival() = default;
  /// The next step, kept for `decode` and `check`.
  virtual void encode(const MotionStep& step) = 0;
  /// Octets of the last step.
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Decodes the last step behind the update that came with it. Throws std::runtime_error where that fails.
  virtual void decode(const codec::MetaUpdate& heard) = 0;
  /// Throws std::runtime_error unless what was decoded last is what was told, on the grid if it has one.
  virtual void check(const MotionStep& step) const = 0;
};

/// Of each vertex in scope its id and three floats, of each object its number and seven.
std::unique_ptr<MotionRival> make_naive_motion();
/// The same on the grid, ids and numbers as differences to the entry before in exponential-Golomb codes:
/// [SAS] has no motion, but these are its means.
std::unique_ptr<MotionRival> make_paper_motion(const RecordedMotion& motion);
/// codec::MotionEncoder; each end finds the scope by itself, within the time it takes.
std::unique_ptr<MotionRival> make_own_motion(const RecordedMotion& motion);

}  // namespace atlaswire::bench
