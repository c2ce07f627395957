#!/usr/bin/env python3
"""The model's token bucket beside Linux's: one overload, tc's TBF in a network namespace, netsim's in virtual time.

Usage: tbf_crosscheck.py ATLAS_NETSIM    exit status 0 agrees, 1 differs, 77 not permitted here (skipped)

Both get 40 Mbps of 1200-octet datagrams for 2 s into 20 Mbps, a bucket of 32 KiB and a queue of 64 KiB. Compared
is the rate of what comes out after the first 0.5 s, in octets of payload. A busy machine can only slow Linux
down, so the best of three attempts counts.
"""
import csv
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

OCTETS = 1200
HEADERS = 42  # Ethernet, IPv4, UDP: what TBF counts on the loopback device
SECONDS = 2.0
SETTLED = 0.5
TOLERANCE = 0.03
ATTEMPTS = 3
PROFILE = f"""
[both]
rate = {{ mbps = 20, burst_kb = 32 }}
queue = {{ limit_kb = 64 }}
overhead_bytes = {HEADERS}
"""


def settled_rate(times):
    """Mbps of payload among arrivals (seconds from the start) after SETTLED."""
    late = [t for t in times if SETTLED <= t <= SECONDS]
    return (len(late) - 1) * OCTETS * 8e-6 / (late[-1] - late[0]) if len(late) > 1 else 0.0


def measure_linux():
    """Inside the namespace: prints the rate that TBF lets through."""
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
    receiver.bind(("127.0.0.1", 0))
    receiver.settimeout(0.5)
    arrivals = []

    def receive():
        try:
            while True:
                receiver.recv(2 * OCTETS)
                arrivals.append(time.monotonic())
        except TimeoutError:
            pass

    thread = threading.Thread(target=receive)
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.connect(receiver.getsockname())
    start = time.monotonic()
    thread.start()
    gap = OCTETS * 8 / 40e6
    for i in range(int(SECONDS / gap)):
        wait = start + i * gap - time.monotonic()
        if wait > 0:
            time.sleep(wait)
        sender.send(bytes(OCTETS))
    thread.join()
    print(settled_rate([t - start for t in arrivals]))


def measure_model(program):
    with tempfile.TemporaryDirectory() as folder:
        profile, log = f"{folder}/tbf.toml", f"{folder}/tbf.csv"
        with open(profile, "w", encoding="ascii") as file:
            file.write(PROFILE)
        subprocess.run([program, "--profile", profile, "--draw", log, "--load", "40M", "--packet", str(OCTETS),
                        "--duration", str(SECONDS)], check=True)
        with open(log, newline="", encoding="ascii") as file:
            rows = [r for r in csv.DictReader(file) if r["direction"] == "up" and r["fate"] == "delivered"]
    return settled_rate(sorted(int(r["delivered_ns"]) * 1e-9 for r in rows))


def in_namespace():
    """The rate through Linux's TBF, or None where namespaces or TBF are not to be had."""
    if not (shutil.which("ip") and shutil.which("tc")):
        return None
    name = f"netsim-tbf-{os.getpid()}"

    def run(*command):
        return subprocess.run(command, capture_output=True, text=True, check=False)

    if run("ip", "netns", "add", name).returncode != 0:
        return None
    inside = ("ip", "netns", "exec", name)
    try:
        shaped = run(*inside, "ip", "link", "set", "lo", "up").returncode == 0 and run(
            *inside, "tc", "qdisc", "add", "dev", "lo", "root", "tbf", "rate", "20mbit", "burst", "32kb", "limit",
            "64kb").returncode == 0
        if not shaped:
            return None
        return float(run(*inside, sys.executable, __file__, "--inside").stdout)
    finally:
        run("ip", "netns", "del", name)


def main():
    if sys.argv[1:] == ["--inside"]:
        return measure_linux()
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    model = measure_model(sys.argv[1])
    best = 0.0
    for _ in range(ATTEMPTS):
        linux = in_namespace()
        if linux is None:
            print("skipped: no permission for network namespaces, or no tc with TBF here")
            return 77
        best = max(best, linux)
        if abs(best / model - 1) <= TOLERANCE:
            break
    print(f"model {model:.3f} Mbps, Linux TBF {best:.3f} Mbps, ratio {best / model:.4f}")
    return 0 if abs(best / model - 1) <= TOLERANCE else 1


if __name__ == "__main__":
    sys.exit(main())
