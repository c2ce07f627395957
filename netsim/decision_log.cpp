#include "netsim/decision_log.h"

#include "netsim/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace atlaswire::netsim {

namespace {

constexpr Fate kFates[] = {Fate::kDelivered, Fate::kLost,    Fate::kBlackout, Fate::kQueueFull,
                           Fate::kEarlyDrop, Fate::kExpired, Fate::kUnsent};
constexpr std::size_t kColumns = 14;
constexpr std::size_t kFateColumn = 9;
constexpr std::int64_t kMostNanos = 100'000'000'000'000'000;  // three years: sums of times stay in range

std::optional<std::int64_t> number(std::string_view text) {
  std::int64_t out = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (ec != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return out;
}

std::optional<Fate> fate_named(std::string_view name) {
  for (const Fate fate : kFates) {
    if (name == fate_name(fate)) return fate;
  }
  return std::nullopt;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> out;
  for (;;) {
    const auto comma = line.find(',');
    out.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return out;
    line.remove_prefix(comma + 1);
  }
}

std::optional<DirectedDecision> parse_line(std::string_view line) {
  const auto fields = split(line);
  if (fields.size() != kColumns || (fields[0] != "up" && fields[0] != "down")) return std::nullopt;
  std::int64_t numbers[kColumns] = {};
  for (std::size_t i = 1; i < kColumns; ++i) {
    if (i == kFateColumn) continue;
    const auto n = number(fields[i]);
    if (!n || *n < 0 || *n > kMostNanos) return std::nullopt;
    numbers[i] = *n;
  }
  const auto fate = fate_named(fields[kFateColumn]);
  constexpr std::int64_t kMostOctets = 65'535;
  if (!fate || numbers[1] > static_cast<std::int64_t>(Profile::kMostRules) || numbers[3] > 0xFFFFFFFF ||
      numbers[4] > kMostOctets || numbers[5] > 3)
    return std::nullopt;
  DirectedDecision d;
  d.direction = fields[0] == "up" ? Direction::kUp : Direction::kDown;
  d.path = static_cast<PathId>(numbers[1]);
  d.decision = {.packet = static_cast<std::uint64_t>(numbers[2]),
                .flow = static_cast<FlowId>(numbers[3]),
                .size = static_cast<std::uint32_t>(numbers[4]),
                .arrived = from_nanos(numbers[6]),
                .left_queue = from_nanos(numbers[7]),
                .delivered = from_nanos(numbers[8]),
                .fate = *fate,
                .ecn = static_cast<Ecn>(numbers[5]),
                .corrupted = numbers[10] != 0,
                .duplicate = numbers[11] != 0,
                .marked = numbers[12] != 0,
                .reordered = numbers[13] != 0};
  return d;
}

/// Packets are numbered within a direction of a path.
std::pair<Direction, PathId> lane_of(const DirectedDecision& d) { return {d.direction, d.path}; }

/// A replay needs every arrival, and time that does not go back.
std::optional<std::string> find_gap(const std::vector<DirectedDecision>& sorted) {
  std::uint64_t next = 0;  // of the direction and path that `lane` names
  Time last{};
  std::optional<std::pair<Direction, PathId>> lane;
  for (const DirectedDecision& d : sorted) {
    if (lane != lane_of(d)) {
      lane = lane_of(d);
      next = 0;
      last = Time{};
    }
    const auto where = [&] {
      return fmt::format(
          "{}{} packet {}", d.direction == Direction::kUp ? "up" : "down",
          d.path == PathId{0} ? "" : fmt::format(" path {}", static_cast<std::uint32_t>(d.path)), next);
    };
    if (d.decision.duplicate) {
      if (d.decision.packet + 1 != next) return where() + " has copies and no original";
      continue;
    }
    if (d.decision.packet != next) return where() + " is missing or there twice";
    if (d.decision.arrived < last) return where() + " arrived before the one before it";
    last = d.decision.arrived;
    ++next;
  }
  return std::nullopt;
}

/// Runs what entered one direction of one path.
void replay_lane(std::span<const DirectedDecision> arrivals, const Profile& profile, std::uint64_t seed,
                 std::vector<DirectedDecision>& out) {
  const auto [direction, path] = lane_of(arrivals[0]);
  Path fresh(profile, path, seed, Time{});
  Link& link = fresh.link(direction);
  const auto collect = [&, way = direction, id = path] {
    for (const Decision& decision : link.take_decisions()) out.push_back({way, decision, id});
  };
  for (const DirectedDecision& d : arrivals) {
    if (d.decision.duplicate) continue;
    (void)link.deliver(d.decision.arrived);  // so that memory does not grow with the log
    link.send(ByteBuffer(d.decision.size), d.decision.arrived, d.decision.flow, d.decision.ecn);
    collect();
  }
  link.finish();
  collect();
}

auto sort_key(const DirectedDecision& d) {
  return std::make_tuple(d.direction, d.path, d.decision.packet, d.decision.duplicate);
}

}  // namespace

std::string_view decision_log_header() {
  return "direction,path,packet,flow,size,ecn,arrived_ns,left_queue_ns,delivered_ns,fate,corrupted,duplicate,"
         "marked,reordered";
}

std::string format_decision(const DirectedDecision& d, Time start) {
  const Decision& x = d.decision;
  const auto since = [start](Time t) { return std::max<std::int64_t>(0, (t - start).count()); };
  const bool delivered = x.fate == Fate::kDelivered;
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{:d},{:d},{:d},{:d}",
                     d.direction == Direction::kUp ? "up" : "down", static_cast<std::uint32_t>(d.path),
                     x.packet, static_cast<std::uint32_t>(x.flow), x.size, static_cast<unsigned>(x.ecn),
                     since(x.arrived), since(x.left_queue), delivered ? since(x.delivered) : 0,
                     fate_name(x.fate), x.corrupted, x.duplicate, x.marked, x.reordered);
}

Result<std::vector<DirectedDecision>> parse_decision_log(std::string_view text) {
  std::vector<DirectedDecision> out;
  std::size_t line_number = 0;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line_number;
    if (line.empty() || line == decision_log_header()) continue;
    const auto decision = parse_line(line);
    if (!decision) return Error{ProfileError::kBadLog, "line " + std::to_string(line_number)};
    out.push_back(*decision);
  }
  sort_log(out);
  if (auto gap = find_gap(out)) return Error{ProfileError::kBadLog, *gap};
  return out;
}

void sort_log(std::vector<DirectedDecision>& log) {
  std::stable_sort(log.begin(), log.end(),
                   [](const auto& a, const auto& b) { return sort_key(a) < sort_key(b); });
}

std::vector<DirectedDecision> replay(const std::vector<DirectedDecision>& log, const Profile& profile,
                                     std::uint64_t seed) {
  std::vector<DirectedDecision> arrivals = log;
  sort_log(arrivals);
  std::vector<DirectedDecision> out;
  for (auto rest = std::span(std::as_const(arrivals)); !rest.empty();) {
    const auto end =
        std::find_if(rest.begin(), rest.end(), [&](const auto& d) { return lane_of(d) != lane_of(rest[0]); });
    const auto lane = rest.first(static_cast<std::size_t>(end - rest.begin()));
    rest = rest.subspan(lane.size());
    if (static_cast<std::uint32_t>(lane[0].path) < profile.paths()) replay_lane(lane, profile, seed, out);
  }
  for (DirectedDecision& d : out) {
    if (d.decision.fate != Fate::kDelivered) d.decision.delivered = Time{};
  }
  sort_log(out);
  return out;
}

}  // namespace atlaswire::netsim
