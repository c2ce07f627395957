#pragma once

#include "base/ids.h"
#include "proto/tokens.h"
#include "server/session.h"

namespace atlaswire::server {

/// From the kernel's cryptographic generator. Throws std::system_error when it fails.
proto::Nonce random_nonce();

/// A new session's token, SSRC (not 0) and first RTP numbers.
SessionKeys random_keys(SessionId id);

}  // namespace atlaswire::server
