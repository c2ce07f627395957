#!/usr/bin/env bash
# Draws what a network profile does to a steady load, both ways: delay over time, loss runs, throughput.
# Usage: scripts/plot_profile.sh PROFILE OUT.png [--load 20M] [--duration 10] [--seed 1] [--packet 1200]
#   PROFILE   a shipped one's name (atlas-netsim --list) or a .toml file; the other options are atlas-netsim's
#   ATLAS_NETSIM=PROGRAM chooses the binary; if unset, the newest one below build/
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
case "${1:-}" in -h | --help) sed -n '2,5s/^# //p' "$0"; exit 0 ;; esac
if [ $# -lt 2 ]; then
  echo "plot_profile.sh: error: needs PROFILE and OUT.png; see --help" >&2
  exit 2
fi
profile=$1
out=$2
shift 2
program=${ATLAS_NETSIM:-$(ls -t "$root"/build/*/bin/atlas-netsim 2>/dev/null | head -n 1 || true)}
if [ -z "$program" ]; then
  echo "plot_profile.sh: error: no atlas-netsim below build/: build it, or set ATLAS_NETSIM" >&2
  exit 2
fi
log=$(mktemp --suffix=.csv)
trap 'rm -f "$log"' EXIT
"$program" --profile "$profile" --draw "$log" "$@"
title="$profile${*:+ ($*)}"
# The distribution's Python has the distribution's matplotlib; another one may come first in PATH.
python=python3
"$python" -c 'import matplotlib' 2>/dev/null || python=/usr/bin/python3
"$python" "$root/scripts/plot_profile.py" "$log" "$out" --title "$title"
