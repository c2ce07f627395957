#pragma once

#include "base/bytes.h"
#include "base/random.h"
#include "base/time.h"

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::test {

using namespace std::chrono_literals;

/// An instant `since` after the clock's zero.
inline Time at(Duration since) { return Time{since}; }

/// "01 ab FF" to octets; blanks are free.
inline ByteBuffer from_hex(std::string_view text) {
  ByteBuffer out;
  std::string digits;
  for (const char c : text) {
    if (c != ' ' && c != '\n') digits += c;
  }
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    out.push_back(static_cast<std::byte>(std::stoul(digits.substr(i, 2), nullptr, 16)));
  }
  return out;
}

/// Octets to "01abff", for messages that a person can compare.
inline std::string to_hex(ByteView bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (const std::byte b : bytes) {
    out += kDigits[std::to_integer<unsigned>(b) >> 4U];
    out += kDigits[std::to_integer<unsigned>(b) & 15U];
  }
  return out;
}

/// Octets without a zero among them, so that no start code can appear.
inline ByteBuffer noise(std::size_t size, Random& random) {
  ByteBuffer out(size);
  for (auto& b : out) b = static_cast<std::byte>(1 + random.below(255));
  return out;
}

/// A NAL unit of `type` and `size` octets.
inline ByteBuffer nal_unit(unsigned type, std::size_t size, Random& random) {
  ByteBuffer out = noise(size, random);
  out[0] = static_cast<std::byte>(0x60U | type);
  return out;
}

/// NAL units to Annex B with 4-octet start codes.
inline ByteBuffer annex_b(const std::vector<ByteBuffer>& nals) {
  ByteBuffer out;
  for (const auto& nal : nals) {
    const ByteBuffer code = from_hex("00000001");
    out.insert(out.end(), code.begin(), code.end());
    out.insert(out.end(), nal.begin(), nal.end());
  }
  return out;
}

/// A picture like an encoder's: SPS, PPS and two slices for an IDR, two slices else; about `size` octets.
inline ByteBuffer picture(bool idr, std::size_t size, Random& random) {
  const unsigned slice = idr ? 5 : 1;
  std::vector<ByteBuffer> nals;
  if (idr) {
    nals.push_back(nal_unit(7, 24, random));
    nals.push_back(nal_unit(8, 5, random));
  }
  nals.push_back(nal_unit(slice, 2 + size / 2, random));
  nals.push_back(nal_unit(slice, 2 + size / 2, random));
  return annex_b(nals);
}

/// Gives every truncation of `bytes`, then every copy with one octet changed (all its bits, its lowest, its
/// highest), to `parse`: it must return, whatever it says.
template <class Parse>
void for_each_damage(const ByteBuffer& bytes, const Parse& parse) {
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const ByteBuffer cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    parse(cut);
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const unsigned flip : {0xFFU, 0x01U, 0x80U}) {
      ByteBuffer changed = bytes;
      changed[i] ^= static_cast<std::byte>(flip);
      parse(changed);
    }
  }
}

/// Does every truncation of `bytes` fail?
template <class Parse>
bool every_truncation_fails(const ByteBuffer& bytes, const Parse& parse) {
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const ByteBuffer cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    if (parse(cut).has_value()) return false;
  }
  return true;
}

}  // namespace atlaswire::test
