#include "base/toml_reader.h"
#include "lab/experiment.h"
#include "lab/keys.h"
#include "lab/lab_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

namespace atlaswire::lab {
namespace {

constexpr std::size_t kMostValues = 1000;

/// The shared reader, and what experiments are made of.
class Reader : public TomlReader<LabError> {
 public:
  using TomlReader::TomlReader;

  /// An array of texts, or one text.
  void words(const char* key, std::vector<std::string>& out) {
    const toml::node* node = find(key);
    if (!node) return;
    out.clear();
    if (const auto* one = node->as_string()) out.push_back(one->get());
    if (const auto* many = node->as_array()) {
      for (const toml::node& item : *many) {
        if (const auto* text = item.as_string()) out.push_back(text->get());
      }
      if (out.size() != many->size()) out.clear();
    }
    if (out.empty() || out.size() > kMostValues)
      fail(LabError::kOutOfRange, std::string(key) + " must be text or an array of texts");
  }
  void required_word(const char* key, std::string& out) {
    word(key, out);
    if (out.empty()) fail(LabError::kOutOfRange, std::string(key) + " is missing or empty");
  }
  /// Runs `read(table, where)` on each table of an array of tables.
  template <class Read>
  void each_table(const char* key, Read read) {
    const toml::array* list = array(key);
    if (!list) return;
    if (list->size() > kMostValues)
      return fail(LabError::kOutOfRange, std::string(key) + " has too many entries");
    for (const toml::node& node : *list) {
      const toml::table* table = node.as_table();
      if (!table) return fail(LabError::kOutOfRange, std::string(key) + " must be an array of tables");
      take(read(*table, at(key)));
    }
  }
  /// Remembers another reader's failure, which already says where.
  void take(std::optional<Error> error) {
    if (error && !taken_) taken_ = std::move(error);
  }
  std::optional<Error> finish_all() {
    if (taken_) return taken_;
    return finish();
  }

 private:
  std::optional<Error> taken_;
};

/// The table's entries in the order of the file; toml++ sorts them by name.
std::vector<std::pair<std::string, const toml::node*>> in_file_order(const toml::table& table) {
  std::vector<std::pair<std::string, const toml::node*>> entries;
  for (const auto& [key, node] : table) entries.emplace_back(std::string(key.str()), &node);
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    const auto& from = a.second->source().begin;
    const auto& to = b.second->source().begin;
    return std::pair(from.line, from.column) < std::pair(to.line, to.column);
  });
  return entries;
}

/// The node as the text that keys take; nothing if the key wants another type.
std::optional<std::string> text_of(const Key& key, const toml::node& node) {
  return std::visit(
      [&]<class T>(T PointSettings::*) -> std::optional<std::string> {
        if constexpr (std::is_same_v<T, bool>) {
          const auto v = node.value_exact<bool>();
          return v ? std::optional(std::string(*v ? "true" : "false")) : std::nullopt;
        } else if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, Extent2D>) {
          return node.value_exact<std::string>();
        } else {
          if (const auto whole = node.value_exact<std::int64_t>()) return fmt::format("{}", *whole);
          const auto real = node.value_exact<double>();
          return real ? std::optional(fmt::format("{}", *real)) : std::nullopt;
        }
      },
      key.member);
}

/// Checks one value by setting it somewhere; gives its canonical text.
Result<std::string> checked(const std::string& name, const toml::node& node, const std::string& where) {
  PointSettings scratch;
  const Key* key = find_key(name);
  auto error = [&where](Error e) { return Error{e.code, where + e.detail}; };
  if (!key) return error(set_value(name, "", scratch).error());
  const auto text = text_of(*key, node);
  if (!text)
    return Error{LabError::kOutOfRange, fmt::format("{}{} must be {}", where, name, allowed_text(*key))};
  if (auto set = set_value(*key, *text, scratch); set.has_error()) return error(set.error());
  return value_text(*key, scratch);
}

std::optional<Error> read_settings(const toml::table& table, const std::string& where,
                                   std::vector<Assignment>& out) {
  for (const auto& [name, node] : in_file_order(table)) {
    auto text = checked(name, *node, where);
    if (text.has_error()) return text.error();
    out.emplace_back(name, *std::move(text));
  }
  return std::nullopt;
}

std::optional<Error> read_axes(const toml::table& table, const std::string& where, std::vector<Axis>& out) {
  for (const auto& [name, node] : in_file_order(table)) {
    const toml::array* values = node->as_array();
    if (!values || values->empty() || values->size() > kMostValues) {
      return Error{LabError::kOutOfRange, where + name + " must be an array of values, not empty"};
    }
    Axis axis{name, {}};
    for (const toml::node& value : *values) {
      auto text = checked(name, value, where);
      if (text.has_error()) return text.error();
      if (std::find(axis.values.begin(), axis.values.end(), *text) != axis.values.end()) {
        return Error{LabError::kOutOfRange, fmt::format("{}{} has {} twice", where, name, *text)};
      }
      axis.values.push_back(*std::move(text));
    }
    out.push_back(std::move(axis));
  }
  return std::nullopt;
}

std::optional<Error> read_variant(const toml::table& table, const std::string& where, Experiment& out) {
  Variant variant;
  toml::table rest = table;
  const auto name = table["name"].value_exact<std::string>();
  if (!name || name->empty()) return Error{LabError::kOutOfRange, where + "name is missing or empty"};
  variant.name = *name;
  const auto same = [&](const Variant& v) { return v.name == variant.name; };
  if (std::any_of(out.variants.begin(), out.variants.end(), same)) {
    return Error{LabError::kOutOfRange, fmt::format("{}name: '{}' is there twice", where, variant.name)};
  }
  rest.erase("name");
  if (auto e = read_settings(rest, where + "'" + variant.name + "'.", variant.settings)) return e;
  out.variants.push_back(std::move(variant));
  return std::nullopt;
}

std::optional<Error> read_scene(const toml::table& table, const std::string& where, Experiment& out) {
  Reader r(table, where);
  SceneChoice choice;
  r.required_word("scene", choice.scene);
  r.required_word("path", choice.path);
  out.scenes.push_back(std::move(choice));
  return r.finish_all();
}

std::optional<Error> read_plot(const toml::table& table, const std::string& where, Experiment& out) {
  Reader r(table, where);
  Plot plot;
  using Kind = Plot::Kind;
  r.choice(
      "kind", plot.kind,
      {{"line", Kind::kLine}, {"bars", Kind::kBars}, {"stack", Kind::kStack}, {"scatter", Kind::kScatter}});
  r.word("title", plot.title);
  r.required_word("x", plot.x);
  r.words("y", plot.y);
  if (plot.y.empty()) r.fail(LabError::kOutOfRange, "y is missing");
  r.word("series", plot.series);
  r.word("x_label", plot.x_label);
  r.word("y_label", plot.y_label);
  r.flag("log_x", plot.log_x);
  out.plots.push_back(std::move(plot));
  return r.finish_all();
}

std::optional<Error> read_quick(const toml::table& table, const std::string& where, QuickCut& out) {
  Reader r(table, where);
  if (const auto* t = r.table("settings")) r.take(read_settings(*t, r.at("settings"), out.settings));
  if (const auto* t = r.table("sweep")) r.take(read_axes(*t, r.at("sweep"), out.sweep));
  if (const auto* t = r.table("around")) r.take(read_axes(*t, r.at("around"), out.around));
  r.words("variants", out.variants);
  return r.finish_all();
}

std::optional<Error> read_crossover(const toml::table& table, const std::string& where, CrossoverRule& out) {
  Reader r(table, where);
  r.required_word("x", out.x);
  r.required_word("y", out.y);
  r.required_word("reference", out.reference);
  return r.finish_all();
}

std::optional<Error> read_rate(const toml::table& table, const std::string& where, RateRule& out) {
  Reader r(table, where);
  r.required_word("rate", out.rate);
  r.required_word("quality", out.quality);
  r.required_word("reference", out.reference);
  return r.finish_all();
}

std::optional<Error> read_difference(const toml::table& table, const std::string& where,
                                     DifferenceRule& out) {
  Reader r(table, where);
  r.words("y", out.y);
  if (out.y.empty()) r.fail(LabError::kOutOfRange, "y is missing");
  r.required_word("reference", out.reference);
  return r.finish_all();
}

std::optional<Error> read_pareto(const toml::table& table, const std::string& where, ParetoRule& out) {
  Reader r(table, where);
  r.words("most", out.most);
  r.words("least", out.least);
  if (out.most.empty() && out.least.empty()) r.fail(LabError::kOutOfRange, "most or least is missing");
  return r.finish_all();
}

std::optional<Error> read_recommendation(const toml::table& table, const std::string& where,
                                         Experiment& out) {
  Reader r(table, where);
  Recommendation recommendation;
  r.required_word("client", recommendation.client);
  r.required_word("best", recommendation.best);
  if (const auto* limits = r.table("at_most")) {
    for (const auto& [name, node] : in_file_order(*limits)) {
      const double most = node->value<double>().value_or(std::numeric_limits<double>::quiet_NaN());
      if (std::isnan(most)) r.fail(LabError::kOutOfRange, "at_most." + name + " must be a number");
      recommendation.at_most.emplace_back(name, most);
    }
  }
  out.recommendations.push_back(std::move(recommendation));
  return r.finish_all();
}

/// References between parts of the file.
std::optional<Error> check_names(const Experiment& e, const std::string& origin) {
  const auto known = [&](const std::string& name) {
    return std::any_of(e.variants.begin(), e.variants.end(),
                       [&](const Variant& v) { return v.name == name; });
  };
  const auto demand = [&](const std::string& where, const std::string& name) -> std::optional<Error> {
    if (name.empty() || known(name)) return std::nullopt;
    return Error{LabError::kOutOfRange, fmt::format("{}: {}: no variant is named '{}'", origin, where, name)};
  };
  if (auto error = demand("crossover.reference", e.crossover.reference)) return error;
  if (auto error = demand("rate.reference", e.rate.reference)) return error;
  if (auto error = demand("difference.reference", e.difference.reference)) return error;
  for (const std::string& name : e.quick.variants) {
    if (auto error = demand("quick.variants", name)) return error;
  }
  for (const Axis& axis : e.sweep) {
    const auto same = [&](const Axis& other) { return other.key == axis.key; };
    if (std::any_of(e.around.begin(), e.around.end(), same)) {
      return Error{LabError::kOutOfRange,
                   fmt::format("{}: {} is in both sweep and around", origin, axis.key)};
    }
  }
  return std::nullopt;
}

}  // namespace

Result<Experiment> parse_experiment(std::string_view toml, const std::string& origin) {
  const auto parsed = parse_toml<LabError>(toml, origin);
  if (parsed.has_error()) return parsed.error();
  Experiment e;
  Reader r(*parsed, origin + ": ");
  r.required_word("name", e.name);
  r.word("title", e.title);
  r.word("figure", e.figure);
  r.word("notes", e.notes);
  r.choice("kind", e.live, {{"points", false}, {"live", true}});
  if (const auto* t = r.table("settings")) r.take(read_settings(*t, r.at("settings"), e.settings));
  r.each_table("scenes", [&](const auto& t, const auto& where) { return read_scene(t, where, e); });
  r.each_table("variant", [&](const auto& t, const auto& where) { return read_variant(t, where, e); });
  if (const auto* t = r.table("sweep")) r.take(read_axes(*t, r.at("sweep"), e.sweep));
  if (const auto* t = r.table("around")) r.take(read_axes(*t, r.at("around"), e.around));
  if (const auto* t = r.table("quick")) r.take(read_quick(*t, r.at("quick"), e.quick));
  r.each_table("plot", [&](const auto& t, const auto& where) { return read_plot(t, where, e); });
  if (const auto* t = r.table("crossover")) r.take(read_crossover(*t, r.at("crossover"), e.crossover));
  if (const auto* t = r.table("rate")) r.take(read_rate(*t, r.at("rate"), e.rate));
  if (const auto* t = r.table("difference")) r.take(read_difference(*t, r.at("difference"), e.difference));
  if (const auto* t = r.table("pareto")) r.take(read_pareto(*t, r.at("pareto"), e.pareto));
  r.each_table("recommend",
               [&](const auto& t, const auto& where) { return read_recommendation(t, where, e); });
  if (auto error = r.finish_all()) return *error;
  if (auto error = check_names(e, origin)) return *error;
  return e;
}

}  // namespace atlaswire::lab
