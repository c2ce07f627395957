#pragma once

#include "codec/meta_update.h"

#include <cstddef>
#include <memory>
#include <vector>

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace atlaswire::codec {

/// Largest body of a plain update before compression, octets. A decoder refuses more before it allocates.
inline constexpr std::size_t kMaxPlainMetaBody = kMaxMetaBody;

/// MetaCodecKind::kPlain: ascending ids as differences, positions as differences to the vertex before,
/// blocks as they are, then zstd where that is smaller. docs/PROTOCOL.md, "Meta update, plain form".
/// Keeps no state between updates, only its buffers.
class PlainMetaEncoder final : public MetaEncoder {
 public:
  PlainMetaEncoder();
  ~PlainMetaEncoder() override;
  PlainMetaEncoder(const PlainMetaEncoder&) = delete;
  PlainMetaEncoder& operator=(const PlainMetaEncoder&) = delete;

  /// Lists that do not ascend strictly are sorted on the way; an id must not come twice in a list.
  void encode(const MetaUpdate& update, ByteBuffer& out) override;

 private:
  void write_body(const MetaUpdate& update);

  ByteBuffer body_;
  ByteBuffer packed_;
  std::vector<std::uint32_t> order_;  // scratch: a list's indices by ascending id
  ZSTD_CCtx_s* zstd_;
};

/// The other end. Trusts nothing: see the checks in docs/PROTOCOL.md, "Meta update, plain form".
class PlainMetaDecoder final : public MetaDecoder {
 public:
  explicit PlainMetaDecoder(const MetaLimits& limits);
  ~PlainMetaDecoder() override;
  PlainMetaDecoder(const PlainMetaDecoder&) = delete;
  PlainMetaDecoder& operator=(const PlainMetaDecoder&) = delete;

  Result<MetaUpdate> decode(ByteView bytes) override;

 private:
  /// The body of a packed update, in `body_`.
  Result<ByteView> unpack(ByteView packed);

  MetaLimits limits_;
  ByteBuffer body_;
  ZSTD_DCtx_s* zstd_;
};

}  // namespace atlaswire::codec
