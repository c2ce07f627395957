#pragma once

#include "base/error_enum.h"

namespace atlaswire::proto {

/// The wire version this build speaks; docs/PROTOCOL.md, section 1.
inline constexpr unsigned kWireVersion = 1;

/// Why bytes of a peer are refused. Parsers on the media path give no detail text: no allocation.
enum class WireError {
  kTruncated = 1,  ///< fewer bytes than the fields need
  kTrailingBytes,  ///< more bytes than the fields need
  kBadVersion,     ///< not our version, or no common one
  kBadType,        ///< a type octet that does not belong there
  kBadLength,      ///< zero, over the limit, or at odds with the contents
  kBadValue,       ///< out of range, NaN or infinite
  kMissingField,   ///< what the message cannot do without
  kMalformed       ///< no protobuf message, or broken structure
};
const char* error_text(WireError e);

}  // namespace atlaswire::proto
ATLASWIRE_ERROR_ENUM(proto, WireError);
