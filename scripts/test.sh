#!/usr/bin/env bash
# Sets up, builds and runs every test: the sanitizer presets' CPU tests first, then the whole suite.
# Usage: scripts/test.sh [--quick]    --quick: the release preset alone
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in
  "" | --quick) ;;
  -h | --help) sed -n '2,3s/^# //p' "$0"; exit 0 ;;
  *) echo "test.sh: error: unknown option '$1'; see --help" >&2; exit 2 ;;
esac
scripts/setup.sh
presets=(asan-ubsan tsan release)
[ "${1:-}" = --quick ] && presets=(release)
jobs=$(nproc)
log=$(mktemp)
trap 'rm -f "$log"' EXIT
for preset in "${presets[@]}"; do
  echo "== $preset: build"
  cmake --preset "$preset" >"$log" 2>&1 || { cat "$log"; exit 1; }
  cmake --build --preset "$preset" -j "$jobs"
done
for preset in "${presets[@]}"; do
  echo "== $preset: test"
  # GPU and end-to-end tests take the machine alone (their label sets RUN_SERIAL); the others share it.
  ctest --preset "$preset" -j "$jobs"
done
