#!/usr/bin/env bash
# Sets up, builds, streams the built-in atrium from a daemon over a simulated network to a headless client, and
# shows the result.
# Usage: scripts/demo.sh [--quick] [--scene NAME|FILE.glb] [--path NAME|FILE.csv] [--network NAME|FILE.toml]
#   --quick     a small scene and 3 seconds instead of 10
#   --network   a profile of atlas-netsim (wifi6; see atlas-netsim --list)
# Leaves out/demo/summary.json, stages.csv and pictures (ground truth | client view | atlas).
set -euo pipefail
from=$PWD
cd "$(dirname "$0")/.."
scene=atrium path= duration=10 network=wifi6
while [ $# -gt 0 ]; do
  case "$1" in
    --quick) scene=atrium:0.2 duration=3 ;;
    --scene) scene=${2:?--scene needs a value}; shift ;;
    --path) path=${2:?--path needs a value}; shift ;;
    --network) network=${2:?--network needs a value}; shift ;;
    -h | --help) sed -n '2,8s/^# //p' "$0"; exit 0 ;;
    *) echo "demo.sh: error: unknown option '$1'; see --help" >&2; exit 2 ;;
  esac
  shift
done
# Files are named from where the user stands.
[ -f "$from/$scene" ] && scene=$from/$scene
[ -f "$from/$path" ] && path=$from/$path
[ -f "$from/$network" ] && network=$from/$network
scripts/setup.sh
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
cmake --build --preset release -j "$(nproc)" --target atlasd atlas-client atlas-netsim

out=out/demo
rm -rf "$out" && mkdir -p "$out"
bin=build/release/bin
# wait_for PID FILE LOG: until a program has written its ready file, or ended too early
wait_for() {
  until [ -s "$2" ]; do
    kill -0 "$1" 2>/dev/null || { cat "$3" >&2; exit 1; }
    sleep 0.1
  done
}
port_in() { sed -n 's/.*"port": *\([0-9]*\).*/\1/p' "$1"; }

pids=()
trap 'kill -TERM "${pids[@]}" 2>/dev/null; wait 2>/dev/null || true' EXIT
echo "starting atlasd with scene $scene, behind the simulated network $network"
"$bin/atlasd" --scene "$scene" --reshade-interval 4 --port 0 --ready-file "$out/atlasd.json" >"$out/atlasd.log" 2>&1 &
pids+=($!)
wait_for $! "$out/atlasd.json" "$out/atlasd.log"
"$bin/atlas-netsim" --listen 0 --to "127.0.0.1:$(port_in "$out/atlasd.json")" --profile "$network" --seed 1 \
  --ready-file "$out/netsim.json" --json >"$out/netsim-summary.json" 2>"$out/netsim.log" &
pids+=($!)
wait_for $! "$out/netsim.json" "$out/netsim.log"
"$bin/atlas-client" --connect "127.0.0.1:$(port_in "$out/netsim.json")" --duration "$duration" --out "$out" --reference "$scene" \
  ${path:+--path "$path"}
