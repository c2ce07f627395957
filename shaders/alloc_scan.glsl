// Exclusive prefix sums over a work group of kGroup invocations, in shared memory: the same for any subgroup
// size.
shared uint scan_words[2][kGroup];

/// The sum of `mine` over the invocations before this one; `total` over all. Every invocation must call it.
uint scan_group(uint mine, out uint total) {
  uint i = gl_LocalInvocationID.x;
  uint from = 0u;
  scan_words[0][i] = mine;
  barrier();
  for (uint step = 1u; step < kGroup; step *= 2u) {
    uint sum = scan_words[from][i] + (i >= step ? scan_words[from][i - step] : 0u);
    scan_words[1u - from][i] = sum;
    from = 1u - from;
    barrier();
  }
  uint inclusive = scan_words[from][i];
  total = scan_words[from][kGroup - 1u];
  barrier();
  return inclusive - mine;
}
