#include "codec/gate_meta.h"

#include "base/assert.h"
#include "codec/gate_script.h"

#include <algorithm>
#include <random>

namespace atlaswire::codec {

namespace {

/// "atlaswire meta", form 2; with derived positions form 4.
constexpr std::uint8_t form_of(BlockPositions positions) {
  return positions == BlockPositions::kSent ? 0xA2 : 0xA4;
}
constexpr std::uint8_t kReset = 1;  // added to the form: everything is forgotten first

/// Patches that both ends may know at once.
constexpr std::uint32_t kMostResidents = 1U << 22U;
/// New patches that one octet of an update may bring: what bounds memory and time by the octets received.
constexpr std::uint64_t kNewPerOctet = 64;

std::uint32_t most_new(const MetaLimits& limits, const ResidentSet& residents, std::size_t octets) {
  const std::uint32_t most = std::min(limits.max_patches, kMostResidents);
  const std::uint64_t room = most - std::min(most, residents.size());
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(room, kNewPerOctet * octets));
}

/// A peer that picks positions must not know how they are scattered.
std::uint64_t unguessable() {
  std::random_device source;
  return std::uint64_t{source()} << 32U | source();
}

}  // namespace

GateMetaEncoder::GateMetaEncoder(const MetaLimits& limits, BlockPositions positions)
    : limits_(limits), positions_(positions), state_(0) {}

void GateMetaEncoder::encode(const MetaUpdate& update, ByteBuffer& out) {
  AW_ASSERT(update.cue.has_value() == (positions_ == BlockPositions::kDerived));
  const std::size_t start = out.size();
  out.push_back(static_cast<std::byte>(form_of(positions_) + (update.reset ? kReset : 0)));
  if (update.reset) state_.clear();
  plan_.begin(update, state_);
  RangeEncoder coder(out);
  std::optional<LayoutCue> cue = update.cue;
  GateScript<RangeEncoder>(coder, state_, limits_, ~0U, cue ? &*cue : nullptr, &plan_)
      .code(update.reset, nullptr);
  coder.finish();
  const std::size_t least = plan_.arrivals().size() / kNewPerOctet + 1;
  out.resize(std::max(out.size(), start + least));
}

GateMetaDecoder::GateMetaDecoder(const MetaLimits& limits, BlockPositions positions, bool believes_all)
    : limits_(limits), positions_(positions), state_(unguessable()), believes_all_(believes_all) {
  AW_ASSERT(limits.grid_bits <= 20);
}

Result<MetaUpdate> GateMetaDecoder::decode(ByteView bytes) {
  if (bytes.empty()) return MetaError::kTruncated;
  if (bytes.size() > kMaxMetaBody) return MetaError::kTooLarge;
  const auto form = std::to_integer<std::uint8_t>(bytes[0]);
  if ((form & ~kReset) != form_of(positions_)) return MetaError::kBadVersion;
  MetaUpdate update;
  update.reset = (form & kReset) != 0;
  if (positions_ == BlockPositions::kDerived) update.cue.emplace();
  if (update.reset) {
    state_.clear();
    broken_ = false;
  }
  if (broken_) return MetaError::kOutOfStep;
  RangeDecoder coder(bytes.subspan(1));
  const auto error =
      GateScript<RangeDecoder>(coder, state_, limits_, most_new(limits_, state_.residents, bytes.size()),
                               update.cue ? &*update.cue : nullptr, nullptr)
          .code(update.reset, &update);
  broken_ = true;
  if (error && !(believes_all_ && *error == MetaError::kOutOfStep)) return *error;
  const ByteView unread = bytes.last(coder.unread());
  if (std::ranges::any_of(unread, [](std::byte octet) { return octet != std::byte{0}; })) {
    return MetaError::kTrailingBytes;
  }
  broken_ = false;
  return update;
}

}  // namespace atlaswire::codec
