#!/usr/bin/env python3
"""Measures atlasd and atlas-client for docs/EXPERIMENTS.md and prints Markdown tables.

  scripts/measure.py rates  [--scene atrium] [--seconds 12]       server rate and stages for three atlas sizes
  scripts/measure.py scenes FOLDER [--seconds 12]                 picture at zero latency for each FILE.glb there

Needs build/release; loopback only; each run ends by itself."""

import argparse
import csv
import json
import pathlib
import shlex
import signal
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BIN = ROOT / "build" / "release" / "bin"
STAGES = ("visibility", "allocation", "shading", "conversion", "encode")


def stream(scene, daemon_options, client_options, folder):
    """One daemon and one client to the client's end; (summary, stage rows, command line)."""
    ready = folder / "ready.json"
    daemon_line = [str(BIN / "atlasd"), "--scene", scene, "--port", "0", "--ready-file", str(ready),
                   "--stats-csv", str(folder / "stats.csv"), "--max-runtime", "900", *daemon_options]
    with open(folder / "atlasd.log", "w") as log:
        daemon = subprocess.Popen(daemon_line, stdout=log, stderr=log)
        try:
            while not ready.exists():
                if daemon.poll() is not None:
                    sys.exit("atlasd did not start:\n" + (folder / "atlasd.log").read_text())
                time.sleep(0.1)
            port = json.loads(ready.read_text())["port"]
            client = subprocess.run([str(BIN / "atlas-client"), "--connect", f"127.0.0.1:{port}", "--json", "--out", str(folder),
                                     *client_options], capture_output=True, text=True, timeout=900)
            if client.returncode != 0:
                sys.exit("atlas-client failed:\n" + client.stderr)
        finally:
            daemon.send_signal(signal.SIGTERM)
            daemon.wait(30)
    with open(folder / "stats.csv") as rows:
        stages = list(csv.DictReader(rows))
    return json.loads((folder / "summary.json").read_text()), stages


def mean_ms(rows, stage):
    return statistics.mean(float(row[stage + "_ms"]) for row in rows)


def rates(arguments):
    print("| atlas | frames/s | " + " ms | ".join(STAGES) + " ms | slowest | video Mbps |")
    print("|---|---|" + "---|" * (len(STAGES) + 2))
    for side in (512, 1024, 2048):
        for more in ([], ["--reshade-interval", "4"]):
            with tempfile.TemporaryDirectory() as folder:
                summary, rows = stream(arguments.scene, ["--atlas", f"{side}x{side}", "--fps", "60", *more, *arguments.daemon],
                                       ["--duration", str(arguments.seconds), "--rate", "2", *arguments.client], pathlib.Path(folder))
            rows = rows[len(rows) // 4:]
            times = [mean_ms(rows, stage) for stage in STAGES]
            slowest = STAGES[times.index(max(times))]
            label = f"{side * side / 2**20:g} MPix" + (", " + " ".join(more) if more else "")
            print(f"| {label} | {summary['server']['fps']:.1f} | " + " | ".join(f"{t:.1f}" for t in times) +
                  f" | {slowest} | {summary['video']['mbps']:.1f} |", flush=True)


def scenes(arguments):
    print("| scene | atlas | MSSIM (mean, lowest) | PSNR dB | coverage % | video Mbps | meta Mbps |")
    print("|---|---|---|---|---|---|---|")
    for scene in sorted(pathlib.Path(arguments.folder).glob("*.glb")):
        path = scene.with_name(scene.stem + "_path.csv")
        client = ["--duration", str(arguments.seconds), "--rate", "5", "--reference", str(scene), "--at-server-pose",
                  "--path", str(path), *arguments.client]
        with tempfile.TemporaryDirectory() as folder:
            s, _ = stream(str(scene), ["--atlas", arguments.atlas, "--bitrate", arguments.bitrate, *arguments.daemon], client, pathlib.Path(folder))
        print(f"| {scene.stem} | {arguments.atlas} | {s['mssim']:.3f}, {s['mssim_lowest']:.3f} | {s['psnr']:.1f} | "
              f"{100 * s['coverage']:.2f} | {s['video']['mbps']:.1f} | {s['meta']['mbps']:.2f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(dest="kind", required=True)
    one = kinds.add_parser("rates", help="server rate and stage times")
    one.add_argument("--scene", default="atrium")
    one.set_defaults(run=rates)
    two = kinds.add_parser("scenes", help="picture at zero latency")
    two.add_argument("folder")
    two.add_argument("--atlas", default="2048x2048")
    two.add_argument("--bitrate", default="40M")
    two.set_defaults(run=scenes)
    for kind in (one, two):
        kind.add_argument("--seconds", type=float, default=12)
        kind.add_argument("--daemon", type=shlex.split, default=[], help="further options of atlasd, in one string")
        kind.add_argument("--client", type=shlex.split, default=[], help="further options of atlas-client, in one string")
    arguments = parser.parse_args()
    arguments.run(arguments)


if __name__ == "__main__":
    main()
