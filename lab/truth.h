#pragma once

#include "base/time.h"
#include "render/camera.h"
#include "render/gpu/open_device.h"
#include "render/image/lens_correction.h"
#include "render/image/picture.h"
#include "render/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace atlaswire::lab {

/// What should be seen, and what a forward pass shades for it.
struct TruePicture {
  render::Picture picture;  ///< alpha: 255 where opaque or masked geometry was hit, 0 where nothing was drawn
  std::uint64_t forward_fragments = 0;   ///< render::ForwardPass::fragments
  std::uint64_t deferred_fragments = 0;  ///< pixels with geometry, before the lens
};

/// Ground truth: the scene drawn by a forward pass for exactly the displayed pose ([SAS] 5.6), then corrected
/// for the display's lens as the methods' pictures are. Pictures are kept in a folder that the points of a
/// sweep share, since all of them are compared with the same ones.
class Truth {
 public:
  /// `cache`: empty: none; made if missing. `scene_name` tells scenes apart there, the file's size and age
  /// with it. Throws ProgramError when the folder cannot be made.
  Truth(render::Device& device, std::shared_ptr<const render::Scene> scene, const std::string& scene_name,
        std::filesystem::path cache, const render::LensCorrection& lens = {});
  ~Truth();

  /// Of a scene that moves, as it is at `time` since the path's start: what a viewer with no latency at all
  /// would see.
  TruePicture picture(const render::Camera& camera, Duration time);

 private:
  struct Parts;
  TruePicture rendered(const render::Camera& camera, Duration time);
  [[nodiscard]] std::filesystem::path place_of(const render::Camera& camera, Duration time) const;

  render::Device* device_;
  std::shared_ptr<const render::Scene> scene_;
  std::string identity_;
  std::filesystem::path cache_;
  render::LensCorrection lens_;
  std::unique_ptr<Parts> parts_;  ///< made when first needed
};

}  // namespace atlaswire::lab
