#include "client/decode_thread.h"

#include "client/replica.h"
#include "client/replica_mesh.h"
#include "codec/meta_update.h"
#include "codec/video.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <mutex>
#include <thread>
#include <utility>

namespace atlaswire::client {
namespace {

constexpr std::size_t kMaxWaitingPictures = 8;
constexpr std::size_t kMaxWaitingUpdates = 128;

struct DecodedFrame {
  std::shared_ptr<const codec::DecodedPicture> picture;
  Time arrival{};
  Duration decoding{};
};

struct DecodedUpdate {
  codec::MetaUpdate update;
  UpdateArrival arrived;
  Duration decoding{};
};

codec::MetaLimits limits_of(const proto::StreamDescription& stream) {
  return {.max_vertices = stream.max_vertices,
          .max_patches = stream.max_patches,
          .grid_bits = stream.grid.bits,
          .atlas = stream.atlas};
}

}  // namespace

class DecodeThread::Impl {
 public:
  Impl(const proto::StreamDescription& stream, std::uint32_t decoder_threads, ArrivalQueue& arrivals,
       HandOver<Pair>& pairs, DecodeTroubles troubles)
      : stream_(stream),
        arrivals_(&arrivals),
        pairs_(&pairs),
        troubles_(std::move(troubles)),
        video_(stream.picture, decoder_threads),
        meta_(codec::make_meta_decoder(static_cast<codec::MetaCodecKind>(stream.meta_codec),
                                       limits_of(stream))),
        replica_(limits_of(stream)),
        mesher_(stream.grid),
        thread_([this] { run(); }) {}

  ~Impl() { finish(); }

  void finish() {
    if (thread_.joinable()) thread_.join();
  }

  [[nodiscard]] DecodeCounts counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  void run() {
    while (std::optional<Arrival> arrival = arrivals_->pop()) {
      if (broken_) continue;  // drain, so that nobody waits for places
      if (arrival->frame) on_frame(*arrival->frame);
      if (arrival->update) on_update(std::move(*arrival->update));
      pair_up();
    }
  }

  void on_frame(const proto::AssembledFrame& frame) {
    if (needs_idr_ && !frame.idr) return count([](DecodeCounts& c) { ++c.skipped; });
    const Time start = steady_now();
    Result<codec::DecodedPicture> picture = video_.decode(frame.access_unit);
    if (!picture) {
      spdlog::debug("frame {} does not decode: {}", value(frame.frame), picture.error().message());
      needs_idr_ = true;
      count([](DecodeCounts& c) { ++c.failed; });
      return troubles_.decode_failed();
    }
    needs_idr_ = false;
    if (picture->view().extent != stream_.picture) {
      const Extent2D got = picture->view().extent;
      return break_with(fmt::format("a picture of {}x{} came where {}x{} was agreed", got.width, got.height,
                                    stream_.picture.width, stream_.picture.height));
    }
    count([](DecodeCounts& c) { ++c.decoded; });
    pairing_.add_picture(frame.frame,
                         {.picture = std::make_shared<const codec::DecodedPicture>(std::move(*picture)),
                          .arrival = frame.last_arrival,
                          .decoding = steady_now() - start});
  }

  void on_update(UpdateArrival arrived) {
    const FrameId frame = arrived.update.meta.frame;
    const Time start = steady_now();
    Result<codec::MetaUpdate> update = meta_->decode(arrived.update.meta.meta);
    if (!update) {
      return break_with(fmt::format("meta update {}: {}", value(frame), update.error().message()));
    }
    if (update->frame != frame) {
      return break_with(fmt::format("meta update of frame {} came in the message of frame {}",
                                    value(update->frame), value(frame)));
    }
    const Duration decoding = steady_now() - start;
    if (!pairing_.add_update(frame, {std::move(*update), std::move(arrived), decoding})) {
      break_with(fmt::format("meta update {} came out of order", value(frame)));
    }
  }

  void pair_up() {
    while (!broken_) {
      auto step = pairing_.next_step();
      if (!step) break;
      const Time start = steady_now();
      if (const Result<void> applied = replica_.apply(step->update.update); !applied) {
        return break_with(fmt::format("meta update {}: {}", value(step->frame), applied.error().message()));
      }
      if (step->picture) publish(*step->picture, step->update, start);
    }
    count([this](DecodeCounts& c) { c.pairing = pairing_.counts(); });
  }

  void publish(const DecodedFrame& picture, const DecodedUpdate& update, Time start) {
    Pair pair;
    mesher_.build(replica_, pair.mesh);
    pair.origin = mesher_.origin();
    pair.picture = picture.picture;
    const ServerTimes& server = update.arrived.server;
    pair.server_pose = server.pose;
    const Time ready = steady_now();
    pair.times = {.frame = update.update.frame,
                  .pose = update.arrived.update.meta.pose,
                  .pose_sampled = server.pose ? std::optional(server.pose->sampled) : std::nullopt,
                  .pose_received = server.pose_received,
                  .render_start = server.render_start,
                  .encode_end = server.encode_end,
                  .video_arrival = picture.arrival,
                  .meta_arrival = update.arrived.update.arrival,
                  .video_decoding = picture.decoding,
                  .meta_decoding = update.decoding + (ready - start),
                  .ready = ready};
    const bool overtaken = pairs_->put(std::move(pair));
    count([&](DecodeCounts& c) {
      c.never_shown += overtaken ? 1U : 0U;
      c.patches = replica_.patches().size();
      c.triangles = replica_.triangle_count();
    });
  }

  void break_with(std::string why) {
    broken_ = true;
    troubles_.peer_broke(std::move(why));
  }

  template <class Action>
  void count(const Action& action) {
    const std::lock_guard lock(mutex_);
    action(counts_);
  }

  proto::StreamDescription stream_;
  ArrivalQueue* arrivals_;
  HandOver<Pair>* pairs_;
  DecodeTroubles troubles_;
  codec::VideoDecoder video_;
  std::unique_ptr<codec::MetaDecoder> meta_;
  Pairing<DecodedFrame, DecodedUpdate> pairing_{kMaxWaitingPictures, kMaxWaitingUpdates};
  Replica replica_;
  ReplicaMesher mesher_;
  bool needs_idr_ = false;
  bool broken_ = false;
  mutable std::mutex mutex_;
  DecodeCounts counts_;
  std::thread thread_;  // last: everything it uses exists
};

DecodeThread::DecodeThread(const proto::StreamDescription& stream, std::uint32_t decoder_threads,
                           ArrivalQueue& arrivals, HandOver<Pair>& pairs, DecodeTroubles troubles)
    : impl_(std::make_unique<Impl>(stream, decoder_threads, arrivals, pairs, std::move(troubles))) {}
DecodeThread::~DecodeThread() = default;

void DecodeThread::finish() { impl_->finish(); }

DecodeCounts DecodeThread::counts() const { return impl_->counts(); }

}  // namespace atlaswire::client
