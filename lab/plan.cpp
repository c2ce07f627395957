#include "lab/plan.h"

#include "lab/keys.h"
#include "lab/lab_error.h"
#include "lab/point_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

namespace atlaswire::lab {
namespace {

constexpr std::size_t kMostPoints = 100'000;

/// The experiment after --quick, --set, --only and --scene.
struct Cut {
  std::vector<Assignment> settings;
  std::vector<SceneChoice> scenes;
  std::vector<Variant> variants;
  std::vector<Axis> sweep;
  std::vector<Axis> around;
};

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const auto end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

Axis* axis_of(std::vector<Axis>& axes, std::string_view key) {
  const auto found = std::find_if(axes.begin(), axes.end(), [&](const Axis& a) { return a.key == key; });
  return found == axes.end() ? nullptr : &*found;
}

void apply_quick(const QuickCut& quick, Cut& cut) {
  cut.settings.insert(cut.settings.end(), quick.settings.begin(), quick.settings.end());
  for (const Axis& axis : quick.sweep) {
    if (Axis* old = axis_of(cut.sweep, axis.key)) {
      old->values = axis.values;
    } else {
      cut.sweep.push_back(axis);
    }
  }
  if (!quick.around.empty()) cut.around = quick.around;
  std::erase_if(cut.variants, [&](const Variant& v) {
    return !quick.variants.empty() &&
           std::find(quick.variants.begin(), quick.variants.end(), v.name) == quick.variants.end();
  });
}

std::optional<Error> keep_only(const std::vector<std::string>& only, Cut& cut) {
  if (only.empty()) return std::nullopt;
  std::string known;
  for (const Variant& v : cut.variants) known += (known.empty() ? "'" : ", '") + v.name + "'";
  for (const std::string& name : only) {
    const auto same = [&](const Variant& v) { return v.name == name; };
    if (std::none_of(cut.variants.begin(), cut.variants.end(), same)) {
      return Error{
          LabError::kNotFound,
          fmt::format("--only {}: {}", name, known.empty() ? "there are no variants" : "there are " + known)};
    }
  }
  std::erase_if(cut.variants,
                [&](const Variant& v) { return std::find(only.begin(), only.end(), v.name) == only.end(); });
  return std::nullopt;
}

/// `--set latency_ms=50` or `--set latency_ms=0,50`. A key that variants set is theirs: their names would
/// lie.
std::optional<Error> apply_set(const std::string& text, Cut& cut) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) return Error{LabError::kSyntax, "--set " + text + ": must be key=value"};
  const std::string key = text.substr(0, equals);
  std::vector<std::string> values = split(std::string_view(text).substr(equals + 1), ',');
  for (std::string& value : values) {
    PointSettings scratch;
    if (auto set = set_value(key, value, scratch); set.has_error())
      return Error{set.error().code, "--set " + set.error().detail};
    value = value_text(*find_key(key), scratch);
  }
  for (const Variant& v : cut.variants) {
    const auto same = [&](const Assignment& a) { return a.first == key; };
    if (std::any_of(v.settings.begin(), v.settings.end(), same)) {
      return Error{
          LabError::kOutOfRange,
          fmt::format("--set {}: variant '{}' sets {} itself; leave it out with --only, or change a copy "
                      "of the experiment (atlas-lab show)",
                      text, v.name, key)};
    }
  }
  std::erase_if(cut.around, [&](const Axis& a) { return a.key == key; });
  if (Axis* axis = axis_of(cut.sweep, key)) {
    axis->values = std::move(values);
  } else if (values.size() == 1) {
    cut.settings.emplace_back(key, values[0]);
  } else {
    cut.sweep.push_back({key, std::move(values)});
  }
  return std::nullopt;
}

Result<Cut> cut_of(const Experiment& e, const PlanRequest& request) {
  Cut cut{e.settings, request.scenes.empty() ? e.scenes : request.scenes, e.variants, e.sweep, e.around};
  if (request.quick) apply_quick(e.quick, cut);
  if (auto error = keep_only(request.only, cut)) return *error;
  for (const std::string& text : request.set) {
    if (auto error = apply_set(text, cut)) return *error;
  }
  return cut;
}

/// The values were checked when they were read.
void assign_all(const std::vector<Assignment>& settings, PointSettings& out) {
  for (const auto& [key, text] : settings) set_value(key, text, out).value();
}

/// Makes points; remembers hashes of files, which many points share.
class Expander {
 public:
  Expander(const Cut& cut, const PlanRequest& request, bool live)
      : cut_(cut), request_(request), live_(live) {}

  std::optional<Error> add_scenes(const PointSettings& base) {
    if (cut_.scenes.empty()) return add_variants(base);
    for (const SceneChoice& choice : cut_.scenes) {
      PointSettings settings = base;
      settings.scene = choice.scene;
      settings.path = choice.path.empty() ? own_path(choice.scene) : choice.path;
      if (auto error = add_variants(settings)) return error;
    }
    return std::nullopt;
  }
  std::vector<PlannedPoint> take() { return std::move(points_); }

 private:
  std::optional<Error> add_variants(const PointSettings& base) {
    if (cut_.variants.empty()) return add_sweep(base, "", 0);
    for (const Variant& variant : cut_.variants) {
      PointSettings settings = base;
      assign_all(variant.settings, settings);
      if (auto error = add_sweep(settings, variant.name, 0)) return error;
    }
    return std::nullopt;
  }

  std::optional<Error> add_sweep(const PointSettings& base, const std::string& variant, std::size_t depth) {
    if (depth == cut_.sweep.size()) return add_around(base, variant);
    const Axis& axis = cut_.sweep[depth];
    for (const std::string& value : axis.values) {
      PointSettings settings = base;
      set_value(axis.key, value, settings).value();
      if (auto error = add_sweep(settings, variant, depth + 1)) return error;
    }
    return std::nullopt;
  }

  std::optional<Error> add_around(const PointSettings& base, const std::string& variant) {
    if (auto error = add(base, variant, "")) return error;
    for (const Axis& axis : cut_.around) {
      const std::string own = value_text(*find_key(axis.key), base);
      for (const std::string& value : axis.values) {
        if (value == own) continue;
        PointSettings settings = base;
        set_value(axis.key, value, settings).value();
        if (auto error = add(settings, variant, axis.key)) return error;
      }
    }
    return std::nullopt;
  }

  std::optional<Error> add(PointSettings settings, const std::string& variant, const std::string& varied) {
    if (points_.size() == kMostPoints) {
      return Error{LabError::kOutOfRange, fmt::format("more than {} points: take fewer values", kMostPoints)};
    }
    if (auto ok = check_together(settings); ok.has_error()) return ok.error();
    const auto files = resolve_files(settings, request_.folder, hashes_);
    if (files.has_error()) return files.error();
    std::string text = (live_ ? "live\n" : "") + *files;
    for (const auto& [key, value] : all_values(settings)) {
      if (key != "scene" && key != "path" && key != "profile") text += key + "=" + value + "\n";
    }
    points_.push_back({text_hash(text), variant, varied, std::move(settings)});
    return std::nullopt;
  }

  const Cut& cut_;
  const PlanRequest& request_;
  bool live_;
  FileHashes hashes_;
  std::vector<PlannedPoint> points_;
};

}  // namespace

std::string text_hash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return fmt::format("{:016x}", hash);
}

Plan plan_of(std::vector<PlannedPoint> points) {
  Plan plan{std::move(points), {}, {}};
  for (const Key& key : keys()) {
    std::string first;
    std::map<std::string, std::string> first_of_variant;
    bool varies = false;
    bool tells = false;
    for (const PlannedPoint& p : plan.points) {
      const std::string text = value_text(key, p.settings);
      if (&p == &plan.points.front()) first = text;
      varies = varies || text != first;
      tells = tells || text != first_of_variant.emplace(p.variant, text).first->second;
    }
    if (varies) plan.varying.emplace_back(key.name);
    if (tells) plan.telling.emplace_back(key.name);
  }
  return plan;
}

std::string settings_text(const PointSettings& settings, const std::vector<std::string>& keys) {
  std::string text;
  for (const std::string& key : keys) {
    text += (text.empty() ? "" : ", ") + key + " " + value_text(*find_key(key), settings);
  }
  return text;
}

std::string label(const PlannedPoint& point, const Plan& plan) {
  std::vector<std::string> telling;
  for (const std::string& key : plan.telling) {
    const auto changed_alone = [&](const PlannedPoint& p) { return p.varied == key; };
    const bool around = std::any_of(plan.points.begin(), plan.points.end(), changed_alone);
    if (!around || point.varied == key) telling.push_back(key);
  }
  const std::string told = settings_text(point.settings, telling);
  const std::string text = point.variant + (point.variant.empty() || told.empty() ? "" : ", ") + told;
  return text.empty() ? "base" : text;
}

Result<Plan> make_plan(const Experiment& experiment, const PlanRequest& request) {
  const auto cut = cut_of(experiment, request);
  if (cut.has_error()) return cut.error();
  PointSettings base;
  assign_all(cut->settings, base);
  Expander expander(*cut, request, experiment.live);
  if (auto error = expander.add_scenes(base)) return *error;
  return plan_of(expander.take());
}

}  // namespace atlaswire::lab
