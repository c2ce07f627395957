#!/usr/bin/env python3
"""Measures atlasd and atlas-client for docs/EXPERIMENTS.md, atlas-netsim for docs/NETSIM.md; prints Markdown tables.

  scripts/measure.py rates  [--scene atrium] [--seconds 12]       server rate and stages for three atlas sizes
  scripts/measure.py scenes FOLDER [--seconds 12]                 picture at zero latency for each FILE.glb there
  scripts/measure.py relay  [--seconds 3] [--runs 5]               what atlas-netsim carries on one core, and its accuracy

Needs build/release; loopback only; each run ends by itself."""

import argparse
import csv
import json
import os
import pathlib
import shlex
import signal
import socket
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


class Relay:
    """atlas-netsim on CPU 0 for as long as the block lasts; then `summary` and `cpu_seconds` say what it did."""

    def __init__(self, arguments, target, spin):
        self.folder = tempfile.TemporaryDirectory()
        ready = pathlib.Path(self.folder.name) / "ready.json"
        self.process = subprocess.Popen([arguments.netsim, "--listen", "0", "--to", f"127.0.0.1:{target}", "--profile", arguments.profile,
                                         "--spin", str(spin), "--json", "--ready-file", str(ready), "--duration", "600"],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        os.sched_setaffinity(self.process.pid, {0})
        while not ready.exists():
            if self.process.poll() is not None:
                sys.exit("atlas-netsim did not start")
            time.sleep(0.01)
        self.port = json.loads(ready.read_text())["port"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        self.summary = json.loads(self.process.stdout.read())
        _, self.process.returncode, usage = os.wait4(self.process.pid, 0)
        self.process.stdout.close()
        self.cpu_seconds = usage.ru_utime + usage.ru_stime
        self.folder.cleanup()


def through_relay(arguments, spin, gap):
    """Datagrams through a relay into a socket that nobody reads, `gap` seconds apart (0: a flood): (the relay, sent)."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sink, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as source:
        sink.bind(("127.0.0.1", 0))
        with Relay(arguments, sink.getsockname()[1], spin) as relay:
            source.connect(("127.0.0.1", relay.port))
            payload, sent, start = bytes(arguments.octets), 0, time.monotonic()
            while (now := time.monotonic() - start) < arguments.seconds:
                if gap and sent * gap > now:
                    time.sleep(sent * gap - now)
                source.send(payload)
                sent += 1
            time.sleep(0.3)  # what is on its way
    return relay, sent


def relay(arguments):
    if os.cpu_count() < 2:
        sys.exit("measure.py: error: needs two cores: one for the relay, one for the load")
    os.sched_setaffinity(0, {1})
    print(f"load {os.getloadavg()[0]:.2f}; {arguments.octets} octets through {arguments.profile}; median (least, most) of {arguments.runs}\n")

    def cells(*columns):
        return " | ".join(f"{statistics.median(c):,.0f} ({min(c):,.0f}, {max(c):,.0f})" for c in columns)

    floods = [through_relay(arguments, 0, 0) for _ in range(arguments.runs)]
    went = [r.summary["lateness_us"]["count"] - r.summary["up"]["send_failures"] for r, _ in floods]
    print("| offered, packets/s | relayed, packets/s | per CPU second of the relay |\n|---|---|---|")
    print("| " + cells([sent / arguments.seconds for _, sent in floods], [n / arguments.seconds for n in went],
                       [n / r.cpu_seconds for n, (r, _) in zip(went, floods)]) + " |\n", flush=True)
    print(f"| {arguments.rate} packets/s | late by, median us | 99th percentile us | most us |\n|---|---|---|---|")
    for spin in (0, 100):
        late = [through_relay(arguments, spin, 1 / arguments.rate)[0].summary["lateness_us"] for _ in range(arguments.runs)]
        print(f"| --spin {spin} | " + cells(*([x[key] for x in late] for key in ("median", "p99", "max"))) + " |", flush=True)


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
    three = kinds.add_parser("relay", help="what atlas-netsim carries on one core, and its accuracy")
    three.add_argument("--seconds", type=float, default=3)
    three.add_argument("--runs", type=int, default=5)
    three.add_argument("--profile", default="paper-sas-20")
    three.add_argument("--octets", type=int, default=1200)
    three.add_argument("--rate", type=int, default=2000, help="packets/s at which lateness is measured")
    three.add_argument("--netsim", default=str(BIN / "atlas-netsim"), help="the program")
    three.set_defaults(run=relay)
    for kind in (one, two):
        kind.add_argument("--seconds", type=float, default=12)
        kind.add_argument("--daemon", type=shlex.split, default=[], help="further options of atlasd, in one string")
        kind.add_argument("--client", type=shlex.split, default=[], help="further options of atlas-client, in one string")
    arguments = parser.parse_args()
    arguments.run(arguments)


if __name__ == "__main__":
    main()
