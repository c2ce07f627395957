#include "proto/handshake.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace atlaswire::proto {

Result<std::uint32_t> choose_version(const VersionRange& client, const VersionRange& server) {
  const std::uint32_t highest = std::min(client.highest, server.highest);
  const std::uint32_t lowest = std::max(client.lowest, server.lowest);
  if (highest >= lowest) return highest;
  return Error(WireError::kBadVersion,
               fmt::format("the client speaks versions {} to {}, the server {} to {}", client.lowest,
                           client.highest, server.lowest, server.highest));
}

Result<std::uint32_t> choose_meta_codec(std::span<const std::uint32_t> server,
                                        std::span<const std::uint32_t> client) {
  for (const std::uint32_t codec : server) {
    if (std::find(client.begin(), client.end(), codec) != client.end()) return codec;
  }
  return Error(WireError::kBadValue, fmt::format("the client knows meta codecs {}, the server {}",
                                                 fmt::join(client, ","), fmt::join(server, ",")));
}

namespace {

Result<void> check_fits(const Extent2D& picture, const Extent2D& largest) {
  if (picture.width <= largest.width && picture.height <= largest.height) return {};
  return Error(WireError::kBadValue,
               fmt::format("the stream's picture of {}x{} is larger than the {}x{} that the client decodes",
                           picture.width, picture.height, largest.width, largest.height));
}

}  // namespace

Result<Terms> agree(const ClientHello& hello, std::span<const std::uint32_t> meta_codecs,
                    const Extent2D& picture) {
  const auto version = choose_version(hello.versions);
  if (version.has_error()) return version.error();
  const auto codec = choose_meta_codec(meta_codecs, hello.meta_codecs);
  if (codec.has_error()) return codec.error();
  const auto fits = check_fits(picture, hello.max_picture);
  if (fits.has_error()) return fits.error();
  return Terms{*version, *codec};
}

Refusal refusal_for(const Error& error) {
  const bool version = error.code == make_error_code(WireError::kBadVersion);
  return {version ? Refusal::Code::kVersion : Refusal::Code::kBadHello, error.message()};
}

Result<void> check_answer(const ClientHello& hello, const ServerHello& answer) {
  if (answer.version < hello.versions.lowest || answer.version > hello.versions.highest) {
    return Error(WireError::kBadVersion,
                 fmt::format("the server chose version {}, offered were {} to {}", answer.version,
                             hello.versions.lowest, hello.versions.highest));
  }
  const auto codec = choose_meta_codec({&answer.stream.meta_codec, 1}, hello.meta_codecs);
  if (codec.has_error()) return codec.error();
  if (answer.stream.motion && !hello.shows_motion)
    return Error(WireError::kBadValue, "the stream moves, which was not offered");
  return check_fits(answer.stream.picture, hello.max_picture);
}

}  // namespace atlaswire::proto
