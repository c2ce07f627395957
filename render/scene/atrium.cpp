#include "render/scene/atrium.h"

#include "base/random.h"
#include "render/scene/atrium_materials.h"
#include "render/scene/scene_error.h"
#include "render/scene/shapes.h"

#include <charconv>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace atlaswire::render {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kBay = 2.75F;  // metres from column to column
constexpr int kBaysLong = 8;   // along x
constexpr int kBaysWide = 3;   // along z
constexpr float kCourtX = kBay * kBaysLong / 2;
constexpr float kCourtZ = kBay * kBaysWide / 2;
constexpr float kHallX = 15;
constexpr float kHallZ = 8;
constexpr float kStorey = 6;  // floor of the gallery
constexpr float kRoof = 11.4F;
constexpr float kSpring = 1.5F;  // arches spring this far below the top of their storey

glm::dmat4 placed(const glm::vec3& at, float turn = 0.0F, float scale = 1.0F) {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(at));
  return glm::scale(glm::rotate(moved, double{turn}, glm::dvec3(0, 1, 0)), glm::dvec3(scale));
}

/// One storey's measures.
struct Storey {
  float floor = 0;
  float height = kStorey;
  float shaft_radius = 0.34F;
  std::uint32_t around = 36;
};

class Builder {
 public:
  Builder(SceneSource& source, const AtriumOptions& options)
      : source_(source), detail_(options.detail), options_(options) {}

  void build() {
    shell();
    for (const Storey& storey :
         {Storey{0, kStorey, 0.34F, 36}, Storey{kStorey + 0.3F, kRoof - kStorey - 0.3F, 0.24F, 28}}) {
      colonnade(storey);
    }
    ceilings();
    balustrades();
    hangings();
    vases();
    fountain();
    lamps();
    if (options_.plants) plants();
  }

 private:
  std::uint32_t add_mesh(SourceMesh mesh, AtriumMaterial material) {
    mesh.material = static_cast<std::uint16_t>(material);
    compute_tangents(mesh);
    source_.meshes.push_back(std::move(mesh));
    return static_cast<std::uint32_t>(source_.meshes.size() - 1);
  }
  void put(std::uint32_t mesh, const glm::dmat4& where) { source_.instances.push_back({mesh, where}); }
  void put(SourceMesh mesh, AtriumMaterial material) {
    put(add_mesh(std::move(mesh), material), glm::dmat4(1.0));
  }
  [[nodiscard]] std::uint32_t cut(std::uint32_t n, std::uint32_t least) const {
    return pieces(n, detail_, least);
  }
  [[nodiscard]] float cell() const { return static_cast<float>(0.7 / std::sqrt(detail_)); }

  /// A flat rectangle from `corner` along two edges, front where u x v points; texture in metres.
  SourceMesh wall(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, float uv_scale) const {
    const auto pieces_of = [this](const glm::vec3& e) {
      return std::max(1U, static_cast<std::uint32_t>(std::ceil(glm::length(e) / cell())));
    };
    return sheet(pieces_of(u), pieces_of(v), [&](float s, float t) {
      SourceVertex out;
      out.position = corner + u * s + v * t;
      out.uv = {s * glm::length(u) * uv_scale, (1.0F - t) * glm::length(v) * uv_scale};
      return out;
    });
  }

  void shell() {
    put(wall({-kHallX, 0, kHallZ}, {2 * kHallX, 0, 0}, {0, 0, -2 * kHallZ}, 0.25F), AtriumMaterial::kFloor);
    for (const auto& [low, high, material] : {std::tuple{0.0F, kStorey, AtriumMaterial::kWall},
                                              std::tuple{kStorey, kRoof, AtriumMaterial::kUpperWall}}) {
      const glm::vec3 up(0, high - low, 0);
      SourceMesh walls = wall({-kHallX, low, -kHallZ}, {2 * kHallX, 0, 0}, up, 0.4F);
      append(walls, wall({kHallX, low, kHallZ}, {-2 * kHallX, 0, 0}, up, 0.4F));
      append(walls, wall({-kHallX, low, kHallZ}, {0, 0, -2 * kHallZ}, up, 0.4F));
      append(walls, wall({kHallX, low, -kHallZ}, {0, 0, 2 * kHallZ}, up, 0.4F));
      put(std::move(walls), material);
    }
    // Gallery floor and roof: four slabs each around the court.
    for (const auto& [low, high, material] : {std::tuple{kStorey, kStorey + 0.3F, AtriumMaterial::kGallery},
                                              std::tuple{kRoof, kRoof + 0.3F, AtriumMaterial::kUpperWall}}) {
      constexpr float kRim = 0.45F;
      const float x = kCourtX - kRim;
      const float z = kCourtZ - kRim;
      SourceMesh slab = box({-kHallX, low, -kHallZ}, {kHallX, high, -z}, cell(), 0.5F);
      append(slab, box({-kHallX, low, z}, {kHallX, high, kHallZ}, cell(), 0.5F));
      append(slab, box({-kHallX, low, -z}, {-x, high, z}, cell(), 0.5F));
      append(slab, box({x, low, -z}, {kHallX, high, z}, cell(), 0.5F));
      put(std::move(slab), material);
    }
  }

  /// Places of the columns around the court, and the turn that makes +x run along their row.
  [[nodiscard]] std::vector<std::pair<glm::vec2, float>> bays() const {
    std::vector<std::pair<glm::vec2, float>> out;
    for (int side = -1; side <= 1; side += 2) {
      const auto s = static_cast<float>(side);
      for (int i = 0; i < kBaysLong; ++i) {
        out.push_back({{-kCourtX + kBay * (static_cast<float>(i) + 0.5F), s * kCourtZ}, 0.0F});
      }
      for (int i = 0; i < kBaysWide; ++i) {
        out.push_back({{s * kCourtX, -kCourtZ + kBay * (static_cast<float>(i) + 0.5F)}, kPi / 2});
      }
    }
    return out;
  }

  void colonnade(const Storey& s) {
    const float shaft_top = s.height - kSpring - 0.45F;
    const glm::vec2 shaft_profile[] = {{s.shaft_radius, 0.42F},
                                       {s.shaft_radius * 1.02F, shaft_top * 0.35F},
                                       {s.shaft_radius * 0.84F, shaft_top}};
    const std::uint32_t shaft = add_mesh(revolve({.profile = shaft_profile,
                                                  .around = cut(s.around, 8),
                                                  .between = cut(9, 1),
                                                  .flutes = 20,
                                                  .flute_depth = 0.07F,
                                                  .uv_scale = {2.0F, 0.5F}}),
                                         AtriumMaterial::kColumn);
    const float r = s.shaft_radius;
    const glm::vec2 base_profile[] = {{r * 1.5F, 0.1F},   {r * 1.55F, 0.16F}, {r * 1.45F, 0.22F},
                                      {r * 1.2F, 0.26F},  {r * 1.18F, 0.3F},  {r * 1.3F, 0.34F},
                                      {r * 1.25F, 0.39F}, {r * 1.0F, 0.42F}};
    const std::uint32_t base = add_mesh(
        revolve(
            {.profile = base_profile, .around = cut(32, 8), .between = cut(1, 1), .uv_scale = {3.0F, 1.0F}}),
        AtriumMaterial::kMoulding);
    const glm::vec2 capital_profile[] = {{r * 0.84F, shaft_top},         {r * 0.98F, shaft_top + 0.03F},
                                         {r * 0.98F, shaft_top + 0.07F}, {r * 0.88F, shaft_top + 0.1F},
                                         {r * 0.95F, shaft_top + 0.2F},  {r * 1.3F, shaft_top + 0.32F},
                                         {r * 1.42F, shaft_top + 0.35F}};
    const std::uint32_t capital = add_mesh(revolve({.profile = capital_profile,
                                                    .around = cut(28, 8),
                                                    .between = cut(2, 1),
                                                    .flutes = 8,
                                                    .flute_depth = 0.1F,
                                                    .uv_scale = {3.0F, 1.0F}}),
                                           AtriumMaterial::kMoulding);
    SourceMesh blocks = box({-r * 1.6F, 0, -r * 1.6F}, {r * 1.6F, 0.1F, r * 1.6F}, cell(), 0.5F);
    append(blocks, box({-r * 1.45F, shaft_top + 0.35F, -r * 1.45F}, {r * 1.45F, shaft_top + 0.45F, r * 1.45F},
                       cell(), 0.5F));
    const std::uint32_t block = add_mesh(std::move(blocks), AtriumMaterial::kArch);

    for (int ix = 0; ix <= kBaysLong; ++ix) {
      for (int iz = 0; iz <= kBaysWide; ++iz) {
        if (ix > 0 && ix < kBaysLong && iz > 0 && iz < kBaysWide) continue;
        const glm::vec3 at(-kCourtX + kBay * static_cast<float>(ix), s.floor,
                           -kCourtZ + kBay * static_cast<float>(iz));
        for (const std::uint32_t mesh : {shaft, base, capital, block}) put(mesh, placed(at));
      }
    }
    arches(s);
  }

  /// The panel over one bay: two faces with a round opening, its soffit, and a roll moulding along the arch.
  void arches(const Storey& s) {
    constexpr float kHalfThick = 0.24F;
    const float spring = s.height - kSpring;
    const float radius = kBay / 2 - s.shaft_radius * 0.95F;
    const std::uint32_t around = cut(20, 6);
    const auto on_arch = [&](float u, float grow) {
      const float angle = kPi * (1.0F - u);
      return glm::vec2((radius + grow) * std::cos(angle), spring + (radius + grow) * std::sin(angle));
    };
    const auto on_rim = [&](float u) {
      const float angle = kPi * (1.0F - u);
      const glm::vec2 way(std::cos(angle), std::sin(angle));
      const float reach =
          std::min(kBay / 2 / std::max(std::abs(way.x), 1e-4F), kSpring / std::max(way.y, 1e-4F));
      return glm::vec2(0, spring) + way * reach;
    };
    const auto face = [&](float z) {
      return sheet(around, cut(3, 1), [&, z](float u, float v) {
        const float along = z > 0 ? u : 1.0F - u;
        const glm::vec2 p = glm::mix(on_arch(along, 0.0F), on_rim(along), v);
        SourceVertex out;
        out.position = {p.x, p.y, z};
        out.uv = {p.x * 0.5F, -p.y * 0.5F};
        return out;
      });
    };
    SourceMesh panel = face(kHalfThick);
    append(panel, face(-kHalfThick));
    append(panel, sheet(around, cut(2, 1), [&](float u, float v) {
             const glm::vec2 p = on_arch(u, 0.0F);
             SourceVertex out;
             out.position = {p.x, p.y, -kHalfThick + 2 * kHalfThick * v};
             out.uv = {u * 2.0F, v * 0.25F};
             return out;
           }));
    const std::uint32_t panel_mesh = add_mesh(std::move(panel), AtriumMaterial::kArch);
    const std::uint32_t roll_mesh = add_mesh(roll(around, on_arch), AtriumMaterial::kMoulding);
    for (const auto& [at, turn] : bays()) {
      const glm::vec3 place(at.x, s.floor, at.y);
      put(panel_mesh, placed(place, turn));
      put(roll_mesh, placed(place, turn));
      put(roll_mesh, placed(place, turn + kPi));
    }
  }

  template <class Curve>
  SourceMesh roll(std::uint32_t around, const Curve& on_arch) const {
    return sheet(around, cut(8, 4), [&](float u, float v) {
      const float angle = v * kPi * 1.5F - kPi * 0.25F;
      const float r = 0.065F;
      const glm::vec2 p = on_arch(1.0F - u, 0.1F + r * std::cos(angle));
      SourceVertex out;
      out.position = {p.x, p.y, 0.24F + r * std::sin(angle)};
      out.uv = {u * 4.0F, v * 0.3F};
      return out;
    });
  }

  void ceilings() {
    SourceMesh beam = box({-0.09F, -0.22F, 0}, {0.09F, 0, kHallZ - kCourtZ}, cell(), 0.8F);
    const std::uint32_t cross = add_mesh(std::move(beam), AtriumMaterial::kCeiling);
    SourceMesh long_beam = box({-kHallX, -0.12F, -0.07F}, {kHallX, 0, 0.07F}, cell(), 0.8F);
    const std::uint32_t along = add_mesh(std::move(long_beam), AtriumMaterial::kCeiling);
    for (const float y : {kStorey, kRoof}) {
      for (int i = -10; i <= 10; ++i) {
        const float x = static_cast<float>(i) * 1.375F;
        put(cross, placed({x, y, kCourtZ}));
        put(cross, placed({x, y, -kCourtZ}, kPi));
      }
      for (int i = 1; i <= 3; ++i) {
        const float z = kCourtZ + static_cast<float>(i) * (kHallZ - kCourtZ) / 4;
        put(along, placed({0, y, z}));
        put(along, placed({0, y, -z}));
      }
    }
  }

  void balustrades() {
    const glm::vec2 profile[] = {{0.055F, 0},    {0.06F, 0.06F},  {0.035F, 0.1F}, {0.075F, 0.3F},
                                 {0.04F, 0.52F}, {0.035F, 0.62F}, {0.06F, 0.66F}, {0.055F, 0.72F}};
    const std::uint32_t baluster =
        add_mesh(revolve({.profile = profile, .around = cut(10, 6), .between = cut(2, 1)}),
                 AtriumMaterial::kBalustrade);
    SourceMesh rail = box({-kBay / 2, 0.72F, -0.09F}, {kBay / 2, 0.84F, 0.09F}, cell(), 0.5F);
    append(rail, box({-kBay / 2, -0.05F, -0.09F}, {kBay / 2, 0.0F, 0.09F}, cell(), 0.5F));
    const std::uint32_t rails = add_mesh(std::move(rail), AtriumMaterial::kBalustrade);
    for (const auto& [at, turn] : bays()) {
      const glm::vec3 foot(at.x, kStorey + 0.35F, at.y);
      put(rails, placed(foot, turn));
      for (int i = 0; i < 7; ++i) {
        const float along = (static_cast<float>(i) - 3.0F) * 0.3F;
        put(baluster, placed(foot + glm::vec3(along * std::cos(turn), 0, -along * std::sin(turn))));
      }
    }
  }

  void hangings() {
    constexpr AtriumMaterial kCloths[] = {AtriumMaterial::kCurtainRed, AtriumMaterial::kCurtainBlue,
                                          AtriumMaterial::kCurtainGreen, AtriumMaterial::kCurtainOchre};
    std::uint32_t cloths[4];
    for (std::size_t c = 0; c < 4; ++c) {
      const float phase = static_cast<float>(c);
      cloths[c] =
          add_mesh(sheet(cut(36, 6), cut(24, 4),
                         [phase](float u, float v) {
                           const float gather = 0.75F + 0.25F * std::pow(std::abs(2.0F * v - 0.9F), 1.5F);
                           const float wave = std::sin(u * 26.0F + phase) * (0.03F + 0.07F * (1.0F - v)) +
                                              0.05F * std::sin(v * 5.0F + phase * 2.0F);
                           SourceVertex out;
                           out.position = {(u - 0.5F) * 1.9F * gather, v * 3.1F, wave};
                           out.uv = {u * 1.5F, (1.0F - v) * 2.5F};
                           return out;
                         }),
                   kCloths[c]);
    }
    int n = 0;
    for (const auto& [at, turn] : bays()) {
      const float inward = 0.42F;
      const glm::vec3 back(turn > 0 ? std::copysign(inward, at.x) : 0, 0,
                           turn > 0 ? 0 : std::copysign(inward, at.y));
      if (n % 2 == 0)
        put(cloths[static_cast<std::size_t>(n / 2) % 4],
            placed(glm::vec3(at.x, kStorey + 0.9F, at.y) + back, turn));
      if (n % 5 == 1)
        put(cloths[static_cast<std::size_t>(n) % 4], placed(glm::vec3(at.x, 1.3F, at.y) + back, turn));
      ++n;
    }
  }

  void vases() {
    const glm::vec2 tall[] = {{0.16F, 0},     {0.18F, 0.05F}, {0.13F, 0.1F},  {0.26F, 0.4F},
                              {0.31F, 0.65F}, {0.24F, 0.85F}, {0.12F, 0.97F}, {0.11F, 1.06F},
                              {0.17F, 1.14F}, {0.15F, 1.14F}, {0.1F, 1.06F},  {0.1F, 0.9F}};
    const glm::vec2 round[] = {{0.2F, 0},      {0.22F, 0.04F}, {0.36F, 0.2F}, {0.42F, 0.38F}, {0.36F, 0.56F},
                               {0.26F, 0.64F}, {0.3F, 0.7F},   {0.27F, 0.7F}, {0.22F, 0.6F}};
    const std::uint32_t meshes[] = {
        add_mesh(
            revolve({.profile = tall, .around = cut(28, 8), .between = cut(3, 1), .uv_scale = {2.0F, 1.0F}}),
            AtriumMaterial::kVasePainted),
        add_mesh(
            revolve({.profile = round, .around = cut(28, 8), .between = cut(4, 1), .uv_scale = {2.0F, 1.0F}}),
            AtriumMaterial::kVaseGlazed)};
    for (int i = 0; i < 14; ++i) {
      const float side = i % 2 == 0 ? 1.0F : -1.0F;
      const float x = (static_cast<float>(i / 2) - 3.0F) * kBay;
      const bool above = i % 3 == 0;
      put(meshes[i % 2], placed({x, above ? kStorey + 0.3F : 0.0F, side * (kCourtZ + (above ? 0.9F : 0.75F))},
                                static_cast<float>(i)));
    }
  }

  void fountain() {
    const glm::vec2 basin[] = {{1.55F, 0},     {1.6F, 0.1F},   {1.45F, 0.16F}, {1.45F, 0.5F},
                               {1.62F, 0.58F}, {1.62F, 0.66F}, {1.35F, 0.66F}, {1.3F, 0.45F}};
    const glm::vec2 stem[] = {{0.3F, 0.4F},  {0.2F, 0.6F},   {0.16F, 1.0F},  {0.24F, 1.3F}, {0.15F, 1.45F},
                              {0.7F, 1.62F}, {0.82F, 1.74F}, {0.78F, 1.76F}, {0.3F, 1.66F}, {0.1F, 1.7F},
                              {0.09F, 2.1F}, {0.16F, 2.2F},  {0.02F, 2.4F}};
    put(revolve({.profile = basin,
                 .around = cut(72, 10),
                 .between = cut(2, 1),
                 .flutes = 24,
                 .flute_depth = 0.02F,
                 .uv_scale = {6.0F, 1.0F}}),
        AtriumMaterial::kPlinth);
    put(revolve({.profile = stem, .around = cut(48, 8), .between = cut(3, 1), .uv_scale = {3.0F, 1.0F}}),
        AtriumMaterial::kBronze);
    const glm::vec2 pool[] = {{1.34F, 0.55F}, {0.05F, 0.55F}};
    put(revolve({.profile = pool, .around = cut(48, 8), .between = cut(6, 1), .uv_scale = {1.0F, 1.0F}}),
        AtriumMaterial::kWater);
  }

  void lamps() {
    Random random(2018);
    for (std::uint32_t i = 0; i < options_.lights; ++i) {
      SourceLight lamp;
      // The first 16 hang in the galleries; more are scattered.
      const bool hung = i < 16;
      const float side = i % 2 == 0 ? 1.0F : -1.0F;
      const float x = hung ? (static_cast<float>(i % 8 / 2) - 1.5F) * 7.0F
                           : (static_cast<float>(random.uniform()) - 0.5F) * 28.0F;
      const float y = hung ? (i < 8 ? 4.4F : 9.8F) : 1.0F + 9.5F * static_cast<float>(random.uniform());
      const float z = hung ? side * 6.0F : (static_cast<float>(random.uniform()) - 0.5F) * 15.0F;
      lamp.position = {x, y, z};
      const float warm = static_cast<float>(random.uniform());
      lamp.light.color =
          glm::mix(glm::vec3(1.0F, 0.55F, 0.25F), glm::vec3(1.0F, 0.78F, 0.5F), warm) * (hung ? 14.0F : 4.0F);
      lamp.light.range = hung ? 7.0F : 3.5F;
      source_.lights.push_back(lamp);
    }
  }

  void plants() {
    Random random(7);
    SourceMesh cards;
    for (int i = 0; i < static_cast<int>(260 * std::min(1.0, detail_ + 0.2)); ++i) {
      const float side = i % 2 == 0 ? 1.0F : -1.0F;
      const float x = (static_cast<float>(random.uniform()) - 0.5F) * 2 * kCourtX;
      const float y = kStorey + 0.2F - 1.3F * static_cast<float>(random.uniform() * random.uniform());
      const float tilt = 0.5F * (static_cast<float>(random.uniform()) - 0.5F);
      const glm::vec3 right(0.5F * std::cos(tilt), 0, 0.5F * std::sin(tilt));
      const glm::vec3 corner = glm::vec3(x, y - 0.55F, side * (kCourtZ - 0.5F)) - right * 0.5F;
      append(cards, sheet(2, 2, [&](float u, float v) {
               SourceVertex out;
               out.position = corner + right * u + glm::vec3(0, 0.55F * v, 0);
               out.uv = {u, 1.0F - v};
               return out;
             }));
    }
    put(std::move(cards), AtriumMaterial::kIvy);
  }

  SceneSource& source_;
  double detail_;
  const AtriumOptions& options_;
};

}  // namespace

Result<AtriumOptions> parse_atrium_name(std::string_view name) {
  AtriumOptions options;
  std::string_view rest = name.substr(std::string_view("atrium").size());
  while (!rest.empty()) {
    rest.remove_prefix(1);  // the colon
    const std::string_view option = rest.substr(0, rest.find(':'));
    rest.remove_prefix(option.size());
    const char* end = option.data() + option.size();
    const auto all = [end](const auto& parsed) { return parsed.ec == std::errc{} && parsed.ptr == end; };
    double detail = 0;
    if (option == "plants") {
      options.plants = true;
    } else if (option.starts_with("lights=")) {
      if (!all(std::from_chars(option.data() + 7, end, options.lights)) || options.lights > 400) {
        return Error{SceneError::kBadName, "'" + std::string(option) + "': lights are 0 to 400"};
      }
    } else if (all(std::from_chars(option.data(), end, detail)) && detail >= 0.02 && detail <= 2) {
      options.detail = detail;
    } else {
      return Error{SceneError::kBadName,
                   "'" + std::string(option) +
                       "': an option of atrium is a detail from 0.02 to 2, lights=N, or plants"};
    }
  }
  return options;
}

SceneSource make_atrium(const AtriumOptions& options) {
  SceneSource source;
  source.name = "atrium";
  add_atrium_materials(source);
  Builder(source, options).build();
  source.sun.direction = glm::normalize(glm::vec3(0.35F, -0.86F, 0.38F));
  source.sun.color = glm::vec3(1.0F, 0.93F, 0.8F) * 6.0F;
  source.ambient_up = {0.30F, 0.36F, 0.46F};
  source.ambient_down = {0.20F, 0.16F, 0.12F};
  source.background = {0.35F, 0.55F, 0.85F};
  source.start.position = {-9.5, 1.7, 0.9};
  source.start.orientation =
      glm::dquat(std::cos(-std::numbers::pi / 4), 0, std::sin(-std::numbers::pi / 4), 0);
  return source;
}

}  // namespace atlaswire::render
