#include "render/scene/atrium_materials.h"

#include "render/scene/procedural_texture.h"

#include <cmath>
#include <glm/common.hpp>
#include <numbers>

namespace atlaswire::render {

namespace {

constexpr std::uint32_t kSide = 256;
constexpr std::uint32_t kFine = 512;
constexpr float kTau = 2.0F * std::numbers::pi_v<float>;

glm::vec4 opaque(const glm::vec3& c) { return {c, 1.0F}; }
glm::vec4 metal_rough(float metallic, float roughness) { return {0.0F, roughness, metallic, 1.0F}; }

/// 1 inside a joint of `width` (share of a cell) around cells of a grid, softened at its rim.
float joint(glm::vec2 cell, float width) {
  const glm::vec2 f = glm::min(cell - glm::floor(cell), 1.0F - (cell - glm::floor(cell)));
  return 1.0F - glm::smoothstep(width, width * 2.0F, std::min(f.x, f.y));
}

/// Bricks: 4 courses of 2, each second course shifted by half.
glm::vec2 brick_cell(glm::vec2 uv) {
  const float course = std::floor(uv.y * 8.0F);
  return {uv.x * 4.0F + (std::fmod(course + 16.0F, 2.0F) > 0.5F ? 0.5F : 0.0F), uv.y * 8.0F};
}
float brick_joint(glm::vec2 uv) {
  const glm::vec2 c = brick_cell(uv);
  const glm::vec2 f = glm::min(c - glm::floor(c), 1.0F - (c - glm::floor(c)));
  return 1.0F - glm::smoothstep(0.03F, 0.07F, std::min(f.x, f.y * 0.5F));
}
float brick_tint(glm::vec2 uv) {
  const glm::vec2 c = glm::floor(brick_cell(uv));
  return tiled_noise(glm::vec2(std::fmod(c.x + 8.0F, 4.0F) * 0.25F + 0.1F, c.y * 0.125F + 0.05F), 16, 71);
}

/// A leaf's coverage: pointed ovals scattered over the card on a jittered grid.
float leaves(glm::vec2 uv) {
  const glm::vec2 cell = uv * 6.0F;
  float best = 0.0F;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const glm::vec2 home = glm::floor(cell) + glm::vec2(static_cast<float>(dx), static_cast<float>(dy));
      const glm::vec2 key = (home + 0.5F) / 6.0F;
      const float turn = kTau * tiled_noise(key, 24, 5);
      const glm::vec2 jitter(tiled_noise(key, 24, 6), tiled_noise(key, 24, 7));
      const glm::vec2 d = cell - home - 0.2F - 0.6F * jitter;
      const glm::vec2 r(d.x * std::cos(turn) + d.y * std::sin(turn),
                        d.y * std::cos(turn) - d.x * std::sin(turn));
      const float inside = 1.0F - std::abs(r.x) / 0.62F - r.y * r.y / 0.085F;
      best = std::max(best, glm::smoothstep(-0.03F, 0.08F, inside));
    }
  }
  return best;
}

/// One material under construction.
class Painter {
 public:
  explicit Painter(SceneSource& source) : source_(source) {}

  std::int32_t add(Texture texture) {
    source_.textures.push_back(std::move(texture));
    return static_cast<std::int32_t>(source_.textures.size() - 1);
  }
  Material& material(const char* name, float roughness, float metallic = 0.0F) {
    Material m;
    m.name = name;
    m.roughness = roughness;
    m.metallic = metallic;
    source_.materials.push_back(m);
    return source_.materials.back();
  }

 private:
  SceneSource& source_;
};

void floors(Painter& p) {
  const auto veins = [](glm::vec2 uv) {
    return std::pow(1.0F - std::abs(2.0F * tiled_fbm(uv, 4, 5, 3) - 1.0F), 6.0F);
  };
  const std::int32_t marble = p.add(paint("marble tiles", kFine, true, [&](glm::vec2 uv) {
    const glm::vec2 c = glm::floor(uv * 4.0F);
    const bool dark = std::fmod(c.x + c.y, 2.0F) > 0.5F;
    const glm::vec3 stone =
        glm::mix(dark ? glm::vec3(0.42F, 0.25F, 0.19F) : glm::vec3(0.80F, 0.75F, 0.66F),
                 dark ? glm::vec3(0.62F, 0.45F, 0.36F) : glm::vec3(0.58F, 0.53F, 0.47F), veins(uv));
    return opaque(glm::mix(stone, glm::vec3(0.25F, 0.22F, 0.19F), joint(uv * 4.0F, 0.012F)));
  }));
  const std::int32_t marble_normal = p.add(normals_of(
      "marble tiles, normals", kFine, 0.01F, [](glm::vec2 uv) { return 1.0F - joint(uv * 4.0F, 0.014F); }));
  const std::int32_t marble_rough = p.add(paint("marble tiles, roughness", kSide, false, [&](glm::vec2 uv) {
    return metal_rough(0.0F, 0.22F + 0.25F * tiled_fbm(uv, 8, 3, 9) + 0.4F * joint(uv * 4.0F, 0.012F));
  }));
  Material& floor = p.material("floor", 1.0F);
  floor.base_color_texture = marble;
  floor.normal_texture = marble_normal;
  floor.metallic_roughness_texture = marble_rough;

  const std::int32_t planks = p.add(paint("planks", kFine, true, [](glm::vec2 uv) {
    const float plank = std::floor(uv.y * 6.0F);
    const float grain = tiled_fbm(glm::vec2(uv.x, uv.y * 4.0F), 8, 5, 20 + static_cast<std::uint32_t>(plank));
    const float tint = tiled_noise(glm::vec2(0.3F, plank / 6.0F + 0.02F), 12, 27);
    const glm::vec3 wood =
        glm::mix(glm::vec3(0.36F, 0.21F, 0.11F), glm::vec3(0.60F, 0.40F, 0.23F), 0.6F * grain + 0.4F * tint);
    const float gap =
        1.0F - glm::smoothstep(0.02F, 0.05F, std::min(uv.y * 6.0F - plank, 1.0F - (uv.y * 6.0F - plank)));
    return opaque(wood * (1.0F - 0.7F * gap));
  }));
  p.material("gallery floor", 0.55F).base_color_texture = planks;
}

void walls(Painter& p) {
  const std::int32_t brick = p.add(paint("bricks", kFine, true, [](glm::vec2 uv) {
    const float tint = brick_tint(uv);
    const glm::vec3 clay = glm::mix(glm::vec3(0.50F, 0.24F, 0.16F), glm::vec3(0.70F, 0.43F, 0.30F), tint) *
                           (0.75F + 0.4F * tiled_fbm(uv, 16, 4, 31));
    return opaque(glm::mix(clay, glm::vec3(0.66F, 0.62F, 0.55F), brick_joint(uv)));
  }));
  const std::int32_t brick_normal = p.add(normals_of("bricks, normals", kFine, 0.018F, [](glm::vec2 uv) {
    return (1.0F - brick_joint(uv)) * (0.8F + 0.2F * tiled_fbm(uv, 32, 3, 33));
  }));
  const std::int32_t brick_rough = p.add(paint("bricks, roughness", kSide, false, [](glm::vec2 uv) {
    return metal_rough(0.0F, 0.75F + 0.2F * tiled_fbm(uv, 16, 3, 35));
  }));
  Material& wall = p.material("wall", 1.0F);
  wall.base_color_texture = brick;
  wall.normal_texture = brick_normal;
  wall.metallic_roughness_texture = brick_rough;

  const std::int32_t plaster = p.add(paint("plaster", kFine, true, [](glm::vec2 uv) {
    const float stain = tiled_fbm(uv, 3, 5, 41);
    return opaque(glm::mix(glm::vec3(0.84F, 0.74F, 0.55F), glm::vec3(0.68F, 0.52F, 0.36F),
                           glm::smoothstep(0.35F, 0.75F, stain)));
  }));
  const std::int32_t plaster_normal = p.add(
      normals_of("plaster, normals", kSide, 0.006F, [](glm::vec2 uv) { return tiled_fbm(uv, 12, 4, 43); }));
  Material& upper = p.material("upper wall", 0.85F);
  upper.base_color_texture = plaster;
  upper.normal_texture = plaster_normal;
}

void stones(Painter& p) {
  const std::int32_t limestone = p.add(paint("limestone", kFine, true, [](glm::vec2 uv) {
    const float band = tiled_fbm(glm::vec2(uv.x, uv.y * 3.0F), 3, 5, 51);
    return opaque(glm::mix(glm::vec3(0.60F, 0.54F, 0.44F), glm::vec3(0.82F, 0.78F, 0.68F), band));
  }));
  const std::int32_t limestone_normal = p.add(
      normals_of("limestone, normals", kSide, 0.008F, [](glm::vec2 uv) { return tiled_fbm(uv, 16, 4, 53); }));
  const std::int32_t limestone_rough = p.add(paint("limestone, roughness", kSide, false, [](glm::vec2 uv) {
    return metal_rough(0.0F, 0.55F + 0.3F * tiled_fbm(uv, 8, 4, 55));
  }));
  Material& column = p.material("column", 1.0F);
  column.base_color_texture = limestone;
  column.normal_texture = limestone_normal;
  column.metallic_roughness_texture = limestone_rough;

  const std::int32_t ashlar = p.add(paint("ashlar", kFine, true, [](glm::vec2 uv) {
    const glm::vec2 c = glm::floor(uv * glm::vec2(4.0F, 4.0F));
    const float tint = tiled_noise((c + 0.5F) / 4.0F, 8, 57);
    const glm::vec3 stone = glm::mix(glm::vec3(0.64F, 0.55F, 0.43F), glm::vec3(0.80F, 0.72F, 0.59F), tint) *
                            (0.85F + 0.25F * tiled_fbm(uv, 16, 4, 58));
    return opaque(stone * (1.0F - 0.45F * joint(uv * 4.0F, 0.02F)));
  }));
  const std::int32_t ashlar_normal = p.add(normals_of("ashlar, normals", kFine, 0.015F, [](glm::vec2 uv) {
    return (1.0F - joint(uv * 4.0F, 0.025F)) + 0.15F * tiled_fbm(uv, 24, 3, 59);
  }));
  Material& arch = p.material("arch", 0.8F);
  arch.base_color_texture = ashlar;
  arch.normal_texture = ashlar_normal;

  Material& moulding = p.material("moulding", 0.7F);
  moulding.base_color = {0.95F, 0.88F, 0.74F, 1.0F};
  moulding.base_color_texture = limestone;
}

void timber_and_fittings(Painter& p) {
  const std::int32_t timber = p.add(paint("timber", kSide, true, [](glm::vec2 uv) {
    const float grain = tiled_fbm(glm::vec2(uv.x * 1.0F, uv.y * 6.0F), 4, 5, 61);
    return opaque(glm::mix(glm::vec3(0.22F, 0.12F, 0.06F), glm::vec3(0.46F, 0.29F, 0.16F), grain));
  }));
  const std::int32_t timber_normal = p.add(normals_of("timber, normals", kSide, 0.006F, [](glm::vec2 uv) {
    return tiled_fbm(glm::vec2(uv.x, uv.y * 6.0F), 4, 5, 61);
  }));
  Material& ceiling = p.material("ceiling", 0.65F);
  ceiling.base_color_texture = timber;
  ceiling.normal_texture = timber_normal;
  Material& balustrade = p.material("balustrade", 0.5F);
  balustrade.base_color = {0.83F, 0.78F, 0.70F, 1.0F};
  Material& plinth = p.material("plinth", 0.35F);
  plinth.base_color_texture = p.add(paint("porphyry", kSide, true, [](glm::vec2 uv) {
    const float speck = glm::smoothstep(0.62F, 0.72F, tiled_noise(uv, 64, 67));
    return opaque(glm::mix(glm::vec3(0.33F, 0.14F, 0.15F), glm::vec3(0.75F, 0.60F, 0.55F), speck));
  }));
  Material& water = p.material("water", 0.05F);
  water.base_color = {0.03F, 0.09F, 0.10F, 1.0F};
  water.normal_texture =
      p.add(normals_of("ripples", kSide, 0.006F, [](glm::vec2 uv) { return tiled_fbm(uv, 6, 3, 69); }));
  Material& bronze = p.material("bronze", 1.0F, 1.0F);
  bronze.base_color = {0.72F, 0.48F, 0.24F, 1.0F};
  bronze.metallic_roughness_texture = p.add(paint("bronze, patina", kSide, false, [](glm::vec2 uv) {
    const float patina = glm::smoothstep(0.5F, 0.7F, tiled_fbm(uv, 8, 4, 73));
    return metal_rough(1.0F - 0.7F * patina, 0.3F + 0.4F * patina);
  }));
}

void pottery(Painter& p) {
  p.material("glazed vase", 0.25F).base_color_texture = p.add(paint("glaze", kSide, true, [](glm::vec2 uv) {
    const float run = tiled_fbm(glm::vec2(uv.x, uv.y * 0.5F), 8, 4, 81);
    return opaque(glm::mix(glm::vec3(0.05F, 0.22F, 0.30F), glm::vec3(0.22F, 0.55F, 0.58F), run));
  }));
  p.material("painted vase", 0.5F).base_color_texture = p.add(paint("meander", kSide, true, [](glm::vec2 uv) {
    const float band = std::fmod(uv.y * 4.0F + 4.0F, 1.0F);
    const float key = std::fmod(uv.x * 8.0F + (band > 0.5F ? 0.5F : 0.0F), 1.0F);
    const bool dark = band > 0.2F && band < 0.8F && key > 0.35F && key < 0.8F;
    return opaque(dark ? glm::vec3(0.09F, 0.06F, 0.05F) : glm::vec3(0.72F, 0.36F, 0.17F));
  }));
}

void curtains(Painter& p) {
  const std::int32_t weave = p.add(normals_of("weave, normals", kSide, 0.004F, [](glm::vec2 uv) {
    return 0.5F + 0.25F * (std::sin(kTau * 48.0F * uv.x) + std::sin(kTau * 48.0F * uv.y));
  }));
  const auto cloth = [&](const char* name, const glm::vec3& ground, const glm::vec3& figure) {
    Material& m = p.material(name, 0.9F);
    m.draw.double_sided = true;
    m.normal_texture = weave;
    m.base_color_texture = p.add(paint(name, kSide, true, [&](glm::vec2 uv) {
      const float lozenge =
          std::abs(std::fmod(uv.x * 4.0F, 1.0F) - 0.5F) + std::abs(std::fmod(uv.y * 4.0F, 1.0F) - 0.5F);
      const float mark =
          (1.0F - glm::smoothstep(0.16F, 0.2F, std::abs(lozenge - 0.3F))) * (uv.y > 0.06F ? 1.0F : 0.0F);
      return opaque(glm::mix(ground, figure, 0.8F * mark) * (0.85F + 0.3F * tiled_fbm(uv, 32, 3, 91)));
    }));
  };
  cloth("red curtain", {0.48F, 0.06F, 0.06F}, {0.72F, 0.50F, 0.18F});
  cloth("blue curtain", {0.07F, 0.12F, 0.40F}, {0.60F, 0.60F, 0.66F});
  cloth("green curtain", {0.06F, 0.28F, 0.12F}, {0.65F, 0.58F, 0.25F});
  cloth("ochre curtain", {0.62F, 0.40F, 0.12F}, {0.36F, 0.10F, 0.08F});
}

void ivy(Painter& p) {
  Material& m = p.material("ivy", 0.8F);
  m.draw = {PatchClass::Alpha::kMask, true};
  m.base_color_texture = p.add(paint("ivy leaves", kSide, true, [](glm::vec2 uv) {
    const glm::vec3 leaf =
        glm::mix(glm::vec3(0.07F, 0.22F, 0.05F), glm::vec3(0.28F, 0.45F, 0.12F), tiled_fbm(uv, 12, 3, 95));
    return glm::vec4(leaf, leaves(uv));
  }));
}

}  // namespace

void add_atrium_materials(SceneSource& source) {
  Painter painter(source);
  floors(painter);
  walls(painter);
  stones(painter);
  timber_and_fittings(painter);
  pottery(painter);
  curtains(painter);
  ivy(painter);
}

}  // namespace atlaswire::render
