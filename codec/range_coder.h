#pragma once

#include "base/bytes.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace atlaswire::codec {

/// What is known of one recurring yes-or-no decision: the mean of a fast and a slow estimate of how often it
/// is "no". Both start as the running mean of what came (rate 1 / (n + 2), as Krichevsky and Trofimov have
/// it) and settle at rates of 1/16 and 1/128. docs/PROTOCOL.md, "Range coding".
class AdaptiveBit {
 public:
  /// Probability of false in 32768ths, 16..32752, so that no decision costs more than 11 bits.
  [[nodiscard]] std::uint32_t probability_of_false() const {
    const std::uint32_t mean = (std::uint32_t{fast_} + slow_) >> 2U;
    return mean < kLeast ? kLeast : mean > kOne - kLeast ? kOne - kLeast : mean;
  }
  void update(bool bit) {
    const std::int32_t target = bit ? 0 : 65535;
    if (seen_ == kSettled) [[likely]] {  // as below, with rates that are shifts
      fast_ = static_cast<std::uint16_t>(fast_ + ((target - fast_) >> 4));
      slow_ = static_cast<std::uint16_t>(slow_ + ((target - slow_) >> 7));
      return;
    }
    fast_ = toward(fast_, target, kRates[seen_ < kFastLimit ? seen_ : kFastLimit]);
    slow_ = toward(slow_, target, kRates[seen_]);
    ++seen_;
  }

  static constexpr std::uint32_t kOne = 32768;

 private:
  static constexpr std::uint32_t kLeast = 16;
  static constexpr std::uint16_t kFastLimit = 14;
  static constexpr std::uint16_t kSettled = 126;
  /// 1 / (n + 2) in 32768ths.
  static constexpr std::array<std::int32_t, kSettled> kRates = [] {
    std::array<std::int32_t, kSettled> rates{};
    for (std::int32_t n = 0; n < kSettled; ++n) rates[static_cast<std::size_t>(n)] = 32768 / (n + 2);
    return rates;
  }();

  static std::uint16_t toward(std::uint16_t from, std::int32_t target, std::int32_t rate) {
    return static_cast<std::uint16_t>(from + (((target - from) * rate) >> 15));
  }

  std::uint16_t fast_ = 32768;
  std::uint16_t seen_ = 0;
  std::uint16_t slow_ = 32768;
};

/// Turns decisions into bytes: an adaptive binary range coder with carry (Martin 1979, as in LZMA), 32 bits
/// wide. `code` and `code_raw` give back what they were told, so that one script can serve both directions.
class RangeEncoder {
 public:
  static constexpr bool kEncodes = true;

  /// Appends to `out`, which it borrows until `finish`.
  explicit RangeEncoder(ByteBuffer& out) : out_(&out), start_(out.size()) {}

  bool code(AdaptiveBit& model, bool bit) {
    const std::uint32_t bound = (range_ >> 15U) * model.probability_of_false();
    if (bit) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model.update(bit);
    while (range_ < kRenormalize) shift();
    return bit;
  }
  /// The low `count` bits of `value`, 0..32, at one bit each; the highest first.
  std::uint32_t code_raw(std::uint32_t value, std::uint32_t count);
  /// Writes what is still inside, as few octets as tell it from its neighbours; zeros at the end are left
  /// out.
  void finish();

 private:
  static constexpr std::uint32_t kRenormalize = 1U << 24U;
  void shift();

  ByteBuffer* out_;
  std::size_t start_;
  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFFFFFF;
  std::uint64_t pending_ = 0;  ///< octets of 0xFF held back behind `cache_`, for a carry may come
  std::uint8_t cache_ = 0;
  bool has_cache_ = false;  ///< the first octet would always be 0, and is not written
};

/// The other end. Safe on any bytes: behind their end it reads zeros, for an encoder leaves those out.
/// Decodes something from everything; whether that makes sense is the caller's to check.
class RangeDecoder {
 public:
  static constexpr bool kEncodes = false;

  explicit RangeDecoder(ByteView bytes);

  bool code(AdaptiveBit& model, bool = false) {
    const std::uint32_t bound = (range_ >> 15U) * model.probability_of_false();
    const bool bit = code_ >= bound;
    if (bit) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model.update(bit);
    while (range_ < kRenormalize) shift();
    return bit;
  }
  std::uint32_t code_raw(std::uint32_t unused, std::uint32_t count);
  /// Octets that no decision has looked at; an honest encoder leaves none.
  [[nodiscard]] std::size_t unread() const { return bytes_.size() - at_; }

 private:
  static constexpr std::uint32_t kRenormalize = 1U << 24U;
  void shift() {
    range_ <<= 8U;
    code_ = code_ << 8U | next_octet();
  }
  std::uint32_t next_octet() {
    return at_ < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[at_++]) : 0;
  }

  ByteView bytes_;
  std::size_t at_ = 0;
  std::uint32_t range_ = 0xFFFFFFFF;
  std::uint32_t code_ = 0;
};

}  // namespace atlaswire::codec
