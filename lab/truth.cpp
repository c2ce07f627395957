#include "lab/truth.h"

#include "base/program.h"
#include "render/display/lens_pass.h"
#include "render/passes/forward.h"
#include "render/passes/scene_gpu.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

namespace atlaswire::lab {
namespace {

namespace fs = std::filesystem;

/// FNV-1a, 64 bits: names of files in a cache that a person may delete at any time.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return hash;
}

/// A name alone stands for a built-in scene; a file is told apart by its size and age too.
std::string identity_of(const std::string& scene) {
  std::error_code error;
  const auto size = fs::file_size(scene, error);
  if (error) return scene;
  const auto age = fs::last_write_time(scene, error).time_since_epoch().count();
  return fmt::format("{}:{}:{}", fs::absolute(scene).string(), size, age);
}

constexpr std::size_t kCountBytes = 2 * sizeof(std::uint64_t);

/// A file holds the picture's octets, then forward and deferred fragments as they are in memory, packed
/// together.
std::optional<TruePicture> read_packed(const fs::path& file, Extent2D extent) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  const std::vector<char> packed{std::istreambuf_iterator<char>(in), {}};
  TruePicture truth{.picture = render::Picture(extent)};
  std::vector<std::uint8_t>& octets = truth.picture.rgba;
  const std::size_t pixels = octets.size();
  octets.resize(pixels + kCountBytes);
  const std::size_t size = ZSTD_decompress(octets.data(), octets.size(), packed.data(), packed.size());
  if (ZSTD_isError(size) != 0 || size != octets.size()) return std::nullopt;
  std::memcpy(&truth.forward_fragments, octets.data() + pixels, sizeof(std::uint64_t));
  std::memcpy(&truth.deferred_fragments, octets.data() + pixels + sizeof(std::uint64_t),
              sizeof(std::uint64_t));
  octets.resize(pixels);
  return truth;
}

/// Whole or not at all, whoever else writes the same one: a picture that cannot be kept is only slower.
void write_packed(const fs::path& file, const TruePicture& truth) {
  std::vector<std::uint8_t> octets = truth.picture.rgba;
  for (const std::uint64_t count : {truth.forward_fragments, truth.deferred_fragments}) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&count);
    octets.insert(octets.end(), bytes, bytes + sizeof(count));
  }
  std::vector<char> packed(ZSTD_compressBound(octets.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), octets.data(), octets.size(), 1);
  if (ZSTD_isError(size) != 0) return;
  const fs::path fresh = fmt::format("{}.{}", file.string(), getpid());
  std::ofstream out(fresh, std::ios::binary);
  out.write(packed.data(), static_cast<std::streamsize>(size));
  out.close();
  std::error_code error;
  if (out) fs::rename(fresh, file, error);
  if (!out || error) fs::remove(fresh, error);
}

std::uint64_t drawn_pixels(const render::Picture& picture) {
  std::uint64_t drawn = 0;
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) drawn += picture.rgba[i] != 0 ? 1U : 0U;
  return drawn;
}

}  // namespace

struct Truth::Parts {
  Parts(render::Device& device, std::shared_ptr<const render::Scene> s,
        const render::LensCorrection& correction)
      : scene(device, std::move(s)), forward(device, scene) {
    if (correction != render::LensCorrection{}) lens.emplace(device, correction, 1);
  }
  render::SceneGpu scene;
  render::ForwardPass forward;
  std::optional<render::LensPass> lens;  ///< nullopt: the display has none
};

Truth::Truth(render::Device& device, std::shared_ptr<const render::Scene> scene,
             const std::string& scene_name, fs::path cache, const render::LensCorrection& lens)
    : device_(&device),
      scene_(std::move(scene)),
      identity_(identity_of(scene_name)),
      cache_(std::move(cache)),
      lens_(lens) {
  if (cache_.empty()) return;
  std::error_code error;
  fs::create_directories(cache_, error);
  if (error) {
    throw ProgramError(ExitCode::kCannotWrite,
                       fmt::format("cannot make folder '{}': {}", cache_.string(), error.message()));
  }
}
Truth::~Truth() = default;

fs::path Truth::place_of(const render::Camera& camera, Duration time) const {
  const auto& [position, turn, velocity, spin] = camera.pose;
  const std::string moment = scene_->motion ? fmt::format("|{}", time.count()) : "";
  const std::string key =
      fmt::format("{}|{}|{}x{}|{:.17g}|{:.17g}|{:.17g},{:.17g},{:.17g}|{:.17g},{:.17g},{:.17g},{:.17g}",
                  identity_, render::to_string(lens_), camera.extent.width, camera.extent.height,
                  camera.vertical_fov, camera.near_plane, position.x, position.y, position.z, turn.w, turn.x,
                  turn.y, turn.z) +
      moment;
  return cache_ / fmt::format("{:016x}.zst", hash_of(key));
}

TruePicture Truth::picture(const render::Camera& camera, Duration time) {
  if (cache_.empty()) return rendered(camera, time);
  const fs::path place = place_of(camera, time);
  if (auto kept = read_packed(place, camera.extent)) return std::move(*kept);
  TruePicture truth = rendered(camera, time);
  write_packed(place, truth);
  return truth;
}

TruePicture Truth::rendered(const render::Camera& camera, Duration time) {
  if (parts_ == nullptr) parts_ = std::make_unique<Parts>(*device_, scene_, lens_);
  parts_->scene.move_to(to_seconds(time));
  TruePicture truth{.picture = parts_->forward.render(camera)};
  truth.forward_fragments = parts_->forward.fragments();
  truth.deferred_fragments = drawn_pixels(truth.picture);
  if (parts_->lens) {
    parts_->lens->apply(*parts_->forward.target(), render::Eye::kLeft);
    truth.picture = parts_->lens->read_back();
  }
  return truth;
}

}  // namespace atlaswire::lab
