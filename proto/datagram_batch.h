#pragma once

#include "base/bytes.h"
#include "base/ids.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlaswire::proto {

/// The datagrams of one picture, back to back in one buffer, so that a reused batch allocates nothing.
struct DatagramBatch {
  FrameId frame{};
  bool idr = false;
  ByteBuffer octets;
  std::vector<std::uint32_t> ends;  ///< where each datagram ends in `octets`

  [[nodiscard]] std::size_t size() const { return ends.size(); }
  [[nodiscard]] ByteView operator[](std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends[i - 1];
    return ByteView(octets).subspan(begin, ends[i] - begin);
  }
  void clear() {
    octets.clear();
    ends.clear();
  }
};

}  // namespace atlaswire::proto
