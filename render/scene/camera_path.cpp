#include "render/scene/camera_path.h"

#include "render/scene/scene_error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>
#include <optional>

namespace atlaswire::render {

namespace {

constexpr std::size_t kColumns = 8;
constexpr std::size_t kMostRows = 1'000'000;
constexpr double kMostSeconds = 86'400;

std::optional<double> number(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  double out = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (ec != std::errc{} || end != text.data() + text.size() || !std::isfinite(out)) return std::nullopt;
  return out;
}

/// Splits one row; empty when it has another number of columns or one is no finite number.
std::optional<std::array<double, kColumns>> row(std::string_view line) {
  std::array<double, kColumns> out{};
  for (std::size_t i = 0; i < kColumns; ++i) {
    const auto comma = line.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == kColumns)) return std::nullopt;
    const auto v = number(line.substr(0, comma));
    if (!v) return std::nullopt;
    out[i] = *v;
    if (comma != std::string_view::npos) line.remove_prefix(comma + 1);
  }
  return out;
}

Error bad(std::size_t line, const char* why) {
  return Error{SceneError::kBadPath, "line " + std::to_string(line) + " " + why};
}

/// Looks along `yaw` (0: -Z, positive turns left) and up by `pitch`.
glm::dquat looking(double yaw, double pitch) {
  return glm::angleAxis(yaw, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch, glm::dvec3(1, 0, 0));
}

/// A smooth step from 0 to 1 between two instants.
double ease(double t, double from, double to) {
  const double x = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// Ten seconds through the court and its gallery at 1.4 m/s, with head bob and quick looks aside.
Pose atrium_walk(double t) {
  Pose pose;
  const double along = 1.4 * t;
  const double sway = 0.9 * std::cos(along * 0.33);
  const double stride = 2 * std::numbers::pi * 1.9 * t;
  pose.position = {-9.5 + along, 1.68 + 0.028 * std::sin(stride), sway + 0.018 * std::sin(stride / 2)};
  // The fountain stands in the middle: walk around it.
  pose.position.z += 2.1 * std::exp(-std::pow((pose.position.x + 0.2) / 2.4, 2));
  const double ahead = -std::numbers::pi / 2;
  // Looks: up to the left gallery, back, to the right, back; at most about 110 degrees a second.
  const double yaw = ahead + 0.95 * (ease(t, 1.2, 2.0) - ease(t, 2.7, 3.6)) -
                     1.2 * (ease(t, 4.8, 5.8) - ease(t, 6.4, 7.6)) +
                     0.5 * (ease(t, 8.2, 8.8) - ease(t, 9.2, 9.9));
  const double pitch = 0.12 * std::sin(0.9 * t) + 0.22 * (ease(t, 1.3, 2.0) - ease(t, 2.6, 3.4));
  pose.orientation = looking(yaw, pitch);
  return pose;
}

/// Eight seconds along an arc about the parade at 1.1 m/s, looking at its middle.
Pose parade_walk(double t) {
  constexpr double kRadius = 5.2;
  const double angle = 0.9 - 1.1 * t / kRadius;
  const double stride = 2 * std::numbers::pi * 1.8 * t;
  Pose pose;
  pose.position = {kRadius * std::sin(angle), 1.68 + 0.025 * std::sin(stride), kRadius * std::cos(angle)};
  pose.orientation = looking(angle + 0.1 * std::sin(0.8 * t), -0.12);
  return pose;
}

template <class At>
std::vector<CameraPath::Key> sample(const At& at, double seconds) {
  std::vector<CameraPath::Key> keys;
  const auto rows = static_cast<int>(seconds * 120);
  for (int i = 0; i < rows; ++i) keys.push_back({from_seconds(i / 120.0), at(i / 120.0)});
  return keys;
}

}  // namespace

CameraPath::CameraPath(std::vector<Key> keys) : keys_(std::move(keys)) {
  const Duration first = keys_.front().at;
  for (Key& key : keys_) key.at -= first;
  for (std::size_t i = 0; i + 1 < keys_.size(); ++i) {
    Pose next = keys_[i + 1].pose;
    set_velocities_from(keys_[i].pose, next, keys_[i + 1].at - keys_[i].at);
    keys_[i].pose.velocity = next.velocity;
    keys_[i].pose.angular_velocity = next.angular_velocity;
  }
  if (keys_.size() > 1) {
    keys_.back().pose.velocity = keys_[keys_.size() - 2].pose.velocity;
    keys_.back().pose.angular_velocity = keys_[keys_.size() - 2].pose.angular_velocity;
  }
}

Result<CameraPath> CameraPath::parse(std::string_view csv) {
  std::vector<Key> keys;
  std::size_t line_number = 0;
  while (!csv.empty()) {
    const auto end = csv.find('\n');
    const std::string_view line = csv.substr(0, end);
    csv.remove_prefix(end == std::string_view::npos ? csv.size() : end + 1);
    ++line_number;
    if (line.empty() || line == "\r") continue;
    if (line_number == 1 && line.front() == 't') continue;
    const auto v = row(line);
    if (!v) return bad(line_number, "is not eight finite numbers t,px,py,pz,qx,qy,qz,qw");
    const auto& n = *v;
    if (std::abs(n[0]) > kMostSeconds) return bad(line_number, "has a time beyond a day");
    Key key{from_seconds(n[0]), {}};
    key.pose.position = {n[1], n[2], n[3]};
    const glm::dquat q(n[7], n[4], n[5], n[6]);
    const double norm = std::sqrt(glm::dot(q, q));
    if (!(std::abs(norm - 1) <= 1e-2)) return bad(line_number, "has a quaternion that is not of unit length");
    key.pose.orientation = q / norm;
    if (!is_sane(key.pose)) return bad(line_number, "has a position beyond 1e9 m");
    if (!keys.empty() && key.at <= keys.back().at)
      return bad(line_number, "does not come after the line before");
    if (keys.size() == kMostRows) return bad(line_number, "is one more than a million rows");
    keys.push_back(key);
  }
  if (keys.empty()) return Error{SceneError::kBadPath, "no row in it"};
  return CameraPath(std::move(keys));
}

Result<CameraPath> CameraPath::load(const std::string& name_or_file) {
  if (name_or_file == "atrium") return CameraPath(sample(atrium_walk, 10));
  if (name_or_file == "atrium-still") return standing(atrium_walk(0));
  if (name_or_file == "atrium-turn") {
    return CameraPath(sample(
        [](double t) {
          Pose pose = atrium_walk(2);
          pose.orientation = looking(-std::numbers::pi / 2 + 2 * std::numbers::pi * t / 4, 0.05);
          return pose;
        },
        4));
  }
  if (name_or_file == "atrium-about") {
    return CameraPath(sample(
        [](double t) {
          Pose pose = atrium_walk(2);
          pose.orientation = looking(-std::numbers::pi / 2 + std::numbers::pi * ease(t, 1, 1.5), 0.05);
          return pose;
        },
        2));
  }
  if (name_or_file == "parade") return CameraPath(sample(parade_walk, 8));
  if (name_or_file == "parade-still") return standing(parade_walk(2));
  std::error_code ignored;
  std::ifstream file(name_or_file);
  if (!std::filesystem::is_regular_file(name_or_file, ignored) || !file) {
    std::string known;
    for (const std::string& name : builtin()) known += (known.empty() ? "" : ", ") + name;
    return Error{SceneError::kNotFound, "camera path '" + name_or_file + "' (built-in: " + known + ")"};
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  auto path = parse(text);
  if (path.has_error()) return Error{path.error().code, "'" + name_or_file + "' " + path.error().detail};
  return path;
}

std::vector<std::string> CameraPath::builtin() {
  return {"atrium", "atrium-about", "atrium-still", "atrium-turn", "parade", "parade-still"};
}

CameraPath CameraPath::standing(const Pose& pose) {
  Key key{Duration::zero(), pose};
  key.pose.velocity = glm::dvec3(0.0);
  key.pose.angular_velocity = glm::dvec3(0.0);
  return CameraPath({key});
}

Pose CameraPath::at(Duration time) const {
  const Duration whole = length();
  if (whole == Duration::zero()) return keys_.front().pose;
  Duration within = time % (2 * whole);
  if (within < Duration::zero()) within += 2 * whole;
  const bool back = within > whole;
  if (back) within = 2 * whole - within;
  const auto after =
      std::upper_bound(keys_.begin(), keys_.end(), within, [](Duration t, const Key& k) { return t < k.at; });
  Pose pose = keys_.back().pose;
  if (after != keys_.end()) {
    const Key& b = *after;
    const Key& a = *(after - 1);
    pose = interpolate(a.pose, b.pose, to_seconds(within - a.at) / to_seconds(b.at - a.at));
  }
  if (back) {
    pose.velocity = -pose.velocity;
    pose.angular_velocity = -pose.angular_velocity;
  }
  return pose;
}

}  // namespace atlaswire::render
