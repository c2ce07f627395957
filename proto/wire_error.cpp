#include "proto/wire_error.h"

namespace atlaswire::proto {

const char* error_text(WireError e) {
  switch (e) {
    case WireError::kTruncated:
      return "too few bytes";
    case WireError::kTrailingBytes:
      return "bytes after the end";
    case WireError::kBadVersion:
      return "no common protocol version";
    case WireError::kBadType:
      return "wrong message type";
    case WireError::kBadLength:
      return "bad length";
    case WireError::kBadValue:
      return "value out of range";
    case WireError::kMissingField:
      return "missing field";
    case WireError::kMalformed:
      return "malformed message";
  }
  return "unknown wire error";
}

}  // namespace atlaswire::proto
