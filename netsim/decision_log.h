#pragma once

#include "base/result.h"
#include "netsim/emulator.h"

#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::netsim {

/// First line of a decision log.
std::string_view decision_log_header();
/// One line of a decision log, without its end: direction, path, packet, flow, size, ECN bits, three times in
/// nanoseconds since the run's start, fate, and the flags. Equal decisions give equal lines.
std::string format_decision(const DirectedDecision& d, Time start);
/// The way back, sorted by `sort_log`; the error names the line, or the packet that is missing or out of
/// order.
Result<std::vector<DirectedDecision>> parse_decision_log(std::string_view text);

/// Runs a log's arrivals through fresh paths in virtual time: the decisions that profile and seed give them.
/// Equal to the log (both sorted by `sort_log`) exactly when links of that profile and seed made it; arrivals
/// on a path that the profile does not have are left out.
std::vector<DirectedDecision> replay(const std::vector<DirectedDecision>& log, const Profile& profile,
                                     std::uint64_t seed);

/// Order for comparing: direction, path, packet, duplicate.
void sort_log(std::vector<DirectedDecision>& log);

}  // namespace atlaswire::netsim
