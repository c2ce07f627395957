#pragma once

#include "render/scene/source.h"

#include <cstdint>
#include <functional>
#include <span>

namespace atlaswire::render {

/// Number of pieces a smooth thing is cut into at a detail factor (1: as designed), at least `least`; grows
/// with the square root, so that triangles grow with the factor.
std::uint32_t pieces(std::uint32_t at_detail_one, double detail, std::uint32_t least = 1);

/// A sheet of `columns` x `rows` quads over the unit square; `at(u, v)` gives position and texture
/// coordinates. Its front is where u x v points. Normals come from the positions; equal points get equal
/// normals.
SourceMesh sheet(std::uint32_t columns, std::uint32_t rows,
                 const std::function<SourceVertex(float u, float v)>& at);

/// A surface of revolution about +Y: `profile` holds (radius, height) from bottom to top, `flute` deepens the
/// radius by a share at `flutes` grooves around.
struct Revolution {
  std::span<const glm::vec2> profile;
  std::uint32_t around = 32;
  std::uint32_t between = 1;  ///< quads from one profile point to the next
  std::uint32_t flutes = 0;
  float flute_depth = 0.0F;
  glm::vec2 uv_scale{1.0F};  ///< repeats around, repeats a metre along the profile
};
SourceMesh revolve(const Revolution& shape);

/// An axis-parallel box with faces cut into quads of at most `cell` metres, texture coordinates in metres
/// times `uv_scale`.
SourceMesh box(const glm::vec3& low, const glm::vec3& high, float cell, float uv_scale);

/// Appends `more` to `mesh`.
void append(SourceMesh& mesh, const SourceMesh& more);

}  // namespace atlaswire::render
