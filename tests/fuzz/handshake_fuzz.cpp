#include "base/assert.h"
#include "proto/handshake.h"
#include "proto/messages.h"

#include <cstddef>
#include <cstdint>

/// A server meets whatever a client says first: terms that it can keep, or a refusal that it can send; and
/// a client meets whatever a server answers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace atlaswire;
  const auto message = proto::parse_message(std::as_bytes(std::span(data, size)));
  ByteBuffer answer;
  const auto refuse = [&](const Error& error) { proto::append_message(proto::refusal_for(error), answer); };
  if (message.has_error()) {
    refuse(message.error());
    return 0;
  }
  if (const auto* hello = std::get_if<proto::ClientHello>(&*message)) {
    constexpr std::uint32_t kCodecs[] = {2, 1};
    const Extent2D picture{1024, 1024};
    const auto terms = proto::agree(*hello, kCodecs, picture);
    if (terms.has_error()) {
      refuse(terms.error());
      return 0;
    }
    AW_ASSERT(terms->version >= hello->versions.lowest && terms->version <= hello->versions.highest);
    proto::ServerHello reply;
    reply.version = terms->version;
    reply.session = SessionId{1};
    reply.stream.picture = reply.stream.atlas = picture;
    reply.stream.meta_codec = terms->meta_codec;
    AW_ASSERT(proto::check_answer(*hello, reply).has_value());
    proto::append_message(reply, answer);
  } else if (const auto* reply = std::get_if<proto::ServerHello>(&*message)) {
    static_cast<void>(proto::check_answer(proto::ClientHello{}, *reply));
  }
  return 0;
}
