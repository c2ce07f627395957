#pragma once

#include "base/result.h"
#include "codec/meta_update.h"
#include "proto/stream_description.h"
#include "render/atlas/allocator.h"
#include "render/atlas/layout_hash.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace atlaswire::client {

/// Runs the server's atlas memory beside it ([SAS] 4.2, render::make_sequential_allocator), so that updates
/// need not say where blocks lie: patches' requests go in, blocks come out, the same as the server's.
/// docs/PROTOCOL.md, "Atlas memory". Work follows from what an update changes, but for resets. Safe on
/// hostile updates: no allocation per patch; arrays grow to the largest id used.
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
  [[nodiscard]] Result<void> check(const codec::MetaUpdate& asked) const;
  void take_in(const codec::MetaUpdate& asked);
  void answer(const render::LayoutChange& change, codec::MetaUpdate& update) const;
  [[nodiscard]] bool asks(PatchId patch) const;
  void add(const codec::AddedPatch& patch);
  void remove(PatchId patch);
  void forget_all();

  std::uint32_t max_patches_;
  bool believes_all_;
  std::unique_ptr<render::IncrementalAllocator> allocator_;
  render::LayoutHash hash_;
  bool in_step_ = false;
  std::vector<codec::AddedPatch> asking_;  ///< packed; their blocks mean nothing
  std::vector<std::uint32_t> slot_;        ///< by PatchId: index into asking_ + 1; 0: does not ask
  std::vector<render::BlockRequest> requests_;
};

}  // namespace atlaswire::client
