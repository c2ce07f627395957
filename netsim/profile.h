#pragma once

#include "base/error_enum.h"
#include "base/result.h"
#include "netsim/link_profile.h"
#include "netsim/packet.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::netsim {

/// Flows that take a path of their own: their rate, queue and chances are not shared with other flows. All
/// flows of one rule share its path.
struct FlowRule {
  std::optional<FlowKind> kind;        ///< none: both kinds
  std::vector<std::uint32_t> numbers;  ///< of flows, ascending; empty: all
  LinkProfile up;
  LinkProfile down;
  [[nodiscard]] bool matches(FlowId flow, FlowKind flow_kind) const;
};

/// A duplex path by name, with the source of its figures.
struct Profile {
  static constexpr std::size_t kMostRules = 16;

  std::string name;
  std::string description;
  std::string source;
  LinkProfile up;               ///< client to server
  LinkProfile down;             ///< server to client
  std::vector<FlowRule> flows;  ///< the first that matches counts; flows without one share `up` and `down`

  /// The path that a flow takes.
  [[nodiscard]] PathId path_of(FlowId flow, FlowKind kind) const;
  /// Paths there are, at least the shared one: PathId{0} up to here.
  [[nodiscard]] std::uint32_t paths() const { return static_cast<std::uint32_t>(flows.size()) + 1; }
  [[nodiscard]] const LinkProfile& link(PathId path, Direction direction) const;
};

/// From TOML text (docs/NETSIM.md gives the keys); `origin` names the file in errors. Trace files are
/// read relative to `directory`.
Result<Profile> parse_profile(std::string_view toml, const std::string& origin, const std::string& directory);

/// A shipped profile by name, or a file when the name ends in ".toml".
Result<Profile> load_profile(const std::string& name_or_file);

/// Names of the shipped profiles, ascending.
std::vector<std::string> shipped_profiles();
/// The TOML text of a shipped profile; empty: no such name.
std::string_view shipped_profile_text(std::string_view name);

/// mahimahi's format: one line a packet opportunity, whole milliseconds, not descending. The period is
/// the last line's time; it must be positive.
Result<RateModel> parse_trace(std::string_view text);

/// Why a profile or trace cannot be used.
enum class ProfileError {
  kSyntax = 1,
  kUnknownKey,
  kOutOfRange,
  kUnknownName,
  kCannotRead,
  kBadTrace,
  kBadLog
};
const char* error_text(ProfileError e);

}  // namespace atlaswire::netsim
ATLASWIRE_ERROR_ENUM(netsim, ProfileError);
