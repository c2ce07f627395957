#include "bench/level_stream.h"

#include "base/program.h"
#include "render/gpu/submit_context.h"
#include "render/passes/visibility.h"
#include "render/scene/camera_path.h"
#include "render/scene/load.h"

#include <fstream>

namespace atlaswire::bench {
namespace {

constexpr std::uint32_t kMagic = 0x31534C41;  // "ALS1"
constexpr Duration kFrame = std::chrono::microseconds(33'333);
constexpr Duration kCover = std::chrono::milliseconds(100);

template <class T>
T checked(Result<T> result) {
  if (!result) throw ProgramError(ExitCode::kBadScene, result.error().message());
  return std::move(*result);
}

std::vector<std::uint32_t> read_words(std::istream& in, std::size_t count,
                                      const std::filesystem::path& file) {
  std::vector<std::uint32_t> words(count);
  in.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(count * sizeof(std::uint32_t)));
  if (!in) throw ProgramError(ExitCode::kBadScene, file.string() + ": not a whole level stream");
  return words;
}

void write_words(std::ostream& out, std::span<const std::uint32_t> words) {
  out.write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(words.size_bytes()));
}

}  // namespace

LevelStream record_levels(const std::string& scene_name, const std::string& path_name, std::uint32_t frames) {
  const auto scene = std::make_shared<const render::Scene>(checked(render::load_scene(scene_name)));
  const auto path = checked(render::CameraPath::load(path_name));
  const auto device = render::open_device({});
  const render::SceneGpu on_device(*device, scene);
  render::VisibilityPass visibility(*device, on_device, {});
  render::SubmitContext context(*device, "levels");
  LevelStream stream{.patch_count = static_cast<std::uint32_t>(scene->patches.size())};
  for (std::uint32_t i = 0; i < frames; ++i) {
    render::Camera camera;
    camera.pose = path.at(i * kFrame);
    context.run([&](const vk::raii::CommandBuffer& commands) {
      visibility.record(commands, camera, render::predicted_poses(camera.pose, kCover, kFrame, 2));
    });
    LevelStream::Frame& frame = stream.frames.emplace_back();
    const auto words = visibility.levels();
    for (std::uint32_t patch = 0; patch < words.size(); ++patch) {
      if (words[patch] != 0) frame.emplace_back(patch, words[patch]);
    }
  }
  return stream;
}

void save_levels(const LevelStream& stream, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  write_words(out, std::array{kMagic, stream.patch_count, static_cast<std::uint32_t>(stream.frames.size())});
  for (const LevelStream::Frame& frame : stream.frames) {
    std::vector<std::uint32_t> words{static_cast<std::uint32_t>(frame.size())};
    for (const auto& [patch, word] : frame) words.insert(words.end(), {patch, word});
    write_words(out, words);
  }
  out.flush();
  if (!out) throw ProgramError(ExitCode::kCannotWrite, "cannot write " + file.string());
}

LevelStream load_levels(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const auto header = read_words(in, 3, file);
  if (header[0] != kMagic) throw ProgramError(ExitCode::kBadScene, file.string() + ": not a level stream");
  LevelStream stream{.patch_count = header[1]};
  for (std::uint32_t i = 0; i < header[2]; ++i) {
    const std::uint32_t count = read_words(in, 1, file)[0];
    if (count > stream.patch_count) {
      throw ProgramError(ExitCode::kBadScene, file.string() + ": a frame has more patches than the scene");
    }
    const auto words = read_words(in, 2 * std::size_t{count}, file);
    LevelStream::Frame& frame = stream.frames.emplace_back();
    for (std::size_t w = 0; w < words.size(); w += 2) {
      if (words[w] >= stream.patch_count || (!frame.empty() && frame.back().first >= words[w])) {
        throw ProgramError(ExitCode::kBadScene, file.string() + ": patches do not ascend");
      }
      frame.emplace_back(words[w], words[w + 1]);
    }
  }
  return stream;
}

std::vector<std::vector<render::BlockRequest>> requests_of(const LevelStream& stream,
                                                           const render::LevelSettings& settings) {
  render::LevelSelector selector(settings, stream.patch_count);
  std::vector<std::uint32_t> packed(stream.patch_count);
  std::vector<std::vector<render::BlockRequest>> all;
  for (const LevelStream::Frame& frame : stream.frames) {
    for (const auto& [patch, word] : frame) packed[patch] = word;
    selector.select(packed, all.emplace_back());
    for (const auto& [patch, word] : frame) packed[patch] = 0;
  }
  return all;
}

render::AllocatorSettings daemon_atlas(Extent2D atlas, std::uint32_t patch_count) {
  return {.atlas = atlas,
          .superblock_log2 = render::suited_superblock_log2(atlas),
          .min_block_log2 = render::suited_min_block_log2(atlas, patch_count)};
}

}  // namespace atlaswire::bench
