#include "codec/gate_table.h"

#include <algorithm>
#include <cstddef>

namespace atlaswire::codec {

void GateTable::clear() {
  index_.clear();
  links_.clear();
  unused_.clear();
  ends_.clear();
}

void GateTable::add(const Outline& patch) {
  for (std::uint32_t i = 0; i < patch.count; ++i) {
    const std::uint32_t from = patch.at(i);
    const std::uint32_t to = patch.at(i + 1);
    if (from == to) continue;
    if (const std::uint32_t filled = find(from, to); filled != kNone) {
      close(filled);
    } else if (find(to, from) == kNone) {
      open({.from = to,
            .to = from,
            .behind_from = patch.at(i + 2),
            .behind_to = patch.at(i + patch.count - 1)});
    }
  }
}

/// Most vertices have no gate or one, and lie close together in memory; an index does not.
std::uint32_t GateTable::find(std::uint32_t from, std::uint32_t to) const {
  std::uint32_t looked = 0;
  for (std::uint32_t number = first_leaving(from); number != kNone; number = next_leaving(number)) {
    if (links_[number].gate.to == to) return number;
    if (++looked == kFewLeaving) return index_.find(key_of(from, to));
  }
  return kNone;
}

void GateTable::open(const Gate& gate) {
  std::uint32_t number = static_cast<std::uint32_t>(links_.size());
  if (unused_.empty()) {
    links_.emplace_back();
  } else {
    number = unused_.back();
    unused_.pop_back();
  }
  links_[number] = {.gate = gate};
  const std::uint32_t last = std::max(gate.from, gate.to);
  if (last >= ends_.size()) ends_.resize(std::size_t{last} + 1);
  link(&Linked::leaving, ends_[gate.from].leaving, number);
  link(&Linked::arriving, ends_[gate.to].arriving, number);
  index_overflow(gate.from);
}

/// A new gate pushes one at most out of those that are looked through.
void GateTable::index_overflow(std::uint32_t vertex) {
  std::uint32_t number = first_leaving(vertex);
  for (std::uint32_t looked = 0; looked < kFewLeaving && number != kNone; ++looked)
    number = next_leaving(number);
  if (number == kNone || links_[number].indexed) return;
  links_[number].indexed = true;
  index_.insert(key_of(vertex, links_[number].gate.to), number);
}

void GateTable::close(std::uint32_t number) {
  const Gate gate = links_[number].gate;
  if (links_[number].indexed) index_.erase(key_of(gate.from, gate.to));
  unlink(&Linked::leaving, ends_[gate.from].leaving, number);
  unlink(&Linked::arriving, ends_[gate.to].arriving, number);
  unused_.push_back(number);
}

void GateTable::link(Link Linked::*list, std::uint32_t& first, std::uint32_t number) {
  links_[number].*list = {.next = first};
  if (first != kNone) (links_[first].*list).previous = number;
  first = number;
}

void GateTable::unlink(Link Linked::*list, std::uint32_t& first, std::uint32_t number) {
  const Link link = links_[number].*list;
  if (link.next != kNone) (links_[link.next].*list).previous = link.previous;
  if (link.previous != kNone) {
    (links_[link.previous].*list).next = link.next;
  } else {
    first = link.next;
  }
}

}  // namespace atlaswire::codec
