#pragma once

#include "base/bytes.h"

#include <cstddef>

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace atlaswire::bench {

/// zstd level 19 over a row of messages, each flushed, so that later ones refer to earlier ones.
class ZstdStreamEncoder {
 public:
  ZstdStreamEncoder();
  ~ZstdStreamEncoder();
  ZstdStreamEncoder(const ZstdStreamEncoder&) = delete;
  ZstdStreamEncoder& operator=(const ZstdStreamEncoder&) = delete;
  /// The message's octets, borrowed until the next call. Throws std::runtime_error.
  ByteView encode(ByteView message);

 private:
  ZSTD_CCtx_s* context_;
  ByteBuffer out_;
};

/// The other end.
class ZstdStreamDecoder {
 public:
  ZstdStreamDecoder();
  ~ZstdStreamDecoder();
  ZstdStreamDecoder(const ZstdStreamDecoder&) = delete;
  ZstdStreamDecoder& operator=(const ZstdStreamDecoder&) = delete;
  /// A message of `size` octets, borrowed until the next call. Throws std::runtime_error.
  ByteView decode(ByteView bytes, std::size_t size);

 private:
  ZSTD_DCtx_s* context_;
  ByteBuffer out_;
};

}  // namespace atlaswire::bench
