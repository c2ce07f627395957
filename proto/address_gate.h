#pragma once

#include "base/time.h"
#include "proto/peer_address.h"
#include "proto/tokens.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace atlaswire::proto {

/// Server: which UDP address of a session may be sent to (docs/PROTOCOL.md, section 3.1). Until an address
/// has echoed the nonce sent to it, it gets no media and at most three octets for each it sent. A new
/// address (a client that roams) must prove itself too; the last one that did gets the media.
/// Bounded: at most `max_candidates` unproven addresses, the ones without the token forgotten first.
class AddressGate {
 public:
  struct Settings {
    Duration nonce_lifetime = std::chrono::seconds(5);
    std::size_t max_candidates = 4;
    std::uint32_t amplification = 3;
  };

  explicit AddressGate(const UdpToken& token) : AddressGate(token, Settings{}) {}
  AddressGate(const UdpToken& token, const Settings& settings) : token_(token), settings_(settings) {}

  /// Any datagram of `octets` that names this session came from `from`. `token`: the one it carried, if it
  /// was a probe; a wrong token is as good as no datagram. Gives the nonce to challenge the address with
  /// (an earlier one while it lives, else `fresh`), counted as sent; nullopt when the address is already
  /// proven, the token wrong or the budget spent.
  std::optional<Nonce> on_datagram(const PeerAddress& from, std::size_t octets,
                                   const std::optional<UdpToken>& token, const Nonce& fresh, Time now);

  /// A confirm came. True when token and nonce are right: `from` is proven and gets the media from now on.
  bool on_confirm(const PeerAddress& from, std::size_t octets, const UdpToken& token, const Nonce& nonce,
                  Time now);

  /// May datagrams of `from` (poses, sync, RTCP) be acted on?
  [[nodiscard]] bool is_proven(const PeerAddress& from) const { return media_ == from; }
  /// Where media goes; nullopt before any address is proven.
  [[nodiscard]] const std::optional<PeerAddress>& media_address() const { return media_; }

 private:
  struct Candidate {
    PeerAddress address;
    Nonce nonce{};
    Time nonce_made{};
    std::uint64_t received = 0;
    std::uint64_t sent = 0;
    bool has_token = false;
    Time last_seen{};
  };
  Candidate* find_or_add(const PeerAddress& from, bool has_token, const Nonce& fresh, Time now);

  UdpToken token_;
  Settings settings_;
  std::optional<PeerAddress> media_;
  std::vector<Candidate> candidates_;
};

}  // namespace atlaswire::proto
