#pragma once

#include "base/result.h"
#include "proto/messages.h"
#include "proto/wire_error.h"

#include <cstdint>
#include <span>

namespace atlaswire::proto {

/// Every version this build speaks.
inline constexpr VersionRange kOurVersions{1, 1};

/// The highest version both speak, or kBadVersion with a text that names both ranges.
Result<std::uint32_t> choose_version(const VersionRange& client, const VersionRange& server = kOurVersions);

/// The first of the server's meta codecs (its order of preference) that the client has; kBadValue with a
/// text that names both lists when there is none.
Result<std::uint32_t> choose_meta_codec(std::span<const std::uint32_t> server,
                                        std::span<const std::uint32_t> client);

/// What the hello settles before a stream is chosen.
struct Terms {
  std::uint32_t version = 1;
  std::uint32_t meta_codec = 1;
};

/// Server: may this client join, and on which terms? Checks version, codec, and that `picture` (the stream's)
/// fits the client's decoder.
Result<Terms> agree(const ClientHello& hello, std::span<const std::uint32_t> meta_codecs,
                    const Extent2D& picture);

/// Server: the refusal that an error of `agree` or of parsing the hello deserves.
Refusal refusal_for(const Error& error);

/// Client: does the answer keep what the hello offered (version in range, codec offered, picture no larger
/// than we can decode)? The text names what does not.
Result<void> check_answer(const ClientHello& hello, const ServerHello& answer);

}  // namespace atlaswire::proto
