#pragma once

#include "render/camera.h"
#include "render/display/i420_planes.h"
#include "render/image/picture.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

namespace atlaswire::render {

class Device;
struct OffscreenTarget;

/// An ordinary picture of the scene with what is known of it.
struct WarpSource {
  Camera camera;      ///< that the picture was drawn with; a width that is a multiple of 8, an even height
  I420Planes colors;  ///< of the camera's extent; of a picture with coded depth, upper_half() of it
  /// Metres along the view axis, rows from the top, > 0, infinity where nothing was drawn. kTimeWarp reads
  /// none and takes an empty span too.
  std::span<const float> depth;
};

/// The image-based methods that [SAS] 5.6 compares with.
enum class WarpKind : std::uint8_t {
  /// Asynchronous time warp: the homography of the rotation alone, as if all were infinitely far.
  kTimeWarp,
  /// Mark et al. 1997: one vertex a source pixel, moved by its depth, with a depth test. The quads between
  /// vertices stay, so that a disocclusion shows a stretched sheet instead of a hole. One more ring of
  /// vertices
  /// on the source's border, with its outermost pixels' depth, makes the grid cover the source's whole view.
  kMesh,
  /// Yang et al. 2011: from each output pixel, fixed-point search for the source pixel whose reprojection
  /// lands there (shaders/warp_iterative.frag says how).
  kIterative,
};

/// How hard kIterative searches.
struct IterativeSettings {
  std::uint32_t iterations = 8;  ///< from each start, >= 1
  std::uint32_t starts = 3;      ///< along the pixel's epipolar line, >= 2
};

/// Shows an ordinary picture from other poses: the display stage of the methods that [SAS] compares with. One
/// thread at a time. Where colours of the source are shown, alpha is 255, the sky's included.
class ViewWarp {
 public:
  virtual ~ViewWarp() = default;

  /// Takes a picture over: copies and uploads it.
  virtual void show(const WarpSource& source) = 0;
  /// Draws the shown source, of which there is one, for any pose, field of view and extent, and waits.
  virtual void draw(const Camera& camera) = 0;
  /// The last picture drawn; empty before the first. Alpha is 0, and the colour the background, where the
  /// source's view does not reach. Valid until the next call.
  virtual const Picture& read_back() = 0;
  /// What draw() drew into; null before the first, and another one whenever a camera has another extent.
  [[nodiscard]] virtual OffscreenTarget* target() = 0;
};

/// `background`: encoded colour 0..1 where nothing is drawn (display_color of the scene's).
std::unique_ptr<ViewWarp> make_view_warp(WarpKind kind, Device& device, const glm::vec3& background,
                                         const IterativeSettings& iterative = {});

}  // namespace atlaswire::render
