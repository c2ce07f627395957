#pragma once

#include "base/time.h"
#include "render/atlas/level_selection.h"
#include "render/gpu/device.h"
#include "render/method.h"
#include "render/passes/visibility.h"

#include <memory>
#include <span>
#include <vector>

namespace atlaswire::render {

/// From a frame's level words to the atlas's layout: level selection and allocation, on the host or on the
/// device, with equal results.
class LayoutPlanner {
 public:
  virtual ~LayoutPlanner() = default;
  /// Records what the device does, behind the visibility pass and in its submission.
  virtual void record(const vk::raii::CommandBuffer& commands, bool may_reset) = 0;
  /// The frame's change, once that submission was waited for; valid until the next.
  virtual const LayoutChange& finish(bool may_reset) = 0;
  /// The next frame's layout follows from its requests alone (AtlasAllocator::restart). Before record().
  virtual void restart() = 0;
  /// What the frame's patches asked for, ascending; valid until the next.
  [[nodiscard]] virtual std::span<const BlockRequest> requests() const = 0;
  /// Visible patches that wait to be admitted.
  [[nodiscard]] virtual std::uint32_t waiting() const = 0;
  /// What level selection did in the frame.
  [[nodiscard]] virtual LevelStats levels() const = 0;
  /// How long record()'s work took on the device.
  [[nodiscard]] virtual Duration device_time() const = 0;
  [[nodiscard]] virtual const AtlasAllocator& allocator() const = 0;
};

/// Where the device is a CPU, kAuto is the sequential model: it needs a tenth of the passes' time there. Any
/// strategy but kS0 is on the host, whatever the kind. `most_new`: as Admission has it.
std::unique_ptr<LayoutPlanner> make_layout_planner(Device& device, const VisibilityPass& visibility,
                                                   const LevelSettings& settings, std::uint32_t patch_count,
                                                   AllocatorKind kind, Strategy strategy,
                                                   std::uint32_t most_new);

}  // namespace atlaswire::render
