#pragma once

#include "base/result.h"
#include "codec/meta_update.h"
#include "proto/stream_description.h"
#include "render/atlas/allocator.h"
#include "render/atlas/layout_hash.h"

#include <memory>
#include <vector>

namespace atlaswire::client {

/// Runs the server's atlas memory beside it ([SAS] 4.2, render::make_sequential_allocator), so that updates
/// need not say where blocks lie: patches' requests go in, blocks come out, the same as the server's.
/// docs/PROTOCOL.md, "Atlas memory". Safe on hostile updates: time and memory follow from patches told.
class LayoutMirror {
 public:
  /// `memory` and `atlas` as a StreamDescription that came through the wire's checks; ids below
  /// `max_patches`. `believes_all`: goes on although a layout does not match, for a fuzzer cannot guess
  /// hashes.
  LayoutMirror(const proto::AtlasMemory& memory, const Extent2D& atlas, std::uint32_t max_patches,
               bool believes_all = false);

  /// From an update with a cue to one that a Replica can apply: patches with the blocks they got, none for
  /// those that the memory had no room for. Lists ascend. Every update, in order. A ReplicaError where the
  /// update contradicts those before; MetaError::kOutOfStep where the layout is not the server's, and from
  /// then on until an update with `reset`.
  Result<codec::MetaUpdate> place(codec::MetaUpdate asked);

 private:
  Result<void> take_in(codec::MetaUpdate& asked);
  void answer(const render::LayoutChange& change, codec::MetaUpdate& update) const;

  render::AllocatorSettings settings_;
  std::uint32_t max_patches_;
  bool believes_all_;
  std::unique_ptr<render::AtlasAllocator> allocator_;
  render::LayoutHash hash_;
  bool in_step_ = false;
  std::vector<codec::AddedPatch> asked_;  ///< ascending; the block is what the patch asks for
  std::vector<codec::AddedPatch> next_;
  std::vector<render::BlockRequest> requests_;
};

}  // namespace atlaswire::client
