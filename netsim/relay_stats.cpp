#include "netsim/relay_stats.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace atlaswire::netsim {

namespace {

std::size_t index_of(Fate fate) { return static_cast<std::size_t>(fate); }

nlohmann::ordered_json way_json(const RelayStats::Way& way) {
  nlohmann::ordered_json fates;
  for (std::size_t i = 0; i < way.packets_by_fate.size(); ++i) {
    fates[fate_name(static_cast<Fate>(i))] = {{"packets", way.packets_by_fate[i]},
                                              {"bytes", way.octets_by_fate[i]}};
  }
  return {{"packets", way.packets},
          {"bytes", way.octets},
          {"fates", fates},
          {"duplicates", way.duplicates},
          {"corrupted", way.corrupted},
          {"reordered", way.reordered},
          {"marked", way.marked},
          {"send_failures", way.send_failures}};
}

std::string way_text(const char* name, const RelayStats::Way& now, const RelayStats::Way& before,
                     double seconds) {
  const std::uint64_t packets = now.packets - before.packets;
  const std::uint64_t delivered = now.packets_by_fate[0] - before.packets_by_fate[0];
  std::uint64_t dropped = 0;
  for (std::size_t i = 1; i < now.packets_by_fate.size(); ++i) {
    dropped += now.packets_by_fate[i] - before.packets_by_fate[i];
  }
  const double mbps = static_cast<double>(now.octets_by_fate[0] - before.octets_by_fate[0]) * 8e-6 / seconds;
  return fmt::format("{} {} in, {} out, {} dropped, {:.2f} Mbps", name, packets, delivered, dropped, mbps);
}

}  // namespace

void RelayStats::count(const Decision& decision, Direction direction) {
  Way& w = way(direction);
  if (decision.duplicate) {
    ++w.duplicates;
    return;
  }
  ++w.packets;
  w.octets += decision.size;
  ++w.packets_by_fate[index_of(decision.fate)];
  w.octets_by_fate[index_of(decision.fate)] += decision.size;
  w.corrupted += decision.corrupted ? 1 : 0;
  w.reordered += decision.reordered ? 1 : 0;
  w.marked += decision.marked ? 1 : 0;
}

std::string stats_json(const RelayStats& stats, const std::string& profile, std::uint64_t seed,
                       Duration elapsed) {
  nlohmann::ordered_json json;
  json["profile"] = profile;
  json["seed"] = seed;
  json["seconds"] = to_seconds(elapsed);
  json["up"] = way_json(stats.way(Direction::kUp));
  json["down"] = way_json(stats.way(Direction::kDown));
  json["lateness_us"] = {{"count", stats.lateness.count()},
                         {"median", stats.lateness.quantile_us(0.5)},
                         {"p99", stats.lateness.quantile_us(0.99)},
                         {"max", stats.lateness.most_us()}};
  json["udp_flows"] = stats.udp_flows;
  json["tcp_connections"] = stats.tcp_connections;
  json["flows_refused"] = stats.flows_refused;
  json["connect_failures"] = stats.connect_failures;
  json["stream_repeats"] = stats.stream_repeats;
  return json.dump(2);
}

std::string stats_line(const RelayStats& now, const RelayStats& before, Duration elapsed) {
  const double seconds = std::max(to_seconds(elapsed), 1e-9);
  return way_text("up", now.ways[0], before.ways[0], seconds) + "  |  " +
         way_text("down", now.ways[1], before.ways[1], seconds) +
         fmt::format("  |  late {:.0f} us median, {:.0f} us p99", now.lateness.quantile_us(0.5),
                     now.lateness.quantile_us(0.99));
}

}  // namespace atlaswire::netsim
