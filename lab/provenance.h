#pragma once

#include <string>
#include <utility>
#include <vector>

namespace atlaswire::lab {

/// The commit that this program was built at: "1a2b3c4d5e6f", "1a2b3c4d5e6f+dirty.9f8e7d6c" (what differs is
/// hashed), or "unknown" outside of a repository. Points of different commits never mix.
std::string build_commit();

/// Facts by name, in a fixed order, for provenance and never for tables.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// What this program and this machine are: version, commit, build type, compiler, processor, cores, operating
/// system, and the libraries of the encoder as they are loaded.
Facts program_facts();

/// Now, in UTC: "2026-11-22T07:30:00Z".
std::string utc_now();

}  // namespace atlaswire::lab
