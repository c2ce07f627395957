#include "netsim/decision_log.h"

#include "netsim/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <tuple>

namespace atlaswire::netsim {

namespace {

constexpr Fate kFates[] = {Fate::kDelivered, Fate::kLost,    Fate::kBlackout, Fate::kQueueFull,
                           Fate::kEarlyDrop, Fate::kExpired, Fate::kUnsent};
constexpr std::size_t kColumns = 12;
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
    if (i == 7) continue;
    const auto n = number(fields[i]);
    if (!n || *n < 0 || *n > kMostNanos) return std::nullopt;
    numbers[i] = *n;
  }
  const auto fate = fate_named(fields[7]);
  constexpr std::int64_t kMostOctets = 65'535;
  if (!fate || numbers[3] > kMostOctets || numbers[2] > 0xFFFFFFFF) return std::nullopt;
  DirectedDecision d;
  d.direction = fields[0] == "up" ? Direction::kUp : Direction::kDown;
  d.decision = {.packet = static_cast<std::uint64_t>(numbers[1]),
                .flow = static_cast<FlowId>(numbers[2]),
                .size = static_cast<std::uint32_t>(numbers[3]),
                .arrived = from_nanos(numbers[4]),
                .left_queue = from_nanos(numbers[5]),
                .delivered = from_nanos(numbers[6]),
                .fate = *fate,
                .corrupted = numbers[8] != 0,
                .duplicate = numbers[9] != 0,
                .marked = numbers[10] != 0,
                .reordered = numbers[11] != 0};
  return d;
}

/// A replay needs every arrival, and time that does not go back.
std::optional<std::string> find_gap(const std::vector<DirectedDecision>& sorted) {
  std::uint64_t next[2] = {};
  Time last[2] = {};
  for (const DirectedDecision& d : sorted) {
    const auto way = static_cast<std::size_t>(d.direction);
    const auto where = [&] { return fmt::format("{} packet {}", way == 0 ? "up" : "down", next[way]); };
    if (d.decision.duplicate) {
      if (d.decision.packet + 1 != next[way]) return where() + " has copies and no original";
      continue;
    }
    if (d.decision.packet != next[way]) return where() + " is missing or there twice";
    if (d.decision.arrived < last[way]) return where() + " arrived before the one before it";
    last[way] = d.decision.arrived;
    ++next[way];
  }
  return std::nullopt;
}

auto sort_key(const DirectedDecision& d) {
  return std::make_tuple(d.direction, d.decision.packet, d.decision.duplicate);
}

}  // namespace

std::string_view decision_log_header() {
  return "direction,packet,flow,size,arrived_ns,left_queue_ns,delivered_ns,fate,corrupted,duplicate,marked,"
         "reordered";
}

std::string format_decision(const DirectedDecision& d, Time start) {
  const Decision& x = d.decision;
  const auto since = [start](Time t) { return std::max<std::int64_t>(0, (t - start).count()); };
  const bool delivered = x.fate == Fate::kDelivered;
  return fmt::format(
      "{},{},{},{},{},{},{},{},{:d},{:d},{:d},{:d}", d.direction == Direction::kUp ? "up" : "down", x.packet,
      static_cast<std::uint32_t>(x.flow), x.size, since(x.arrived), since(x.left_queue),
      delivered ? since(x.delivered) : 0, fate_name(x.fate), x.corrupted, x.duplicate, x.marked, x.reordered);
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
  Path path(profile, seed, Time{});
  std::vector<DirectedDecision> out;
  for (const Direction direction : {Direction::kUp, Direction::kDown}) {
    Link& link = path.link(direction);
    const auto collect = [&] {
      for (const Decision& decision : link.take_decisions()) out.push_back({direction, decision});
    };
    for (const DirectedDecision& d : arrivals) {
      if (d.direction != direction || d.decision.duplicate) continue;
      (void)link.deliver(d.decision.arrived);  // so that memory does not grow with the log
      link.send(ByteBuffer(d.decision.size), d.decision.arrived, d.decision.flow);
      collect();
    }
    link.finish();
    collect();
  }
  for (DirectedDecision& d : out) {
    if (d.decision.fate != Fate::kDelivered) d.decision.delivered = Time{};
  }
  sort_log(out);
  return out;
}

}  // namespace atlaswire::netsim
