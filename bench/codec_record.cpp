// Records the meta updates of a walk through a scene, as a stream makes them, for codec_bench.
#include "base/program.h"
#include "bench/meta_recording.h"
#include "render/camera.h"
#include "render/gpu/open_device.h"
#include "render/scene/camera_path.h"
#include "render/scene/load.h"
#include "render/scene/walk_order.h"
#include "server/atlas_stream.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <numeric>

using namespace atlaswire;

namespace {

struct Options {
  std::string scene = "atrium";
  std::string path = "atrium";
  std::string out = "updates.meta";
  std::uint32_t frames = 300;
  double rate = 30;
  std::uint32_t width = 480;
  std::uint32_t height = 270;
  std::uint32_t atlas = 1024;
  std::uint32_t grid_bits = 0;
  double turn_at = -1;
  std::string whole;
  std::uint32_t new_patches = 0;
  bool requests = false;
  std::uint32_t hold_frames = render::MethodSettings{}.hold_frames;
};

constexpr double kTurnRate = 1.5707963267948966;  // radians a second

/// Where the viewer is: on the path, or standing on it and turning about the vertical.
Pose pose_at(const render::CameraPath& path, const Options& options, Duration now) {
  if (options.turn_at < 0) return path.at(now);
  Pose pose = path.at(from_seconds(options.turn_at));
  pose.orientation =
      glm::angleAxis(kTurnRate * to_seconds(now), glm::dvec3(0, 1, 0)) * glm::dquat(pose.orientation);
  return pose;
}

/// Numbers patches by a walk over the whole surface instead of chunk after chunk.
void number_by_walk(const render::Scene& scene, codec::MetaUpdate& update) {
  std::vector<render::TriangleGroup> groups(scene.patches.size());
  for (std::size_t p = 0; p < groups.size(); ++p) {
    groups[p].count = scene.patches[p].triangles;
    std::ranges::transform(scene.patches[p].positions, groups[p].corners.begin(),
                           [](VertexId v) { return value(v); });
  }
  std::vector<std::uint32_t> walk(groups.size());
  std::iota(walk.begin(), walk.end(), 0U);
  render::WalkOrder(scene.positions, groups).arrange(walk);
  std::vector<codec::AddedPatch> walked;
  for (const std::uint32_t patch : walk) {
    walked.push_back(update.added[patch]);
    walked.back().id = PatchId{static_cast<std::uint32_t>(walked.size() - 1)};
  }
  update.added = std::move(walked);
}

/// All of a scene in one update, without blocks.
void record_whole(const Options& options) {
  auto scene = std::make_shared<const render::Scene>(render::load_scene(options.scene).value());
  server::ReplicaTracker tracker(scene, options.grid_bits);
  std::vector<render::PlacedPatch> patches;
  for (std::uint32_t i = 0; i < scene->patches.size(); ++i) patches.push_back({PatchId{i}, {}});
  bench::MetaRecording recording{.limits = tracker.limits({options.atlas, options.atlas})};
  recording.updates.push_back(tracker.restart(FrameId{0}, patches));
  if (options.whole == "surface") number_by_walk(*scene, recording.updates.front());
  bench::write_recording(recording, options.out);
}

/// Tells a stream's motion once more, to write down what was told.
class MotionRecorder {
 public:
  MotionRecorder(std::shared_ptr<const render::Scene> scene, const PositionGrid& grid)
      : teller_(std::move(scene), grid) {
    const proto::MotionDescription& told = teller_.description();
    motion_.settings = {grid, {.step = told.translation_step, .rotation_bits = told.rotation_bits}};
    motion_.movers = told.movers;
  }
  void add(const server::PreparedFrame& frame) {
    ByteBuffer message;
    teller_.tell(frame.update, frame.moved.value(), message).value();
    const codec::MotionTargets told = teller_.told();
    motion_.frames.push_back(
        {{told.positions.begin(), told.positions.end()}, {told.transforms.begin(), told.transforms.end()}});
  }
  [[nodiscard]] const bench::RecordedMotion& motion() const { return motion_; }

 private:
  server::MotionTeller teller_;
  bench::RecordedMotion motion_;
};

void record(const Options& options) {
  auto scene = std::make_shared<const render::Scene>(render::load_scene(options.scene).value());
  const render::CameraPath path = render::CameraPath::load(options.path).value();
  const auto device = render::open_device({});
  server::StreamSettings settings;
  settings.render.atlas = {options.atlas, options.atlas};
  settings.grid_bits = options.grid_bits;
  settings.meta_codec = options.requests ? codec::MetaCodecKind::kMirror : codec::MetaCodecKind::kGate;
  settings.max_fps = options.rate;
  settings.render.most_new_patches = options.new_patches;
  settings.render.hold_frames = options.hold_frames;
  settings.video.encoder = "raw";
  settings.video.intra_interval = 5;
  server::AtlasStream stream(settings, scene, render::make_method("sas", *device, scene, settings.render));
  bench::MetaRecording recording{
      .limits = server::ReplicaTracker(scene, options.grid_bits).limits(settings.render.atlas)};
  if (const auto memory = stream.memory()) {
    recording.memory = {memory->superblock_log2, memory->min_block_log2, memory->high_water};
  }
  std::optional<MotionRecorder> motion;
  if (scene->motion) motion.emplace(scene, stream.grid());
  server::ViewRequest request;
  request.camera.extent = {options.width, options.height};
  request.cover = from_seconds(0.05);
  const Duration step = from_seconds(1 / options.rate);
  for (std::uint32_t frame = 0; frame < options.frames; ++frame) {
    const Duration now = frame * step;
    request.camera.pose = pose_at(path, options, now);
    set_velocities_from(pose_at(path, options, now - step), request.camera.pose, step);
    request.restart = frame == 0;
    if (motion) request.scene_time = now;
    server::PreparedFrame prepared = stream.render(request);
    recording.updates.push_back(prepared.update);
    if (motion) motion->add(prepared);
    stream.encode(std::move(prepared)).value();
  }
  if (motion) recording.motion = motion->motion();
  bench::write_recording(recording, options.out);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Records a stream's meta updates and, of a scene that moves, where its movers are to be");
  app.add_option("--scene", options.scene, "Built-in name or glTF file");
  app.add_option("--path", options.path, "Built-in name or CSV file");
  app.add_option("--out", options.out, "File to write");
  app.add_option("--frames", options.frames, "How many");
  app.add_option("--rate", options.rate, "Frames a second");
  app.add_option("--width", options.width, "Display pixels");
  app.add_option("--height", options.height, "Display pixels");
  app.add_option("--atlas", options.atlas, "Texels a side");
  app.add_option("--whole", options.whole,
                 "Instead of a stream all of the scene in one update, its patches numbered as in the scene "
                 "(scene) or by a walk over the whole surface (surface)")
      ->check(CLI::IsMember({"scene", "surface"}));
  app.add_option("--turn-at", options.turn_at,
                 "Stand where the path is at this second, and turn by 90 degrees a second");
  app.add_option("--grid-bits", options.grid_bits, "0: suited to the scene");
  app.add_option("--new-patches", options.new_patches, "That a frame may show for the first time; 0: all");
  app.add_option("--hold-frames", options.hold_frames, "That a patch stays after it was last seen")
      ->capture_default_str();
  app.add_flag("--requests", options.requests, "What patches ask for instead of the blocks they got");
  CLI11_PARSE(app, argc, argv);
  try {
    options.whole.empty() ? record(options) : record_whole(options);
  } catch (const std::exception& e) {
    fmt::print(stderr, "codec_record: {}\n", e.what());
    return 1;
  }
  return 0;
}
