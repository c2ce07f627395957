#include "codec/plain_meta.h"

#include "base/assert.h"

#include <zstd.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>

namespace atlaswire::codec {

namespace {

constexpr std::uint8_t kForm = 0xA1;  // "atlaswire meta", form 1
constexpr std::uint8_t kResetFlag = 1;
constexpr std::uint8_t kPackedFlag = 2;
constexpr int kZstdLevel = 1;
constexpr std::size_t kMinPackedBody = 64;  // below this zstd's frame header eats the gain

// Fewest octets an entry of each list takes: what bounds a list's count by the octets left.
constexpr std::size_t kMinRemoved = 1;
constexpr std::size_t kMinVertex = 4;
constexpr std::size_t kMinMoved = 5;
constexpr std::size_t kMinAdded = 8;

// The octet of an entry that says how its patch is drawn.
constexpr unsigned kAlphaShift = 2;
constexpr unsigned kDoubleSidedShift = 4;
constexpr unsigned kTransposedShift = 5;
constexpr std::uint8_t kUnusedBits = 0xC0;

std::uint32_t id_of(PatchId id) { return value(id); }
std::uint32_t id_of(const NewVertex& v) { return value(v.id); }
std::uint32_t id_of(const AddedPatch& p) { return value(p.id); }
std::uint32_t id_of(const MovedPatch& p) { return value(p.id); }

/// Calls `visit(entry, difference of its id)` in ascending order of ids; `order` is scratch.
template <class Entry, class Visit>
void visit_ascending(const std::vector<Entry>& list, std::vector<std::uint32_t>& order, Visit visit) {
  const auto less = [](const Entry& a, const Entry& b) { return id_of(a) < id_of(b); };
  std::uint64_t expected = 0;  // the smallest id that may come next
  const auto one = [&](const Entry& entry) {
    AW_ASSERT(id_of(entry) >= expected);
    visit(entry, id_of(entry) - expected);
    expected = std::uint64_t{id_of(entry)} + 1;
  };
  if (std::is_sorted(list.begin(), list.end(), less)) {
    std::for_each(list.begin(), list.end(), one);
    return;
  }
  order.resize(list.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return less(list[a], list[b]); });
  for (const std::uint32_t i : order) one(list[i]);
}

void write_block(ByteWriter& out, const Block& block) {
  out.write(static_cast<std::uint8_t>(block.width_log2 << 4U | block.height_log2));
  out.write_varint(block.x);
  out.write_varint(block.y);
}

std::uint8_t draw_octet(const AddedPatch& patch) {
  return static_cast<std::uint8_t>(patch.triangles | static_cast<unsigned>(patch.draw.alpha) << kAlphaShift |
                                   static_cast<unsigned>(patch.draw.double_sided) << kDoubleSidedShift |
                                   static_cast<unsigned>(patch.block.transposed) << kTransposedShift);
}

/// Reads one body; the first failure sticks.
class BodyReader {
 public:
  BodyReader(ByteView body, const MetaLimits& limits) : in_(body), limits_(limits) {}

  Result<MetaUpdate> read(bool reset) {
    update_.reset = reset;
    update_.frame = FrameId{in_.read<std::uint32_t>()};
    const bool complete = read_removed() && read_vertices() && read_added() && read_moved();
    if (!complete) return *error_;
    if (in_.remaining() != 0) return MetaError::kTrailingBytes;
    if (moves_what_changes()) return MetaError::kBadOrder;
    return std::move(update_);
  }

 private:
  bool fail(MetaError why) {
    if (!error_) error_ = in_.ok() ? why : MetaError::kTruncated;
    return false;
  }

  /// A list's length, believed only as far as the octets left can hold it.
  bool read_count(std::size_t min_entry, std::size_t& count) {
    const std::uint64_t raw = in_.read_varint();
    if (!in_.ok() || raw > in_.remaining() / min_entry) return fail(MetaError::kTruncated);
    count = static_cast<std::size_t>(raw);
    return true;
  }

  /// The next id of a strictly ascending list; `expected` is the smallest that may come.
  bool read_id(std::uint64_t& expected, std::uint32_t limit, std::uint32_t& id) {
    const std::uint64_t difference = in_.read_varint();
    if (!in_.ok() || difference >= limit || expected + difference >= limit) {
      return fail(MetaError::kIdOutOfRange);
    }
    id = static_cast<std::uint32_t>(expected + difference);
    expected = std::uint64_t{id} + 1;
    return true;
  }

  bool read_removed() {
    std::size_t count = 0;
    if (!read_count(kMinRemoved, count)) return false;
    update_.removed.resize(count);
    std::uint64_t expected = 0;
    for (PatchId& patch : update_.removed) {
      std::uint32_t id = 0;
      if (!read_id(expected, limits_.max_patches, id)) return false;
      patch = PatchId{id};
    }
    return true;
  }

  bool read_vertices() {
    std::size_t count = 0;
    if (!read_count(kMinVertex, count)) return false;
    update_.vertices.resize(count);
    std::uint64_t expected = 0;
    GridPosition previous{0};
    for (NewVertex& vertex : update_.vertices) {
      std::uint32_t id = 0;
      if (!read_id(expected, limits_.max_vertices, id)) return false;
      vertex.id = VertexId{id};
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t step = in_.read_signed_varint();
        const std::int64_t end = std::int64_t{1} << limits_.grid_bits;
        if (!in_.ok() || step <= -end || step >= end) return fail(MetaError::kBadPosition);
        const std::int64_t at = std::int64_t{previous[axis]} + step;
        if (at < 0 || at >= end) return fail(MetaError::kBadPosition);
        previous[axis] = static_cast<std::uint32_t>(at);
      }
      vertex.position = previous;
    }
    return true;
  }

  bool read_added() {
    std::size_t count = 0;
    if (!read_count(kMinAdded, count)) return false;
    update_.added.resize(count);
    std::uint64_t expected = 0;
    std::int64_t nearby = 0;  // the previous patch's first corner
    for (AddedPatch& patch : update_.added) {
      std::uint32_t id = 0;
      if (!read_id(expected, limits_.max_patches, id) || !read_draw(patch) || !read_block(patch.block) ||
          !read_corners(patch, nearby)) {
        return false;
      }
      patch.id = PatchId{id};
    }
    return true;
  }

  bool read_draw(AddedPatch& patch) {
    const auto octet = in_.read<std::uint8_t>();
    patch.triangles = octet & 3U;
    const unsigned alpha = octet >> kAlphaShift & 3U;
    if (!in_.ok() || (octet & kUnusedBits) != 0 || patch.triangles == 0 || alpha > 2) {
      return fail(MetaError::kBadPatch);
    }
    patch.draw.alpha = static_cast<PatchClass::Alpha>(alpha);
    patch.draw.double_sided = (octet >> kDoubleSidedShift & 1U) != 0;
    patch.block.transposed = (octet >> kTransposedShift & 1U) != 0;
    return true;
  }

  bool read_block(Block& block) {
    const auto sides = in_.read<std::uint8_t>();
    const std::uint64_t x = in_.read_varint();
    const std::uint64_t y = in_.read_varint();
    block.width_log2 = sides >> 4U;
    block.height_log2 = sides & 15U;
    if (!in_.ok() || block.width_log2 < block.height_log2 || x > 0xFFFF || y > 0xFFFF ||
        x + block.width() > limits_.atlas.width || y + block.height() > limits_.atlas.height) {
      return fail(MetaError::kBadBlock);
    }
    block.x = static_cast<std::uint16_t>(x);
    block.y = static_cast<std::uint16_t>(y);
    return true;
  }

  bool read_corners(AddedPatch& patch, std::int64_t& nearby) {
    std::int64_t previous = nearby;
    for (std::uint32_t corner = 0; corner < corner_count(patch.triangles); ++corner) {
      const std::int64_t step = in_.read_signed_varint();
      const std::int64_t limit = limits_.max_vertices;
      if (!in_.ok() || step <= -limit || step >= limit) return fail(MetaError::kIdOutOfRange);
      previous += step;
      if (previous < 0 || previous >= limit) return fail(MetaError::kIdOutOfRange);
      patch.corners[corner] = VertexId{static_cast<std::uint32_t>(previous)};
    }
    nearby = value(patch.corners[0]);
    return true;
  }

  bool read_moved() {
    std::size_t count = 0;
    if (!read_count(kMinMoved, count)) return false;
    update_.moved.resize(count);
    std::uint64_t expected = 0;
    for (MovedPatch& patch : update_.moved) {
      std::uint32_t id = 0;
      if (!read_id(expected, limits_.max_patches, id)) return false;
      patch.id = PatchId{id};
      const auto transposed = in_.read<std::uint8_t>();
      if (!in_.ok() || transposed > 1) return fail(MetaError::kBadBlock);
      patch.block.transposed = transposed != 0;
      if (!read_block(patch.block)) return false;
    }
    return true;
  }

  /// Does a moved patch stand among the removed or added? Each list ascends, so one walk tells.
  [[nodiscard]] bool moves_what_changes() const {
    auto removed = update_.removed.begin();
    auto added = update_.added.begin();
    for (const MovedPatch& patch : update_.moved) {
      while (removed != update_.removed.end() && *removed < patch.id) ++removed;
      while (added != update_.added.end() && added->id < patch.id) ++added;
      if (removed != update_.removed.end() && *removed == patch.id) return true;
      if (added != update_.added.end() && added->id == patch.id) return true;
    }
    return false;
  }

  ByteReader in_;
  const MetaLimits& limits_;
  MetaUpdate update_;
  std::optional<MetaError> error_;
};

}  // namespace

PlainMetaEncoder::PlainMetaEncoder() : zstd_(ZSTD_createCCtx()) { AW_ASSERT(zstd_ != nullptr); }

PlainMetaEncoder::~PlainMetaEncoder() { ZSTD_freeCCtx(zstd_); }

void PlainMetaEncoder::encode(const MetaUpdate& update, ByteBuffer& out) {
  write_body(update);
  AW_ASSERT(body_.size() <= kMaxPlainMetaBody);
  std::span<const std::byte> body = body_;
  std::uint8_t flags = update.reset ? kResetFlag : 0;
  if (body_.size() >= kMinPackedBody) {
    packed_.resize(ZSTD_compressBound(body_.size()));
    const std::size_t size =
        ZSTD_compressCCtx(zstd_, packed_.data(), packed_.size(), body_.data(), body_.size(), kZstdLevel);
    AW_ASSERT(ZSTD_isError(size) == 0U);
    if (size < body_.size()) {
      body = std::span(packed_).first(size);
      flags |= kPackedFlag;
    }
  }
  ByteWriter writer(out);
  writer.write(kForm);
  writer.write(flags);
  writer.write_bytes(body);
}

void PlainMetaEncoder::write_body(const MetaUpdate& update) {
  body_.clear();
  ByteWriter out(body_);
  out.write(value(update.frame));
  out.write_varint(update.removed.size());
  visit_ascending(update.removed, order_, [&](PatchId, std::uint64_t step) { out.write_varint(step); });

  out.write_varint(update.vertices.size());
  GridPosition previous{0};
  visit_ascending(update.vertices, order_, [&](const NewVertex& vertex, std::uint64_t step) {
    out.write_varint(step);
    for (int axis = 0; axis < 3; ++axis) {
      out.write_signed_varint(std::int64_t{vertex.position[axis]} - std::int64_t{previous[axis]});
    }
    previous = vertex.position;
  });

  out.write_varint(update.added.size());
  std::int64_t nearby = 0;
  visit_ascending(update.added, order_, [&](const AddedPatch& patch, std::uint64_t step) {
    AW_ASSERT(patch.triangles >= 1 && patch.triangles <= kMaxPatchTriangles);
    out.write_varint(step);
    out.write(draw_octet(patch));
    write_block(out, patch.block);
    for (std::uint32_t corner = 0; corner < corner_count(patch.triangles); ++corner) {
      out.write_signed_varint(std::int64_t{value(patch.corners[corner])} - nearby);
      nearby = value(patch.corners[corner]);
    }
    nearby = value(patch.corners[0]);
  });

  out.write_varint(update.moved.size());
  visit_ascending(update.moved, order_, [&](const MovedPatch& patch, std::uint64_t step) {
    out.write_varint(step);
    out.write(static_cast<std::uint8_t>(patch.block.transposed));
    write_block(out, patch.block);
  });
}

PlainMetaDecoder::PlainMetaDecoder(const MetaLimits& limits) : limits_(limits), zstd_(ZSTD_createDCtx()) {
  AW_ASSERT(zstd_ != nullptr);
  AW_ASSERT(limits.grid_bits <= 32);
}

PlainMetaDecoder::~PlainMetaDecoder() { ZSTD_freeDCtx(zstd_); }

Result<MetaUpdate> PlainMetaDecoder::decode(ByteView bytes) {
  ByteReader in(bytes);
  const auto form = in.read<std::uint8_t>();
  const auto flags = in.read<std::uint8_t>();
  if (!in.ok()) return MetaError::kTruncated;
  if (form != kForm || flags > (kResetFlag | kPackedFlag)) return MetaError::kBadVersion;
  ByteView body = in.read_bytes(in.remaining());
  if ((flags & kPackedFlag) != 0) {
    const Result<ByteView> unpacked = unpack(body);
    if (!unpacked) return unpacked.error();
    body = *unpacked;
  }
  if (body.size() > kMaxPlainMetaBody) return MetaError::kTooLarge;
  return BodyReader(body, limits_).read((flags & kResetFlag) != 0);
}

Result<ByteView> PlainMetaDecoder::unpack(ByteView packed) {
  const std::size_t frame = ZSTD_findFrameCompressedSize(packed.data(), packed.size());
  if (ZSTD_isError(frame) != 0U) return MetaError::kTruncated;
  if (frame != packed.size()) return MetaError::kTrailingBytes;
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN) return MetaError::kBadVersion;
  if (size > kMaxPlainMetaBody) return MetaError::kTooLarge;
  body_.resize(static_cast<std::size_t>(size));
  const std::size_t got =
      ZSTD_decompressDCtx(zstd_, body_.data(), body_.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0U || got != body_.size()) return MetaError::kTruncated;
  return ByteView(body_);
}

}  // namespace atlaswire::codec
