#pragma once

#include "base/bytes.h"
#include "base/result.h"
#include "proto/atlaswire.pb.h"
#include "proto/wire_error.h"

namespace atlaswire::proto {

/// Parses and validates one protobuf envelope: exactly one message in it, enums known, numbers finite and
/// within the ranges of messages.h, extents and tokens of legal size, ids non-zero where they must be.
/// Safe on hostile bytes; memory stays within a small multiple of the input. Most code wants
/// `parse_message` instead, which keeps protobuf out of sight.
Result<wire::Envelope> parse_envelope(ByteView bytes);

/// The rules alone, on an envelope that is already parsed.
Result<void> check_envelope(const wire::Envelope& envelope);

}  // namespace atlaswire::proto
