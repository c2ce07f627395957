#include "bench/meta_recording.h"

#include "codec/plain_meta.h"

#include <fstream>
#include <iterator>

namespace atlaswire::bench {

void write_recording(const MetaRecording& recording, const std::filesystem::path& file) {
  ByteBuffer out;
  ByteWriter writer(out);
  const codec::MetaLimits& limits = recording.limits;
  for (const std::uint32_t field :
       {limits.max_vertices, limits.max_patches, limits.grid_bits, limits.atlas.width, limits.atlas.height}) {
    writer.write(field);
  }
  codec::PlainMetaEncoder encoder;
  ByteBuffer bytes;
  for (const codec::MetaUpdate& update : recording.updates) {
    bytes.clear();
    encoder.encode(update, bytes);
    writer.write(static_cast<std::uint32_t>(bytes.size()));
    writer.write_bytes(bytes);
  }
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(out.data()), static_cast<std::streamsize>(out.size()));
}

Result<MetaRecording> read_recording(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> raw{std::istreambuf_iterator<char>(in), {}};
  ByteReader reader(std::as_bytes(std::span(raw)));
  MetaRecording recording;
  codec::MetaLimits& limits = recording.limits;
  for (std::uint32_t* field : {&limits.max_vertices, &limits.max_patches, &limits.grid_bits,
                               &limits.atlas.width, &limits.atlas.height}) {
    *field = reader.read<std::uint32_t>();
  }
  if (!reader.ok() || limits.grid_bits > 20) return Error{codec::MetaError::kBadVersion, file.string()};
  codec::PlainMetaDecoder decoder(limits);
  while (reader.remaining() != 0) {
    auto update = decoder.decode(reader.read_bytes(reader.read<std::uint32_t>()));
    if (!update) return Error{update.error().code, file.string()};
    recording.updates.push_back(std::move(*update));
  }
  return recording;
}

}  // namespace atlaswire::bench
