#include "netsim/profile.h"

#include <algorithm>

namespace atlaswire::netsim {

bool FlowRule::matches(FlowId flow, FlowKind flow_kind) const {
  if (kind && *kind != flow_kind) return false;
  return numbers.empty() ||
         std::binary_search(numbers.begin(), numbers.end(), static_cast<std::uint32_t>(flow));
}

PathId Profile::path_of(FlowId flow, FlowKind kind) const {
  for (std::size_t i = 0; i < flows.size(); ++i) {
    if (flows[i].matches(flow, kind)) return static_cast<PathId>(i + 1);
  }
  return PathId{0};
}

const LinkProfile& Profile::link(PathId path, Direction direction) const {
  const bool is_up = direction == Direction::kUp;
  if (path == PathId{0}) return is_up ? up : down;
  const FlowRule& rule = flows.at(static_cast<std::size_t>(path) - 1);
  return is_up ? rule.up : rule.down;
}

}  // namespace atlaswire::netsim
