#pragma once

#include "codec/gate_plan.h"
#include "codec/gate_state.h"
#include "codec/meta_update.h"

namespace atlaswire::codec {

/// How a receiver learns where blocks lie: MetaCodecKind::kGate or kMirror.
enum class BlockPositions : std::uint8_t { kSent, kDerived };

/// MetaCodecKind::kGate, the incremental form: both ends remember every patch that was ever visible and where
/// the known surface ends, so that a patch that comes back is a decision or two, and a new one grows from its
/// neighbours. docs/PROTOCOL.md, "Meta update, gate form".
///
/// What a decoder gives is equivalent, not equal: the same patches with the same positions, drawing and
/// blocks under the same patch ids, but vertices numbered as they came, one for each grid position; and a
/// patch that is removed and added again at once, unchanged, is at most moved.
class GateMetaEncoder final : public MetaEncoder {
 public:
  explicit GateMetaEncoder(const MetaLimits& limits, BlockPositions positions = BlockPositions::kSent);

  /// The update must have a cue if positions are derived, and only then.
  void encode(const MetaUpdate& update, ByteBuffer& out) override;

 private:
  MetaLimits limits_;
  BlockPositions positions_;
  GateState state_;
  GatePlan plan_;
};

/// The other end. A stream out of step, by an update lost or bent, is noticed at the first update that does
/// not match (2^-16 of them pass) and refused with kOutOfStep until one with `reset` comes.
class GateMetaDecoder final : public MetaDecoder {
 public:
  /// `believes_all`: goes on although an update does not match, for a fuzzer cannot guess hashes.
  explicit GateMetaDecoder(const MetaLimits& limits, BlockPositions positions = BlockPositions::kSent,
                           bool believes_all = false);

  Result<MetaUpdate> decode(ByteView bytes) override;

 private:
  MetaLimits limits_;
  BlockPositions positions_;
  GateState state_;
  bool believes_all_;
  bool broken_ = false;
};

}  // namespace atlaswire::codec
