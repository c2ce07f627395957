#pragma once

#include "base/bytes.h"
#include "base/result.h"
#include "proto/wire_error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::proto {

/// NAL unit types this room looks at (H.264 table 7-1, RFC 6184 table 1).
enum class NalType : std::uint8_t {
  kSlice = 1,
  kIdr = 5,
  kSei = 6,
  kSps = 7,
  kPps = 8,
  kStapA = 24,
  kFuA = 28
};

/// Type of a NAL unit by its first octet; 0 for an empty one.
inline NalType nal_type(ByteView nal) {
  return nal.empty() ? NalType{} : static_cast<NalType>(std::to_integer<unsigned>(nal[0]) & 0x1FU);
}

/// Appends the NAL units between the start codes of an Annex B byte stream (3- or 4-octet codes; trailing
/// zeros dropped), borrowed from it. Bytes before the first start code are ignored.
void split_annex_b(ByteView bytes, std::vector<ByteView>& nals);

/// One RTP payload: `prefix` octets of FU or STAP headers, then either one run of a NAL unit, or (STAP-A)
/// whole NAL units, each behind its 16-bit size.
struct PayloadPlan {
  std::array<std::byte, 2> prefix{};
  std::uint8_t prefix_size = 0;  ///< 0 single NAL unit, 1 STAP-A, 2 FU-A
  ByteView fragment;             ///< single NAL unit and FU-A
  std::uint32_t first_nal = 0;   ///< STAP-A: index into nals()
  std::uint32_t nal_count = 0;   ///< STAP-A
  std::uint32_t size = 0;        ///< octets of the payload
};

/// Splits access units for RTP (RFC 6184 packetization-mode 1): runs of small NAL units into STAP-A, large
/// ones into FU-A. Allocates only until its lists have grown to the largest picture.
class H264Packetizer {
 public:
  /// Plans the payloads of one Annex B access unit: the first at most `first_limit` octets, the others
  /// `limit` (both at least 16). The plans borrow from `access_unit`, until the next call.
  std::span<const PayloadPlan> plan(ByteView access_unit, std::size_t first_limit, std::size_t limit);
  /// Appends a planned payload.
  void append(const PayloadPlan& payload, ByteBuffer& out) const;
  [[nodiscard]] std::span<const ByteView> nals() const { return nals_; }

 private:
  void plan_fragments(ByteView nal, std::size_t first_limit, std::size_t limit);
  std::uint32_t plan_aggregate(std::uint32_t first, std::size_t limit);

  std::vector<ByteView> nals_;
  std::vector<PayloadPlan> plans_;
};

/// Joins payloads of one access unit, given in order, to Annex B with 4-octet start codes.
class H264Depacketizer {
 public:
  /// Starts an access unit that is appended to `out`.
  void begin(ByteBuffer& out);
  /// One payload; refuses reserved types, broken STAP-A sizes, and FU-A out of order. Safe on hostile bytes.
  Result<void> add(ByteView payload);
  /// Ends it: refuses an unfinished FU-A or an empty unit.
  Result<void> end();
  /// The unit holds an IDR slice.
  [[nodiscard]] bool has_idr() const { return has_idr_; }

 private:
  Result<void> add_nal(ByteView nal);
  Result<void> add_aggregate(ByteView payload);
  Result<void> add_fragment(ByteView payload);

  ByteBuffer* out_ = nullptr;
  bool has_idr_ = false;
  bool in_fragment_ = false;
  std::byte fragment_header_{};
  bool any_ = false;
};

}  // namespace atlaswire::proto
