#include "client/pair_maker.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <random>
#include <utility>

namespace atlaswire::client {
namespace {

constexpr std::size_t kMaxWaitingPictures = 8;
constexpr std::size_t kMaxWaitingUpdates = 128;
/// Restarts that are asked for one after the other, unless so many updates in step lie between.
constexpr std::uint32_t kMostRestarts = 4;
constexpr std::uint32_t kLongInStep = 256;

codec::MetaLimits limits_of(const proto::StreamDescription& stream) {
  return {.max_vertices = stream.max_vertices,
          .max_patches = stream.max_patches,
          .grid_bits = stream.grid.bits,
          .atlas = stream.atlas};
}

std::optional<LayoutMirror> mirror_for(const proto::StreamDescription& stream) {
  const auto codec = static_cast<codec::MetaCodecKind>(stream.meta_codec);
  if (!codec::leaves_positions(codec) || !stream.memory) return std::nullopt;
  return std::optional<LayoutMirror>(std::in_place, *stream.memory, stream.atlas, stream.max_patches);
}

std::optional<MovingReplica> moving_for(const proto::StreamDescription& stream) {
  if (!stream.motion) return std::nullopt;
  std::random_device source;
  return std::optional<MovingReplica>(std::in_place, *stream.motion, stream.grid,
                                      std::uint64_t{source()} << 32U | source());
}

}  // namespace

std::vector<std::uint32_t> readable_meta_codecs() {
  std::vector<std::uint32_t> numbers;
  for (const codec::MetaCodecKind kind : codec::kMetaCodecs)
    numbers.push_back(static_cast<std::uint32_t>(kind));
  return numbers;
}

PairMaker::PairMaker(const proto::StreamDescription& stream, DecodeSettings settings, DecodeTroubles troubles)
    : stream_(stream),
      settings_(std::move(settings)),
      troubles_(std::move(troubles)),
      video_(stream.picture, settings_.threads, settings_.coding),
      meta_(
          codec::make_meta_decoder(static_cast<codec::MetaCodecKind>(stream.meta_codec), limits_of(stream))),
      mirror_(mirror_for(stream)),
      pairing_(kMaxWaitingPictures, kMaxWaitingUpdates),
      replica_(limits_of(stream)),
      moving_(moving_for(stream)),
      mesher_(stream.grid) {}

void PairMaker::on_frame(const proto::AssembledFrame& frame) {
  if (broken_) return;
  if (needs_idr_ && !frame.idr) {
    ++counts_.skipped;
    return;
  }
  const Time start = settings_.clock();
  Result<codec::DecodedPicture> picture = video_.decode(frame.access_unit);
  if (!picture) {
    spdlog::debug("frame {} does not decode: {}", value(frame.frame), picture.error().message());
    needs_idr_ = true;
    ++counts_.failed;
    return troubles_.decode_failed();
  }
  needs_idr_ = false;
  if (picture->view().extent != stream_.picture) {
    const Extent2D got = picture->view().extent;
    return break_with(fmt::format("a picture of {}x{} came where {}x{} was agreed", got.width, got.height,
                                  stream_.picture.width, stream_.picture.height));
  }
  ++counts_.decoded;
  pairing_.add_picture(frame.frame,
                       {.picture = std::make_shared<const codec::DecodedPicture>(std::move(*picture)),
                        .arrival = frame.last_arrival,
                        .decoding = settings_.clock() - start});
}

void PairMaker::on_update(UpdateArrival arrived) {
  if (broken_) return;
  const FrameId frame = arrived.update.meta.frame;
  const Time start = settings_.clock();
  codec::MoverChange movers;
  Result<codec::MetaUpdate> update = read(arrived.update.meta.meta, movers);
  if (!update) return lose_step(frame, update.error());
  if (update->frame != frame) {
    return break_with(fmt::format("meta update of frame {} came in the message of frame {}",
                                  value(update->frame), value(frame)));
  }
  if (out_of_step_ && !update->reset) return;
  out_of_step_ = false;
  if (++in_step_for_ >= kLongInStep) restarts_in_a_row_ = 0;
  const Duration decoding = settings_.clock() - start;
  if (!pairing_.add_update(frame, {std::move(*update), std::move(movers), std::move(arrived), decoding})) {
    break_with(fmt::format("meta update {} came out of order", value(frame)));
  }
}

Result<codec::MetaUpdate> PairMaker::read(ByteView bytes, codec::MoverChange& movers) {
  Result<codec::MetaUpdate> update = meta_->decode(bytes);
  if (update && moving_) movers = moving_->watch(*update);
  if (!update || !update->cue) return update;
  if (!mirror_) return Error{codec::MetaError::kBadVersion, "the atlas's memory was not described"};
  return mirror_->place(std::move(*update));
}

/// Codecs that keep state can come back after an error, if the server tells all anew; so can motion.
void PairMaker::lose_step(FrameId frame, const Error& why) {
  if (out_of_step_ && why.code == codec::MetaError::kOutOfStep) return;  // it is asked for already
  const bool keeps_state =
      moving_ || codec::keeps_state(static_cast<codec::MetaCodecKind>(stream_.meta_codec));
  const std::string text = fmt::format("meta update {}: {}", value(frame), why.message());
  if (!keeps_state || out_of_step_ || restarts_in_a_row_ == kMostRestarts) return break_with(text);
  spdlog::warn("{}; asking for all anew", text);
  out_of_step_ = true;
  in_step_for_ = 0;
  ++restarts_in_a_row_;
  ++counts_.restarts;
  troubles_.out_of_step(frame, text);
}

std::optional<Pair> PairMaker::next_pair() {
  while (!broken_) {
    auto step = pairing_.next_step();
    counts_.pairing = pairing_.counts();
    if (!step) break;
    const Time start = settings_.clock();
    if (const Result<void> applied = replica_.apply(step->update.update); !applied) {
      break_with(fmt::format("meta update {}: {}", value(step->frame), applied.error().message()));
      break;
    }
    if (!move(step->update)) continue;
    if (step->picture) return make_pair(*step->picture, step->update, start);
  }
  return std::nullopt;
}

/// Brings what moves to the update's frame. False: it is not known where that is, so nothing is shown.
bool PairMaker::move(const DecodedUpdate& update) {
  const ByteBuffer& told = update.arrived.update.meta.motion;
  if (!moving_) {
    if (!told.empty()) break_with("the server tells motion of a stream in which nothing moves");
    return told.empty();
  }
  if (motion_lost_ && !update.update.reset) return false;
  const Result<void> moved = moving_->move(update.movers, told);
  motion_lost_ = !moved;
  if (!moved) lose_step(update.update.frame, moved.error());
  return !motion_lost_;
}

Pair PairMaker::make_pair(const DecodedFrame& picture, const DecodedUpdate& update, Time start) {
  Pair pair;
  mesher_.build(replica_, moving_ ? &*moving_ : nullptr, pair.mesh);
  pair.origin = mesher_.origin();
  pair.picture = picture.picture;
  const ServerTimes& server = update.arrived.server;
  pair.server_pose = server.pose;
  const Time ready = settings_.clock();
  pair.times = {.frame = update.update.frame,
                .pose = update.arrived.update.meta.pose,
                .pose_sampled = server.pose ? std::optional(server.pose->sampled) : std::nullopt,
                .pose_received = server.pose_received,
                .render_start = server.render_start,
                .scene_time = moving_ ? std::optional(update.arrived.update.meta.scene_time) : std::nullopt,
                .scene_ahead = update.arrived.update.meta.scene_ahead,
                .encode_end = server.encode_end,
                .video_arrival = picture.arrival,
                .meta_arrival = update.arrived.update.arrival,
                .video_decoding = picture.decoding,
                .meta_decoding = update.decoding + (ready - start),
                .ready = ready};
  counts_.patches = replica_.patches().size();
  counts_.triangles = replica_.triangle_count();
  return pair;
}

void PairMaker::break_with(std::string why) {
  broken_ = true;
  troubles_.peer_broke(std::move(why));
}

}  // namespace atlaswire::client
