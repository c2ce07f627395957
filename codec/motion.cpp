#include "codec/motion.h"

#include "base/assert.h"
#include "codec/motion_script.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace atlaswire::codec {

namespace {

constexpr std::uint8_t kForm = 0xB2;       // "atlaswire motion", form 2
constexpr std::uint8_t kResetForm = 0xB3;  // the same, everything forgotten first

}  // namespace

const char* error_text(MotionError e) {
  switch (e) {
    case MotionError::kTruncated:
      return "motion message has no octets";
    case MotionError::kTrailingBytes:
      return "octets behind the end of a motion message";
    case MotionError::kBadVersion:
      return "unknown form of motion message";
    case MotionError::kTooLarge:
      return "motion message too large";
    case MotionError::kBadWeights:
      return "prediction weight out of range";
    case MotionError::kBadPosition:
      return "position outside the grid and its margin";
    case MotionError::kBadRotation:
      return "not the orientation of a rigid object";
    case MotionError::kBadTranslation:
      return "translation too far";
    case MotionError::kOutOfStep:
      return "motion out of step: it needs a reset";
    case MotionError::kNotFinite:
      return "not finite";
  }
  return "unknown motion error";
}

MotionEncoder::MotionEncoder(const MotionSettings& settings, bool fits) : settings_(settings), fits_(fits) {}

Result<void> MotionEncoder::quantize(const MotionScope& scope, const MotionTargets& targets) {
  AW_ASSERT(targets.positions.size() == scope.vertices.size());
  AW_ASSERT(targets.transforms.size() == scope.objects.size());
  const PositionGrid& grid = settings_.grid;
  const double side = static_cast<double>(1U << grid.bits);
  positions_.resize(scope.vertices.size());
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = std::round((targets.positions[i][axis] - grid.origin[axis]) / grid.step);
      if (steps >= -side && steps < 2 * side) {
        positions_[i][axis] = static_cast<std::int32_t>(steps);
        continue;
      }
      return Error{
          std::isfinite(targets.positions[i][axis]) ? MotionError::kBadPosition : MotionError::kNotFinite,
          "vertex " + std::to_string(scope.vertices[i])};
    }
  }
  transforms_.resize(scope.objects.size());
  for (std::size_t i = 0; i < transforms_.size(); ++i) {
    const RigidTransform& t = targets.transforms[i];
    if (const auto on_grid = settings_.transforms.quantize(t)) {
      transforms_[i] = *on_grid;
      continue;
    }
    const std::string object = "object " + std::to_string(scope.objects[i]);
    const glm::dquat& q = t.orientation;
    if (!std::isfinite(t.translation.x + t.translation.y + t.translation.z) ||
        !std::isfinite(q.x + q.y + q.z + q.w)) {
      return Error{MotionError::kNotFinite, object};
    }
    const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return Error{square >= 0.25 && square <= 4.0 ? MotionError::kBadTranslation : MotionError::kBadRotation,
                 object};
  }
  return {};
}

Result<void> MotionEncoder::encode(const MotionScope& scope, const MotionTargets& targets, ByteBuffer& out) {
  if (auto checked = quantize(scope, targets); checked.has_error()) return checked.error();
  out.push_back(static_cast<std::byte>(targets.reset ? kResetForm : kForm));
  if (targets.reset) {
    state_.clear();
    fit_ = {};
  }
  RangeEncoder coder(out);
  const MotionWanted wanted{positions_, transforms_};
  MotionScript<RangeEncoder>(coder, state_, settings_, scope, &wanted, fits_ ? &fit_ : nullptr).code();
  coder.finish();
  return {};
}

MotionDecoder::MotionDecoder(const MotionSettings& settings, bool believes_all)
    : settings_(settings), believes_all_(believes_all) {
  AW_ASSERT(settings.grid.bits <= 20 && settings.transforms.rotation_bits >= 8 &&
            settings.transforms.rotation_bits <= 20);
}

Result<void> MotionDecoder::decode(const MotionScope& scope, ByteView bytes) {
  if (bytes.empty()) return MotionError::kTruncated;
  if (bytes.size() > kMaxMotionBody) return MotionError::kTooLarge;
  const auto form = std::to_integer<std::uint8_t>(bytes[0]);
  if (form != kForm && form != kResetForm) return MotionError::kBadVersion;
  if (form == kResetForm) {
    state_.clear();
    broken_ = false;
  }
  if (broken_) return MotionError::kOutOfStep;
  broken_ = true;
  RangeDecoder coder(bytes.subspan(1));
  const auto error = MotionScript<RangeDecoder>(coder, state_, settings_, scope, nullptr, nullptr).code();
  if (error && !(believes_all_ && *error == MotionError::kOutOfStep)) return *error;
  const ByteView unread = bytes.last(coder.unread());
  if (std::ranges::any_of(unread, [](std::byte octet) { return octet != std::byte{0}; })) {
    return MotionError::kTrailingBytes;
  }
  broken_ = false;
  return {};
}

glm::dvec3 MotionDecoder::position(const MotionSurface& surface, std::uint32_t vertex) const {
  const glm::ivec3 at =
      vertex < state_.vertices.size() ? state_.vertices[vertex].at[0] : glm::ivec3(surface.rest(vertex));
  return settings_.grid.origin + glm::dvec3(at) * settings_.grid.step;
}

RigidTransform MotionDecoder::transform(std::uint32_t object) const {
  return settings_.transforms.transform(object < state_.objects.size() ? state_.objects[object].at[0]
                                                                       : settings_.transforms.rest());
}

}  // namespace atlaswire::codec
