#include "lab/analysis.h"

#include "lab/bd_rate.h"
#include "lab/keys.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace atlaswire::lab {
namespace {

using Curve = std::vector<std::pair<double, double>>;  // x and y, ascending in x

/// The curves of one group, by variant.
struct Group {
  std::string name;
  std::map<std::string, Curve> curves;
};

/// Varying keys that neither a variant sets nor `others` holds.
std::vector<std::string> shared_keys(const Experiment& e, const Plan& plan, std::set<std::string> others) {
  for (const Variant& v : e.variants) {
    for (const Assignment& a : v.settings) others.insert(a.first);
  }
  std::vector<std::string> keys;
  for (const std::string& key : plan.varying) {
    if (!others.contains(key)) keys.push_back(key);
  }
  return keys;
}

/// Keys that tell groups of curves over `x` apart. Where x is a figure, the axis behind it is every swept
/// key.
std::vector<std::string> group_keys(const Experiment& e, const Plan& plan, const std::string& x) {
  std::set<std::string> others{x};
  if (!find_key(x)) {
    for (const Axis& axis : e.sweep) others.insert(axis.key);
  }
  return shared_keys(e, plan, std::move(others));
}

std::vector<Group> groups_of(const Experiment& e, const Plan& plan, const std::vector<Row>& rows,
                             const std::string& x, const std::string& y) {
  const std::vector<std::string> keys = group_keys(e, plan, x);
  std::vector<Group> groups;
  for (const Row& row : rows) {
    const std::string name = settings_text(row.point.settings, keys);
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.name == name; });
    if (group == groups.end()) group = groups.insert(groups.end(), {name, {}});
    const double at = number_of(row, x);
    const double value = number_of(row, y);
    if (std::isfinite(at) && std::isfinite(value)) group->curves[row.point.variant].emplace_back(at, value);
  }
  for (Group& group : groups) {
    for (auto& [variant, curve] : group.curves) std::sort(curve.begin(), curve.end());
  }
  return groups;
}

/// Where reference minus other changes sign, over the x that both have.
Crossover crossover(const Curve& reference, const Curve& other) {
  Crossover c;
  Curve difference;
  for (const auto& [x, y] : reference) {
    const auto same = std::lower_bound(other.begin(), other.end(), std::pair(x, -HUGE_VAL));
    if (same != other.end() && same->first == x) difference.emplace_back(x, y - same->second);
  }
  c.reference_first = !difference.empty() && difference.front().second > 0;
  for (std::size_t i = 1; i < difference.size(); ++i) {
    const auto& [x0, d0] = difference[i - 1];
    const auto& [x1, d1] = difference[i];
    if ((d0 > 0) == (d1 > 0)) continue;
    c.at.push_back({x0 + (x1 - x0) * d0 / (d0 - d1), d1 > 0});
  }
  return c;
}

std::vector<Crossover> crossovers(const Experiment& e, const Plan& plan, const std::vector<Row>& rows) {
  const CrossoverRule& rule = e.crossover;
  std::vector<Crossover> found;
  if (rule.reference.empty()) return found;
  for (const Group& group : groups_of(e, plan, rows, rule.x, rule.y)) {
    const auto reference = group.curves.find(rule.reference);
    if (reference == group.curves.end()) continue;
    for (const Variant& v : e.variants) {
      const auto other = group.curves.find(v.name);
      if (v.name == rule.reference || other == group.curves.end()) continue;
      Crossover c = crossover(reference->second, other->second);
      c.group = group.name;
      c.variant = v.name;
      found.push_back(std::move(c));
    }
  }
  return found;
}

std::vector<RatePoint> rate_points(const Curve& curve) {
  std::vector<RatePoint> points;
  for (const auto& [rate, quality] : curve) points.push_back({rate, quality});
  return points;
}

std::vector<RateDifference> rate_differences(const Experiment& e, const Plan& plan,
                                             const std::vector<Row>& rows) {
  const RateRule& rule = e.rate;
  std::vector<RateDifference> differences;
  if (rule.reference.empty()) return differences;
  for (const Group& group : groups_of(e, plan, rows, rule.rate, rule.quality)) {
    const auto reference = group.curves.find(rule.reference);
    if (reference == group.curves.end()) continue;
    const std::vector<RatePoint> anchor = rate_points(reference->second);
    for (const Variant& v : e.variants) {
      const auto other = group.curves.find(v.name);
      if (v.name == rule.reference || other == group.curves.end()) continue;
      const std::vector<RatePoint> test = rate_points(other->second);
      const auto rate = bd_rate(anchor, test);
      const auto quality = bd_quality(anchor, test);
      RateDifference d{group.name, v.name, kNotApplicable, kNotApplicable, {}};
      if (rate.has_value()) d.rate_percent = *rate;
      if (quality.has_value()) d.quality = *quality;
      if (rate.has_error()) d.why = rate.error().message();
      differences.push_back(std::move(d));
    }
  }
  return differences;
}

/// Differences in one y among the rows of a group, the reference's first.
void add_differences(const DifferenceRule& rule, const std::string& y, const std::vector<const Row*>& group,
                     const std::string& name, std::vector<Difference>& out) {
  const auto reference =
      std::ranges::find_if(group, [&](const Row* r) { return r->point.variant == rule.reference; });
  if (reference == group.end()) return;
  const double base = number_of(**reference, y);
  out.push_back({name, rule.reference, y, base, 0});
  for (const Row* row : group) {
    const double value = number_of(*row, y);
    if (row == *reference || std::isnan(value)) continue;
    out.push_back({name, row->point.variant, y, value, value - base});
  }
}

std::vector<Difference> differences(const Experiment& e, const Plan& plan, const std::vector<Row>& rows) {
  std::vector<Difference> found;
  if (e.difference.reference.empty()) return found;
  const std::vector<std::string> keys = shared_keys(e, plan, {});
  std::vector<std::string> names;
  std::map<std::string, std::vector<const Row*>> groups;
  for (const Row& row : rows) {
    const std::string name = settings_text(row.point.settings, keys);
    if (!groups.contains(name)) names.push_back(name);
    groups[name].push_back(&row);
  }
  for (const std::string& name : names) {
    for (const std::string& y : e.difference.y) add_differences(e.difference, y, groups[name], name, found);
  }
  return found;
}

/// At least as good in everything, and better in something.
bool dominates(const Row& a, const Row& b, const ParetoRule& rule) {
  bool better = false;
  const auto no_worse = [&](double good, double other) {
    better = better || good > other;
    return good >= other;
  };
  const auto more = [&](const std::string& name) { return no_worse(number_of(a, name), number_of(b, name)); };
  const auto less = [&](const std::string& name) {
    return no_worse(-number_of(a, name), -number_of(b, name));
  };
  return std::all_of(rule.most.begin(), rule.most.end(), more) &&
         std::all_of(rule.least.begin(), rule.least.end(), less) && better;
}

bool has_all(const Row& row, const ParetoRule& rule) {
  const auto known = [&](const std::string& name) { return !std::isnan(number_of(row, name)); };
  return std::all_of(rule.most.begin(), rule.most.end(), known) &&
         std::all_of(rule.least.begin(), rule.least.end(), known);
}

std::vector<std::string> pareto_front(const ParetoRule& rule, const std::vector<Row>& rows) {
  std::vector<std::string> front;
  if (rule.most.empty() && rule.least.empty()) return front;
  for (const Row& row : rows) {
    if (!has_all(row, rule)) continue;
    const auto beats = [&](const Row& other) { return has_all(other, rule) && dominates(other, row, rule); };
    const bool seen = std::find(front.begin(), front.end(), row.point.id) != front.end();
    if (!seen && std::none_of(rows.begin(), rows.end(), beats)) front.push_back(row.point.id);
  }
  return front;
}

Advice advise(const Recommendation& wish, const Plan& plan, const std::vector<Row>& rows) {
  Advice advice{wish.client, {}, {}};
  double best = kNotApplicable;
  for (const Row& row : rows) {
    const auto within = [&](const auto& limit) { return number_of(row, limit.first) <= limit.second; };
    const double value = number_of(row, wish.best);
    if (!std::all_of(wish.at_most.begin(), wish.at_most.end(), within) || std::isnan(value)) continue;
    if (!std::isnan(best) && value <= best) continue;
    best = value;
    advice.id = row.point.id;
    advice.label = label(row.point, plan);
  }
  return advice;
}

}  // namespace

Analysis analyse(const Experiment& experiment, const Plan& plan, const std::vector<Row>& rows) {
  Analysis a;
  a.crossovers = crossovers(experiment, plan, rows);
  a.rates = rate_differences(experiment, plan, rows);
  a.differences = differences(experiment, plan, rows);
  a.front = pareto_front(experiment.pareto, rows);
  for (const Recommendation& wish : experiment.recommendations) a.advice.push_back(advise(wish, plan, rows));
  return a;
}

}  // namespace atlaswire::lab
