#include "bench/meta_recording.h"

#include "codec/plain_meta.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace atlaswire::bench {

namespace {

constexpr std::uint32_t kMagic = 0x41574D32;  // "AWM2"
constexpr std::uint8_t kHasCue = 1;
constexpr std::uint8_t kCueResets = 2;

void write_triple(ByteWriter& out, const glm::dvec3& v) {
  for (int axis = 0; axis < 3; ++axis) out.write(v[axis]);
}
glm::dvec3 read_triple(ByteReader& in) {
  glm::dvec3 v{};
  for (int axis = 0; axis < 3; ++axis) v[axis] = in.read<double>();
  return v;
}

void write_limits(const MetaRecording& recording, ByteWriter& out) {
  const codec::MetaLimits& limits = recording.limits;
  for (const std::uint32_t field :
       {limits.max_vertices, limits.max_patches, limits.grid_bits, limits.atlas.width, limits.atlas.height,
        recording.memory.superblock_log2, recording.memory.min_block_log2}) {
    out.write(field);
  }
  out.write(recording.memory.high_water);
}
bool read_limits(ByteReader& in, MetaRecording& recording) {
  codec::MetaLimits& limits = recording.limits;
  for (std::uint32_t* field :
       {&limits.max_vertices, &limits.max_patches, &limits.grid_bits, &limits.atlas.width,
        &limits.atlas.height, &recording.memory.superblock_log2, &recording.memory.min_block_log2}) {
    *field = in.read<std::uint32_t>();
  }
  recording.memory.high_water = in.read<double>();
  return in.ok() && limits.grid_bits <= 20;
}

void write_movers(const std::optional<RecordedMotion>& motion, ByteWriter& out) {
  out.write(static_cast<std::uint32_t>(motion ? motion->movers.size() : 0));
  if (!motion) return;
  for (const Mover& mover : motion->movers) {
    out.write(mover.first_patch);
    out.write(mover.patch_count);
    out.write(static_cast<std::uint8_t>(mover.deforms));
    out.write(mover.object);
  }
  write_triple(out, motion->settings.grid.origin);
  out.write(motion->settings.grid.step);
  out.write(motion->settings.grid.bits);
  out.write(motion->settings.transforms.step);
  out.write(motion->settings.transforms.rotation_bits);
}
bool read_movers(ByteReader& in, std::optional<RecordedMotion>& motion) {
  const auto count = in.read<std::uint32_t>();
  if (count == 0 || count > kMostMovers) return in.ok() && count == 0;
  motion.emplace();
  for (std::uint32_t i = 0; i < count; ++i) {
    Mover& mover = motion->movers.emplace_back();
    mover.first_patch = in.read<std::uint32_t>();
    mover.patch_count = in.read<std::uint32_t>();
    mover.deforms = in.read<std::uint8_t>() != 0;
    mover.object = in.read<std::uint32_t>();
  }
  motion->settings.grid.origin = read_triple(in);
  motion->settings.grid.step = in.read<double>();
  motion->settings.grid.bits = in.read<std::uint32_t>();
  motion->settings.transforms.step = in.read<double>();
  motion->settings.transforms.rotation_bits = in.read<std::uint32_t>();
  return in.ok() && motion->settings.grid.bits <= 20 && motion->settings.transforms.rotation_bits <= 20;
}

void write_places(const MoverPlaces& places, ByteWriter& out) {
  out.write(static_cast<std::uint32_t>(places.positions.size()));
  for (const glm::dvec3& position : places.positions) write_triple(out, position);
  out.write(static_cast<std::uint32_t>(places.transforms.size()));
  for (const codec::RigidTransform& t : places.transforms) {
    write_triple(out, t.translation);
    for (const double member : {t.orientation.x, t.orientation.y, t.orientation.z, t.orientation.w})
      out.write(member);
  }
}
/// A count of things of so many octets each, of which there can be no more than octets are left.
std::uint32_t read_count(ByteReader& in, std::size_t octets) {
  return static_cast<std::uint32_t>(
      std::min<std::size_t>(in.read<std::uint32_t>(), in.remaining() / octets + 1));
}
MoverPlaces read_places(ByteReader& in) {
  MoverPlaces places;
  places.positions.resize(read_count(in, 24));
  for (glm::dvec3& position : places.positions) position = read_triple(in);
  places.transforms.resize(read_count(in, 56));
  for (codec::RigidTransform& t : places.transforms) {
    t.translation = read_triple(in);
    for (double* member : {&t.orientation.x, &t.orientation.y, &t.orientation.z, &t.orientation.w})
      *member = in.read<double>();
  }
  return places;
}

void write_cue(const std::optional<codec::LayoutCue>& cue, ByteWriter& out) {
  out.write(static_cast<std::uint8_t>(cue ? kHasCue | (cue->reset ? kCueResets : 0) : 0));
  out.write(cue ? cue->check : std::uint16_t{0});
}
std::optional<codec::LayoutCue> read_cue(ByteReader& in) {
  const auto flags = in.read<std::uint8_t>();
  const codec::LayoutCue cue{.reset = (flags & kCueResets) != 0, .check = in.read<std::uint16_t>()};
  return (flags & kHasCue) != 0 ? std::optional(cue) : std::nullopt;
}

}  // namespace

void write_recording(const MetaRecording& recording, const std::filesystem::path& file) {
  ByteBuffer out;
  ByteWriter writer(out);
  writer.write(kMagic);
  write_limits(recording, writer);
  write_movers(recording.motion, writer);
  writer.write(static_cast<std::uint32_t>(recording.updates.size()));
  codec::PlainMetaEncoder encoder;
  ByteBuffer bytes;
  for (std::size_t frame = 0; frame < recording.updates.size(); ++frame) {
    bytes.clear();
    encoder.encode(recording.updates[frame], bytes);
    write_cue(recording.updates[frame].cue, writer);
    writer.write(static_cast<std::uint32_t>(bytes.size()));
    writer.write_bytes(bytes);
    if (recording.motion) write_places(recording.motion->frames.at(frame), writer);
  }
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(out.data()), static_cast<std::streamsize>(out.size()));
}

Result<MetaRecording> read_recording(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> raw{std::istreambuf_iterator<char>(in), {}};
  ByteReader reader(std::as_bytes(std::span(raw)));
  MetaRecording recording;
  if (reader.read<std::uint32_t>() != kMagic || !read_limits(reader, recording) ||
      !read_movers(reader, recording.motion)) {
    return Error{codec::MetaError::kBadVersion, file.string()};
  }
  codec::PlainMetaDecoder decoder(recording.limits);
  for (auto left = reader.read<std::uint32_t>(); left != 0; --left) {
    const auto cue = read_cue(reader);
    auto update = decoder.decode(reader.read_bytes(reader.read<std::uint32_t>()));
    if (!update) return Error{update.error().code, file.string()};
    update->cue = cue;
    recording.updates.push_back(std::move(*update));
    if (recording.motion) recording.motion->frames.push_back(read_places(reader));
  }
  if (!reader.finished()) {
    return Error{reader.ok() ? codec::MetaError::kTrailingBytes : codec::MetaError::kTruncated,
                 file.string()};
  }
  return recording;
}

}  // namespace atlaswire::bench
