#pragma once

#include "base/result.h"
#include "lab/point.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace atlaswire::lab {

/// One setting of a point: the one place that knows its name in experiment files, `--set`, CSV columns and
/// JSON, its range and its text. Sides of extents are 16..8192.
struct Key {
  /// Which member it is; also says which texts are values.
  using Member = std::variant<double PointSettings::*, std::uint32_t PointSettings::*,
                              std::uint64_t PointSettings::*, int PointSettings::*, bool PointSettings::*,
                              std::string PointSettings::*, Extent2D PointSettings::*>;
  std::string_view name;
  Member member;
  double low = 0;            ///< of numbers
  double high = 0;           ///< of numbers
  std::string_view choices;  ///< of texts, separated by spaces; empty: any
  std::string_view help;     ///< one line with the unit
};

/// All keys, in the order of PointSettings.
std::span<const Key> keys();
/// Nullptr: no such key.
const Key* find_key(std::string_view name);

/// "0..1000", "true or false", "one of sas, atw": what a value of the key may be.
std::string allowed_text(const Key& key);

/// A value as text that `set_value` takes back exactly.
std::string value_text(const Key& key, const PointSettings& settings);

/// Parses and checks a value. The error names key, text and what is allowed, in one line.
Result<void> set_value(const Key& key, std::string_view text, PointSettings& settings);
/// The same by name; kUnknownKey names the nearest key there is.
Result<void> set_value(std::string_view name, std::string_view text, PointSettings& settings);

/// What single keys cannot say: settings that exclude each other, an atlas that is no multiple of 64.
Result<void> check_together(const PointSettings& settings);

/// Settings by name, in order of `keys()`, as text: the form that is hashed and stored.
std::vector<std::pair<std::string, std::string>> all_values(const PointSettings& settings);

}  // namespace atlaswire::lab
