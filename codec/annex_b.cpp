#include "codec/annex_b.h"

#include <array>

namespace atlaswire::codec {

namespace {

constexpr std::array kStartCode{std::byte{0}, std::byte{0}, std::byte{0}, std::byte{1}};

/// Offset of the next 00 00 01, or the size when there is none.
std::size_t find_start_code(ByteView bytes) {
  for (std::size_t i = 2; i < bytes.size(); ++i) {
    if (bytes[i] > std::byte{1}) {
      i += 2;  // neither this octet nor the two after it can end a start code
    } else if (bytes[i] == std::byte{1} && bytes[i - 1] == std::byte{0} && bytes[i - 2] == std::byte{0}) {
      return i - 2;
    }
  }
  return bytes.size();
}

ByteView after_start_code(ByteView bytes) {
  const std::size_t at = find_start_code(bytes);
  return at == bytes.size() ? ByteView{} : bytes.subspan(at + 3);
}

}  // namespace

AnnexBReader::AnnexBReader(ByteView stream) : rest_(after_start_code(stream)) {}

std::optional<ByteView> AnnexBReader::next() {
  while (!rest_.empty()) {
    const std::size_t end = find_start_code(rest_);
    ByteView unit = rest_.first(end);
    rest_ = after_start_code(rest_.subspan(end));
    while (!unit.empty() && unit.back() == std::byte{0}) unit = unit.first(unit.size() - 1);
    if (!unit.empty()) return unit;
  }
  return std::nullopt;
}

bool contains_idr(ByteView stream) {
  AnnexBReader units(stream);
  while (const auto unit = units.next()) {
    if (nal_type(*unit) == NalType::kIdr) return true;
  }
  return false;
}

ByteBuffer parameter_sets_of(ByteView stream) {
  ByteBuffer out;
  AnnexBReader units(stream);
  while (const auto unit = units.next()) {
    const NalType type = nal_type(*unit);
    if (type != NalType::kSequenceSet && type != NalType::kPictureSet) continue;
    out.insert(out.end(), kStartCode.begin(), kStartCode.end());
    out.insert(out.end(), unit->begin(), unit->end());
  }
  return out;
}

}  // namespace atlaswire::codec
