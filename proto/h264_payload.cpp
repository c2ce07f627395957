#include "proto/h264_payload.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::proto {

namespace {

constexpr unsigned kStapA = 24;
constexpr unsigned kFuA = 28;
constexpr std::size_t kMaxNalInAggregate = 0xFFFF;
constexpr unsigned kStart = 0x80;
constexpr unsigned kEnd = 0x40;

unsigned octet(ByteView bytes, std::size_t i) { return std::to_integer<unsigned>(bytes[i]); }

/// Offset of the next 00 00 01 at or after `from`; the size when there is none.
std::size_t find_start_code(ByteView bytes, std::size_t from) {
  for (std::size_t i = from; i + 3 <= bytes.size();) {
    if (octet(bytes, i + 2) > 1) {
      i += 3;
    } else if (octet(bytes, i) == 0 && octet(bytes, i + 1) == 0 && octet(bytes, i + 2) == 1) {
      return i;
    } else {
      ++i;
    }
  }
  return bytes.size();
}

void append_start_code(ByteBuffer& out) {
  for (const unsigned b : {0U, 0U, 0U, 1U}) out.push_back(static_cast<std::byte>(b));
}

}  // namespace

void split_annex_b(ByteView bytes, std::vector<ByteView>& nals) {
  std::size_t code = find_start_code(bytes, 0);
  while (code < bytes.size()) {
    const std::size_t begin = code + 3;
    code = find_start_code(bytes, begin);
    ByteView nal = bytes.subspan(begin, code - begin);
    while (!nal.empty() && nal.back() == std::byte{0}) nal = nal.first(nal.size() - 1);
    if (!nal.empty()) nals.push_back(nal);
  }
}

std::span<const PayloadPlan> H264Packetizer::plan(ByteView access_unit, std::size_t first_limit,
                                                  std::size_t limit) {
  AW_ASSERT(first_limit >= 16 && limit >= 16);
  nals_.clear();
  plans_.clear();
  split_annex_b(access_unit, nals_);
  for (std::uint32_t i = 0; i < nals_.size();) {
    const std::size_t room = plans_.empty() ? first_limit : limit;
    if (nals_[i].size() > room) {
      plan_fragments(nals_[i], room, limit);
      ++i;
      continue;
    }
    const std::uint32_t together = plan_aggregate(i, room);
    if (together == 1) {
      PayloadPlan plan;
      plan.fragment = nals_[i];
      plan.size = static_cast<std::uint32_t>(nals_[i].size());
      plans_.push_back(plan);
    }
    i += together;
  }
  return plans_;
}

/// Plans a STAP-A of as many NAL units from `first` on as fit and gives their number; 1 plans nothing.
std::uint32_t H264Packetizer::plan_aggregate(std::uint32_t first, std::size_t limit) {
  std::size_t size = 1;
  std::uint32_t count = 0;
  unsigned forbidden = 0;
  unsigned importance = 0;
  while (first + count < nals_.size()) {
    const ByteView nal = nals_[first + count];
    if (size + 2 + nal.size() > limit || nal.size() > kMaxNalInAggregate) break;
    size += 2 + nal.size();
    forbidden |= octet(nal, 0) & 0x80U;
    importance = std::max(importance, octet(nal, 0) & 0x60U);
    ++count;
  }
  if (count < 2) return 1;
  PayloadPlan plan;
  plan.prefix[0] = static_cast<std::byte>(forbidden | importance | kStapA);
  plan.prefix_size = 1;
  plan.first_nal = first;
  plan.nal_count = count;
  plan.size = static_cast<std::uint32_t>(size);
  plans_.push_back(plan);
  return count;
}

void H264Packetizer::plan_fragments(ByteView nal, std::size_t first_limit, std::size_t limit) {
  const unsigned head = octet(nal, 0);
  ByteView rest = nal.subspan(1);
  unsigned flags = kStart;
  std::size_t room = first_limit;
  while (!rest.empty()) {
    const std::size_t taken = std::min(rest.size(), room - 2);
    if (taken == rest.size()) flags |= kEnd;
    PayloadPlan plan;
    plan.prefix = {static_cast<std::byte>((head & 0xE0U) | kFuA),
                   static_cast<std::byte>(flags | (head & 0x1FU))};
    plan.prefix_size = 2;
    plan.fragment = rest.first(taken);
    plan.size = static_cast<std::uint32_t>(taken + 2);
    plans_.push_back(plan);
    rest = rest.subspan(taken);
    flags = 0;
    room = limit;
  }
}

void H264Packetizer::append(const PayloadPlan& payload, ByteBuffer& out) const {
  out.insert(out.end(), payload.prefix.begin(), payload.prefix.begin() + payload.prefix_size);
  ByteWriter writer(out);
  writer.write_bytes(payload.fragment);
  for (std::uint32_t i = 0; i < payload.nal_count; ++i) {
    const ByteView nal = nals_[payload.first_nal + i];
    writer.write(static_cast<std::uint16_t>(nal.size()));
    writer.write_bytes(nal);
  }
}

void H264Depacketizer::begin(ByteBuffer& out) {
  out_ = &out;
  has_idr_ = false;
  in_fragment_ = false;
  any_ = false;
}

Result<void> H264Depacketizer::add(ByteView payload) {
  AW_ASSERT(out_ != nullptr);
  if (payload.empty()) return WireError::kTruncated;
  const unsigned type = octet(payload, 0) & 0x1FU;
  if (type == kFuA) return add_fragment(payload);
  if (in_fragment_) return WireError::kMalformed;
  return type == kStapA ? add_aggregate(payload.subspan(1)) : add_nal(payload);
}

Result<void> H264Depacketizer::end() {
  if (in_fragment_) return WireError::kTruncated;
  if (!any_) return WireError::kMissingField;
  return {};
}

Result<void> H264Depacketizer::add_nal(ByteView nal) {
  if (nal.empty()) return WireError::kBadLength;
  const unsigned type = octet(nal, 0) & 0x1FU;
  if (type == 0 || type >= kStapA) return WireError::kBadType;
  has_idr_ |= type == static_cast<unsigned>(NalType::kIdr);
  any_ = true;
  append_start_code(*out_);
  out_->insert(out_->end(), nal.begin(), nal.end());
  return {};
}

Result<void> H264Depacketizer::add_aggregate(ByteView payload) {
  ByteReader reader(payload);
  if (payload.empty()) return WireError::kTruncated;
  while (reader.remaining() > 0) {
    const auto size = reader.read<std::uint16_t>();
    const ByteView nal = reader.read_bytes(size);
    if (!reader.ok()) return WireError::kTruncated;
    const auto added = add_nal(nal);
    if (added.has_error()) return added;
  }
  return {};
}

Result<void> H264Depacketizer::add_fragment(ByteView payload) {
  if (payload.size() < 3) return WireError::kTruncated;
  const unsigned flags = octet(payload, 1);
  const bool start = (flags & kStart) != 0;
  const bool end = (flags & kEnd) != 0;
  const unsigned type = flags & 0x1FU;
  const auto head = static_cast<std::byte>((octet(payload, 0) & 0xE0U) | type);
  if (type == 0 || type >= kStapA || (start && end)) return WireError::kBadType;
  if (start == in_fragment_ || (in_fragment_ && head != fragment_header_)) return WireError::kMalformed;
  if (start) {
    const auto added = add_nal({&head, 1});
    if (added.has_error()) return added;
    fragment_header_ = head;
  }
  out_->insert(out_->end(), payload.begin() + 2, payload.end());
  in_fragment_ = !end;
  return {};
}

}  // namespace atlaswire::proto
