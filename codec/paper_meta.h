#pragma once

#include "codec/meta_update.h"

namespace atlaswire::codec {

/// MetaCodecKind::kPaper, as [SAS] 6.5 sketches it: more than 30 new vertices as an octree, fewer raw; all
/// else as differences, attribute by attribute, in exponential-Golomb codes. docs/PROTOCOL.md, "Meta update,
/// paper form". Keeps no state between updates. The paper leaves the codes' orders open: here each attribute
/// has the order that suits it best, and is told.
class PaperMetaEncoder final : public MetaEncoder {
 public:
  explicit PaperMetaEncoder(const MetaLimits& limits) : limits_(limits) {}

  /// An id must not come twice in a list. Positions must lie on the grid.
  void encode(const MetaUpdate& update, ByteBuffer& out) override;

 private:
  MetaLimits limits_;
};

/// The other end. Trusts nothing: see the checks in docs/PROTOCOL.md, "Meta update, paper form".
class PaperMetaDecoder final : public MetaDecoder {
 public:
  explicit PaperMetaDecoder(const MetaLimits& limits);

  /// Vertices come in octree order where there are more than 30.
  Result<MetaUpdate> decode(ByteView bytes) override;

 private:
  MetaLimits limits_;
};

}  // namespace atlaswire::codec
