#version 460
#extension GL_GOOGLE_include_directive : require
// Provisioning phase ([SAS] 4.2), as SuperblockStore::provision has it: one invocation's work over counts,
// first for requests, then, below the high-water mark, for shrunken patches. The tables that it walks lie in
// shared memory.
#include "shaders/alloc_state.glsl"

layout(local_size_x = kKeyGroup) in;

shared uint requested[kMostLevels];
shared uint inflow[kMostLevels];
shared uint stack_size[kMostLevels];
shared uint leftover_size[kMostLevels];
shared uint leftover_taken[kMostLevels];
shared uint tail_superblock[kMostSides];
shared uint tail_row[kMostSides];

uint free_count;
uint allocated;
uint segment_count;
// The level being served.
uint level;  // sides
uint wanted;
uint served;

void leave(uint sides, uint position) {
  uint number = number_of(sides);
  leftovers[number * kMostLeftovers + leftover_size[number]] = position;
  ++leftover_size[number];
}

uint shifted(uint position, uint x, uint y) { return position + x + (y << 16); }

/// Of a parent split into rows of blocks the first `blocks` are taken: the rest, in the largest pieces that
/// are landscape and aligned, is left over.
void keep_rest(uint position, uint parent, uint blocks) {
  uint across_log2 = width_of(parent) - width_of(level);
  uint across = 1u << across_log2;
  uint partial_row = blocks >> across_log2;
  for (uint column = blocks & (across - 1u); column != 0u && column != across;) {
    uint step = uint(findLSB(column));
    leave(sides_of(width_of(level) + step, height_of(level)),
          shifted(position, column << width_of(level), partial_row << height_of(level)));
    column += 1u << step;
  }
  uint down = 1u << (height_of(parent) - height_of(level));
  for (uint row = (blocks + across - 1u) >> across_log2; row < down;) {
    uint step = uint(findLSB(row));
    leave(sides_of(width_of(parent), height_of(level) + step),
          shifted(position, 0u, row << height_of(level)));
    row += 1u << step;
  }
}

/// Serves from up to `available` parents of a source. Returns how many it used.
uint take(uint available, uint source, uint parent, uint first, uint superblock) {
  uint missing = wanted - served;
  if (available == 0u || missing == 0u) return 0u;
  uint blocks_log2 = area_log2(parent) - area_log2(level);
  uint parents = min(available, ((missing - 1u) >> blocks_log2) + 1u);
  uint blocks = min(missing, parents << blocks_log2);
  served += blocks;
  Segment segment = Segment(served, source | number_of(parent) << 8, first, superblock);
  segments[segment_count] = segment;
  ++segment_count;
  uint in_last = blocks - ((parents - 1u) << blocks_log2);
  if (in_last != 1u << blocks_log2) keep_rest(parent_at(segment, parents - 1u), parent, in_last);
  return parents;
}

void take_stacked(uint parent) {
  uint number = number_of(parent);
  uint taken = leftover_taken[number];
  leftover_taken[number] = taken + take(leftover_size[number] - taken, kFromLeftover, parent, taken, 0u);
  uint size = stack_size[number];
  stack_size[number] = size - take(size, kFromStack, parent, size - 1u, 0u);
}

void take_tail(uint parent) {
  uint w = width_of(parent);
  if (tail_superblock[w] == kNone) return;
  uint row = tail_row[w];
  uint parents = take((rows_of(w) - row) >> height_of(parent), kFromTail, parent, row, tail_superblock[w]);
  row += parents << height_of(parent);
  tail_row[w] = row;
  if (row == rows_of(w)) tail_superblock[w] = kNone;
}

/// Opens as many free superblocks as the level needs; the last becomes its width's tail.
void take_free() {
  if (wanted == served || free_count == 0u) return;
  uint each_log2 = 2u * (set.max_log2 - set.min_log2) - area_log2(level);
  uint blocks = take(free_count << each_log2, kFromFree, level, free_count - 1u, 0u);
  uint opened = ((blocks - 1u) >> each_log2) + 1u;
  for (uint i = 0u; i < opened; ++i) superblocks[superblocks[free_count - 1u - i].free_stack].open = 1u;
  free_count -= opened;
  uint in_last = blocks - ((opened - 1u) << each_log2);
  if (in_last != 1u << each_log2) {
    tail_superblock[width_of(level)] = superblocks[free_count].free_stack;
    tail_row[width_of(level)] = in_last << height_of(level);
  }
}

void serve() {
  take_stacked(level);
  take_tail(level);
  take_free();
  for (uint area = width_of(level) + height_of(level) + 1u;
       area <= 2u * set.max_log2 && served != wanted; ++area) {
    for (uint w = max(width_of(level), (area + 1u) / 2u); w <= set.max_log2; ++w) {
      if (area < w + height_of(level)) break;
      uint parent = sides_of(w, area - w);
      take_stacked(parent);
      if (2u * w == area) take_tail(parent);
    }
  }
}

/// Rounds a width's tail up to its tallest block; what is skipped is left over ([SAS] 4.2 (e)).
void align_tail(uint w) {
  if (tail_superblock[w] == kNone) return;
  uint row = tail_row[w];
  while ((row & ((1u << w) - 1u)) != 0u) {
    uint height = uint(findLSB(row));
    leave(sides_of(w, height), row_at(tail_superblock[w], w, row));
    row += 1u << height;
  }
  tail_row[w] = row;
  if (row == rows_of(w)) tail_superblock[w] = kNone;
}

void provision(uint round, uint cap, bool may_shrink) {
  for (uint i = 0u; i < set.levels; ++i) inflow[i] = 0u;
  for (uint number = set.levels; number-- > 0u;) {
    level = sides_of_number(number);
    wanted = requested[number] + inflow[number];
    served = 0u;
    store.rounds[round].segment[number] = segment_count;
    if (wanted != 0u && area_log2(level) <= cap) serve();
    store.rounds[round].served[number] = served;
    allocated += served << area_log2(level);
    if (may_shrink && number != 0u && served != wanted) {
      uint next = number_of(halved(level));
      store.rounds[round].onward[number] = requested[next] + inflow[next];
      inflow[next] += wanted - served;
    }
    if (height_of(level) == set.min_log2) align_tail(width_of(level));
  }
}

uint saturating_add(uint sum, uint count, uint shift) {
  return min(kSaturated, sum + (count > (kSaturated >> shift) ? kSaturated : count << shift));
}

/// AtlasDemand::area_cap, in log2 of smallest blocks.
uint area_cap(uint room) {
  uint cap = 2u * (set.max_log2 - set.min_log2);
  for (; cap > 0u; --cap) {
    uint sum = 0u;
    for (uint i = 0u; i < set.levels; ++i) {
      sum = saturating_add(sum, requested[i], min(cap, area_log2(sides_of_number(i))));
    }
    if (sum <= room) break;
  }
  return cap;
}

/// Lets as many shrunken patches grow as stay below the high-water mark, the largest first.
void limit_regrowing() {
  uint room = set.regrow_limit - min(set.regrow_limit, allocated);
  for (uint number = set.levels; number-- > 0u;) {
    uint area = area_log2(sides_of_number(number));
    uint count = min(store.counted[kRegrows * set.levels + number], room >> area);
    requested[number] = count;
    room -= count << area;
  }
}

void place_outgrown() {
  uint grown = 0u;
  for (uint number = set.levels; number-- > 0u;) {
    store.outgrown_first[number] = grown;
    grown += store.rounds[1].served[number];
  }
  store.grown = grown;
}

void main() {
  uint mine = gl_LocalInvocationID.x;
  for (uint i = mine; i < set.levels; i += kKeyGroup) {
    requested[i] = store.counted[kRequests * set.levels + i];
    stack_size[i] = store.stack_size[i] + store.counted[kReleases * set.levels + i];
    leftover_size[i] = 0u;
    leftover_taken[i] = 0u;
  }
  if (mine < kMostSides) {
    tail_superblock[mine] = store.tail_superblock[mine];
    tail_row[mine] = store.tail_row[mine];
  }
  barrier();
  if (mine == 0u) {
    free_count = store.free_count;
    allocated = store.allocated;
    segment_count = 0u;
    provision(0u, area_cap(set.capacity - allocated), true);
    limit_regrowing();
    provision(1u, 2u * (set.max_log2 - set.min_log2), false);
    place_outgrown();
    store.free_count = free_count;
    store.allocated = allocated;
  }
  barrier();
  for (uint i = mine; i < set.levels; i += kKeyGroup) {
    store.stack_size[i] = stack_size[i];
    store.leftover_size[i] = leftover_size[i];
    store.leftover_taken[i] = leftover_taken[i];
  }
  if (mine < kMostSides) {
    store.tail_superblock[mine] = tail_superblock[mine];
    store.tail_row[mine] = tail_row[mine];
  }
}
