#pragma once

#include "client/arrival.h"
#include "client/hand_over.h"
#include "client/pair.h"
#include "client/pairing.h"
#include "proto/stream_description.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace atlaswire::client {

/// What the decode thread did so far.
struct DecodeCounts {
  std::uint64_t decoded = 0;      ///< pictures
  std::uint64_t failed = 0;       ///< access units that the decoder refused
  std::uint64_t skipped = 0;      ///< P-frames not tried because an IDR is due after a failure
  std::uint64_t never_shown = 0;  ///< pairs overtaken by a newer one before the display took them
  PairingCounts pairing;
  std::uint64_t patches = 0;  ///< of the newest pair
  std::uint64_t triangles = 0;
};

/// Whom the decode thread turns to; called on its thread.
struct DecodeTroubles {
  std::function<void()> decode_failed;          ///< a picture did not decode: an IDR is needed
  std::function<void(std::string)> peer_broke;  ///< the server contradicts itself: the session must end
};

/// Decodes pictures and meta updates as they arrive ([SAS] 3.5), pairs them, keeps the replica, builds each
/// pair's vertex buffer and hands the newest pair over. Ends when the arrival queue closes.
class DecodeThread {
 public:
  /// `arrivals` and `pairs` outlive it.
  DecodeThread(const proto::StreamDescription& stream, std::uint32_t decoder_threads, ArrivalQueue& arrivals,
               HandOver<Pair>& pairs, DecodeTroubles troubles);
  /// As `finish`.
  ~DecodeThread();
  DecodeThread(const DecodeThread&) = delete;
  DecodeThread& operator=(const DecodeThread&) = delete;

  /// Waits until everything in the queue is decoded: close it first.
  void finish();
  [[nodiscard]] DecodeCounts counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atlaswire::client
