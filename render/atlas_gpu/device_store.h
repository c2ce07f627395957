#pragma once

#include "render/atlas/allocator.h"
#include "render/gpu/buffer.h"
#include "render/gpu/descriptors.h"
#include "render/gpu/pipeline.h"
#include "shaders/alloc_layout.h"

#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::render {

/// How slots are given to the requests of a frame.
enum class SlotOrder : std::uint8_t {
  kRanked,  ///< by rank in prefix sums: the layout is a function of the inputs, as the sequential model has
            ///< it
  kDrawn,   ///< from atomic counters, as [SAS] 4.2 does: fewer passes, but a layout that chance decides
};

/// The atlas's memory on the device ([SAS] 4.2): the sequential model's arithmetic as compute passes, with no
/// host in between. Any subgroup size will do.
///
///   admit      patches never shown before, so many a frame         (if there is a limit)
///   request    every patch: who gives a block back, who asks for one
///   reclaim    superblocks without blocks become free; or a reset frees all
///   list       those patches in ascending order                            (ranked only)
///   rank       their slots within tiles of 256, by level                   (ranked only)
///   compact    stacks forget what lies in reclaimed superblocks            (if there are any)
///   count      slots within the frame                                      (ranked only)
///   push       blocks given back go onto the stacks
///   provision  memory for all slots, from counts alone
///   assign     every slot's block, records and the change list
///   settle     leftovers go onto the stacks; sums for the host
class DeviceStore {
 public:
  /// Settings are checked (check_allocator_settings). Throws ProgramError if the device's buffers are too
  /// small for such an atlas.
  /// `most_new`: as Admission has it.
  DeviceStore(Device& device, const AllocatorSettings& settings, std::uint32_t patch_count, SlotOrder order,
              Residence wants, std::uint32_t most_new);

  /// What each patch wants (alloc_layout.h), hidden at first: written by the host (if its residence is
  /// kUpload) or by an earlier pass before record().
  [[nodiscard]] const Buffer& wants() const { return wants_; }

  /// Records one frame, whose wants are visible to shaders. `reset`: 0, kMayReset or kMustReset.
  void record(const vk::raii::CommandBuffer& commands, std::uint32_t reset) const;

  /// What the recorded frame did, once it was waited for.
  [[nodiscard]] alloc::Report report() const;
  /// Its change list; ascending by patch where slots are ranked.
  [[nodiscard]] std::span<const alloc::Change> changes() const;

 private:
  struct Pass {
    Pipeline pipeline;
    enum class Extent : std::uint8_t { kOne, kPatches, kEventWords, kKeys, kItems, kCompaction } extent;
  };

  Buffer make(Device& device, const char* name, std::size_t bytes, Residence residence) const;
  void upload_initial_state(Device& device, const AllocatorSettings& settings);
  void add_pass(Device& device, const char* name, ShaderWords shader, Pass::Extent extent);

  alloc::Constants constants_;
  SlotOrder order_;
  Buffer store_;
  Buffer wants_;
  Buffer records_;
  Buffer items_;
  Buffer superblocks_;
  Buffer stacks_;
  Buffer deferred_;
  Buffer tiles_;
  Buffer events_;
  Buffer segments_;
  Buffer leftovers_;
  Buffer changes_;
  Buffer report_;
  Buffer admitted_;
  DescriptorLayout layout_;
  DescriptorSets sets_;
  std::vector<Pass> passes_;
};

}  // namespace atlaswire::render
