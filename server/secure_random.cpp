#include "server/secure_random.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace atlaswire::server {

namespace {

template <class T>
T random_value() {
  T v{};
  if (::getentropy(&v, sizeof(v)) != 0) {
    throw std::system_error(errno, std::generic_category(), "the kernel gives no random numbers");
  }
  return v;
}

}  // namespace

proto::Nonce random_nonce() { return random_value<proto::Nonce>(); }

SessionKeys random_keys(SessionId id) {
  SessionKeys keys;
  keys.id = id;
  keys.token = random_value<proto::UdpToken>();
  keys.ssrc = random_value<std::uint32_t>() | 1U;
  // Far from the wrap, so that receivers that begin late see no jump at once (RFC 3711 section 3.3.1).
  keys.first_sequence = random_value<std::uint16_t>() & 0x7FFFU;
  keys.timestamp_base = random_value<std::uint32_t>();
  return keys;
}

}  // namespace atlaswire::server
