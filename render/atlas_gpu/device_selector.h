#pragma once

#include "render/atlas/level_selection.h"
#include "render/gpu/buffer.h"
#include "render/gpu/descriptors.h"
#include "render/gpu/pipeline.h"
#include "shaders/select_layout.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// LevelSelector as compute passes: from the visibility pass's level words to the atlas memory's wants, with
/// no host in between and equal results.
class DeviceSelector {
 public:
  /// `levels` and `wants` hold one word a patch and live as long; wants are 0 at first, and only record()
  /// writes them. Throws ProgramError for settings out of range.
  DeviceSelector(Device& device, const LevelSettings& settings, std::uint32_t patch_count,
                 const Buffer& levels, const Buffer& wants);

  /// Records one frame, whose levels are visible to shaders; its wants will be.
  void record(const vk::raii::CommandBuffer& commands) const;

  /// What the recorded frame did, once it was waited for; `one_step_bias` is not computed here.
  [[nodiscard]] LevelStats stats() const;

 private:
  select::SelectConstants constants_;
  std::uint32_t unit_log2_;  ///< of areas
  Buffer selection_;
  Buffer remembered_;
  Buffer savings_;
  DescriptorLayout layout_;
  DescriptorSets sets_;
  Pipeline count_;
  Pipeline bias_;
  Pipeline want_;
  Pipeline excess_;
  Pipeline demote_;
};

}  // namespace atlaswire::render
