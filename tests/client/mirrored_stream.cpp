#include "tests/client/mirrored_stream.h"

namespace atlaswire::client::testing {

std::shared_ptr<const render::Scene> sheet_of(std::uint32_t patches) {
  constexpr std::uint32_t kRow = 32;
  auto scene = std::make_shared<render::Scene>();
  const std::uint32_t rows = (patches + kRow - 1) / kRow;
  for (std::uint32_t y = 0; y <= rows; ++y) {
    for (std::uint32_t x = 0; x <= kRow; ++x) scene->positions.emplace_back(x, y, 0);
  }
  scene->box = {{0, 0, 0}, {kRow, rows, 1}};
  scene->materials.resize(1);
  for (std::uint32_t i = 0; i < patches; ++i) {
    const std::uint32_t at = i / kRow * (kRow + 1) + i % kRow;
    render::Patch patch;
    patch.triangles = 2;
    patch.positions = {VertexId{at}, VertexId{at + 1}, VertexId{at + kRow + 2}, VertexId{at + kRow + 1},
                       VertexId{at + kRow + 1}};
    scene->patches.push_back(patch);
  }
  return scene;
}

MirroredStream::MirroredStream(const render::AllocatorSettings& settings, std::uint32_t patches)
    : settings_(settings),
      tracker_(sheet_of(patches), 12),
      limits_(tracker_.limits(settings.atlas)),
      memory_(render::make_sequential_allocator(settings, patches)),
      encoder_(codec::make_meta_encoder(codec::MetaCodecKind::kMirror, limits_)) {
  join();
}

void MirroredStream::join() {
  decoder_ = codec::make_meta_decoder(codec::MetaCodecKind::kMirror, limits_);
  mirror_ = std::make_unique<LayoutMirror>(
      proto::AtlasMemory{settings_.superblock_log2, settings_.min_block_log2, settings_.high_water},
      settings_.atlas, limits_.max_patches);
  replica_ = std::make_unique<Replica>(limits_);
}

codec::MetaUpdate MirroredStream::serve(std::span<const render::BlockRequest> visible, bool may_reset,
                                        bool restart) {
  if (restart) memory_->restart();
  const render::LayoutChange& change = memory_->update(visible, may_reset);
  const auto live = memory_->blocks();
  const server::ReplicaTracker::Asked asked{visible, &change, live};
  frame_ = next(frame_);
  return restart ? tracker_.restart(frame_, asked) : tracker_.update(frame_, asked);
}

std::string MirroredStream::carry(const codec::MetaUpdate& update) {
  ByteBuffer message;
  encoder_->encode(update, message);
  bytes_ += message.size();
  auto got = decoder_->decode(message);
  if (!got) return got.error().message();
  auto placed = mirror_->place(std::move(*got));
  if (!placed) return placed.error().message();
  if (const auto applied = replica_->apply(*placed); !applied) return applied.error().message();
  return compare();
}

std::string MirroredStream::compare() const {
  std::map<PatchId, Block> shown;
  for (const ReplicaPatch& patch : replica_->patches()) shown[patch.id] = patch.block;
  const auto live = memory_->blocks();
  if (shown.size() != live.size()) {
    return std::to_string(shown.size()) + " patches where the server has " + std::to_string(live.size());
  }
  for (const render::PlacedPatch& placed : live) {
    const auto at = shown.find(placed.patch);
    if (at == shown.end() || at->second != placed.block) {
      return "patch " + std::to_string(value(placed.patch)) + " is elsewhere";
    }
  }
  return {};
}

}  // namespace atlaswire::client::testing
