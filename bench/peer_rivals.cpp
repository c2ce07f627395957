// Naive structs, Draco, meshoptimizer: what ours is held against.
#include "bench/codec_rival.h"
#include "bench/peer_motion.h"
#include "bench/side_columns.h"
#include "bench/update_check.h"
#include "bench/zstd_stream.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <array>
#include <stdexcept>

namespace atlaswire::bench {

namespace {

void demand(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

/// A codec that knows of no patches.
class PeerRival : public CodecRival {
 public:
  void encode(const Increment& increment) final {
    told_ = &increment;
    tell(increment);
  }
  [[nodiscard]] const codec::MetaUpdate& heard() const final { return *told_->update; }

 protected:
  virtual void tell(const Increment& increment) = 0;
  void demand_triangles(const std::vector<GridPosition>& positions,
                        const std::vector<std::uint32_t>& indices) const {
    demand(indices.size() == told_->indices.size() &&
               triangle_set_hash(positions, indices) == triangle_set_hash(told_->positions, told_->indices),
           "other triangles were decoded");
  }

 private:
  const Increment* told_ = nullptr;
};

class NaiveRival final : public PeerRival {
 public:
  [[nodiscard]] std::string name() const override { return "naive structs"; }
  void tell(const Increment& increment) override {
    mesh_.clear();
    blocks_.clear();
    const codec::MetaUpdate& update = *increment.update;
    ByteWriter mesh(mesh_);
    ByteWriter blocks(blocks_);
    for (const PatchId id : update.removed) mesh.write(value(id));
    for (const codec::NewVertex& v : update.vertices) {
      mesh.write(value(v.id));
      for (int axis = 0; axis < 3; ++axis) mesh.write(static_cast<float>(v.position[axis]));
    }
    for (const codec::AddedPatch& patch : update.added) {
      mesh.write(value(patch.id));
      mesh.write(patch.triangles);
      for (std::uint32_t c = 0; c < corner_count(patch.triangles); ++c) mesh.write(value(patch.corners[c]));
      blocks.write(static_cast<std::uint8_t>(patch.draw.alpha));
      write_block(blocks, patch.block);
    }
    for (const codec::MovedPatch& patch : update.moved) {
      blocks.write(value(patch.id));
      write_block(blocks, patch.block);
    }
  }
  [[nodiscard]] UpdateCost cost() const override { return {mesh_.size(), blocks_.size()}; }
  void decode() override {
    copy_ = mesh_;
    copy_.insert(copy_.end(), blocks_.begin(), blocks_.end());
  }
  void check() override { demand(copy_.size() == mesh_.size() + blocks_.size(), "naive structs differ"); }
  [[nodiscard]] MotionRivals motions(const RecordedMotion&) const override {
    MotionRivals rivals;
    rivals.push_back(make_naive_motion());
    return rivals;
  }

 private:
  static void write_block(ByteWriter& out, const Block& block) {
    out.write(block.x);
    out.write(block.y);
    out.write(block.width_log2);
    out.write(block.height_log2);
  }
  ByteBuffer mesh_;
  ByteBuffer blocks_;
  ByteBuffer copy_;
};

/// A message through zstd, both ways.
class Column {
 public:
  ByteBuffer& begin() {
    plain_.clear();
    return plain_;
  }
  void encode() {
    const ByteView packed = encoder_.encode(plain_);
    packed_.assign(packed.begin(), packed.end());
  }
  ByteView decode() { return decoder_.decode(packed_, plain_.size()); }
  [[nodiscard]] std::size_t size() const { return packed_.size(); }

 private:
  ByteBuffer plain_;
  ByteBuffer packed_;
  ZstdStreamEncoder encoder_;
  ZstdStreamDecoder decoder_;
};

void encode_draco(const std::vector<GridPosition>& positions, const std::vector<std::uint32_t>& indices,
                  draco::EncoderBuffer& out) {
  draco::Mesh mesh;
  const auto points = static_cast<std::uint32_t>(positions.size());
  const auto faces = static_cast<std::uint32_t>(indices.size() / 3);
  mesh.set_num_points(points);
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false, 12, 0);
  const int number = mesh.AddAttribute(attribute, true, points);
  for (std::uint32_t i = 0; i < points; ++i) {
    const std::array<std::int32_t, 3> at{static_cast<std::int32_t>(positions[i].x),
                                         static_cast<std::int32_t>(positions[i].y),
                                         static_cast<std::int32_t>(positions[i].z)};
    mesh.attribute(number)->SetAttributeValue(draco::AttributeValueIndex(i), at.data());
  }
  mesh.SetNumFaces(faces);
  for (std::uint32_t f = 0; f < faces; ++f) {
    draco::Mesh::Face face;
    for (std::uint32_t c = 0; c < 3; ++c) face[c] = draco::PointIndex(indices[3 * std::size_t{f} + c]);
    mesh.SetFace(draco::FaceIndex(f), face);
  }
  draco::Encoder encoder;
  encoder.SetSpeedOptions(0, 0);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  demand(encoder.EncodeMeshToBuffer(mesh, &out).ok(), "Draco would not encode");
}

class DracoRival final : public PeerRival {
 public:
  [[nodiscard]] std::string name() const override { return "Draco"; }
  void tell(const Increment& increment) override {
    mesh_.Clear();
    if (!increment.indices.empty()) encode_draco(increment.positions, increment.indices, mesh_);
    write_removals(increment, removals_.begin());
    removals_.encode();
    write_blocks(increment, blocks_.begin());
    blocks_.encode();
  }
  [[nodiscard]] UpdateCost cost() const override { return {mesh_.size() + removals_.size(), blocks_.size()}; }
  void decode() override {
    removals_.decode();
    blocks_.decode();
    decoded_.reset();
    if (mesh_.size() == 0) return;
    draco::DecoderBuffer bytes;
    bytes.Init(mesh_.data(), mesh_.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&bytes);
    demand(decoded.ok(), "Draco would not decode");
    decoded_ = std::move(decoded).value();
  }
  void check() override {
    std::vector<GridPosition> positions;
    std::vector<std::uint32_t> indices;
    if (decoded_) take_out(*decoded_, positions, indices);
    demand_triangles(positions, indices);
  }
  [[nodiscard]] MotionRivals motions(const RecordedMotion&) const override {
    MotionRivals rivals;
    for (const int order : {0, 1, 2}) rivals.push_back(make_peer_motion(MotionPacking::kDraco, order));
    return rivals;
  }

 private:
  static void take_out(const draco::Mesh& mesh, std::vector<GridPosition>& positions,
                       std::vector<std::uint32_t>& indices) {
    const draco::PointAttribute* attribute = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
      std::array<std::int32_t, 3> at{};
      attribute->GetValue(attribute->mapped_index(draco::PointIndex(i)), at.data());
      positions.emplace_back(at[0], at[1], at[2]);
    }
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
      for (std::uint32_t c = 0; c < 3; ++c) indices.push_back(mesh.face(draco::FaceIndex(f))[c].value());
    }
  }

  draco::EncoderBuffer mesh_;
  std::unique_ptr<draco::Mesh> decoded_;
  Column removals_;
  Column blocks_;
};

class MeshoptRival final : public PeerRival {
 public:
  [[nodiscard]] std::string name() const override { return "meshoptimizer + zstd"; }
  void tell(const Increment& increment) override {
    ByteBuffer& mesh = mesh_.begin();
    write_removals(increment, mesh);
    removals_size_ = mesh.size();
    arrange(increment);
    append_indices(mesh);
    indices_size_ = mesh.size() - removals_size_;
    append_vertices(mesh);
    mesh_.encode();
    write_blocks(increment, blocks_.begin());
    blocks_.encode();
  }
  [[nodiscard]] UpdateCost cost() const override { return {mesh_.size(), blocks_.size()}; }
  void decode() override {
    const ByteView mesh = mesh_.decode();
    blocks_.decode();
    const ByteView indices = mesh.subspan(removals_size_, indices_size_);
    const ByteView vertices = mesh.subspan(removals_size_ + indices_size_);
    const auto octets = [](ByteView v) { return reinterpret_cast<const unsigned char*>(v.data()); };
    if (indices_.empty()) return;
    demand(meshopt_decodeIndexBuffer(decoded_indices_.data(), indices_.size(), 4, octets(indices),
                                     indices.size()) == 0 &&
               meshopt_decodeVertexBuffer(decoded_vertices_.data(), vertices_.size(), sizeof(Vertex),
                                          octets(vertices), vertices.size()) == 0,
           "meshoptimizer would not decode");
  }
  void check() override {
    std::vector<GridPosition> positions;
    for (const Vertex& v : decoded_vertices_) positions.emplace_back(v[0], v[1], v[2]);
    demand_triangles(positions, indices_.empty() ? indices_ : decoded_indices_);
  }
  [[nodiscard]] MotionRivals motions(const RecordedMotion&) const override {
    MotionRivals rivals;
    for (const int order : {1, 2}) rivals.push_back(make_peer_motion(MotionPacking::kMeshopt, order));
    return rivals;
  }

 private:
  using Vertex = std::array<std::uint32_t, 3>;

  /// Triangles in strip order, vertices in order of first use: what its manual asks for.
  void arrange(const Increment& increment) {
    indices_.resize(increment.indices.size());
    vertices_.resize(increment.positions.size());
    if (indices_.empty()) return;
    std::vector<Vertex> unordered;
    for (const GridPosition& at : increment.positions) unordered.push_back({at.x, at.y, at.z});
    meshopt_optimizeVertexCacheStrip(indices_.data(), increment.indices.data(), indices_.size(),
                                     vertices_.size());
    vertices_.resize(meshopt_optimizeVertexFetch(vertices_.data(), indices_.data(), indices_.size(),
                                                 unordered.data(), unordered.size(), sizeof(Vertex)));
    decoded_indices_.resize(indices_.size());
    decoded_vertices_.resize(vertices_.size());
  }
  template <class Encode>
  static void append(ByteBuffer& out, std::size_t bound, Encode encode) {
    const std::size_t before = out.size();
    out.resize(before + bound);
    out.resize(before + encode(reinterpret_cast<unsigned char*>(out.data() + before)));
  }
  void append_indices(ByteBuffer& out) {
    if (indices_.empty()) return;
    meshopt_encodeIndexVersion(1);
    const std::size_t bound = meshopt_encodeIndexBufferBound(indices_.size(), vertices_.size());
    append(out, bound, [&](unsigned char* to) {
      return meshopt_encodeIndexBuffer(to, bound, indices_.data(), indices_.size());
    });
  }
  void append_vertices(ByteBuffer& out) {
    if (indices_.empty()) return;
    const std::size_t bound = meshopt_encodeVertexBufferBound(vertices_.size(), sizeof(Vertex));
    append(out, bound, [&](unsigned char* to) {
      return meshopt_encodeVertexBuffer(to, bound, vertices_.data(), vertices_.size(), sizeof(Vertex));
    });
  }

  Column mesh_;
  Column blocks_;
  std::size_t removals_size_ = 0;
  std::size_t indices_size_ = 0;
  std::vector<std::uint32_t> indices_;
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> decoded_indices_;
  std::vector<Vertex> decoded_vertices_;
};

}  // namespace

std::unique_ptr<CodecRival> make_naive_rival() { return std::make_unique<NaiveRival>(); }
std::unique_ptr<CodecRival> make_draco_rival() { return std::make_unique<DracoRival>(); }
std::unique_ptr<CodecRival> make_meshopt_rival() { return std::make_unique<MeshoptRival>(); }

std::size_t draco_size(const std::vector<GridPosition>& positions,
                       const std::vector<std::uint32_t>& indices) {
  draco::EncoderBuffer bytes;
  encode_draco(positions, indices, bytes);
  return bytes.size();
}

}  // namespace atlaswire::bench
