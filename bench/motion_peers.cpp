#include "bench/motion_peers.h"

#include "base/assert.h"
#include "bench/zstd_stream.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <meshoptimizer.h>

#include <cstring>
#include <utility>

namespace atlaswire::bench {

namespace {

/// Packs what is left of numbers when time has been told.
class Packer {
 public:
  virtual ~Packer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  virtual void pack(std::span<const std::uint32_t> numbers, ByteBuffer& out) = 0;
  virtual void unpack(ByteView bytes, std::span<std::uint32_t> numbers) = 0;
};

std::uint32_t zigzag(std::int32_t v) {
  return static_cast<std::uint32_t>(v) << 1U ^ static_cast<std::uint32_t>(v >> 31);
}
std::int32_t unzigzag(std::uint32_t v) {
  return static_cast<std::int32_t>(v >> 1U) ^ -static_cast<std::int32_t>(v & 1U);
}

/// The lower octets of all numbers, then the upper ones where any has them.
class ZstdPacker final : public Packer {
 public:
  [[nodiscard]] std::string name() const override { return "zstd"; }
  void pack(std::span<const std::uint32_t> numbers, ByteBuffer& out) override {
    planes_.clear();
    for (std::uint32_t shift = 0; shift < 32; shift += 8) {
      for (const std::uint32_t n : numbers) planes_.push_back(static_cast<std::byte>(n >> shift));
    }
    const ByteView packed = encoder_.encode(planes_);
    out.insert(out.end(), packed.begin(), packed.end());
  }
  void unpack(ByteView bytes, std::span<std::uint32_t> numbers) override {
    const ByteView planes = decoder_.decode(bytes, numbers.size() * 4);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = 0;
      for (std::size_t plane = 0; plane < 4; ++plane)
        numbers[i] |= std::to_integer<std::uint32_t>(planes[plane * numbers.size() + i]) << 8 * plane;
    }
  }

 private:
  ZstdStreamEncoder encoder_;
  ZstdStreamDecoder decoder_;
  ByteBuffer planes_;
};

/// Rows as vertices, whose octets meshoptimizer tells as differences to the row before.
class MeshoptPacker final : public Packer {
 public:
  explicit MeshoptPacker(std::uint32_t width) : width_(width) {}
  [[nodiscard]] std::string name() const override { return "meshoptimizer + zstd"; }
  void pack(std::span<const std::uint32_t> numbers, ByteBuffer& out) override {
    const std::size_t rows = numbers.size() / width_;
    packed_.resize(meshopt_encodeVertexBufferBound(rows, 4 * width_));
    packed_.resize(
        meshopt_encodeVertexBuffer(packed_.data(), packed_.size(), numbers.data(), rows, 4 * width_));
    size_ = packed_.size();
    const ByteView packed = encoder_.encode(std::as_bytes(std::span(packed_)));
    out.insert(out.end(), packed.begin(), packed.end());
  }
  void unpack(ByteView bytes, std::span<std::uint32_t> numbers) override {
    const std::size_t rows = numbers.size() / width_;
    const ByteView packed = decoder_.decode(bytes, size_);
    const auto* data = reinterpret_cast<const unsigned char*>(packed.data());
    AW_ASSERT(meshopt_decodeVertexBuffer(numbers.data(), rows, 4 * width_, data, packed.size()) == 0);
  }

 private:
  std::uint32_t width_;
  ZstdStreamEncoder encoder_;
  ZstdStreamDecoder decoder_;
  std::vector<unsigned char> packed_;
  std::size_t size_ = 0;  ///< of what zstd packs; the decoder knows it free of charge
};

/// Points in their order (a k-d tree would lose it), at Draco's slowest and smallest.
class DracoPacker final : public Packer {
 public:
  [[nodiscard]] std::string name() const override { return "Draco"; }
  void pack(std::span<const std::uint32_t> numbers, ByteBuffer& out) override {
    draco::PointCloudBuilder builder;
    builder.Start(static_cast<draco::PointIndex::ValueType>(numbers.size() / 3));
    const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_INT32);
    points_.resize(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) points_[i] = unzigzag(numbers[i]);
    builder.SetAttributeValuesForAllPoints(attribute, points_.data(), 0);
    const auto cloud = builder.Finalize(false);
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
    encoder.SetSpeedOptions(0, 0);
    draco::EncoderBuffer buffer;
    AW_ASSERT(encoder.EncodePointCloudToBuffer(*cloud, &buffer).ok());
    const auto* data = reinterpret_cast<const std::byte*>(buffer.data());
    out.insert(out.end(), data, data + buffer.size());
  }
  void unpack(ByteView bytes, std::span<std::uint32_t> numbers) override {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto cloud = decoder.DecodePointCloudFromBuffer(&buffer);
    AW_ASSERT(cloud.ok());
    const draco::PointAttribute* attribute =
        cloud.value()->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    for (std::uint32_t i = 0; i < numbers.size() / 3; ++i) {
      std::int32_t point[3];
      attribute->GetValue(attribute->mapped_index(draco::PointIndex(i)), point);
      for (std::size_t axis = 0; axis < 3; ++axis) numbers[3 * i + axis] = zigzag(point[axis]);
    }
  }

 private:
  std::vector<std::int32_t> points_;
};

/// Differences of an order in time, packed.
class DifferencePeer final : public MotionPeer {
 public:
  DifferencePeer(int order, std::unique_ptr<Packer> packer) : order_(order), packer_(std::move(packer)) {}

  [[nodiscard]] std::string name() const override {
    constexpr const char* kOrders[] = {"positions", "first differences", "second differences"};
    return std::string(kOrders[order_]) + ", " + packer_->name();
  }
  void encode(std::span<const std::int32_t> numbers, ByteBuffer& out) override {
    told_.prepare(numbers.size());
    rest_.resize(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      rest_[i] = zigzag(numbers[i] - told_.expected(order_, i));
    told_.push(numbers);
    packer_->pack(rest_, out);
  }
  void decode(ByteView bytes, std::span<std::int32_t> numbers) override {
    heard_.prepare(numbers.size());
    rest_.resize(numbers.size());
    packer_->unpack(bytes, rest_);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      numbers[i] = unzigzag(rest_[i]) + heard_.expected(order_, i);
    heard_.push(numbers);
  }

 private:
  struct Past {
    void prepare(std::size_t count) {
      last.resize(count);
      before.resize(count);
    }
    [[nodiscard]] std::int32_t expected(int order, std::size_t i) const {
      return order == 0 ? 0 : order == 1 ? last[i] : 2 * last[i] - before[i];
    }
    void push(std::span<const std::int32_t> numbers) {
      before.swap(last);
      last.assign(numbers.begin(), numbers.end());
    }
    std::vector<std::int32_t> last;
    std::vector<std::int32_t> before;
  };

  int order_;
  std::unique_ptr<Packer> packer_;
  Past told_;
  Past heard_;
  std::vector<std::uint32_t> rest_;
};

}  // namespace

std::unique_ptr<MotionPeer> make_motion_peer(MotionPacking packing, int order, std::uint32_t width) {
  AW_ASSERT(order >= 0 && order <= 2 && (packing != MotionPacking::kDraco || width == 3));
  std::unique_ptr<Packer> packer;
  switch (packing) {
    case MotionPacking::kZstd:
      packer = std::make_unique<ZstdPacker>();
      break;
    case MotionPacking::kMeshopt:
      packer = std::make_unique<MeshoptPacker>(width);
      break;
    case MotionPacking::kDraco:
      packer = std::make_unique<DracoPacker>();
      break;
  }
  return std::make_unique<DifferencePeer>(order, std::move(packer));
}

std::vector<std::unique_ptr<MotionPeer>> make_motion_peers(std::uint32_t width) {
  std::vector<std::unique_ptr<MotionPeer>> peers;
  for (const int order : {1, 2}) {
    peers.push_back(make_motion_peer(MotionPacking::kZstd, order, width));
    peers.push_back(make_motion_peer(MotionPacking::kMeshopt, order, width));
  }
  if (width == 3) {
    for (const int order : {0, 2}) peers.push_back(make_motion_peer(MotionPacking::kDraco, order, width));
  }
  return peers;
}

}  // namespace atlaswire::bench
