#include "render/sas/sas_method.h"

#include "base/program.h"
#include "render/gpu/barriers.h"

#include <algorithm>
#include <utility>

namespace atlaswire::render {
namespace {

MethodSettings checked(MethodSettings settings, std::size_t patches) {
  settings.allocator.atlas = settings.atlas;
  settings.allocator.min_block_log2 =
      std::min(settings.allocator.min_block_log2,
               suited_min_block_log2(settings.atlas, static_cast<std::uint32_t>(patches)));
  if (!(settings.fov_scale >= 1.0 && settings.fov_scale <= 4.0) ||
      !(settings.id_scale > 0.0 && settings.id_scale <= 4.0) || settings.max_views < 1 ||
      settings.reshade_interval < 1 || settings.frames_in_flight < 1) {
    throw ProgramError(ExitCode::kUsage,
                       "sas: the field of view's scale must be in [1, 4], the id buffer's in (0, 4]; views, "
                       "reshade interval and frames in flight at least 1");
  }
  return settings;
}

VisibilitySettings visibility_settings(const MethodSettings& s) {
  constexpr std::uint32_t kEyes = 2;
  return {.fov_scale = s.fov_scale,
          .id_scale = s.id_scale,
          .max_views = kEyes * s.max_views,
          .hold_frames = s.hold_frames};
}

/// Where the visible sets that the frame unites are seen from.
std::vector<Pose> viewpoints(const FrameRequest& request, const MethodSettings& s) {
  const ViewHints& hints = request.hints;
  std::vector<Pose> heads = hints.foreseen;
  heads.resize(std::min<std::size_t>(heads.size(), s.max_views));
  if (heads.empty()) {
    heads = predicted_poses(request.camera.pose, request.cover, s.prediction_step, s.max_views);
  }
  if (!(hints.eye_separation > 0)) return heads;
  std::vector<Pose> eyes;
  for (const Pose& head : heads) {
    eyes.push_back(eye_pose(head, -hints.eye_separation / 2));
    eyes.push_back(eye_pose(head, hints.eye_separation / 2));
  }
  return eyes;
}

LevelSettings level_settings(const MethodSettings& s) {
  LevelSettings levels;
  levels.allocator = s.allocator;
  levels.max_oversampling = s.max_oversampling;
  levels.hysteresis = s.level_hysteresis;
  return levels;
}

std::vector<std::uint32_t> chunks_of_patches(const Scene& scene) {
  std::vector<std::uint32_t> chunk_of(scene.patches.size());
  for (std::uint32_t i = 0; i < scene.chunks.size(); ++i) {
    for (const std::uint32_t patch : patches_of(scene, scene.chunks[i])) chunk_of[patch] = i;
  }
  return chunk_of;
}

/// Is `patch` in the list? Both are walked in ascending order.
template <class Iterator>
bool advance_to(Iterator& at, Iterator end, PatchId patch) {
  while (at != end && at->patch < patch) ++at;
  return at != end && at->patch == patch;
}

}  // namespace

SasMethod::SasMethod(Device& device, std::shared_ptr<const Scene> scene, const MethodSettings& settings)
    : settings_(checked(settings, scene->patches.size())),
      scene_(std::move(scene)),
      scene_gpu_(device, scene_),
      visibility_(device, scene_gpu_, visibility_settings(settings_)),
      planner_(make_layout_planner(device, visibility_, level_settings(settings_),
                                   static_cast<std::uint32_t>(scene_->patches.size()),
                                   settings_.allocator_kind, settings_.strategy, settings_.most_new_patches)),
      freed_(settings_.atlas, settings_.allocator.min_block_log2,
             static_cast<std::uint32_t>(scene_->patches.size())),
      shading_(device, scene_gpu_, settings_.atlas, settings_.frames_in_flight),
      conversion_(device, shading_.atlas(),
                  scene_->requirements.alpha() ? I420Pass::LowerHalf::kCoverage : I420Pass::LowerHalf::kNone,
                  settings_.frames_in_flight),
      timer_(device, "sas timer", 2),
      context_(device, "sas"),
      chunk_of_patch_(chunks_of_patches(*scene_)) {
  visibility_.set_emphasis(settings_.emphasis);
}

RenderedFrame SasMethod::render(const FrameRequest& request) {
  RenderedFrame frame{.frame = request.frame};
  const Time begin = steady_now();
  if (request.restart) planner_->restart();
  scene_gpu_.pose(request.scene_seconds);
  const Time start = steady_now();
  find_visible(request);
  const Time found = steady_now();
  const LayoutChange& change = planner_->finish(request.intra);
  const LevelStats levels = planner_->levels();
  freed_.apply(change);
  choose_stale(change);
  const Time placed = steady_now();
  const std::uint32_t slot = frames_ % settings_.frames_in_flight;
  frame.timings.motion = start - begin;
  frame.timings.visibility = found - start - planner_->device_time();
  frame.timings.allocation = placed - found + planner_->device_time();
  frame.shaded_texels = shade(request, slot, frame.timings);
  frame.picture = conversion_.picture(slot);
  frame.change = &change;
  frame.moved = &scene_gpu_.moved();
  frame.requests = planner_->requests();
  frame.layout = counts_of(change);
  frame.usage = planner_->allocator().usage();
  frame.visible_patches = levels.visible;
  frame.waiting_patches = planner_->waiting();
  frame.bias = levels.bias;
  ++frames_;
  return frame;
}

void SasMethod::find_visible(const FrameRequest& request) {
  const auto& commands = context_.begin();
  scene_gpu_.record_moves(commands);
  visibility_.record(commands, request.camera, viewpoints(request, settings_));
  planner_->record(commands, request.intra);
  context_.wait(context_.submit());
}

void SasMethod::choose_stale(const LayoutChange& change) {
  stale_ = planner_->allocator().blocks();
  if (settings_.reshade_interval == 1) return;
  auto added = change.added.begin();
  auto moved = change.moved.begin();
  const std::vector<Mover> movers = take_moved();
  auto mover = movers.begin();
  std::erase_if(stale_, [&](const PlacedPatch& placed) {
    const bool is_new = advance_to(added, change.added.end(), placed.patch);
    const bool is_moved = advance_to(moved, change.moved.end(), placed.patch);
    const std::uint32_t turn = chunk_of_patch_[value(placed.patch)] + frames_;
    while (mover != movers.end() && mover->end() <= value(placed.patch)) ++mover;
    const bool moves = mover != movers.end() && mover->first_patch <= value(placed.patch);
    return !is_new && !is_moved && !moves && turn % settings_.reshade_interval != 0;
  });
}

/// The runs of patches that moved since the last call.
std::vector<Mover> SasMethod::take_moved() {
  const MovedScene& moved = scene_gpu_.moved();
  shaded_versions_.resize(moved.parts().size());
  std::vector<Mover> movers;
  for (std::size_t i = 0; i < shaded_versions_.size(); ++i) {
    if (std::exchange(shaded_versions_[i], moved.version(i)) != moved.version(i))
      movers.push_back(moved.parts()[i].mover);
  }
  return movers;
}

void SasMethod::clear_freed(const vk::raii::CommandBuffer& commands) {
  std::vector<vk::ClearRect> rects;
  for (const TexelRect& r : freed_.take()) {
    rects.push_back({.rect = {.offset = {static_cast<std::int32_t>(r.x), static_cast<std::int32_t>(r.y)},
                              .extent = {r.width, r.height}},
                     .layerCount = 1});
  }
  Image& atlas = shading_.atlas();
  if (rects.empty() || frames_ == 0) return;
  use_image(commands, atlas, ImageUse::kColorTarget);
  const vk::RenderingAttachmentInfo color{.imageView = atlas.view(),
                                          .imageLayout = atlas.layout(),
                                          .loadOp = vk::AttachmentLoadOp::eLoad,
                                          .storeOp = vk::AttachmentStoreOp::eStore};
  commands.beginRendering({.renderArea = {.extent = {atlas.extent().width, atlas.extent().height}},
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color});
  commands.clearAttachments(
      vk::ClearAttachment{.aspectMask = vk::ImageAspectFlagBits::eColor,
                          .colorAttachment = 0,
                          .clearValue = vk::ClearColorValue(std::array{0.5F, 0.5F, 0.5F, 0.0F})},
      rects);
  commands.endRendering();
}

std::uint64_t SasMethod::shade(const FrameRequest& request, std::uint32_t slot, RenderTimings& timings) {
  const Time start = steady_now();
  const auto& commands = context_.begin();
  timer_.reset(commands);
  if (request.intra) clear_freed(commands);
  const std::uint64_t texels = shading_.record(
      commands, stale_, request.hints.shading_eye.value_or(request.camera.pose.position), frames_ == 0);
  use_image(commands, shading_.atlas(), ImageUse::kSampledInCompute);
  timer_.begin(commands, "conversion");
  conversion_.record(commands, slot);
  timer_.end(commands);
  writes_to_host(commands);
  context_.wait(context_.submit());
  for (const auto& [stage, duration] : timer_.collect()) timings.conversion += duration;
  timings.shading = std::max(Duration::zero(), steady_now() - start - timings.conversion);
  return texels;
}

}  // namespace atlaswire::render
