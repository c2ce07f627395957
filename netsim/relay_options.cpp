#include "netsim/relay_options.h"

#include "base/host_port.h"
#include "base/option_check.h"
#include "base/program.h"
#include "base/version.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <optional>

namespace atlaswire::netsim {

namespace {

constexpr const char* kFooter = R"(Examples:
  atlas-netsim --list                                             what networks there are
  atlas-netsim --show lte > mine.toml                             a profile to change; docs/NETSIM.md has the keys
  atlas-netsim --listen 7500 --to 127.0.0.1:7400 --profile lte    then let the client connect to port 7500
  atlas-netsim --listen 7500 --to 127.0.0.1:7400 --profile mine.toml --seed 7 --log run.csv --pcapng run.pcapng
  atlas-netsim --replay run.csv --profile mine.toml --seed 7      the same decisions again, in virtual time
  atlas-netsim --draw probe.csv --profile lte --load 30M          what the profile does to a steady load

Exit codes: 0 done, 1 a replay differs, 2 usage or bad profile, 5 port in use, 6 --to cannot be found,
9 cannot write a file. SIGINT and SIGTERM end a relay cleanly: logs are complete, the summary is printed.)";

/// The texts and numbers that become other types after parsing.
struct Raw {
  std::string listen;
  std::string to;
  std::string profile;
  std::string show;
  std::string load = "20M";
  double duration_s = 0;
  double spin_us = 100;
  double idle_timeout_s = 60;
  bool list = false;
  bool summary = false;
};

/// A port alone stands at `default_host`; empty default: it may not stand alone.
std::optional<HostPort> host_port(const std::string& text, const std::string& default_host) {
  if (text.find(':') != std::string::npos || default_host.empty()) return parse_host_port(text);
  return parse_host_port(default_host + ":" + text);
}

void add_relay_options(CLI::App& app, NetsimOptions& o, Raw& raw) {
  auto* group = app.add_option_group("Relay");
  group->add_option(
      "--listen", raw.listen,
      "PORT or ADDRESS:PORT for UDP and TCP; the address is 127.0.0.1 if not told, port 0 any free");
  group->add_option("--to", raw.to, "HOST:PORT that clients reach through the network");
  group->add_option("--duration", raw.duration_s, "End after this many seconds; 0: when told to");
  group->add_option("--spin", raw.spin_us,
                    "Busy-wait this many microseconds before each arrival, 0..10000: accuracy against CPU");
  group->add_option("--idle-timeout", raw.idle_timeout_s,
                    "Forget UDP flows silent for this many seconds, 1..86400");
  group->add_option("--max-flows", o.relay.max_flows, "UDP flows and TCP connections at once, 1..65536");
}

void add_profile_options(CLI::App& app, NetsimOptions& o, Raw& raw) {
  auto* group = app.add_option_group("Network");
  group->add_option("--profile", raw.profile, "A shipped profile's name (--list), or a .toml file");
  group->add_option("--seed", o.relay.seed, "Equal seeds give equal chances");
  group->add_flag("--list", raw.list, "Print the shipped profiles; then exit");
  group->add_option("--show", raw.show, "Print a shipped profile's file; then exit");
}

void add_report_options(CLI::App& app, NetsimOptions& o, Raw& raw) {
  auto* group = app.add_option_group("Reports");
  group->add_option("--ready-file", o.ready_file,
                    R"(Write {"port":N,"pid":N} here, atomically, once listening)");
  group->add_option("--log", o.relay.log_file,
                    "Write every decision to this CSV file, for --replay and plots");
  group->add_option("--pcapng", o.relay.pcapng_file,
                    "Write every packet to this file for Wireshark, its decision as a comment");
  group->add_flag("--summary", raw.summary, "A line on stderr each second, if that is a terminal");
  group->add_flag("--json", o.json, "Print a JSON summary on stdout at the end");
}

void add_virtual_options(CLI::App& app, NetsimOptions& o, Raw& raw) {
  auto* group = app.add_option_group("Virtual time");
  group->add_option(
      "--replay", o.replay_file,
      "Take a log's decisions again with --profile and --seed; exit 1 and show the first that differs");
  group->add_option(
      "--draw", o.draw_file,
      "Write the decisions of a steady load, both ways, to this CSV file (scripts/plot_profile.sh)");
  group->add_option("--load", raw.load, "Rate of that load such as 20M, each way, 1k..100G");
  group->add_option("--packet", o.load.packet_octets, "Octets of its packets, 1..65507");
}

std::string list_text() {
  std::string text;
  for (const std::string& name : shipped_profiles()) {
    text += fmt::format("{:<14} {}\n", name, load_profile(name).value().description);
  }
  return text;
}

void apply_relay(const Raw& raw, NetsimOptions& o) {
  const auto listen = host_port(raw.listen, "127.0.0.1");
  if (!listen) refuse_option("--listen", raw.listen, "PORT or ADDRESS:PORT, port 0..65535");
  const auto to = host_port(raw.to, "");
  if (!to || to->port == 0) refuse_option("--to", raw.to, "HOST:PORT or [IPV6]:PORT, port 1..65535");
  o.relay.listen_address = listen->host;
  o.relay.port = listen->port;
  o.relay.target_host = to->host;
  o.relay.target_port = to->port;
  demand_range("--spin", raw.spin_us, 0.0, 10'000.0);
  o.relay.spin = from_seconds(raw.spin_us * 1e-6);
  demand_range("--idle-timeout", raw.idle_timeout_s, 1.0, 86'400.0);
  o.relay.idle_timeout = from_seconds(raw.idle_timeout_s);
  demand_range("--max-flows", o.relay.max_flows, std::size_t{1}, std::size_t{65'536});
  demand_range("--duration", raw.duration_s, 0.0, 1e8);
  o.relay.duration = from_seconds(raw.duration_s);
  o.relay.live_line = raw.summary && isatty(STDERR_FILENO) != 0;
}

void apply_draw(const Raw& raw, NetsimOptions& o) {
  const auto rate = parse_bit_rate(raw.load);
  if (!rate || rate->bits_per_second < 1000 || rate->bits_per_second > 100'000'000'000) {
    refuse_option("--load", raw.load, "a rate such as 800k or 20M, 1k..100G");
  }
  o.load.rate = *rate;
  demand_range("--packet", o.load.packet_octets, 1U, 65'507U);
  demand_range("--duration", raw.duration_s, 0.0, 3600.0);
  if (raw.duration_s > 0) o.load.length = from_seconds(raw.duration_s);
}

void apply(const Raw& raw, NetsimOptions& o) {
  using Mode = NetsimOptions::Mode;
  if (raw.list) {
    o.text = list_text();
    return;
  }
  if (!raw.show.empty()) {
    o.text = shipped_profile_text(raw.show);
    if (o.text.empty()) refuse_option("--show", raw.show, "a name that --list gives");
    return;
  }
  o.mode = !o.replay_file.empty() ? Mode::kReplay : !o.draw_file.empty() ? Mode::kDraw : Mode::kRelay;
  if (o.mode == Mode::kRelay && (raw.listen.empty() || raw.to.empty())) {
    throw ProgramError(ExitCode::kUsage,
                       "needs --listen and --to, or --list, --show, --replay or --draw; see --help");
  }
  if (raw.profile.empty())
    throw ProgramError(ExitCode::kUsage, "needs --profile; --list names the shipped ones");
  auto profile = load_profile(raw.profile);
  if (profile.has_error()) throw ProgramError(ExitCode::kUsage, "--profile: " + profile.error().message());
  o.relay.profile = std::move(*profile);
  if (o.relay.profile.name.empty()) o.relay.profile.name = raw.profile;
  if (o.mode == Mode::kRelay) apply_relay(raw, o);
  if (o.mode == Mode::kDraw) apply_draw(raw, o);
}

}  // namespace

NetsimOptions parse_netsim_options(int argc, const char* const* argv) {
  NetsimOptions options;
  Raw raw;
  CLI::App app{"atlas-netsim: puts a bad network between any client and any server, live, from seeded models",
               "atlas-netsim"};
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("atlas-netsim ") + kVersion);
  app.set_config("--config", "", "Read options from this TOML file; the command line wins");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.option_defaults()->always_capture_default();
  add_relay_options(app, options, raw);
  add_profile_options(app, options, raw);
  add_report_options(app, options, raw);
  add_virtual_options(app, options, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    options.text = app.help();
    return options;
  } catch (const CLI::CallForVersion&) {
    options.text = app.version() + "\n";
    return options;
  } catch (const CLI::ParseError& e) {
    throw ProgramError(ExitCode::kUsage, std::string(e.what()) + "; see atlas-netsim --help");
  }
  apply(raw, options);
  return options;
}

}  // namespace atlaswire::netsim
