#include "client/replica.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace atlaswire::client {
namespace {

codec::MetaLimits small_limits() {
  return {.max_vertices = 200, .max_patches = 100, .grid_bits = 8, .atlas = {256, 128}};
}

codec::AddedPatch patch(std::uint32_t id, std::vector<std::uint32_t> corners, Block block = {0, 0, 3, 2}) {
  codec::AddedPatch p{.id = PatchId{id},
                      .triangles = static_cast<std::uint8_t>(corners.size() - 2),
                      .draw = {},
                      .corners = {},
                      .block = block};
  for (std::size_t i = 0; i < corners.size(); ++i) p.corners[i] = VertexId{corners[i]};
  return p;
}

codec::NewVertex vertex(std::uint32_t id, std::uint32_t x = 1) {
  return {.id = VertexId{id}, .position = {x, 2, 3}};
}

/// Four vertices and the patches 3 (2 triangles) and 4 (1 triangle).
codec::MetaUpdate first_update() {
  return {.frame = FrameId{7},
          .reset = true,
          .removed = {},
          .vertices = {vertex(0), vertex(1), vertex(2), vertex(5, 9)},
          .added = {patch(3, {0, 1, 2, 5}), patch(4, {2, 1, 0})},
          .moved = {}};
}

/// What a replica holds, in an order of its own.
std::map<std::uint32_t, ReplicaPatch> contents(const Replica& r) {
  std::map<std::uint32_t, ReplicaPatch> all;
  for (const ReplicaPatch& p : r.patches()) all.emplace(value(p.id), p);
  return all;
}

void expect_refused(Replica& r, const codec::MetaUpdate& update, ReplicaError why) {
  const auto before = contents(r);
  const std::size_t vertices = r.vertex_count();
  const Result<void> result = r.apply(update);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, make_error_code(why)) << result.error().message();
  const auto after = contents(r);
  EXPECT_EQ(r.vertex_count(), vertices);
  ASSERT_EQ(after.size(), before.size());
  for (const auto& [id, p] : before) EXPECT_EQ(after.at(id).block, p.block);
}

TEST(Replica, AddsVerticesAndPatches) {
  Replica r(small_limits());
  ASSERT_TRUE(r.apply(first_update()));
  EXPECT_EQ(r.vertex_count(), 4U);
  EXPECT_EQ(r.triangle_count(), 3U);
  ASSERT_EQ(r.patches().size(), 2U);
  EXPECT_EQ(r.positions()[5], (GridPosition{9, 2, 3}));
}

TEST(Replica, RemovesAndMoves) {
  Replica r(small_limits());
  ASSERT_TRUE(r.apply(first_update()));
  codec::MetaUpdate u;
  u.removed = {PatchId{3}};
  u.moved = {{PatchId{4}, Block{16, 8, 2, 2}}};
  ASSERT_TRUE(r.apply(u));
  ASSERT_EQ(r.patches().size(), 1U);
  EXPECT_EQ(r.patches()[0].id, PatchId{4});
  EXPECT_EQ(r.patches()[0].block.x, 16);
  EXPECT_EQ(r.triangle_count(), 1U);
  EXPECT_EQ(r.vertex_count(), 4U) << "vertices outlive their patches";
}

TEST(Replica, ResetForgetsVertices) {
  Replica r(small_limits());
  ASSERT_TRUE(r.apply(first_update()));
  codec::MetaUpdate u;
  u.reset = true;
  u.added = {patch(3, {0, 1, 2})};
  expect_refused(r, u, ReplicaError::kVertexUnknown);
  u.vertices = {vertex(0), vertex(1), vertex(2)};
  ASSERT_TRUE(r.apply(u));
  EXPECT_EQ(r.patches().size(), 1U);
  EXPECT_EQ(r.vertex_count(), 3U);
}

TEST(Replica, AllowsRemovingAndAddingInOneUpdate) {
  Replica r(small_limits());
  ASSERT_TRUE(r.apply(first_update()));
  codec::MetaUpdate u;
  u.removed = {PatchId{3}};
  u.added = {patch(3, {0, 1, 2}, Block{32, 0, 1, 1})};
  u.moved = {{PatchId{3}, Block{64, 0, 1, 1}}};
  ASSERT_TRUE(r.apply(u));
  EXPECT_EQ(contents(r).at(3).block.x, 64);
  EXPECT_EQ(r.triangle_count(), 2U);
}

TEST(Replica, RefusesWhatContradictsItAndStaysAsItWas) {
  Replica r(small_limits());
  ASSERT_TRUE(r.apply(first_update()));
  const auto with = [](auto change) {
    codec::MetaUpdate u;
    change(u);
    return u;
  };
  using U = codec::MetaUpdate;
  expect_refused(r, with([](U& u) { u.removed = {PatchId{99}}; }), ReplicaError::kPatchUnknown);
  expect_refused(r, with([](U& u) { u.removed = {PatchId{3}, PatchId{3}}; }), ReplicaError::kPatchUnknown);
  expect_refused(r, with([](U& u) {
                   u.moved = {{PatchId{9}, Block{0, 0, 1, 1}}};
                 }),
                 ReplicaError::kPatchUnknown);
  expect_refused(r, with([](U& u) {
                   u.removed = {PatchId{3}};
                   u.moved = {{PatchId{3}, Block{0, 0, 1, 1}}};
                 }),
                 ReplicaError::kPatchUnknown);
  expect_refused(r, with([](U& u) { u.added = {patch(3, {0, 1, 2})}; }), ReplicaError::kPatchKnown);
  expect_refused(r, with([](U& u) {
                   u.added = {patch(8, {0, 1, 2}), patch(8, {0, 1, 2})};
                 }),
                 ReplicaError::kPatchKnown);
  expect_refused(r, with([](U& u) { u.added = {patch(100, {0, 1, 2})}; }), ReplicaError::kPatchOutOfRange);
  expect_refused(r, with([](U& u) { u.added = {patch(8, {0, 1, 6})}; }), ReplicaError::kVertexUnknown);
  expect_refused(r, with([](U& u) { u.vertices = {vertex(0)}; }), ReplicaError::kVertexKnown);
  expect_refused(r, with([](U& u) { u.vertices = {vertex(9), vertex(9)}; }), ReplicaError::kVertexKnown);
  expect_refused(r, with([](U& u) { u.vertices = {vertex(200)}; }), ReplicaError::kVertexOutOfRange);
  expect_refused(r, with([](U& u) { u.vertices = {vertex(9, 256)}; }), ReplicaError::kBadPosition);
  expect_refused(r, with([](U& u) {
                   u.added = {patch(8, {0, 1, 2}, Block{250, 0, 3, 2})};
                 }),
                 ReplicaError::kBadBlock);
  expect_refused(r, with([](U& u) {
                   u.added = {patch(8, {0, 1, 2}, Block{0, 0, 2, 3})};
                 }),
                 ReplicaError::kBadBlock);
  expect_refused(r, with([](U& u) {
                   u.moved = {{PatchId{4}, Block{0, 127, 1, 1}}};
                 }),
                 ReplicaError::kBadBlock);
  expect_refused(r, with([](U& u) {
                   u.moved = {{PatchId{4}, Block{0, 0, 200, 1}}};
                 }),
                 ReplicaError::kBadBlock);
  expect_refused(r, with([](U& u) {
                   u.added = {patch(8, {0, 1, 2})};
                   u.added[0].triangles = 4;
                 }),
                 ReplicaError::kBadTriangleCount);
  expect_refused(r, with([](U& u) {
                   u.reset = true;
                   u.removed = {PatchId{3}};
                 }),
                 ReplicaError::kRemovalAfterReset);
}

TEST(Replica, ARefusedUpdateLeavesNoMarksBehind) {
  Replica r(small_limits());
  ASSERT_TRUE(r.apply(first_update()));
  codec::MetaUpdate bad;
  bad.removed = {PatchId{3}};
  bad.vertices = {vertex(9), vertex(0)};
  ASSERT_FALSE(r.apply(bad));
  codec::MetaUpdate good;
  good.removed = {PatchId{3}};
  good.vertices = {vertex(9)};
  good.added = {patch(3, {0, 1, 9})};
  EXPECT_TRUE(r.apply(good));
}

TEST(Replica, FollowsAModelThroughRandomUpdates) {
  Replica r(small_limits());
  Random random(17);
  std::map<std::uint32_t, codec::AddedPatch> model;
  codec::MetaUpdate start;
  for (std::uint32_t v = 0; v < 200; ++v) start.vertices.push_back(vertex(v));
  ASSERT_TRUE(r.apply(start));
  for (int round = 0; round < 500; ++round) {
    codec::MetaUpdate u;
    for (std::uint32_t id = 0; id < 100; ++id) {
      const std::uint64_t dice = random.below(10);
      const bool live = model.contains(id);
      const Block block{static_cast<std::uint16_t>(random.below(30) * 8),
                        static_cast<std::uint16_t>(random.below(15) * 8), 3, 3};
      if (live && dice == 0) {
        u.removed.push_back(PatchId{id});
        model.erase(id);
      } else if (live && dice == 1) {
        u.moved.push_back({PatchId{id}, block});
        model.at(id).block = block;
      } else if (!live && dice < 3) {
        const auto corner = static_cast<std::uint32_t>(random.below(190));
        u.added.push_back(patch(id, {corner, corner + 1, corner + 2, corner + 3, corner + 4}, block));
        model.emplace(id, u.added.back());
      }
    }
    ASSERT_TRUE(r.apply(u));
    const auto held = contents(r);
    ASSERT_EQ(held.size(), model.size());
    ASSERT_EQ(r.triangle_count(), model.size() * 3);
    for (const auto& [id, p] : model) {
      ASSERT_TRUE(held.contains(id));
      ASSERT_EQ(held.at(id).block, p.block);
      ASSERT_EQ(held.at(id).corners, p.corners);
    }
  }
}

}  // namespace
}  // namespace atlaswire::client
