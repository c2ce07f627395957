#include "codec/paper_meta.h"

#include "base/assert.h"
#include "codec/bit_io.h"
#include "codec/golomb_column.h"
#include "codec/octree.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace atlaswire::codec {

namespace {

constexpr std::uint8_t kForm = 0xB1;       // "atlaswire meta", the paper's form
constexpr std::uint8_t kResetForm = 0xB2;  // the same, everything forgotten first
constexpr std::uint32_t kMostRaw = 30;     // new vertices that are sent raw
constexpr std::uint32_t kCountOrder = 5;

// Fewest bits an entry of each list takes: what bounds a list's count by the bits left.
constexpr std::uint32_t kMinRemoved = 1;
constexpr std::uint32_t kMinVertex = 2;
constexpr std::uint32_t kMinAdded = 10;
constexpr std::uint32_t kMinMoved = 6;

std::uint32_t class_number(const AddedPatch& patch) {
  return static_cast<std::uint32_t>(patch.triangles) * 6 + static_cast<std::uint32_t>(patch.draw.alpha) * 2 +
         static_cast<std::uint32_t>(patch.draw.double_sided);
}

std::int32_t difference(std::uint32_t a, std::uint32_t b) { return static_cast<std::int32_t>(a - b); }

/// A list by ascending ids.
template <class Entry, class IdOf>
std::vector<const Entry*> ascending(const std::vector<Entry>& list, IdOf id_of) {
  std::vector<const Entry*> order;
  order.reserve(list.size());
  for (const Entry& entry : list) order.push_back(&entry);
  std::ranges::sort(order, {}, [&](const Entry* entry) { return id_of(*entry); });
  return order;
}

void write_blocks(const std::vector<const Block*>& blocks, BitWriter& out) {
  const auto column = [&](auto number_of) {
    GolombColumn numbers;
    std::uint32_t before = 0;
    for (const Block* block : blocks) {
      numbers.add_signed(difference(number_of(*block), before));
      before = number_of(*block);
    }
    numbers.write(out);
  };
  column([](const Block& b) { return std::uint32_t{b.width_log2}; });
  column([](const Block& b) { return std::uint32_t{b.height_log2}; });
  column([](const Block& b) { return std::uint32_t{b.x}; });
  column([](const Block& b) { return std::uint32_t{b.y}; });
  for (const Block* block : blocks) out.write(block->transposed ? 1 : 0, 1);
}

void write_removed(const std::vector<PatchId>& removed, BitWriter& out) {
  out.write_golomb(static_cast<std::uint32_t>(removed.size()), kCountOrder);
  GolombIds ids;
  for (const PatchId* id : ascending(removed, [](PatchId p) { return value(p); })) ids.add(value(*id));
  ids.write(out);
}

void write_vertices(const std::vector<NewVertex>& vertices, std::uint32_t grid_bits, BitWriter& out) {
  out.write_golomb(static_cast<std::uint32_t>(vertices.size()), kCountOrder);
  auto order = ascending(vertices, [](const NewVertex& v) { return value(v.id); });
  if (vertices.size() <= kMostRaw) {
    GolombIds ids;
    for (const NewVertex* v : order) ids.add(value(v->id));
    ids.write(out);
    for (const NewVertex* v : order) {
      for (int axis = 0; axis < 3; ++axis) out.write(v->position[axis], grid_bits);
    }
    return;
  }
  std::ranges::stable_sort(order, {}, [](const NewVertex* v) { return octree_order(v->position); });
  GolombColumn ids;
  std::uint32_t before = 0;
  std::vector<GridPosition> points;
  for (const NewVertex* v : order) {
    ids.add_signed(difference(value(v->id), before));
    before = value(v->id);
    points.push_back(v->position);
  }
  ids.write(out);
  write_octree(points, grid_bits, out);
}

void write_added(const std::vector<AddedPatch>& added, BitWriter& out) {
  out.write_golomb(static_cast<std::uint32_t>(added.size()), kCountOrder);
  GolombIds ids;
  GolombColumn classes;
  GolombColumn first_corners;
  GolombColumn other_corners;
  std::vector<const Block*> blocks;
  std::uint32_t class_before = 0;
  std::uint32_t first_before = 0;
  for (const AddedPatch* patch : ascending(added, [](const AddedPatch& p) { return value(p.id); })) {
    ids.add(value(patch->id));
    classes.add_signed(difference(class_number(*patch), class_before));
    class_before = class_number(*patch);
    first_corners.add_signed(difference(value(patch->corners[0]), first_before));
    first_before = value(patch->corners[0]);
    for (std::uint32_t c = 1; c < corner_count(patch->triangles); ++c) {
      other_corners.add_signed(difference(value(patch->corners[c]), value(patch->corners[c - 1])));
    }
    blocks.push_back(&patch->block);
  }
  ids.write(out);
  classes.write(out);
  first_corners.write(out);
  other_corners.write(out);
  write_blocks(blocks, out);
}

void write_moved(const std::vector<MovedPatch>& moved, BitWriter& out) {
  out.write_golomb(static_cast<std::uint32_t>(moved.size()), kCountOrder);
  GolombIds ids;
  std::vector<const Block*> blocks;
  for (const MovedPatch* patch : ascending(moved, [](const MovedPatch& p) { return value(p.id); })) {
    ids.add(value(patch->id));
    blocks.push_back(&patch->block);
  }
  ids.write(out);
  write_blocks(blocks, out);
}

/// Reads the body of an update, and stops at the first nonsense.
class Reader {
 public:
  Reader(ByteView bytes, const MetaLimits& limits) : in_(bytes), limits_(&limits) {}

  std::optional<MetaError> read(MetaUpdate& update) {
    update.frame = FrameId{in_.read(32)};
    if (read_removed(update.removed) && read_vertices(update.vertices) && read_added(update.added) &&
        read_moved(update.moved) && !in_.finished()) {
      fail(MetaError::kTrailingBytes);
    }
    return error_;
  }

 private:
  bool fail(MetaError why) {
    error_ = in_.ok() ? why : MetaError::kTruncated;
    return false;
  }
  bool whole() { return in_.ok() || fail(MetaError::kTruncated); }

  bool read_count(std::uint32_t least_bits, std::uint32_t& count) {
    count = in_.read_golomb(kCountOrder);
    if (!in_.ok() || std::uint64_t{count} * least_bits > in_.bits_left()) {
      error_ = MetaError::kTruncated;
      return false;
    }
    return true;
  }
  /// Numbers of one attribute, each to `take`, which says whether to go on.
  template <class Take>
  bool read_column(std::uint32_t count, Take take) {
    if (count == 0) return true;
    const std::uint32_t order = in_.read(kColumnOrderBits);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t number = in_.read_golomb(order);
      if (!whole() || !take(i, number)) return false;
    }
    return true;
  }
  template <class Take>
  bool read_ids(std::uint32_t count, std::uint32_t most, Take take) {
    std::uint64_t expected = 0;
    return read_column(count, [&](std::uint32_t i, std::uint32_t number) {
      const std::uint64_t id = expected + number;
      if (id >= most) return fail(MetaError::kIdOutOfRange);
      expected = id + 1;
      take(i, static_cast<std::uint32_t>(id));
      return true;
    });
  }
  /// Each number as the sum of the differences so far; `take` gets what was modulo 2^32.
  template <class Take>
  bool read_sums(std::uint32_t count, Take take) {
    std::uint32_t sum = 0;
    return read_column(count, [&](std::uint32_t i, std::uint32_t number) {
      sum += static_cast<std::uint32_t>(unzigzag(number));
      return take(i, sum);
    });
  }

  bool read_removed(std::vector<PatchId>& removed) {
    std::uint32_t count = 0;
    if (!read_count(kMinRemoved, count)) return false;
    return read_ids(count, limits_->max_patches,
                    [&](std::uint32_t, std::uint32_t id) { removed.push_back(PatchId{id}); });
  }

  bool read_vertices(std::vector<NewVertex>& vertices) {
    std::uint32_t count = 0;
    if (!read_count(kMinVertex, count)) return false;
    if (count > limits_->max_vertices) return fail(MetaError::kIdOutOfRange);
    vertices.resize(count);
    return count <= kMostRaw ? read_raw(vertices) : read_tree(vertices);
  }
  bool read_raw(std::vector<NewVertex>& vertices) {
    const auto count = static_cast<std::uint32_t>(vertices.size());
    if (!read_ids(count, limits_->max_vertices,
                  [&](std::uint32_t i, std::uint32_t id) { vertices[i].id = VertexId{id}; })) {
      return false;
    }
    for (NewVertex& vertex : vertices) {
      for (int axis = 0; axis < 3; ++axis) vertex.position[axis] = in_.read(limits_->grid_bits);
    }
    return whole();
  }
  bool read_tree(std::vector<NewVertex>& vertices) {
    const auto count = static_cast<std::uint32_t>(vertices.size());
    std::vector<std::uint32_t> ids(count);
    if (!read_sums(count, [&](std::uint32_t i, std::uint32_t id) {
          if (id >= limits_->max_vertices) return fail(MetaError::kIdOutOfRange);
          vertices[i].id = VertexId{id};
          ids[i] = id;
          return true;
        })) {
      return false;
    }
    std::ranges::sort(ids);
    if (std::ranges::adjacent_find(ids) != ids.end()) return fail(MetaError::kBadOrder);
    const auto points = read_octree(in_, count, limits_->grid_bits);
    if (!points) return fail(MetaError::kBadPosition);
    for (std::uint32_t i = 0; i < count; ++i) vertices[i].position = (*points)[i];
    return true;
  }

  bool read_added(std::vector<AddedPatch>& added) {
    std::uint32_t count = 0;
    if (!read_count(kMinAdded, count)) return false;
    if (count > limits_->max_patches) return fail(MetaError::kIdOutOfRange);
    added.resize(count);
    return read_ids(count, limits_->max_patches,
                    [&](std::uint32_t i, std::uint32_t id) { added[i].id = PatchId{id}; }) &&
           read_sums(count,
                     [&](std::uint32_t i, std::uint32_t number) { return take_class(number, added[i]); }) &&
           read_corners(added) && read_blocks(added);
  }
  bool take_class(std::uint32_t number, AddedPatch& patch) {
    if (number < 6 || number >= 24) return fail(MetaError::kBadPatch);
    patch.triangles = static_cast<std::uint8_t>(number / 6);
    patch.draw.alpha = static_cast<PatchClass::Alpha>(number / 2 % 3);
    patch.draw.double_sided = number % 2 != 0;
    return true;
  }
  bool read_corners(std::vector<AddedPatch>& added) {
    const auto count = static_cast<std::uint32_t>(added.size());
    const auto take = [&](VertexId& corner, std::uint32_t vertex) {
      if (vertex >= limits_->max_vertices) return fail(MetaError::kIdOutOfRange);
      corner = VertexId{vertex};
      return true;
    };
    if (!read_sums(count, [&](std::uint32_t i, std::uint32_t v) { return take(added[i].corners[0], v); })) {
      return false;
    }
    std::uint32_t others = 0;
    for (const AddedPatch& patch : added) others += corner_count(patch.triangles) - 1;
    std::size_t at = 0;
    std::uint32_t corner = 0;
    return read_column(others, [&](std::uint32_t, std::uint32_t number) {
      if (corner + 1 == corner_count(added[at].triangles)) {
        ++at;
        corner = 0;
      }
      ++corner;
      auto& corners = added[at].corners;
      return take(corners[corner], value(corners[corner - 1]) + static_cast<std::uint32_t>(unzigzag(number)));
    });
  }

  template <class Entry>
  bool read_blocks(std::vector<Entry>& list) {
    const auto count = static_cast<std::uint32_t>(list.size());
    const auto column = [&](std::uint32_t most, auto set) {
      return read_sums(count, [&](std::uint32_t i, std::uint32_t number) {
        if (number > most) return fail(MetaError::kBadBlock);
        set(list[i].block, number);
        return true;
      });
    };
    const auto octet = [](std::uint32_t number) { return static_cast<std::uint8_t>(number); };
    const auto texel = [](std::uint32_t number) { return static_cast<std::uint16_t>(number); };
    if (!(column(15, [&](Block& b, std::uint32_t n) { b.width_log2 = octet(n); }) &&
          column(15, [&](Block& b, std::uint32_t n) { b.height_log2 = octet(n); }) &&
          column(0xFFFF, [&](Block& b, std::uint32_t n) { b.x = texel(n); }) &&
          column(0xFFFF, [&](Block& b, std::uint32_t n) { b.y = texel(n); }))) {
      return false;
    }
    for (Entry& entry : list) {
      Block& b = entry.block;
      b.transposed = in_.read(1) != 0;
      if (b.height_log2 > b.width_log2 || b.x + b.width() > limits_->atlas.width ||
          b.y + b.height() > limits_->atlas.height) {
        return fail(MetaError::kBadBlock);
      }
    }
    return whole();
  }

  bool read_moved(std::vector<MovedPatch>& moved) {
    std::uint32_t count = 0;
    if (!read_count(kMinMoved, count)) return false;
    if (count > limits_->max_patches) return fail(MetaError::kIdOutOfRange);
    moved.resize(count);
    return read_ids(count, limits_->max_patches,
                    [&](std::uint32_t i, std::uint32_t id) { moved[i].id = PatchId{id}; }) &&
           read_blocks(moved);
  }

  BitReader in_;
  const MetaLimits* limits_;
  std::optional<MetaError> error_;
};

/// Whether a moved patch is also removed or added; all lists ascend.
bool contradicts(const MetaUpdate& update) {
  return std::ranges::any_of(update.moved, [&](const MovedPatch& moved) {
    const auto added = std::ranges::lower_bound(update.added, moved.id, {}, &AddedPatch::id);
    return std::ranges::binary_search(update.removed, moved.id) ||
           (added != update.added.end() && added->id == moved.id);
  });
}

}  // namespace

void PaperMetaEncoder::encode(const MetaUpdate& update, ByteBuffer& out) {
  out.push_back(static_cast<std::byte>(update.reset ? kResetForm : kForm));
  BitWriter writer(out);
  writer.write(value(update.frame), 32);
  write_removed(update.removed, writer);
  write_vertices(update.vertices, limits_.grid_bits, writer);
  write_added(update.added, writer);
  write_moved(update.moved, writer);
  writer.finish();
}

PaperMetaDecoder::PaperMetaDecoder(const MetaLimits& limits) : limits_(limits) {
  AW_ASSERT(limits.grid_bits <= 20);
}

Result<MetaUpdate> PaperMetaDecoder::decode(ByteView bytes) {
  if (bytes.empty()) return MetaError::kTruncated;
  if (bytes.size() > kMaxMetaBody) return MetaError::kTooLarge;
  const auto form = std::to_integer<std::uint8_t>(bytes[0]);
  if (form != kForm && form != kResetForm) return MetaError::kBadVersion;
  MetaUpdate update;
  update.reset = form == kResetForm;
  if (const auto error = Reader(bytes.subspan(1), limits_).read(update)) return *error;
  if (contradicts(update)) return MetaError::kBadOrder;
  return update;
}

}  // namespace atlaswire::codec
