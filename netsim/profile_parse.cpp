#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>

// toml++ asserts, or with NDEBUG tells the optimizer to assume, what bad input breaks ("[" and a new line),
// and then handles it all the same. Neither, please.
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#include "netsim/profile.h"

#include <toml++/toml.h>

namespace atlaswire::netsim {

namespace {

constexpr double kMaxMs = 3'600'000;
constexpr double kMaxKilobytes = 4'194'304;
constexpr double kMaxMbps = 1'000'000;

/// Reads one table's keys, remembering the first failure; a key nobody asked for is a failure too.
class TableReader {
 public:
  TableReader(const toml::table& table, std::string where) : table_(table), where_(std::move(where)) {}

  void number(const char* key, double& out, double low, double high) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto v = node->value<double>();
    if (!v || !(*v >= low && *v <= high)) {
      return fail(ProfileError::kOutOfRange,
                  std::string(key) + " must be a number from " + text(low) + " to " + text(high));
    }
    out = *v;
  }
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
  void flag(const char* key, bool& out) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto v = node->value_exact<bool>();
    if (!v) return fail(ProfileError::kOutOfRange, std::string(key) + " must be true or false");
    out = *v;
  }
  void word(const char* key, std::string& out) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto v = node->value_exact<std::string>();
    if (!v) return fail(ProfileError::kOutOfRange, std::string(key) + " must be text");
    out = *v;
  }
  template <class Enum>
  void choice(const char* key, Enum& out, std::initializer_list<std::pair<const char*, Enum>> choices) {
    std::string name;
    word(key, name);
    if (name.empty()) return;
    std::string known;
    for (const auto& [text, v] : choices) {
      if (name == text) {
        out = v;
        return;
      }
      known += known.empty() ? text : std::string(", ") + text;
    }
    fail(ProfileError::kOutOfRange, std::string(key) + " must be one of " + known);
  }
  const toml::array* array(const char* key) {
    const toml::node* node = find(key);
    if (!node) return nullptr;
    if (!node->is_array()) fail(ProfileError::kOutOfRange, std::string(key) + " must be an array");
    return node->as_array();
  }
  const toml::table* table(const char* key) {
    const toml::node* node = find(key);
    if (!node) return nullptr;
    if (!node->is_table()) fail(ProfileError::kOutOfRange, std::string(key) + " must be a table");
    return node->as_table();
  }
  [[nodiscard]] std::string at(const char* key) const { return where_ + key + "."; }

  void fail(ProfileError code, const std::string& what) {
    if (!error_) error_ = Error{code, where_ + what};
  }
  /// The first failure, or a key that was never asked for.
  std::optional<Error> finish() {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (!error_ && std::find(known_.begin(), known_.end(), name) == known_.end()) {
        error_ = Error{ProfileError::kUnknownKey, where_ + name};
      }
    }
    return error_;
  }

 private:
  const toml::node* find(const char* key) {
    known_.emplace_back(key);
    return table_.get(key);
  }
  static std::string text(double v) {
    std::string s = std::to_string(v);
    s.erase(s.find_last_not_of('0') + 1);
    if (s.back() == '.') s.pop_back();
    return s;
  }

  const toml::table& table_;
  std::string where_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
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
  if (const toml::array* samples = r.array("samples_ms")) {
    m.samples.clear();
    for (const toml::node& node : *samples) {
      const double ms = node.value<double>().value_or(-1);
      if (!(ms >= 0 && ms <= kMaxMs)) {
        r.fail(ProfileError::kOutOfRange, "samples_ms must hold numbers from 0 to 3600000");
        break;
      }
      m.samples.push_back(from_seconds(ms * 1e-3));
    }
    std::sort(m.samples.begin(), m.samples.end());
  }
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
  if (const toml::array* list = r.array("packets")) {
    m.list.clear();
    for (const toml::node& node : *list) {
      const std::int64_t packet = node.value_exact<std::int64_t>().value_or(-1);
      if (packet < 0) r.fail(ProfileError::kOutOfRange, "packets must hold whole numbers from 0");
      m.list.push_back(static_cast<std::uint64_t>(packet));
    }
    std::sort(m.list.begin(), m.list.end());
  }
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
  if (const toml::array* steps = r.array("step")) {
    for (const toml::node& node : *steps) {
      const toml::table* table = node.as_table();
      if (!table) return Error{ProfileError::kSyntax, where + "step must be an array of tables"};
      if (auto e = read_step(*table, where + "step.", directory, out)) return e;
    }
  }
  return r.finish();
}

}  // namespace

Result<Profile> parse_profile(std::string_view toml, const std::string& origin,
                              const std::string& directory) {
  // toml++ 3.3 has undefined behaviour on letters beyond ASCII outside of strings, so none may get that far.
  const auto foreign =
      std::find_if(toml.begin(), toml.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
  if (foreign != toml.end()) {
    const auto line = 1 + std::count(toml.begin(), foreign, '\n');
    return Error{ProfileError::kSyntax, origin + " line " + std::to_string(line) + ": only ASCII is allowed"};
  }
  const toml::parse_result parsed = toml::parse(toml, origin);
  if (!parsed) {
    const auto& e = parsed.error();
    return Error{ProfileError::kSyntax, origin + " line " + std::to_string(e.source().begin.line) + ": " +
                                            std::string(e.description())};
  }
  Profile profile;
  TableReader r(parsed.table(), origin + ": ");
  r.word("name", profile.name);
  r.word("description", profile.description);
  r.word("source", profile.source);
  profile.up.steps.assign(1, {});
  profile.down.steps.assign(1, {});
  if (const toml::table* both = r.table("both")) {
    if (auto e = read_link(*both, r.at("both"), directory, profile.up)) return *e;
    profile.down = profile.up;
  }
  const toml::table* up = r.table("up");
  const toml::table* down = r.table("down");
  if (up) {
    if (auto e = read_link(*up, r.at("up"), directory, profile.up)) return *e;
  }
  if (down) {
    if (auto e = read_link(*down, r.at("down"), directory, profile.down)) return *e;
  }
  if (auto e = r.finish()) return *e;
  return profile;
}

}  // namespace atlaswire::netsim
