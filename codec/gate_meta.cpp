#include "codec/gate_meta.h"

#include "base/assert.h"
#include "codec/gate_script.h"

#include <algorithm>
#include <random>

namespace atlaswire::codec {

namespace {

constexpr std::uint8_t kForm = 0xA2;       // "atlaswire meta", form 2
constexpr std::uint8_t kResetForm = 0xA3;  // the same, everything forgotten first

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

GateMetaEncoder::GateMetaEncoder(const MetaLimits& limits) : limits_(limits), state_(0) {}

void GateMetaEncoder::encode(const MetaUpdate& update, ByteBuffer& out) {
  const std::size_t start = out.size();
  out.push_back(static_cast<std::byte>(update.reset ? kResetForm : kForm));
  if (update.reset) state_.clear();
  plan_.begin(update, state_);
  RangeEncoder coder(out);
  GateScript<RangeEncoder>(coder, state_, limits_, ~0U, &plan_).code(update.reset, nullptr);
  coder.finish();
  const std::size_t least = plan_.arrivals().size() / kNewPerOctet + 1;
  out.resize(std::max(out.size(), start + least));
}

GateMetaDecoder::GateMetaDecoder(const MetaLimits& limits, bool believes_all)
    : limits_(limits), state_(unguessable()), believes_all_(believes_all) {
  AW_ASSERT(limits.grid_bits <= 20);
}

Result<MetaUpdate> GateMetaDecoder::decode(ByteView bytes) {
  if (bytes.empty()) return MetaError::kTruncated;
  if (bytes.size() > kMaxMetaBody) return MetaError::kTooLarge;
  const auto form = std::to_integer<std::uint8_t>(bytes[0]);
  if (form != kForm && form != kResetForm) return MetaError::kBadVersion;
  MetaUpdate update;
  update.reset = form == kResetForm;
  if (update.reset) {
    state_.clear();
    broken_ = false;
  }
  if (broken_) return MetaError::kOutOfStep;
  RangeDecoder coder(bytes.subspan(1));
  const auto error = GateScript<RangeDecoder>(coder, state_, limits_,
                                              most_new(limits_, state_.residents, bytes.size()), nullptr)
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
