// Bytes of the gate form that must not change unnoticed, and sets of points at the edges of what it takes.
#include "base/grid.h"
#include "tests/codec/gate_stream.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

namespace atlaswire::codec {
namespace {

MetaLimits limits_of(std::uint32_t grid_bits) {
  return {.max_vertices = 1U << 21U, .max_patches = 1U << 20U, .grid_bits = grid_bits, .atlas = {1024, 512}};
}

std::string hex(ByteView bytes) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string text;
  for (const std::byte octet : bytes) {
    text += kDigits[std::to_integer<unsigned>(octet) >> 4U];
    text += kDigits[std::to_integer<unsigned>(octet) & 15U];
  }
  return text;
}

Block block_at(std::uint16_t x) { return {.x = x, .y = 8, .width_log2 = 3, .height_log2 = 2}; }

/// A quad and a triangle beside it.
MetaUpdate first_update() {
  MetaUpdate update;
  update.frame = FrameId{7};
  update.reset = true;
  update.vertices = {{VertexId{0}, {100, 100, 50}},
                     {VertexId{1}, {200, 100, 50}},
                     {VertexId{2}, {200, 200, 50}},
                     {VertexId{3}, {100, 200, 51}},
                     {VertexId{4}, {310, 150, 60}}};
  update.added = {{.id = PatchId{3},
                   .triangles = 2,
                   .corners = {VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}},
                   .block = block_at(128)},
                  {.id = PatchId{5},
                   .draw = {.alpha = PatchClass::Alpha::kMask, .double_sided = true},
                   .corners = {VertexId{1}, VertexId{4}, VertexId{2}},
                   .block = block_at(136)}};
  return update;
}

/// A patch goes, one comes that grows from what is left, one gets another block.
MetaUpdate second_update() {
  MetaUpdate update;
  update.frame = FrameId{8};
  update.removed = {PatchId{5}};
  update.vertices = {{VertexId{5}, {100, 300, 52}}, {VertexId{6}, {200, 300, 51}}};
  update.added = {{.id = PatchId{4},
                   .triangles = 2,
                   .corners = {VertexId{3}, VertexId{2}, VertexId{6}, VertexId{5}},
                   .block = block_at(64)}};
  update.moved = {{PatchId{3}, {.x = 0, .y = 0, .width_log2 = 4, .height_log2 = 2, .transposed = true}}};
  return update;
}

/// A known patch comes back in another shape: what was known of it is dropped.
MetaUpdate third_update() {
  MetaUpdate update;
  update.frame = FrameId{9};
  update.added = {{.id = PatchId{5},
                   .draw = {.alpha = PatchClass::Alpha::kMask, .double_sided = true},
                   .corners = {VertexId{1}, VertexId{4}, VertexId{6}},
                   .block = block_at(136)}};
  return update;
}

/// The first quad and the triangle beside it once more, elsewhere and turned: the shape is remembered.
MetaUpdate fourth_update() {
  MetaUpdate update;
  update.frame = FrameId{10};
  update.vertices = {{VertexId{7}, {1980, 1140, 50}},
                     {VertexId{8}, {2040, 1220, 50}},
                     {VertexId{9}, {1960, 1280, 50}},
                     {VertexId{10}, {1900, 1200, 51}},
                     {VertexId{11}, {2066, 1338, 60}}};
  update.added = {
      {.id = PatchId{20},
       .triangles = 2,
       .corners = {VertexId{7}, VertexId{8}, VertexId{9}, VertexId{10}},
       .block = block_at(256)},
      {.id = PatchId{21}, .corners = {VertexId{8}, VertexId{11}, VertexId{9}}, .block = block_at(264)}};
  return update;
}

TEST(GateMetaGolden, BytesStayAsTheyAre) {
  GateMetaEncoder encoder(limits_of(16));
  const auto bytes_of = [&](const MetaUpdate& update) {
    ByteBuffer out;
    encoder.encode(update, out);
    return hex(out);
  };
  EXPECT_EQ(bytes_of(first_update()), "A300000007082BBCC8358DD548D4AE59FF75E509502948FD048EECBBA8");
  EXPECT_EQ(bytes_of(second_update()), "A2AB4F5A45E71D7B3EDC1847");
  EXPECT_EQ(bytes_of(third_update()), "A2E1FEE21F24DD5248F226AF0337E06F");
  EXPECT_EQ(bytes_of(fourth_update()), "A22EF745ADF76F99C1F6519FBC35B320BDAD607C655B");
}

TEST(GateMetaGolden, UpdatesComeThrough) {
  GateStream stream(limits_of(16));
  ASSERT_NO_FATAL_FAILURE(stream.pass(first_update()));
  ASSERT_NO_FATAL_FAILURE(stream.pass(second_update()));
  ASSERT_NO_FATAL_FAILURE(stream.pass(third_update()));
  ASSERT_NO_FATAL_FAILURE(stream.pass(fourth_update()));
}

/// Patches of one triangle over `count` points, each next to those before; `at` gives a point.
template <class At>
MetaUpdate strip(std::uint32_t count, At at) {
  MetaUpdate update;
  update.reset = true;
  for (std::uint32_t v = 0; v < count; ++v) update.vertices.push_back({VertexId{v}, at(v)});
  for (std::uint32_t i = 0; i + 2 < count; i += 2) {
    update.added.push_back({.id = PatchId{i / 2},
                            .corners = {VertexId{i}, VertexId{i + 1}, VertexId{i + 2}},
                            .block = block_at(static_cast<std::uint16_t>(i % 64 * 8))});
  }
  return update;
}

TEST(GateMetaExtremes, AMillionPointsComeThrough) {
  GateStream stream(limits_of(20));
  const auto scattered = [](std::uint32_t v) {
    const std::uint32_t x = v * 2654435761U;
    return GridPosition(x >> 12U, v, (x ^ v * 40503U) & 0xFFFFFU);
  };
  ASSERT_NO_FATAL_FAILURE(stream.pass(strip(1U << 20U, scattered)));
}

TEST(GateMetaExtremes, OnePointInEveryCornerComesThrough) {
  GateStream stream(limits_of(8));
  ASSERT_NO_FATAL_FAILURE(stream.pass(strip(1000, [](std::uint32_t) { return GridPosition(255, 0, 255); })));
}

TEST(GateMetaExtremes, EdgesOfManyPatchesComeThrough) {
  // A fan of 50 triangles on one edge, wound either way, each there twice.
  MetaUpdate update;
  update.reset = true;
  update.vertices = {{VertexId{0}, {500, 500, 0}}, {VertexId{1}, {500, 500, 1000}}};
  for (std::uint32_t i = 0; i < 50; ++i) {
    update.vertices.push_back({VertexId{i + 2}, {400 + 7 * i, 300 + i * i, 500}});
    for (std::uint32_t copy = 0; copy < 2; ++copy) {
      AddedPatch patch{.id = PatchId{2 * i + copy}, .corners = {VertexId{0}, VertexId{1}, VertexId{i + 2}}};
      if (i % 2 == 1) std::swap(patch.corners[0], patch.corners[1]);
      update.added.push_back(patch);
    }
  }
  GateStream stream(limits_of(16));
  ASSERT_NO_FATAL_FAILURE(stream.pass(update));
}

TEST(GateMetaExtremes, MillimetresInAMillionMetresStayWithinTheBound) {
  // Points a millimetre apart, 10^6 m apart: the finest grid cannot tell the former, and none is lost.
  const PositionGrid grid = PositionGrid::over(glm::dvec3(0), glm::dvec3(1e6), 20);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 3000; ++i)
    points.push_back(glm::dvec3(i % 2 * 1e6 - i % 3 * 1e-3, i * 1e-3, 5e5 + i * 333.333));
  const MetaUpdate update = strip(3000, [&](std::uint32_t v) { return grid.quantize(points[v]); });
  GateStream stream(limits_of(20));
  ASSERT_NO_FATAL_FAILURE(stream.pass(update));
  EXPECT_EQ(stream.got.patches().size(), update.added.size());
  for (const auto& [id, patch] : stream.got.patches()) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const auto& p = patch.positions[corner];
      const glm::dvec3 got = grid.position({p[0], p[1], p[2]});
      const glm::dvec3 wanted = glm::clamp(points[2 * value(id) + corner], 0.0, 1e6);
      EXPECT_LE(glm::distance(got, wanted), grid.max_error() * 1.0001);
    }
  }
}

}  // namespace
}  // namespace atlaswire::codec
