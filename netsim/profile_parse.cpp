#include "base/toml_reader.h"
#include "netsim/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <type_traits>

namespace atlaswire::netsim {

namespace {

constexpr double kMaxMs = 3'600'000;
constexpr double kMaxKilobytes = 4'194'304;
constexpr double kMaxMbps = 1'000'000;
constexpr std::int64_t kMaxPacket = 1'000'000'000'000'000;
constexpr std::int64_t kMaxFlow = 0xFFFFFFFF;

/// The shared reader, and quantities of profiles.
class TableReader : public TomlReader<ProfileError> {
 public:
  using TomlReader::TomlReader;

  void duration(const char* key, Duration& out, double low_ms = 0) {
    double ms = to_ms(out);
    number(key, ms, low_ms, kMaxMs);
    out = from_seconds(ms * 1e-3);
  }
  void count(const char* key, std::uint64_t& out, std::uint64_t low, std::uint64_t high) {
    double v = static_cast<double>(out);
    number(key, v, static_cast<double>(low), static_cast<double>(high));
    out = static_cast<std::uint64_t>(v);
  }
  void kilobytes(const char* key, Bytes& out) {
    double kb = static_cast<double>(out.count) / 1024;
    number(key, kb, 0, kMaxKilobytes);
    out.count = static_cast<std::uint64_t>(std::llround(kb * 1024));
  }
  /// Numbers from `low` to `high`, of which `convert` makes the elements; they are sorted.
  template <class Number, class T, class Convert>
  void list(const char* key, std::vector<T>& out, Number low, Number high, Convert convert) {
    const toml::array* given = array(key);
    if (!given) return;
    out.clear();
    for (const toml::node& node : *given) {
      const auto v = node.value<Number>();
      if (!v || !(*v >= low && *v <= high)) {
        constexpr const char* kWhole = std::is_integral_v<Number> ? "whole " : "";
        return fail(ProfileError::kOutOfRange,
                    fmt::format("{} must hold {}numbers from {} to {}", key, kWhole, low, high));
      }
      out.push_back(convert(*v));
    }
    std::sort(out.begin(), out.end());
  }
  /// Calls `read`, which gives an optional error, with each table of an array of tables.
  template <class Read>
  std::optional<Error> tables(const char* key, Read read) {
    const toml::array* given = array(key);
    if (!given) return std::nullopt;
    for (const toml::node& node : *given) {
      const toml::table* one = node.as_table();
      if (!one) {
        fail(ProfileError::kOutOfRange, std::string(key) + " must be an array of tables");
        return std::nullopt;
      }
      if (auto e = read(*one, at(key))) return e;
    }
    return std::nullopt;
  }
};

std::optional<Error> read_delay(const toml::table& t, const std::string& where, DelayModel& m) {
  TableReader r(t, where);
  using Shape = DelayModel::Shape;
  r.choice("shape", m.shape,
           {{"constant", Shape::kConstant},
            {"uniform", Shape::kUniform},
            {"normal", Shape::kNormal},
            {"pareto", Shape::kPareto},
            {"empirical", Shape::kEmpirical}});
  r.duration("base_ms", m.base);
  r.duration("spread_ms", m.spread);
  r.number("pareto_alpha", m.pareto_alpha, 1.01, 100);
  r.number("correlation", m.correlation, 0, 0.9999);
  r.duration("hold_ms", m.hold);
  r.duration("most_ms", m.most);
  r.list("samples_ms", m.samples, 0.0, kMaxMs, [](double ms) { return from_seconds(ms * 1e-3); });
  if (m.shape == Shape::kEmpirical && m.samples.empty())
    r.fail(ProfileError::kOutOfRange, "samples_ms must not be empty");
  if (m.shape == Shape::kUniform && m.spread > m.base)
    r.fail(ProfileError::kOutOfRange, "spread_ms must not exceed base_ms");
  return r.finish();
}

std::optional<Error> read_loss(const toml::table& t, const std::string& where, LossModel& m) {
  TableReader r(t, where);
  using Kind = LossModel::Kind;
  r.choice("kind", m.kind,
           {{"none", Kind::kNone},
            {"bernoulli", Kind::kBernoulli},
            {"gilbert-elliott", Kind::kGilbertElliott},
            {"four-state", Kind::kFourState},
            {"periodic", Kind::kPeriodic},
            {"list", Kind::kList}});
  const std::pair<const char*, double*> probabilities[] = {{"probability", &m.probability},
                                                           {"p", &m.p},
                                                           {"r", &m.r},
                                                           {"loss_good", &m.loss_good},
                                                           {"loss_bad", &m.loss_bad},
                                                           {"p13", &m.p13},
                                                           {"p31", &m.p31},
                                                           {"p32", &m.p32},
                                                           {"p23", &m.p23},
                                                           {"p14", &m.p14}};
  for (const auto& [key, out] : probabilities) r.number(key, *out, 0, 1);
  r.count("period", m.period, 1, 1'000'000'000);
  r.count("burst", m.burst, 0, 1'000'000'000);
  r.list("packets", m.list, std::int64_t{0}, kMaxPacket,
         [](std::int64_t packet) { return static_cast<std::uint64_t>(packet); });
  if (m.p13 + m.p14 > 1 || m.p31 + m.p32 > 1)
    r.fail(ProfileError::kOutOfRange, "probabilities of leaving one state exceed 1");
  if (m.kind == Kind::kPeriodic && m.burst > m.period)
    r.fail(ProfileError::kOutOfRange, "burst must not exceed period");
  return r.finish();
}

std::optional<Error> read_rate(const toml::table& t, const std::string& where, const std::string& directory,
                               RateModel& m) {
  TableReader r(t, where);
  m = RateModel{};
  double mbps = -1;
  std::string trace;
  r.number("mbps", mbps, 0, kMaxMbps);
  r.kilobytes("burst_kb", m.burst);
  r.word("trace", trace);
  if (mbps >= 0 && !trace.empty()) r.fail(ProfileError::kOutOfRange, "mbps and trace exclude each other");
  if (mbps >= 0) m.rate = BitRate{static_cast<std::uint64_t>(std::llround(mbps * 1e6))};
  if (!trace.empty()) {
    std::ifstream file(directory + "/" + trace);
    if (!file) {
      r.fail(ProfileError::kCannotRead, "trace file '" + trace + "'");
    } else {
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      auto parsed = parse_trace(text);
      if (parsed.has_error())
        return Error{parsed.error().code, where + "trace '" + trace + "' " + parsed.error().detail};
      m = std::move(*parsed);
    }
  }
  return r.finish();
}

std::optional<Error> read_queue(const toml::table& t, const std::string& where, QueueModel& m) {
  TableReader r(t, where);
  using Policy = QueueModel::Policy;
  r.choice("policy", m.policy,
           {{"drop-tail", Policy::kDropTail},
            {"drop-head", Policy::kDropHead},
            {"codel", Policy::kCodel},
            {"pie", Policy::kPie}});
  m.target = m.policy == Policy::kPie ? std::chrono::milliseconds(15) : std::chrono::milliseconds(5);
  r.kilobytes("limit_kb", m.limit);
  Duration time_limit{-1};
  r.duration("limit_ms", time_limit);
  if (time_limit >= Duration::zero()) m.time_limit = time_limit;
  r.duration("target_ms", m.target, 0.001);
  r.duration("interval_ms", m.interval, 0.001);
  r.flag("ecn", m.ecn);
  return r.finish();
}

/// The keys of one direction or one step, over what held before.
std::optional<Error> read_parameters(TableReader& r, const std::string& directory, LinkParameters& p) {
  const auto part = [&r](const char* key, auto read, auto& model, auto&... extra) -> std::optional<Error> {
    const toml::table* table = r.table(key);
    return table ? read(*table, r.at(key), extra..., model) : std::nullopt;
  };
  if (auto e = part("delay", read_delay, p.delay)) return e;
  if (auto e = part("loss", read_loss, p.loss)) return e;
  if (auto e = part("rate", read_rate, p.rate, directory)) return e;
  if (auto e = part("queue", read_queue, p.queue)) return e;
  r.number("duplicate", p.duplicate, 0, 1);
  r.number("corrupt", p.corrupt, 0, 1);
  r.number("reorder", p.reorder, 0, 1);
  r.count("overhead_bytes", p.overhead.count, 0, 1000);
  return std::nullopt;
}

std::optional<Error> read_step(const toml::table& t, const std::string& where, const std::string& directory,
                               LinkProfile& out) {
  TableReader r(t, where);
  ProfileStep step;
  step.parameters = out.steps.back().parameters;
  r.duration("at_ms", step.at);
  r.flag("down", step.down);
  if (auto e = read_parameters(r, directory, step.parameters)) return e;
  if (step.at <= out.steps.back().at)
    r.fail(ProfileError::kOutOfRange, "at_ms must be after the step before");
  out.steps.push_back(std::move(step));
  return r.finish();
}

std::optional<Error> read_link(const toml::table& t, const std::string& where, const std::string& directory,
                               LinkProfile& out) {
  TableReader r(t, where);
  out.steps.assign(1, {});
  r.flag("down", out.steps[0].down);
  if (auto e = read_parameters(r, directory, out.steps[0].parameters)) return e;
  const auto step = [&](const toml::table& table, const std::string& at) {
    return read_step(table, at, directory, out);
  };
  if (auto e = r.tables("step", step)) return e;
  return r.finish();
}

/// `up` and `down` replace `both` whole; what is not there leaves `up_link` and `down_link` as they are.
std::optional<Error> read_directions(TableReader& r, const std::string& directory, LinkProfile& up_link,
                                     LinkProfile& down_link) {
  if (const toml::table* both = r.table("both")) {
    if (auto e = read_link(*both, r.at("both"), directory, up_link)) return e;
    down_link = up_link;
  }
  if (const toml::table* up = r.table("up")) {
    if (auto e = read_link(*up, r.at("up"), directory, up_link)) return e;
  }
  if (const toml::table* down = r.table("down")) {
    if (auto e = read_link(*down, r.at("down"), directory, down_link)) return e;
  }
  return std::nullopt;
}

std::optional<Error> read_flow_rule(const toml::table& t, const std::string& where,
                                    const std::string& directory, Profile& out) {
  TableReader r(t, where);
  FlowRule rule{.kind = std::nullopt, .numbers = {}, .up = out.up, .down = out.down};
  r.choice("kind", rule.kind, {{"datagram", FlowKind::kDatagram}, {"stream", FlowKind::kStream}});
  r.list("numbers", rule.numbers, std::int64_t{1}, kMaxFlow,
         [](std::int64_t number) { return static_cast<std::uint32_t>(number); });
  if (rule.numbers.empty() && (!rule.kind || t.contains("numbers")))
    r.fail(ProfileError::kOutOfRange, "kind or numbers must say which flows");
  if (auto e = read_directions(r, directory, rule.up, rule.down)) return e;
  if (out.flows.size() == Profile::kMostRules)
    r.fail(ProfileError::kOutOfRange, fmt::format("kind: more than {} rules", Profile::kMostRules));
  out.flows.push_back(std::move(rule));
  return r.finish();
}

}  // namespace

Result<Profile> parse_profile(std::string_view toml, const std::string& origin,
                              const std::string& directory) {
  const auto parsed = parse_toml<ProfileError>(toml, origin);
  if (parsed.has_error()) return parsed.error();
  Profile profile;
  TableReader r(*parsed, origin + ": ");
  r.word("name", profile.name);
  r.word("description", profile.description);
  r.word("source", profile.source);
  profile.up.steps.assign(1, {});
  profile.down.steps.assign(1, {});
  if (auto e = read_directions(r, directory, profile.up, profile.down)) return *e;
  const auto rule = [&](const toml::table& table, const std::string& at) {
    return read_flow_rule(table, at, directory, profile);
  };
  if (auto e = r.tables("flow", rule)) return *e;
  if (auto e = r.finish()) return *e;
  return profile;
}

}  // namespace atlaswire::netsim
