#include "codec/gap_detector.h"

#include "codec/annex_b.h"

namespace atlaswire::codec {

namespace {

/// Reads bits of a NAL unit behind its header octet, leaving out emulation prevention octets (H.264 7.3.1).
/// Past the end every bit is 0 and `ok()` turns false.
class NalBits {
 public:
  explicit NalBits(ByteView unit) : unit_(unit) {}

  std::uint32_t bits(std::uint32_t count) {
    std::uint32_t v = 0;
    for (; count > 0; --count) v = v << 1U | bit();
    return v;
  }

  /// ue(v), H.264 9.1.
  std::uint32_t exp_golomb() {
    std::uint32_t zeros = 0;
    while (ok_ && bit() == 0) ++zeros;
    if (zeros > 31) ok_ = false;
    return ok_ ? (1U << zeros) - 1 + bits(zeros) : 0;
  }

  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::uint32_t bit() {
    if (left_ == 0) next_octet();
    if (!ok_) return 0;
    --left_;
    return octet_ >> left_ & 1U;
  }

  void next_octet() {
    const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(unit_[i]); };
    ++at_;
    if (at_ < unit_.size() && zeros_ >= 2 && at(at_) == 3) {
      zeros_ = 0;
      ++at_;
    }
    if (at_ >= unit_.size()) {
      ok_ = false;
      return;
    }
    octet_ = at(at_);
    zeros_ = octet_ == 0 ? zeros_ + 1 : 0;
    left_ = 8;
  }

  ByteView unit_;
  std::size_t at_ = 0;
  std::uint32_t octet_ = 0;
  std::uint32_t left_ = 0;
  std::uint32_t zeros_ = 0;
  bool ok_ = true;
};

bool has_chroma_fields(std::uint32_t profile) {
  for (const std::uint32_t high : {100U, 110U, 122U, 244U, 44U, 83U, 86U, 118U, 128U}) {
    if (profile == high) return true;
  }
  return false;
}

/// Bits of frame_num by a sequence parameter set (H.264 7.3.2.1.1); 0 where we do not follow: 4:4:4 and
/// scaling matrices, which no encoder of ours writes.
std::uint32_t frame_number_bits(ByteView unit) {
  NalBits in(unit);
  const std::uint32_t profile = in.bits(8);
  in.bits(16);      // constraint flags, level
  in.exp_golomb();  // seq_parameter_set_id
  if (has_chroma_fields(profile)) {
    const std::uint32_t chroma_format = in.exp_golomb();
    in.exp_golomb();  // bit depths
    in.exp_golomb();
    in.bits(1);  // qpprime_y_zero_transform_bypass_flag
    const bool scaling_matrix = in.bits(1) != 0;
    if (chroma_format > 2 || scaling_matrix) return 0;
  }
  const std::uint32_t bits = in.exp_golomb() + 4;
  return in.ok() && bits <= 16 ? bits : 0;
}

}  // namespace

GapDetector::Verdict GapDetector::inspect(ByteView access_unit) {
  AnnexBReader units(access_unit);
  while (const auto unit = units.next()) {
    const NalType type = nal_type(*unit);
    if (type == NalType::kSequenceSet) frame_number_bits_ = frame_number_bits(*unit);
    if (type != NalType::kIdr && type != NalType::kSlice) continue;
    // The first slice tells: all slices of a picture carry the same frame_num.
    if (type == NalType::kIdr) {
      reference_ = 0;
      return Verdict::kContinues;
    }
    if (!reference_) return Verdict::kNoReference;
    if (frame_number_bits_ == 0) return Verdict::kContinues;  // cannot tell
    NalBits in(*unit);
    in.exp_golomb();  // first_mb_in_slice
    in.exp_golomb();  // slice_type
    in.exp_golomb();  // pic_parameter_set_id
    const std::uint32_t number = in.bits(frame_number_bits_);
    const std::uint32_t expected = (*reference_ + 1) & ((1U << frame_number_bits_) - 1);
    if (!in.ok() || number != expected) return Verdict::kGap;
    const bool is_reference = (std::to_integer<unsigned>((*unit)[0]) >> 5U & 3U) != 0;
    if (is_reference) reference_ = number;
    return Verdict::kContinues;
  }
  return Verdict::kNoReference;
}

}  // namespace atlaswire::codec
