#pragma once

#include "base/patch_layout.h"
#include "codec/flat_index.h"

#include <array>
#include <cstdint>
#include <vector>

namespace atlaswire::codec {

/// A border edge of the known surface, as a patch beyond it would have it: from `from` to `to`. The patch on
/// this side goes on to `behind_from` after `from`, and came from `behind_to` to `to`.
struct Gate {
  std::uint32_t from = 0;  ///< vertices
  std::uint32_t to = 0;
  std::uint32_t behind_from = 0;
  std::uint32_t behind_to = 0;
  std::uint8_t refused = 0;  ///< times that it was offered in vain, at most kMostRefused

  static constexpr std::uint8_t kMostRefused = 3;
};

/// The corners of a patch in order; `count` of them count.
struct Outline {
  std::array<std::uint32_t, kMaxPatchCorners> corners{};  ///< vertices
  std::uint32_t count = 0;

  [[nodiscard]] std::uint32_t at(std::uint32_t corner) const { return corners[corner % count]; }
};

/// The open gates: directed edges that a known patch has the other way round and none has this way round.
/// Where more than two patches meet at an edge, or wind against each other, the later take what the earlier
/// left: always the same, never more than one gate a directed edge.
class GateTable {
 public:
  static constexpr std::uint32_t kNone = FlatIndex::kNone;

  explicit GateTable(std::uint64_t seed) : index_(seed) {}

  void clear();
  /// Closes the gates that the patch fills, and opens those behind its other edges. Edges from a vertex to
  /// itself have none. Vertices must be below 2^32 - 1.
  void add(const Outline& patch);

  /// The open gate of a directed edge, or kNone.
  [[nodiscard]] std::uint32_t find(std::uint32_t from, std::uint32_t to) const;
  [[nodiscard]] const Gate& gate(std::uint32_t number) const { return links_[number].gate; }
  /// Notes that a new patch was not attached there.
  void refuse(std::uint32_t number) {
    std::uint8_t& refused = links_[number].gate.refused;
    if (refused < Gate::kMostRefused) ++refused;
  }

  /// Gates that leave a vertex or arrive at it, the latest first; kNone ends the lists.
  [[nodiscard]] std::uint32_t first_leaving(std::uint32_t vertex) const {
    return vertex < ends_.size() ? ends_[vertex].leaving : kNone;
  }
  [[nodiscard]] std::uint32_t next_leaving(std::uint32_t number) const { return links_[number].leaving.next; }
  [[nodiscard]] std::uint32_t first_arriving(std::uint32_t vertex) const {
    return vertex < ends_.size() ? ends_[vertex].arriving : kNone;
  }
  [[nodiscard]] std::uint32_t next_arriving(std::uint32_t number) const {
    return links_[number].arriving.next;
  }

 private:
  struct Link {
    std::uint32_t next = kNone;
    std::uint32_t previous = kNone;
  };
  struct Linked {
    Gate gate;
    Link leaving;
    Link arriving;
    bool indexed = false;
  };
  /// The first of a vertex's lists.
  struct Ends {
    std::uint32_t leaving = kNone;
    std::uint32_t arriving = kNone;
  };

  static std::uint64_t key_of(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t{from} << 32U | to;
  }
  /// Gates that leave a vertex and are looked through; those behind them in the list are in the index, for
  /// they may be many.
  static constexpr std::uint32_t kFewLeaving = 6;

  void open(const Gate& gate);
  void index_overflow(std::uint32_t vertex);
  void close(std::uint32_t number);
  void link(Link Linked::*list, std::uint32_t& first, std::uint32_t number);
  void unlink(Link Linked::*list, std::uint32_t& first, std::uint32_t number);

  FlatIndex index_;
  std::vector<Linked> links_;
  std::vector<std::uint32_t> unused_;  ///< numbers
  std::vector<Ends> ends_;             ///< by vertex
};

}  // namespace atlaswire::codec
