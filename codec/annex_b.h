#pragma once

#include "base/bytes.h"

#include <optional>

namespace atlaswire::codec {

/// NAL unit types of H.264 table 7-1 that are looked for here.
enum class NalType : std::uint8_t { kSlice = 1, kIdr = 5, kSequenceSet = 7, kPictureSet = 8 };

/// Walks the NAL units of an Annex B byte stream (H.264 annex B), without their start codes. Safe on any
/// bytes; octets before the first start code are skipped.
class AnnexBReader {
 public:
  explicit AnnexBReader(ByteView stream);
  /// The next unit, at least its header octet long; nullopt at the end. Trailing zero octets are cut.
  std::optional<ByteView> next();

 private:
  ByteView rest_;  // behind a start code, or empty
};

/// The type in a unit's header octet.
inline NalType nal_type(ByteView unit) {
  return static_cast<NalType>(std::to_integer<std::uint8_t>(unit[0]) & 0x1FU);
}

/// Is there a slice of an IDR picture among the units?
bool contains_idr(ByteView stream);

/// The sequence and picture parameter sets of a stream, in order, with 4-octet start codes.
ByteBuffer parameter_sets_of(ByteView stream);

}  // namespace atlaswire::codec
