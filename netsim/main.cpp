#include "base/program.h"
#include "netsim/decision_log.h"
#include "netsim/relay_options.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace atlaswire::netsim {

namespace {

void write_file(const std::string& name, const std::string& text) {
  std::ofstream file(name, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (!file) throw ProgramError(ExitCode::kCannotWrite, "cannot write '" + name + "'");
}

void write_ready_file(const std::string& name, std::uint16_t port) {
  const std::string unfinished = name + ".new";
  write_file(unfinished,
             "{\"port\":" + std::to_string(port) + ",\"pid\":" + std::to_string(getpid()) + "}\n");
  if (std::rename(unfinished.c_str(), name.c_str()) != 0) {
    throw ProgramError(ExitCode::kCannotWrite, "cannot write '" + name + "'");
  }
}

int relay_live(const NetsimOptions& o) {
  Relay relay(o.relay);
  if (!o.ready_file.empty()) write_ready_file(o.ready_file, relay.port());
  std::fprintf(stderr, "atlas-netsim: %s:%u to %s:%u through %s, seed %llu\n", o.relay.listen_address.c_str(),
               relay.port(), o.relay.target_host.c_str(), o.relay.target_port, o.relay.profile.name.c_str(),
               static_cast<unsigned long long>(o.relay.seed));
  relay.run();
  if (o.json) {
    std::printf("%s\n",
                stats_json(relay.stats(), o.relay.profile.name, o.relay.seed, relay.elapsed()).c_str());
  } else {
    std::fprintf(stderr, "%s\n", stats_line(relay.stats(), RelayStats{}, relay.elapsed()).c_str());
  }
  return 0;
}

int replay_log(const NetsimOptions& o) {
  std::ifstream file(o.replay_file, std::ios::binary);
  if (!file) throw ProgramError(ExitCode::kUsage, "cannot read '" + o.replay_file + "'");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto log = parse_decision_log(text);
  if (log.has_error()) throw ProgramError(ExitCode::kUsage, o.replay_file + ": " + log.error().message());
  const auto again = replay(*log, o.relay.profile, o.relay.seed);
  for (std::size_t i = 0; i < std::max(log->size(), again.size()); ++i) {
    if (i < log->size() && i < again.size() && (*log)[i] == again[i]) continue;
    const auto line = [i](const auto& decisions) {
      return i < decisions.size() ? format_decision(decisions[i], Time{}) : std::string("nothing more");
    };
    std::printf("first difference, at decision %zu of %zu:\n%s\nlog:    %s\nreplay: %s\n", i + 1, log->size(),
                ("        " + std::string(decision_log_header())).c_str(), line(*log).c_str(),
                line(again).c_str());
    return 1;
  }
  std::printf("%zu decisions, all identical\n", log->size());
  return 0;
}

int draw(const NetsimOptions& o) {
  std::string text(decision_log_header());
  text += '\n';
  for (const DirectedDecision& d : probe(o.relay.profile, o.relay.seed, o.load)) {
    text += format_decision(d, Time{}) + '\n';
  }
  write_file(o.draw_file, text);
  return 0;
}

int run(int argc, char** argv) {
  const NetsimOptions o = parse_netsim_options(argc, argv);
  switch (o.mode) {
    case NetsimOptions::Mode::kPrint:
      std::fputs(o.text.c_str(), stdout);
      return 0;
    case NetsimOptions::Mode::kRelay:
      return relay_live(o);
    case NetsimOptions::Mode::kReplay:
      return replay_log(o);
    case NetsimOptions::Mode::kDraw:
      return draw(o);
  }
  return static_cast<int>(ExitCode::kInternal);
}

}  // namespace

}  // namespace atlaswire::netsim

int main(int argc, char** argv) {
  return atlaswire::run_program("atlas-netsim", argc, argv, atlaswire::netsim::run);
}
