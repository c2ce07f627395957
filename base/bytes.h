#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace atlaswire {

/// A borrowed run of octets.
using ByteView = std::span<const std::byte>;
/// Octets that are owned.
using ByteBuffer = std::vector<std::byte>;

/// Reads big-endian (network order) fields from peer bytes. Safe on hostile input: past the end every
/// read gives 0 and `ok()` turns false for good, so that a parser may check once at its end.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : bytes_(bytes) {}

  /// The next unsigned or signed integer, or the next IEEE float, most significant octet first.
  template <class T>
  requires(std::integral<T> || std::floating_point<T>) T read() {
    using Raw = std::conditional_t<
        sizeof(T) == 8, std::uint64_t,
        std::conditional_t<sizeof(T) == 4, std::uint32_t,
                           std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;
    std::uint64_t raw = 0;
    if (!take(sizeof(T))) return T{};
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      raw = (raw << 8U) | std::to_integer<std::uint64_t>(bytes_[at_ - sizeof(T) + i]);
    }
    return std::bit_cast<T>(static_cast<Raw>(raw));
  }

  /// LEB128 unsigned; more than 10 octets or bits beyond 64 fail.
  std::uint64_t read_varint();
  /// Zigzag LEB128 signed.
  std::int64_t read_signed_varint();
  /// The next `count` octets, borrowed; empty and not ok() when fewer remain.
  ByteView read_bytes(std::size_t count);

  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - at_; }
  [[nodiscard]] bool ok() const { return ok_; }
  /// Everything was read, and nothing more than everything.
  [[nodiscard]] bool finished() const { return ok_ && remaining() == 0; }

 private:
  bool take(std::size_t count);

  ByteView bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// Appends big-endian fields to a buffer it borrows.
class ByteWriter {
 public:
  explicit ByteWriter(ByteBuffer& out) : out_(&out) {}

  template <class T>
  requires(std::integral<T> || std::floating_point<T>) void write(T v) {
    std::byte raw[sizeof(T)];
    std::memcpy(raw, &v, sizeof(T));
    static_assert(std::endian::native == std::endian::little);
    for (std::size_t i = sizeof(T); i-- > 0;) out_->push_back(raw[i]);
  }
  void write_varint(std::uint64_t v);
  void write_signed_varint(std::int64_t v);
  void write_bytes(ByteView bytes) { out_->insert(out_->end(), bytes.begin(), bytes.end()); }

 private:
  ByteBuffer* out_;
};

}  // namespace atlaswire
