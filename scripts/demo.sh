#!/usr/bin/env bash
# Sets up, builds, streams the built-in atrium from a daemon to a headless client, and shows the result.
# Usage: scripts/demo.sh [--quick] [--scene NAME|FILE.glb] [--path NAME|FILE.csv]
#   --quick   a small scene and 3 seconds instead of 10
# Leaves out/demo/summary.json, stages.csv and pictures (ground truth | client view | atlas).
set -euo pipefail
cd "$(dirname "$0")/.."
scene=atrium path= duration=10
while [ $# -gt 0 ]; do
  case "$1" in
    --quick) scene=atrium:0.2 duration=3 ;;
    --scene) scene=${2:?--scene needs a value}; shift ;;
    --path) path=${2:?--path needs a value}; shift ;;
    -h | --help) sed -n '2,5s/^# //p' "$0"; exit 0 ;;
    *) echo "demo.sh: error: unknown option '$1'; see --help" >&2; exit 2 ;;
  esac
  shift
done
scripts/setup.sh
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
cmake --build --preset release -j "$(nproc)" --target atlasd atlas-client

out=out/demo
rm -rf "$out" && mkdir -p "$out"
bin=build/release/bin
"$bin/atlasd" --scene "$scene" --reshade-interval 4 --port 0 --ready-file "$out/atlasd.json" >"$out/atlasd.log" 2>&1 &
daemon=$!
trap 'kill -TERM $daemon 2>/dev/null; wait $daemon 2>/dev/null || true' EXIT
echo "starting atlasd with scene $scene"
until [ -s "$out/atlasd.json" ]; do
  kill -0 $daemon 2>/dev/null || { cat "$out/atlasd.log" >&2; exit 1; }
  sleep 0.1
done
port=$(sed -n 's/.*"port": *\([0-9]*\).*/\1/p' "$out/atlasd.json")
"$bin/atlas-client" --connect "127.0.0.1:$port" --duration "$duration" --out "$out" --reference "$scene" ${path:+--path "$path"}
