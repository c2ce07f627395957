#include "client/layout_mirror.h"
#include "client/moving_replica.h"
#include "client/replica.h"
#include "render/atlas/allocator.h"
#include "render/scene/assemble.h"
#include "render/scene/parade.h"
#include "server/motion_teller.h"
#include "server/replica_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>

namespace atlaswire::client {
namespace {

using codec::MetaCodecKind;

std::shared_ptr<const render::Scene> parade() {
  static const auto scene = std::make_shared<const render::Scene>(
      render::assemble(render::make_parade({.figures = 1, .cloths = 1, .orbiters = 4})).value());
  return scene;
}

/// Both ends of a stream of the parade, but for network, pictures and pairing.
class MovingStream {
 public:
  explicit MovingStream(MetaCodecKind kind)
      : mirrors_(codec::leaves_positions(kind)),
        scene_(parade()),
        moved_(scene_),
        tracker_(scene_, 0),
        teller_(scene_, tracker_.grid()),
        memory_(render::make_sequential_allocator(allocator_,
                                                  static_cast<std::uint32_t>(scene_->patches.size()))),
        limits_(tracker_.limits(allocator_.atlas)),
        encoder_(codec::make_meta_encoder(kind, limits_)),
        decoder_(codec::make_meta_decoder(kind, limits_)),
        mirror_({allocator_.superblock_log2, allocator_.min_block_log2, allocator_.high_water},
                allocator_.atlas, limits_.max_patches),
        replica_(limits_),
        moving_(teller_.description(), tracker_.grid(), 7) {}

  /// What a frame sends.
  struct Sent {
    ByteBuffer meta;
    ByteBuffer motion;
  };
  Sent send(std::uint32_t frame, double seconds, bool restart) {
    const std::vector<render::BlockRequest> visible = visible_in(frame);
    if (restart) memory_->restart();
    const render::LayoutChange& change = memory_->update(visible, false);
    const auto live = memory_->blocks();
    const FrameId id{frame};
    codec::MetaUpdate update;
    if (mirrors_) {
      const server::ReplicaTracker::Asked asked{visible, &change, live};
      update = restart ? tracker_.restart(id, asked) : tracker_.update(id, asked);
    } else {
      update = restart ? tracker_.restart(id, live) : tracker_.update(id, change);
    }
    moved_.pose(seconds);
    Sent sent;
    encoder_->encode(update, sent.meta);
    teller_.tell(update, teller_.look(moved_), sent.motion).value();
    return sent;
  }

  Result<void> receive(const Sent& sent) {
    auto update = decoder_->decode(sent.meta);
    if (!update) return update.error();
    const codec::MoverChange movers = moving_.watch(*update);
    if (update->cue) {
      update = mirror_.place(std::move(*update));
      if (!update) return update.error();
    }
    if (auto applied = replica_.apply(*update); !applied) return applied;
    return moving_.move(movers, sent.motion);
  }

  /// Farthest of any corner from where the server has it, in grid errors: of what rests, is rigid, deforms.
  std::array<double, 3> errors() const {
    std::array<double, 3> worst{};
    const PositionGrid& grid = tracker_.grid();
    for (const ReplicaPatch& patch : replica_.patches()) {
      const std::uint32_t count = corner_count(patch.triangles);
      std::array<glm::vec3, kMaxPatchCorners> at{};
      for (std::uint32_t c = 0; c < count; ++c)
        at[c] = glm::vec3(grid.position(replica_.positions()[value(patch.corners[c])]) - scene_->origin);
      moving_.place(patch.id, replica_.positions(), std::span(patch.corners).first(count), scene_->origin,
                    std::span(at).first(count));
      const Mover* mover = codec::find_mover(teller_.description().movers, patch.id);
      const std::size_t kind = mover == nullptr ? 0 : mover->deforms ? 2 : 1;
      for (std::uint32_t c = 0; c < count; ++c) {
        const std::uint32_t vertex = scene_->patches[value(patch.id)].vertices[c];
        const double error = glm::distance(glm::dvec3(at[c]), glm::dvec3(moved_.vertex(vertex).position));
        worst[kind] = std::max(worst[kind], error / grid.max_error());
      }
    }
    return worst;
  }
  [[nodiscard]] std::size_t patches() const { return replica_.patches().size(); }

 private:
  /// Runs of patches come and go, of movers and of what rests.
  [[nodiscard]] std::vector<render::BlockRequest> visible_in(std::uint32_t frame) const {
    std::vector<render::BlockRequest> visible;
    for (std::uint32_t p = 0; p < scene_->patches.size(); ++p) {
      if ((p / 24 + frame / 3) % 4 != 0) visible.push_back({PatchId{p}, 2, 2, false});
    }
    return visible;
  }

  bool mirrors_;
  render::AllocatorSettings allocator_{.atlas = {512, 512}};
  std::shared_ptr<const render::Scene> scene_;
  render::MovedScene moved_;
  server::ReplicaTracker tracker_;
  server::MotionTeller teller_;
  std::unique_ptr<render::AtlasAllocator> memory_;
  codec::MetaLimits limits_;
  std::unique_ptr<codec::MetaEncoder> encoder_;
  std::unique_ptr<codec::MetaDecoder> decoder_;
  LayoutMirror mirror_;
  Replica replica_;
  MovingReplica moving_;
};

class MovingStreamTest : public ::testing::TestWithParam<MetaCodecKind> {};

TEST_P(MovingStreamTest, BringsEverythingWhereTheServerHasIt) {
  MovingStream stream(GetParam());
  for (std::uint32_t frame = 0; frame < 40; ++frame) {
    // A restart in the middle, as after a client lost step.
    const auto sent = stream.send(frame, 0.2 + frame / 30.0, frame == 0 || frame == 25);
    const auto received = stream.receive(sent);
    ASSERT_TRUE(received) << received.error().message() << " at " << frame;
    ASSERT_GT(stream.patches(), 1000U);
    const auto [resting, rigid, deformed] = stream.errors();
    constexpr double kFloat = 0.02;  // float positions are relative to the scene's origin
    ASSERT_LE(resting, 1 + kFloat) << frame;
    ASSERT_LE(rigid, 3 + kFloat) << frame << ": rest, translation and rotation err once each";
    ASSERT_LE(deformed, 1 + kFloat) << frame;
    ASSERT_GT(rigid, 0.0);
    ASSERT_GT(deformed, 0.0);
  }
}

TEST_P(MovingStreamTest, NoticesALostMessageAndHealsWithARestart) {
  MovingStream stream(GetParam());
  ASSERT_TRUE(stream.receive(stream.send(0, 0.0, true)));
  ASSERT_TRUE(stream.receive(stream.send(1, 0.1, false)));
  auto robbed = stream.send(2, 0.2, false);
  robbed.motion.clear();
  EXPECT_EQ(stream.receive(robbed).error().code, codec::MotionError::kTruncated);
  EXPECT_EQ(stream.receive(stream.send(3, 0.3, false)).error().code, codec::MotionError::kOutOfStep);
  ASSERT_TRUE(stream.receive(stream.send(4, 0.4, true)));
  EXPECT_LE(stream.errors()[2], 1.02);
}

INSTANTIATE_TEST_SUITE_P(Codecs, MovingStreamTest,
                         ::testing::Values(MetaCodecKind::kMirror, MetaCodecKind::kGate,
                                           MetaCodecKind::kPlain, MetaCodecKind::kPaper),
                         [](const auto& param) { return std::string(codec::name(param.param)); });

}  // namespace
}  // namespace atlaswire::client
