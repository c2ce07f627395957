#include "netsim/profile.h"

#include <charconv>

namespace atlaswire::netsim {

namespace {

constexpr std::size_t kMaxOpportunities = 4'000'000;
constexpr std::int64_t kMaxMilliseconds = 86'400'000;

std::string_view next_line(std::string_view& text) {
  const auto end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace

Result<RateModel> parse_trace(std::string_view text) {
  RateModel model;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::string_view line = next_line(text);
    ++number;
    if (line.empty()) continue;
    const auto bad = [&](const char* why) {
      return Error{ProfileError::kBadTrace, "line " + std::to_string(number) + " " + why};
    };
    std::int64_t ms = 0;
    const auto [end, ec] = std::from_chars(line.data(), line.data() + line.size(), ms);
    if (ec != std::errc{} || end != line.data() + line.size())
      return bad("is not a whole number of milliseconds");
    if (ms < 0 || ms > kMaxMilliseconds) return bad("is outside 0 to 86400000 ms");
    const Duration at = std::chrono::milliseconds(ms);
    if (!model.trace.empty() && at < model.trace.back()) return bad("goes back in time");
    if (model.trace.size() == kMaxOpportunities) return bad("exceeds 4000000 opportunities");
    model.trace.push_back(at);
  }
  if (model.trace.empty()) return Error{ProfileError::kBadTrace, "no packet opportunity in it"};
  model.trace_period = model.trace.back();
  if (model.trace_period <= Duration::zero())
    return Error{ProfileError::kBadTrace, "its last line is 0 ms: zero length"};
  return model;
}

const char* error_text(ProfileError e) {
  switch (e) {
    case ProfileError::kSyntax:
      return "not valid TOML";
    case ProfileError::kUnknownKey:
      return "unknown key; docs/NETSIM.md lists them";
    case ProfileError::kOutOfRange:
      return "value out of range";
    case ProfileError::kUnknownName:
      return "unknown profile; `atlas-netsim --list` names the shipped ones, or give a .toml file";
    case ProfileError::kCannotRead:
      return "cannot be read";
    case ProfileError::kBadTrace:
      return "not a packet delivery trace";
    case ProfileError::kBadLog:
      return "not a decision log";
  }
  return "unknown profile error";
}

}  // namespace atlaswire::netsim
