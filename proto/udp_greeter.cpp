#include "proto/udp_greeter.h"

namespace atlaswire::proto {

std::optional<Probe> UdpGreeter::poll(Time now) {
  if (now < next_) return std::nullopt;
  established_ = false;  // `next_` lies `silence` after the last datagram while established
  next_ = now + settings_.interval;
  return Probe{session_, token_};
}

std::optional<Confirm> UdpGreeter::on_challenge(const Challenge& challenge) const {
  if (challenge.session != session_) return std::nullopt;
  return Confirm{session_, token_, challenge.nonce};
}

void UdpGreeter::on_received(Time now) {
  established_ = true;
  next_ = now + settings_.silence;
}

}  // namespace atlaswire::proto
