#pragma once

#include "client/arrival.h"
#include "client/layout_mirror.h"
#include "client/moving_replica.h"
#include "client/pair.h"
#include "client/pairing.h"
#include "client/replica.h"
#include "client/replica_mesh.h"
#include "codec/meta_update.h"
#include "codec/video.h"
#include "proto/stream_description.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace atlaswire::client {

/// What decoding and pairing did so far.
struct DecodeCounts {
  std::uint64_t decoded = 0;      ///< pictures
  std::uint64_t failed = 0;       ///< access units that the decoder refused
  std::uint64_t skipped = 0;      ///< P-frames not tried because an IDR is due after a failure
  std::uint64_t never_shown = 0;  ///< pairs overtaken by a newer one before the display took them
  std::uint64_t restarts = 0;  ///< asked for, because what we know had come apart from what the server tells
  PairingCounts pairing;
  std::uint64_t patches = 0;  ///< of the newest pair
  std::uint64_t triangles = 0;
};

/// Whom decoding turns to; called on its thread.
struct DecodeTroubles {
  std::function<void()> decode_failed;          ///< a picture did not decode: an IDR is needed
  std::function<void(std::string)> peer_broke;  ///< the server contradicts itself: the session must end
  /// What we know has come apart from what the server tells, as this frame's update shows: it must be asked
  /// to tell all anew. The last pair stays valid.
  std::function<void(FrameId, std::string)> out_of_step;
};

/// How a stream is decoded.
struct DecodeSettings {
  std::uint32_t threads = 1;  ///< slice threads
  codec::VideoCoding coding = codec::VideoCoding::kH264;
  std::function<Time()> clock = steady_now;  ///< for the durations that pairs carry
};

/// The meta codecs that a PairMaker reads, for the hello.
std::vector<std::uint32_t> readable_meta_codecs();

/// Decodes pictures and meta updates as they arrive ([SAS] 3.5), pairs them, keeps the replica and builds
/// each pair's vertex buffer. No thread of its own. After `peer_broke` it ignores everything.
class PairMaker {
 public:
  PairMaker(const proto::StreamDescription& stream, DecodeSettings settings, DecodeTroubles troubles);

  void on_frame(const proto::AssembledFrame& frame);
  void on_update(UpdateArrival arrived);
  /// The next pair that became complete; updates without a picture are applied on the way. nullopt: more must
  /// arrive. Call until then after every arrival.
  std::optional<Pair> next_pair();

  [[nodiscard]] bool is_broken() const { return broken_; }
  [[nodiscard]] const DecodeCounts& counts() const { return counts_; }

 private:
  struct DecodedFrame {
    std::shared_ptr<const codec::DecodedPicture> picture;
    Time arrival{};
    Duration decoding{};
  };
  struct DecodedUpdate {
    codec::MetaUpdate update;
    codec::MoverChange movers;  ///< before blocks are placed: who asks for one takes part
    UpdateArrival arrived;
    Duration decoding{};
  };

  Result<codec::MetaUpdate> read(ByteView bytes, codec::MoverChange& movers);
  bool move(const DecodedUpdate& update);
  void lose_step(FrameId frame, const Error& why);
  Pair make_pair(const DecodedFrame& picture, const DecodedUpdate& update, Time start);
  void break_with(std::string why);

  proto::StreamDescription stream_;
  DecodeSettings settings_;
  DecodeTroubles troubles_;
  codec::VideoDecoder video_;
  std::unique_ptr<codec::MetaDecoder> meta_;
  std::optional<LayoutMirror> mirror_;  ///< where updates leave out where blocks lie
  Pairing<DecodedFrame, DecodedUpdate> pairing_;
  Replica replica_;
  std::optional<MovingReplica> moving_;  ///< of a stream that moves
  ReplicaMesher mesher_;
  bool needs_idr_ = false;
  bool out_of_step_ = false;             ///< nothing is believed until an update with reset
  bool motion_lost_ = false;             ///< nothing is shown until one was applied
  std::uint32_t restarts_in_a_row_ = 0;  ///< that did not keep us in step for long
  std::uint32_t in_step_for_ = 0;        ///< updates
  bool broken_ = false;
  DecodeCounts counts_;
};

}  // namespace atlaswire::client
