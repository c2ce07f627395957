#include "bench/zstd_stream.h"

#include <zstd.h>

#include <stdexcept>

namespace atlaswire::bench {

namespace {

constexpr int kLevel = 19;
constexpr int kWindowLog = 22;

std::size_t checked(std::size_t result) {
  if (ZSTD_isError(result) != 0) throw std::runtime_error(ZSTD_getErrorName(result));
  return result;
}

}  // namespace

ZstdStreamEncoder::ZstdStreamEncoder() : context_(ZSTD_createCCtx()) {
  checked(ZSTD_CCtx_setParameter(context_, ZSTD_c_compressionLevel, kLevel));
  checked(ZSTD_CCtx_setParameter(context_, ZSTD_c_windowLog, kWindowLog));
}
ZstdStreamEncoder::~ZstdStreamEncoder() { ZSTD_freeCCtx(context_); }

ByteView ZstdStreamEncoder::encode(ByteView message) {
  out_.resize(ZSTD_compressBound(message.size()) + 64);
  ZSTD_inBuffer in{message.data(), message.size(), 0};
  ZSTD_outBuffer out{out_.data(), out_.size(), 0};
  if (checked(ZSTD_compressStream2(context_, &out, &in, ZSTD_e_flush)) != 0) {
    throw std::runtime_error("zstd: not flushed");
  }
  out_.resize(out.pos);
  return out_;
}

ZstdStreamDecoder::ZstdStreamDecoder() : context_(ZSTD_createDCtx()) {}
ZstdStreamDecoder::~ZstdStreamDecoder() { ZSTD_freeDCtx(context_); }

ByteView ZstdStreamDecoder::decode(ByteView bytes, std::size_t size) {
  out_.resize(size);
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  ZSTD_outBuffer out{out_.data(), out_.size(), 0};
  while (in.pos < in.size && out.pos < out.size) checked(ZSTD_decompressStream(context_, &out, &in));
  if (out.pos != size) throw std::runtime_error("zstd: a message ends early");
  return out_;
}

}  // namespace atlaswire::bench
