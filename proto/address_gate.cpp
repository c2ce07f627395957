#include "proto/address_gate.h"

#include "proto/datagram.h"

#include <algorithm>

namespace atlaswire::proto {

AddressGate::Candidate* AddressGate::find_or_add(const PeerAddress& from, bool has_token, const Nonce& fresh,
                                                 Time now) {
  const auto known = std::find_if(candidates_.begin(), candidates_.end(),
                                  [&](const Candidate& c) { return c.address == from; });
  if (known != candidates_.end()) return &*known;
  if (candidates_.size() >= settings_.max_candidates) {
    // Whoever shows the token is never pushed out by those who do not: they may be anybody.
    const auto worst =
        std::min_element(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
          return a.has_token != b.has_token ? b.has_token : a.last_seen < b.last_seen;
        });
    if (worst == candidates_.end() || (worst->has_token && !has_token)) return nullptr;
    candidates_.erase(worst);
  }
  Candidate candidate;
  candidate.address = from;
  candidate.nonce = fresh;
  candidate.nonce_made = now;
  candidates_.push_back(candidate);
  return &candidates_.back();
}

std::optional<Nonce> AddressGate::on_datagram(const PeerAddress& from, std::size_t octets,
                                              const std::optional<UdpToken>& token, const Nonce& fresh,
                                              Time now) {
  if (media_ == from) return std::nullopt;
  if (token && !equal_secret(*token, token_)) return std::nullopt;
  Candidate* candidate = find_or_add(from, token.has_value(), fresh, now);
  if (candidate == nullptr) return std::nullopt;
  candidate->has_token |= token.has_value();
  candidate->last_seen = now;
  candidate->received += octets;
  if (candidate->sent + kChallengeSize > settings_.amplification * candidate->received) return std::nullopt;
  if (now - candidate->nonce_made > settings_.nonce_lifetime) {
    candidate->nonce = fresh;
    candidate->nonce_made = now;
  }
  candidate->sent += kChallengeSize;
  return candidate->nonce;
}

bool AddressGate::on_confirm(const PeerAddress& from, std::size_t octets, const UdpToken& token,
                             const Nonce& nonce, Time now) {
  if (media_ == from) return false;
  const auto known = std::find_if(candidates_.begin(), candidates_.end(),
                                  [&](const Candidate& c) { return c.address == from; });
  if (known == candidates_.end()) return false;
  known->received += octets;
  known->last_seen = now;
  // A nonce may have been sent just before it expired: twice its life is what an answer gets.
  const bool alive = now - known->nonce_made <= 2 * settings_.nonce_lifetime;
  if (known->sent == 0 || !alive || !equal_secret(token, token_) || !equal_secret(nonce, known->nonce)) {
    return false;
  }
  candidates_.erase(known);
  media_ = from;
  return true;
}

}  // namespace atlaswire::proto
