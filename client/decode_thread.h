#pragma once

#include "client/hand_over.h"
#include "client/pair_maker.h"

#include <memory>

namespace atlaswire::client {

/// Runs a PairMaker on a thread of its own and hands the newest pair over. Ends when the arrival queue
/// closes.
class DecodeThread {
 public:
  /// `arrivals` and `pairs` outlive it.
  DecodeThread(const proto::StreamDescription& stream, const DecodeSettings& settings, ArrivalQueue& arrivals,
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
