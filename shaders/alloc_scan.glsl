// Prefix sums over a work group of kGroup invocations, in shared memory: the same for any subgroup size. Few
// barriers, because on a device that is a CPU each one switches between all invocations.
const uint kScanRow = 16u;  // kGroup is its square
shared uint scan_words[kGroup];
shared uint scan_rows[kScanRow];
shared uint scan_flags[kGroup / 32u];

/// The sum of `mine` over the invocations before this one; `total` over all. Every invocation must call it.
uint scan_group(uint mine, out uint total) {
  uint i = gl_LocalInvocationID.x;
  scan_words[i] = mine;
  barrier();
  if (i < kScanRow) {
    uint sum = 0u;
    for (uint k = 0u; k < kScanRow; ++k) sum += scan_words[i * kScanRow + k];
    scan_rows[i] = sum;
  }
  barrier();
  uint before = 0u;
  total = 0u;
  for (uint row = 0u; row < kScanRow; ++row) {
    uint sum = scan_rows[row];
    before += row < i / kScanRow ? sum : 0u;
    total += sum;
  }
  for (uint k = 0u; k < i % kScanRow; ++k) before += scan_words[i - i % kScanRow + k];
  barrier();
  return before;
}

/// The number of invocations before this one for which `mine` holds; `total` of all. Every invocation must
/// call it.
uint scan_flag(bool mine, out uint total) {
  uint i = gl_LocalInvocationID.x;
  if (i < kGroup / 32u) scan_flags[i] = 0u;
  barrier();
  if (mine) atomicOr(scan_flags[i / 32u], 1u << (i % 32u));
  barrier();
  uint before = uint(bitCount(scan_flags[i / 32u] & ((1u << (i % 32u)) - 1u)));
  total = 0u;
  for (uint word = 0u; word < kGroup / 32u; ++word) {
    uint count = uint(bitCount(scan_flags[word]));
    before += word < i / 32u ? count : 0u;
    total += count;
  }
  barrier();
  return before;
}
