#pragma once

#include "codec/gate_meta.h"
#include "tests/codec/shown_patches.h"

#include <gtest/gtest.h>

namespace atlaswire::codec {

/// Both ends, and what a client shows by each.
struct GateStream {
  explicit GateStream(const MetaLimits& limits) : encoder(limits), decoder(limits) {}

  ByteBuffer encoded(const MetaUpdate& update) {
    ByteBuffer message;
    encoder.encode(update, message);
    return message;
  }
  /// Passes an update through and holds what comes out against it.
  void pass(const MetaUpdate& update) {
    bytes += encoded_and_decoded(update);
    wanted.apply(update);
    ASSERT_TRUE(wanted == got);
  }
  std::size_t encoded_and_decoded(const MetaUpdate& update) {
    const ByteBuffer message = encoded(update);
    const auto back = decoder.decode(message);
    EXPECT_TRUE(back) << back.error().message();
    if (!back) return 0;
    EXPECT_EQ(back->frame, update.frame);
    EXPECT_EQ(back->reset, update.reset);
    got.apply(*back);
    return message.size();
  }

  GateMetaEncoder encoder;
  GateMetaDecoder decoder;
  ShownPatches wanted;
  ShownPatches got;
  std::size_t bytes = 0;
};

}  // namespace atlaswire::codec
