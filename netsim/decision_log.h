#pragma once

#include "base/result.h"
#include "netsim/emulator.h"

#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::netsim {

/// First line of a decision log.
std::string_view decision_log_header();
/// One line of a decision log, without its end: direction, packet, flow, size, three times in nanoseconds
/// since the run's start, fate, and the flags. Equal decisions give equal lines.
std::string format_decision(const DirectedDecision& d, Time start);
/// The way back, sorted by `sort_log`; the error names the line, or the packet that is missing or out of
/// order.
Result<std::vector<DirectedDecision>> parse_decision_log(std::string_view text);

/// Runs a log's arrivals through a fresh path in virtual time: the decisions that profile and seed give them.
/// Equal to the log (both sorted by direction, packet, duplicate) exactly when it was made by that profile
/// and seed.
std::vector<DirectedDecision> replay(const std::vector<DirectedDecision>& log, const Profile& profile,
                                     std::uint64_t seed);

/// Order for comparing: direction, packet, duplicate.
void sort_log(std::vector<DirectedDecision>& log);

}  // namespace atlaswire::netsim
