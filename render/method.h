#pragma once

#include "base/emphasis.h"
#include "base/ids.h"
#include "base/pose.h"
#include "base/time.h"
#include "base/units.h"
#include "render/atlas/allocator.h"
#include "render/atlas/strategy.h"
#include "render/camera.h"
#include "render/scene/scene.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace atlaswire::render {

class Device;
class MovedScene;

/// What a caller may know of a view beyond its pose.
struct ViewHints {
  double eye_separation = 0;   ///< metres; above 0 two eyes look, half of it to the left and to the right
  std::vector<Pose> foreseen;  ///< poses that will be displayed: stand in for prediction; empty: unknown
  std::optional<glm::dvec3> shading_eye;  ///< where highlights are seen from; nullopt: the camera's position
};

/// What one frame is to show: the viewer's newest pose and how far ahead clients may still be drawing it.
struct FrameRequest {
  FrameId frame{};
  Camera camera;
  Duration cover{};    ///< predict up to this far ahead
  bool intra = false;  ///< the encoder will make an I-frame of it
  /// Somebody knows nothing yet: the layout, and all that follow, are to be a function of requests from this
  /// frame on, so that a receiver can begin here to derive them, and admission begins anew; only with
  /// `intra`.
  bool restart = false;
  std::optional<double> scene_seconds;  ///< into the scene's clips; nullopt: it is shown at rest
  ViewHints hints;
};

/// How long each of a method's stages took; zero where a stage does not apply.
struct RenderTimings {
  Duration motion{};      ///< posing what moves, on the host
  Duration visibility{};  ///< id passes and marking
  Duration allocation{};  ///< level selection and atlas memory
  Duration shading{};     ///< shadows and shading
  Duration conversion{};  ///< to I420
};

/// A picture in I420 on the host. Planes are contiguous; borrowed from a ring: valid until the ring comes
/// round (MethodSettings::frames_in_flight further frames).
struct I420Picture {
  Extent2D extent;
  const std::uint8_t* y = nullptr;
  const std::uint8_t* u = nullptr;
  const std::uint8_t* v = nullptr;
};

/// An ordinary view of the scene: what "video" draws instead of an atlas.
struct RenderedView {
  Camera camera;       ///< as drawn: even sides; its extent is that of the picture's colours
  double nearest = 0;  ///< metres along the view axis: nothing drawn is nearer; infinity: nothing was drawn
  /// Distances along the view axis in metres, rows from the top, infinity where nothing was drawn; blended
  /// surfaces have none. Only with VideoDepth::kFree; borrowed as the picture is.
  std::span<const float> depth;
};

/// What a method gives for one frame: a picture to encode, and what the picture is of: the change of an
/// atlas's layout, or an ordinary view.
struct RenderedFrame {
  FrameId frame{};
  I420Picture picture;
  const LayoutChange* change = nullptr;    ///< valid until the next render; null: the method has no atlas
  std::span<const BlockRequest> requests;  ///< what `change` answers; as long valid; ascending
  std::optional<RenderedView> view;        ///< nullopt: the method has an atlas
  const MovedScene* moved = nullptr;       ///< where things are in it; valid until the next render
  AtlasUsage usage;
  LayoutCounts layout;
  std::uint32_t visible_patches = 0;
  std::uint32_t waiting_patches = 0;  ///< of these, left for later frames (MethodSettings::most_new_patches)
  std::uint64_t shaded_texels = 0;
  double bias = 0;  ///< [SAS] eq. 3; below 0 the atlas has room to spare
  RenderTimings timings;
};

/// How the depth of an ordinary view reaches the client.
enum class VideoDepth : std::uint8_t {
  kNone,   ///< not at all: asynchronous time warp needs none
  kFree,   ///< exact and beside the picture, at no cost in bytes ([SAS] 5.6 to 5.8 count none)
  kCoded,  ///< below the colours in the picture's luma, 8 bits a pixel (render/video/depth_plane.h)
};

/// Settings of "video" alone.
struct VideoSettings {
  Extent2D display{960, 540};  ///< what every request's camera has; even sides
  VideoDepth depth = VideoDepth::kNone;
};

/// Who chooses levels and allocates blocks. The layout is the same.
enum class AllocatorKind : std::uint8_t {
  kAuto,        ///< the device, unless it is a CPU
  kDevice,      ///< compute passes ([SAS] 4.2): no host between visibility and layout
  kSequential,  ///< one thread of the host
};

/// Settings of all methods; each states its trade. "video" reads `fov_scale`, `frames_in_flight` and `video`.
struct MethodSettings {
  Extent2D atlas{1024, 1024};  ///< colour texels; quality against bytes and shading time
  double fov_scale = 1.2;      ///< >= 1; room for rotation against larger visible sets
  double id_scale = 1.0;  ///< id buffer pixels per display pixel along a side; small triangles against time
  std::uint32_t max_views = 2;    ///< visible sets united per frame
  std::uint32_t hold_frames = 4;  ///< that a patch stays after it was last seen: steady sets against texels
  Duration prediction_step = std::chrono::microseconds(33'333);
  double max_oversampling = 4.0;          ///< texels a pixel may get when the atlas has room
  std::uint32_t most_new_patches = 4096;  ///< a frame may show for the first time, the largest first; 0: all
  std::uint32_t reshade_interval = 1;  ///< each block is shaded at least every n-th frame; new ones at once
  std::uint32_t frames_in_flight = 3;
  Emphasis emphasis;  ///< until Method::set_emphasis()
  AllocatorKind allocator_kind = AllocatorKind::kAuto;
  Strategy strategy = Strategy::kS0;  ///< others are there to compare with, on the host
  double level_hysteresis = 0.25;  ///< 0..1 octaves; blocks that stay put against the sharpest size for each
  AllocatorSettings allocator;  ///< `atlas` follows ours; its smallest block is at most suited_min_block_log2
  VideoSettings video;
};

/// A way to turn views into frames for the encoder: "sas", or "video" to compare with. One thread at a time.
class Method {
 public:
  virtual ~Method() = default;
  /// Picture size that the encoder will get: the atlas, and the coverage plane below it where the scene
  /// has alpha (luma 0..255 = coverage, chroma 128); or the view, and its depth plane where that is coded.
  [[nodiscard]] virtual Extent2D picture_extent() const = 0;
  virtual RenderedFrame render(const FrameRequest& request) = 0;
  /// The atlas's memory wants an early I-frame.
  [[nodiscard]] virtual bool wants_intra() const = 0;
  /// The memory that a receiver must have to derive each frame's layout from its requests
  /// (make_sequential_allocator); nullopt: it cannot.
  [[nodiscard]] virtual std::optional<AllocatorSettings> memory() const = 0;
  /// From the next frame on, in place of the one before. Methods without an atlas have nothing to share out.
  virtual void set_emphasis(const Emphasis& emphasis) = 0;
  /// Every live patch, ascending: what a new client must be told. Empty without an atlas.
  [[nodiscard]] virtual std::vector<PlacedPatch> blocks() const = 0;
};

/// Makes a method by its name. Throws ProgramError for an unknown name, listing the known.
std::unique_ptr<Method> make_method(const std::string& name, Device& device,
                                    std::shared_ptr<const Scene> scene, const MethodSettings& settings);
std::vector<std::string> method_names();

}  // namespace atlaswire::render
