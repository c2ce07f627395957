#pragma once

#include "base/result.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// toml++ asserts, or with NDEBUG tells the optimizer to assume, what bad input breaks ("[" and a new line),
// and then handles it all the same. Neither, please.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace atlaswire {

/// TOML text (ASCII only) to its table; `origin` names the file in errors, which give the line. `Code` is the
/// caller's error enum and has kSyntax.
template <class Code>
Result<toml::table> parse_toml(std::string_view text, const std::string& origin) {
  // toml++ 3.3 has undefined behaviour on letters beyond ASCII outside of strings, so none may get that far.
  const auto foreign =
      std::find_if(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
  if (foreign != text.end()) {
    const auto line = 1 + std::count(text.begin(), foreign, '\n');
    return Error{Code::kSyntax, origin + " line " + std::to_string(line) + ": only ASCII is allowed"};
  }
  toml::parse_result parsed = toml::parse(text, origin);
  if (!parsed) {
    const auto& e = parsed.error();
    return Error{Code::kSyntax, origin + " line " + std::to_string(e.source().begin.line) + ": " +
                                    std::string(e.description())};
  }
  return std::move(parsed).table();
}

/// Reads one table's keys, remembering the first failure; a key nobody asked for is a failure too. `Code` is
/// the caller's error enum and has kOutOfRange and kUnknownKey.
template <class Code>
class TomlReader {
 public:
  /// `where` is put before the key in errors: "file.toml: up."; the table must outlive the reader.
  TomlReader(const toml::table& table, std::string where) : table_(table), where_(std::move(where)) {}

  void number(const char* key, double& out, double low, double high) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto v = node->value<double>();
    if (!v || !(*v >= low && *v <= high)) {
      return fail(Code::kOutOfRange,
                  std::string(key) + " must be a number from " + text(low) + " to " + text(high));
    }
    out = *v;
  }
  void flag(const char* key, bool& out) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto v = node->value_exact<bool>();
    if (!v) return fail(Code::kOutOfRange, std::string(key) + " must be true or false");
    out = *v;
  }
  void word(const char* key, std::string& out) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto v = node->value_exact<std::string>();
    if (!v) return fail(Code::kOutOfRange, std::string(key) + " must be text");
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
    fail(Code::kOutOfRange, std::string(key) + " must be one of " + known);
  }
  /// Nullptr: no such key, or (a failure) not an array.
  const toml::array* array(const char* key) {
    const toml::node* node = find(key);
    if (!node) return nullptr;
    if (!node->is_array()) fail(Code::kOutOfRange, std::string(key) + " must be an array");
    return node->as_array();
  }
  /// Nullptr: no such key, or (a failure) not a table.
  const toml::table* table(const char* key) {
    const toml::node* node = find(key);
    if (!node) return nullptr;
    if (!node->is_table()) fail(Code::kOutOfRange, std::string(key) + " must be a table");
    return node->as_table();
  }
  [[nodiscard]] std::string at(const char* key) const { return where_ + key + "."; }

  void fail(Code code, const std::string& what) {
    if (!error_) error_ = Error{code, where_ + what};
  }
  /// The first failure, or a key that was never asked for.
  std::optional<Error> finish() {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (!error_ && std::find(known_.begin(), known_.end(), name) == known_.end()) {
        error_ = Error{Code::kUnknownKey, where_ + name};
      }
    }
    return error_;
  }

 protected:
  /// Nullptr: no such key. Asked for, it is known to `finish`.
  const toml::node* find(const char* key) {
    known_.emplace_back(key);
    return table_.get(key);
  }

 private:
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

}  // namespace atlaswire
