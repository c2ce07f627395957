#pragma once

#include "base/random.h"
#include "client/layout_mirror.h"
#include "client/replica.h"
#include "codec/meta_update.h"
#include "render/atlas/allocator.h"
#include "render/scene/scene.h"
#include "server/replica_tracker.h"

#include <map>
#include <memory>
#include <span>
#include <string>

namespace atlaswire::client::testing {

/// A sheet of `patches` quads, in rows of 32.
std::shared_ptr<const render::Scene> sheet_of(std::uint32_t patches);

/// A server's atlas memory, tracker and encoder, and a client's decoder, mirror and replica behind them.
class MirroredStream {
 public:
  MirroredStream(const render::AllocatorSettings& settings, std::uint32_t patches);

  /// What the server makes of one frame. `restart`: tells all from nothing.
  codec::MetaUpdate serve(std::span<const render::BlockRequest> visible, bool may_reset,
                          bool restart = false);
  /// Through the codec to the client. Empty if it then shows the server's layout, else what went wrong.
  std::string carry(const codec::MetaUpdate& update);
  /// A client that knows nothing.
  void join();

  LayoutMirror& mirror() { return *mirror_; }
  [[nodiscard]] const render::AtlasAllocator& memory() const { return *memory_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  [[nodiscard]] std::string compare() const;

  render::AllocatorSettings settings_;
  server::ReplicaTracker tracker_;
  codec::MetaLimits limits_;
  std::unique_ptr<render::AtlasAllocator> memory_;
  std::unique_ptr<codec::MetaEncoder> encoder_;
  std::unique_ptr<codec::MetaDecoder> decoder_;
  std::unique_ptr<LayoutMirror> mirror_;
  std::unique_ptr<Replica> replica_;
  FrameId frame_{};
  std::size_t bytes_ = 0;
};

}  // namespace atlaswire::client::testing
