#include "server/atlas_source.h"

#include "base/program.h"

#include <utility>

namespace atlaswire::server {

AtlasSource::AtlasSource(const StreamSettings& settings, render::Device& device,
                         std::shared_ptr<const render::Scene> scene)
    : settings_(settings), device_(device), scene_(std::move(scene)) {
  auto stream = make_stream();
  warm_up(*stream);
  description_ = describe(*scene_, *stream, settings_);
  constexpr std::uint32_t kMostNumbered = 1U << 26U;  // docs/PROTOCOL.md, StreamInfo
  if (scene_->patches.size() > kMostNumbered || scene_->positions.size() > kMostNumbered) {
    throw ProgramError(ExitCode::kBadScene,
                       "scene '" + scene_->name + "' has more than 67 million patches or vertices; split it");
  }
  parameter_sets_ = stream->parameter_sets();
  encoder_name_ = stream->encoder_name();
  spare_ = std::move(stream);
}

std::unique_ptr<AtlasStream> AtlasSource::make_stream() const {
  auto method = render::make_method(settings_.method, device_, scene_, settings_.render);
  return std::make_unique<AtlasStream>(settings_, scene_, std::move(method));
}

void AtlasSource::warm_up(AtlasStream& stream) const {
  ViewRequest request;
  request.camera.pose = scene_->start;
  // The second frame takes the paths that only frames with a past take.
  for (int frame = 0; frame < 2; ++frame) {
    const auto encoded = stream.encode(stream.render(request));
    if (!encoded) {
      throw ProgramError(ExitCode::kInternal,
                         "the first frame could not be encoded: " + encoded.error().message());
    }
  }
}

std::unique_ptr<FrameMaker> AtlasSource::make() {
  {
    const std::lock_guard lock(mutex_);
    if (spare_) return std::move(spare_);
  }
  return make_stream();
}

void AtlasSource::give_back(std::unique_ptr<FrameMaker> maker) {
  const std::lock_guard lock(mutex_);
  // Swapped, so that a surplus stream is destroyed after the lock is gone.
  if (!spare_) std::swap(spare_, maker);
}

}  // namespace atlaswire::server
