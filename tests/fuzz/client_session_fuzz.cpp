#include "base/bytes.h"
#include "client/session.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

/// A hostile server against the client's session: the input is a run of `u8 what | u16 length | octets`.
/// what & 1: a datagram, else bytes of the reliable channel; what >> 1: milliseconds that pass before it.
/// Nothing may crash, hang, or keep growing.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace atlaswire;
  Time now{std::chrono::seconds(1)};
  client::Session session(client::SessionSettings{}, now);
  ByteReader input({reinterpret_cast<const std::byte*>(data), size});
  while (input.remaining() > 0) {
    const auto what = input.read<std::uint8_t>();
    const std::size_t length = std::min<std::size_t>(input.read<std::uint16_t>(), input.remaining());
    const ByteView bytes = input.read_bytes(length);
    now += std::chrono::milliseconds(what >> 1U);
    if ((what & 1U) != 0) {
      session.on_datagram(bytes, now);
    } else {
      session.on_stream_bytes(bytes, now);
    }
    session.on_pose(Pose{}, now);
    session.poll(now);
    session.take_stream_bytes();
    while (session.pop_datagram()) {
    }
    while (session.pop_frame()) {
    }
    while (session.pop_update()) {
    }
    if (const auto next = session.next_deadline(); next && *next < now) __builtin_trap();
  }
  return 0;
}
