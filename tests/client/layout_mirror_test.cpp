#include "client/layout_mirror.h"

#include "tests/client/mirrored_stream.h"
#include "tests/render/atlas/layout_checker.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace atlaswire::client {
namespace {

using render::AllocatorSettings;
using render::DriftingScene;
using render::small_atlas;
using Load = render::DriftLoad;
using testing::MirroredStream;

class LayoutMirrorDrift : public ::testing::TestWithParam<Load> {};

TEST_P(LayoutMirrorDrift, ShowsTheServersLayoutFrameByFrame) {
  const Load& run = GetParam();
  MirroredStream stream(run.settings, run.patches);
  DriftingScene scene(7, run.patches, run.settings);
  int resets = 0;
  for (int frame = 0; frame < run.frames; ++frame) {
    const auto& visible = scene.step(frame == 0 ? 1.0 : run.churn, run.visible, run.largest_log2);
    // Now and then somebody joins whom the server tells all; between that memory resets when it must.
    const bool restart = frame % 211 == 0;
    if (restart) stream.join();
    const codec::MetaUpdate update = stream.serve(visible, frame % 5 == 0, restart);
    resets += update.cue->reset && !restart ? 1 : 0;
    ASSERT_EQ(stream.carry(update), "") << "frame " << frame;
  }
  RecordProperty("resets", resets);
}

INSTANTIATE_TEST_SUITE_P(
    Loads, LayoutMirrorDrift,
    ::testing::Values(Load{"comfortable", small_atlas(), 600, 0.05, 0.4, 4, 3000},
                      Load{"overload", small_atlas(), 3000, 0.05, 0.5, 4, 600},
                      Load{"all_new_every_frame", small_atlas(), 400, 1.0, 0.5, 5, 500},
                      Load{"one_superblock", small_atlas(32, 5, 1), 40, 0.2, 0.5, 5, 2000},
                      Load{"one_texel_blocks", small_atlas(64, 4, 0), 3000, 0.1, 0.7, 1, 300},
                      Load{"fewer_blocks_than_patches", small_atlas(64, 4, 3), 300, 0.2, 0.8, 4, 600},
                      Load{"oblong", {.atlas = {512, 64}, .superblock_log2 = 6}, 300, 0.1, 0.5, 6, 1000}),
    [](const auto& load) { return std::string(load.param.name); });

TEST(LayoutMirror, ResetsWithTheServer) {
  // Large blocks after small ones: only a reset makes room, and the server takes it.
  MirroredStream stream(small_atlas(64, 5, 1), 400);
  DriftingScene scene(3, 400, small_atlas(64, 5, 1));
  int resets = 0;
  for (int frame = 0; frame < 400; ++frame) {
    const auto& visible = scene.step(0.3, frame % 80 < 40 ? 0.9 : 0.05, frame % 80 < 40 ? 1 : 5);
    const codec::MetaUpdate update = stream.serve(visible, frame % 3 == 0, frame == 0);
    resets += update.cue->reset ? 1 : 0;
    ASSERT_EQ(stream.carry(update), "") << "frame " << frame;
  }
  EXPECT_GT(resets, 3);
}

/// Some frames into a stream whose atlas is under pressure.
struct LayoutMirrorTest : ::testing::Test {
  LayoutMirrorTest() {
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(stream.carry(stream.serve(scene.step(0.2, 0.6, 4), i % 5 == 0, i == 0)), "");
    }
  }
  std::string carry_next(bool restart = false) {
    return stream.carry(stream.serve(scene.step(0.2, 0.6, 4), false, restart));
  }

  MirroredStream stream{small_atlas(128), 600};
  DriftingScene scene{5, 600, small_atlas(128)};
};

const std::string kOutOfStep = error_text(codec::MetaError::kOutOfStep);

TEST_F(LayoutMirrorTest, SaysThatItIsOutOfStepUntilARestart) {
  codec::MetaUpdate update = stream.serve(scene.step(0.2, 0.6, 4), false);
  update.cue->check ^= 1U;
  EXPECT_NE(stream.carry(update).find(kOutOfStep), std::string::npos);
  EXPECT_EQ(carry_next(), kOutOfStep);
  EXPECT_EQ(carry_next(), kOutOfStep);
  EXPECT_EQ(carry_next(true), "");
  EXPECT_EQ(carry_next(), "");
}

TEST_F(LayoutMirrorTest, NoticesAnotherMemory) {
  AllocatorSettings other = small_atlas(128);
  other.superblock_log2 = 6;
  LayoutMirror mirror({other.superblock_log2, other.min_block_log2, other.high_water}, other.atlas, 600);
  const auto placed = mirror.place(stream.serve(scene.step(0.2, 0.6, 4), false, true));
  ASSERT_FALSE(placed);
  EXPECT_EQ(placed.error().code, codec::MetaError::kOutOfStep);
}

TEST_F(LayoutMirrorTest, NeedsTheBeginning) {
  stream.join();
  const codec::MetaUpdate update = stream.serve(scene.step(0.2, 0.6, 4), false);
  const auto placed = stream.mirror().place(update);
  ASSERT_FALSE(placed);
  EXPECT_EQ(placed.error().code, codec::MetaError::kOutOfStep);
}

TEST_F(LayoutMirrorTest, RefusesContradictions) {
  const auto refusal = [](const std::function<void(codec::MetaUpdate&)>& spoil) {
    LayoutMirror mirror({5, 1, 0.95}, {128, 128}, 600);
    codec::MetaUpdate first;
    first.reset = true;
    first.cue.emplace();
    first.added = {{.id = PatchId{4}}, {.id = PatchId{7}}};
    spoil(first);
    const auto placed = mirror.place(first);
    return placed ? std::error_code{} : placed.error().code;
  };
  EXPECT_EQ(refusal([](auto& u) { u.removed = {PatchId{4}}; }), ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) { u.moved = {{PatchId{4}, {}}}; }), ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) { u.added.push_back(u.added[0]); }), ReplicaError::kPatchKnown);
  EXPECT_EQ(refusal([](auto& u) { u.added[1].id = PatchId{600}; }), ReplicaError::kPatchOutOfRange);
}

TEST(LayoutMirror, RefusesWhatDoesNotFitWhoAskedBefore) {
  const auto refusal = [](const std::function<void(codec::MetaUpdate&)>& spoil) {
    LayoutMirror mirror({5, 1, 0.95}, {128, 128}, 600, true);
    codec::MetaUpdate update;
    update.reset = true;
    update.cue.emplace();
    update.added = {{.id = PatchId{4}}, {.id = PatchId{7}}, {.id = PatchId{90}}};
    EXPECT_TRUE(mirror.place(update));
    codec::MetaUpdate second;
    second.cue.emplace();
    spoil(second);
    const auto placed = mirror.place(second);
    // What was refused leaves nothing behind.
    const auto again = mirror.place(update);
    EXPECT_TRUE(again && again->added.size() == 3 && again->removed.empty());
    return placed ? std::error_code{} : placed.error().code;
  };
  EXPECT_EQ(refusal([](auto& u) { u.removed = {PatchId{90}, PatchId{4}}; }), std::error_code{});
  EXPECT_EQ(refusal([](auto& u) { u.removed = {PatchId{4}, PatchId{4}}; }), ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) { u.removed = {PatchId{5}}; }), ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) { u.removed = {PatchId{~0U}}; }), ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) { u.moved = {{PatchId{7}, {}}, {PatchId{4}, {}}}; }), std::error_code{});
  EXPECT_EQ(refusal([](auto& u) {
              u.moved = {{PatchId{7}, {}}, {PatchId{7}, {}}};
            }),
            ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) { u.moved = {{PatchId{6}, {}}}; }), ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) {
              u.added = {{.id = PatchId{5}}};
              u.moved = {{PatchId{5}, {}}};
            }),
            ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) {
              u.removed = {PatchId{7}};
              u.moved = {{PatchId{7}, {}}};
            }),
            ReplicaError::kPatchUnknown);
  EXPECT_EQ(refusal([](auto& u) { u.added = {{.id = PatchId{5}}, {.id = PatchId{3}}}; }), std::error_code{});
  EXPECT_EQ(refusal([](auto& u) { u.added = {{.id = PatchId{4}}}; }), ReplicaError::kPatchKnown);
  EXPECT_EQ(refusal([](auto& u) {
              u.removed = {PatchId{4}};
              u.added = {{.id = PatchId{4}}};
            }),
            ReplicaError::kPatchKnown);
}

TEST_F(LayoutMirrorTest, TakesLevelsThatNoBlockHas) {
  // A hostile server asks for the impossible: the memory makes legal blocks of it.
  codec::MetaUpdate wild;
  wild.reset = true;
  wild.cue.emplace();
  for (std::uint32_t i = 0; i < 600; ++i) {
    wild.added.push_back({.id = PatchId{i},
                          .block = {.x = 9,
                                    .width_log2 = static_cast<std::uint8_t>(i % 256),
                                    .height_log2 = static_cast<std::uint8_t>(i * 7 % 256)}});
  }
  std::vector<render::BlockRequest> requests;
  for (const codec::AddedPatch& patch : wild.added) {
    requests.push_back({patch.id, patch.block.width_log2, patch.block.height_log2, false});
  }
  const AllocatorSettings settings = small_atlas(128);
  const auto memory = render::make_sequential_allocator(settings, 600);
  memory->restart();
  memory->update(requests, false);
  render::LayoutHash hash;
  hash.begin(memory->blocks());
  wild.cue->check = hash.hash().upper();
  LayoutMirror mirror({5, 1, 0.95}, {128, 128}, 600);
  const auto placed = mirror.place(wild);
  ASSERT_TRUE(placed);
  EXPECT_EQ(placed->added.size(), memory->blocks().size());
  for (const codec::AddedPatch& patch : placed->added) {
    EXPECT_LE(patch.block.x + patch.block.width(), 128U);
    EXPECT_LE(patch.block.y + patch.block.height(), 128U);
  }
}

}  // namespace
}  // namespace atlaswire::client
