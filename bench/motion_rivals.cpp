#include "bench/motion_rival.h"
#include "codec/bit_io.h"
#include "codec/golomb_column.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

namespace atlaswire::bench {

namespace {

constexpr std::uint64_t kSeed = 1;  // recordings are not made against us

void demand(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

std::array<std::int32_t, 7> numbers_of(const codec::TransformGrid& grid, const codec::RigidTransform& t) {
  const auto on_grid = grid.quantize(t);
  demand(on_grid.has_value(), "a recorded transform is beyond the grid");
  std::array<std::int32_t, 7> out{};
  for (int axis = 0; axis < 3; ++axis) out[static_cast<std::size_t>(axis)] = on_grid->translation[axis];
  std::ranges::copy(on_grid->rotation, out.begin() + 3);
  return out;
}

std::array<std::int32_t, 3> numbers_of(const PositionGrid& grid, const glm::dvec3& at) {
  std::array<std::int32_t, 3> out{};
  for (int axis = 0; axis < 3; ++axis) {
    out[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(std::round((at[axis] - grid.origin[axis]) / grid.step));
  }
  return out;
}

class NaiveMotion final : public MotionRival {
 public:
  void encode(const MotionStep& step) override {
    told_.clear();
    const codec::MotionScope scope = step.scope->scope();
    for (std::size_t i = 0; i < scope.vertices.size(); ++i) {
      Vertex& v = told_.vertices.emplace_back(Vertex{value(step.scope->id(scope.vertices[i])), {}});
      for (int axis = 0; axis < 3; ++axis)
        v.at[static_cast<std::size_t>(axis)] = static_cast<float>(step.places->positions[i][axis]);
    }
    for (std::size_t i = 0; i < scope.objects.size(); ++i) {
      const auto& [shift, turn] = step.places->transforms[i];
      const auto f = [](double d) { return static_cast<float>(d); };
      told_.objects.push_back(
          {scope.objects[i],
           {f(shift.x), f(shift.y), f(shift.z), f(turn.x), f(turn.y), f(turn.z), f(turn.w)}});
    }
  }
  [[nodiscard]] std::size_t size() const override {
    return told_.vertices.size() * sizeof(Vertex) + told_.objects.size() * sizeof(Object);
  }
  void decode(const codec::MetaUpdate&) override { heard_ = told_; }
  void check(const MotionStep&) const override { demand(heard_ == told_, "naive motion differs"); }

 private:
  struct Vertex {
    std::uint32_t id = 0;
    std::array<float, 3> at{};
    bool operator==(const Vertex&) const = default;
  };
  struct Object {
    std::uint32_t number = 0;
    std::array<float, 7> transform{};
    bool operator==(const Object&) const = default;
  };
  struct Message {
    std::vector<Vertex> vertices;
    std::vector<Object> objects;
    void clear() {
      vertices.clear();
      objects.clear();
    }
    bool operator==(const Message&) const = default;
  };
  Message told_;
  Message heard_;
};

/// Rows of numbers under ascending ids.
template <std::size_t kWidth>
using Rows = std::vector<std::pair<std::uint32_t, std::array<std::int32_t, kWidth>>>;

constexpr std::uint32_t kCountOrder = 5;

template <std::size_t kWidth>
void write_rows(const Rows<kWidth>& rows, codec::BitWriter& out) {
  out.write_golomb(static_cast<std::uint32_t>(rows.size()), kCountOrder);
  codec::GolombIds ids;
  for (const auto& row : rows) ids.add(row.first);
  ids.write(out);
  for (std::size_t member = 0; member < kWidth; ++member) {
    codec::GolombColumn column;
    std::int32_t before = 0;
    for (const auto& row : rows)
      column.add_signed(row.second[member] - std::exchange(before, row.second[member]));
    column.write(out);
  }
}

template <std::size_t kWidth>
void read_rows(codec::BitReader& in, Rows<kWidth>& rows) {
  rows.resize(std::min<std::size_t>(in.read_golomb(kCountOrder), in.bits_left()));
  if (rows.empty()) return;
  std::uint32_t order = in.read(codec::kColumnOrderBits);
  std::uint32_t expected = 0;
  for (auto& row : rows) {
    row.first = expected + in.read_golomb(order);
    expected = row.first + 1;
  }
  for (std::size_t member = 0; member < kWidth; ++member) {
    order = in.read(codec::kColumnOrderBits);
    std::int32_t before = 0;
    for (auto& row : rows) before = row.second[member] = before + codec::unzigzag(in.read_golomb(order));
  }
}

class PaperMotion final : public MotionRival {
 public:
  explicit PaperMotion(const RecordedMotion& motion) : settings_(motion.settings) {}
  void encode(const MotionStep& step) override {
    const codec::MotionScope scope = step.scope->scope();
    vertices_.clear();
    for (std::size_t i = 0; i < scope.vertices.size(); ++i) {
      vertices_.emplace_back(value(step.scope->id(scope.vertices[i])),
                             numbers_of(settings_.grid, step.places->positions[i]));
    }
    std::ranges::sort(vertices_);
    objects_.clear();
    for (std::size_t i = 0; i < scope.objects.size(); ++i)
      objects_.emplace_back(scope.objects[i], numbers_of(settings_.transforms, step.places->transforms[i]));
    bytes_.clear();
    codec::BitWriter writer(bytes_);
    write_rows(vertices_, writer);
    write_rows(objects_, writer);
    writer.finish();
  }
  [[nodiscard]] std::size_t size() const override { return bytes_.size(); }
  void decode(const codec::MetaUpdate&) override {
    codec::BitReader reader(bytes_);
    read_rows(reader, heard_vertices_);
    read_rows(reader, heard_objects_);
    demand(reader.finished(), "the paper's motion would not decode");
  }
  void check(const MotionStep&) const override {
    demand(heard_vertices_ == vertices_ && heard_objects_ == objects_, "the paper's motion differs");
  }

 private:
  codec::MotionSettings settings_;
  Rows<3> vertices_;
  Rows<7> objects_;
  Rows<3> heard_vertices_;
  Rows<7> heard_objects_;
  ByteBuffer bytes_;
};

class OwnMotion final : public MotionRival {
 public:
  explicit OwnMotion(const RecordedMotion& motion)
      : settings_(motion.settings),
        told_(motion.movers),
        heard_(motion.movers),
        encoder_(motion.settings),
        decoder_(motion.settings) {}
  void encode(const MotionStep& step) override {
    told_.scope.follow(told_.watch.take(*step.update));
    bytes_.clear();
    encoder_
        .encode(told_.scope.scope(), {step.update->reset, step.places->positions, step.places->transforms},
                bytes_)
        .value();
  }
  [[nodiscard]] std::size_t size() const override { return bytes_.size(); }
  void decode(const codec::MetaUpdate& heard) override {
    heard_.scope.follow(heard_.watch.take(heard));
    demand(decoder_.decode(heard_.scope.scope(), bytes_).has_value(), "our motion would not decode");
  }
  void check(const MotionStep& step) const override {
    const codec::MotionScope scope = heard_.scope.scope();
    demand(std::ranges::equal(scope.vertices, step.scope->scope().vertices) &&
               std::ranges::equal(scope.objects, step.scope->scope().objects),
           "our motion is of other movers");
    for (std::size_t i = 0; i < scope.vertices.size(); ++i) {
      demand(numbers_of(settings_.grid, decoder_.position(heard_.scope.surface(), scope.vertices[i])) ==
                 numbers_of(settings_.grid, step.places->positions[i]),
             "our motion of a vertex differs");
    }
    for (std::size_t i = 0; i < scope.objects.size(); ++i) {
      const codec::RigidTransform heard = decoder_.transform(scope.objects[i]);
      const codec::RigidTransform& told = step.places->transforms[i];
      const double turn = std::abs(glm::dot(heard.orientation, glm::normalize(told.orientation)));
      demand(glm::distance(heard.translation, told.translation) <=
                     settings_.transforms.max_translation_error() * (1 + 1e-9) &&
                 2 * std::acos(std::min(turn, 1.0)) <= settings_.transforms.max_rotation_error() + 1e-7,
             "our motion of an object differs");
    }
  }

 private:
  struct End {
    explicit End(const std::vector<Mover>& movers) : watch(movers), scope(movers, kSeed) {}
    codec::MoverWatch watch;
    codec::MoverScope scope;
  };
  codec::MotionSettings settings_;
  End told_;
  End heard_;
  codec::MotionEncoder encoder_;
  codec::MotionDecoder decoder_;
  ByteBuffer bytes_;
};

}  // namespace

MotionFollower::MotionFollower(const RecordedMotion& motion)
    : motion_(&motion), watch_(motion.movers), scope_(motion.movers, kSeed) {
  std::uint32_t objects = 0;
  for (const Mover& mover : motion.movers) {
    if (!mover.deforms) objects = std::max(objects, mover.object + 1);
  }
  const auto rest = numbers_of(motion.settings.transforms, codec::RigidTransform{});
  for (std::uint32_t i = 0; i < objects; ++i) rest_.insert(rest_.end(), rest.begin(), rest.end());
  step_.objects = rest_;
}

const MotionStep& MotionFollower::next(const codec::MetaUpdate& update) {
  scope_.follow(watch_.take(update));
  if (update.reset) {
    step_.vertices.clear();
    step_.objects = rest_;
  }
  demand(frame_ < motion_->frames.size(), "a recording has fewer frames of motion than updates");
  step_.update = &update;
  step_.scope = &scope_;
  step_.places = &motion_->frames[frame_++];
  const codec::MotionScope scope = scope_.scope();
  demand(step_.places->positions.size() == scope.vertices.size() &&
             step_.places->transforms.size() == scope.objects.size(),
         "a recording's motion is not of its movers");
  step_.vertices.resize(std::size_t{3} * scope_.surface().size());
  for (std::size_t i = 0; i < scope.vertices.size(); ++i) {
    const auto now = numbers_of(motion_->settings.grid, step_.places->positions[i]);
    const GridPosition& rest = scope_.surface().rest(scope.vertices[i]);
    for (int axis = 0; axis < 3; ++axis) {
      const auto member = static_cast<std::size_t>(axis);
      step_.vertices[std::size_t{3} * scope.vertices[i] + member] =
          now[member] - static_cast<std::int32_t>(rest[axis]);
    }
  }
  for (std::size_t i = 0; i < scope.objects.size(); ++i) {
    std::ranges::copy(numbers_of(motion_->settings.transforms, step_.places->transforms[i]),
                      step_.objects.begin() + std::ptrdiff_t{7} * scope.objects[i]);
  }
  return step_;
}

std::unique_ptr<MotionRival> make_naive_motion() { return std::make_unique<NaiveMotion>(); }
std::unique_ptr<MotionRival> make_paper_motion(const RecordedMotion& motion) {
  return std::make_unique<PaperMotion>(motion);
}
std::unique_ptr<MotionRival> make_own_motion(const RecordedMotion& motion) {
  return std::make_unique<OwnMotion>(motion);
}

}  // namespace atlaswire::bench
