#!/usr/bin/env python3
"""Draws a decision log: delay over time, runs of lost packets, throughput.

Usage: plot_profile.py LOG.csv OUT.png [--title TEXT] [--window SECONDS]
  LOG.csv   from `atlas-netsim --draw` or `--log`
"""
import argparse
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend must be chosen first

COLORS = {"up": "#d95f02", "down": "#1b6ca8"}
MORE_COLORS = ["#7a9f35", "#8e4585", "#b8860b", "#555555"]


def color(way):
    """One a direction, for flows' own paths another."""
    if way in COLORS:
        return COLORS[way]
    direction, _, path = way.split(" ")
    return MORE_COLORS[(2 * int(path) + (direction == "up")) % len(MORE_COLORS)]


def read_log(name):
    """Per direction of a path, the originals in order of arrival, as dicts of numbers and the fate."""
    ways = {"up": [], "down": []}
    with open(name, newline="", encoding="ascii") as file:
        for row in csv.DictReader(file):
            if row["duplicate"] == "1":
                continue
            way = row["direction"] if row["path"] == "0" else f"{row['direction']} path {row['path']}"
            ways.setdefault(way, []).append({
                "packet": int(row["packet"]),
                "size": int(row["size"]),
                "arrived": int(row["arrived_ns"]) * 1e-9,
                "delivered": int(row["delivered_ns"]) * 1e-9,
                "fate": row["fate"],
            })
    for packets in ways.values():
        packets.sort(key=lambda p: p["packet"])
    return {way: packets for way, packets in ways.items() if packets}


def loss_runs(packets):
    """Lengths of runs of packets that did not arrive."""
    runs, length = [], 0
    for packet in packets:
        if packet["fate"] != "delivered":
            length += 1
        elif length:
            runs.append(length)
            length = 0
    return runs + ([length] if length else [])


def throughput(packets, time, window):
    """Mbps of payload per window, by `time` ("arrived": offered, "delivered": what came out)."""
    end = max(p["arrived"] for p in packets) + window
    bins = [0] * (int(end / window) + 1)
    for packet in packets:
        if time == "delivered" and packet["fate"] != "delivered":
            continue
        at = int(packet[time] / window)
        if at < len(bins):
            bins[at] += packet["size"]
    return [(i + 0.5) * window for i in range(len(bins) - 1)], [b * 8e-6 / window for b in bins[:-1]]


def add_legend(axes, place):
    """In columns of four."""
    entries = len(axes.get_legend_handles_labels()[0])
    axes.legend(loc=place, fontsize=8, framealpha=0.6, ncol=1 + (entries - 1) // 4)


def draw_delay(axes, ways):
    for way, packets in ways.items():
        came = [p for p in packets if p["fate"] == "delivered"]
        gone = [p for p in packets if p["fate"] != "delivered"]
        axes.plot([p["arrived"] for p in came], [(p["delivered"] - p["arrived"]) * 1e3 for p in came], ".",
                  markersize=1.5, color=color(way), label=f"{way}: {len(came)} delivered")
        if gone:  # an empty line that is not clipped has no extent, and squeezes the whole figure to none
            axes.plot([p["arrived"] for p in gone], [0] * len(gone), "|", markersize=6, color=color(way), alpha=0.6,
                      clip_on=False, label=f"{way}: {len(gone)} not (ticks)")
    axes.set_ylim(bottom=0)
    axes.set_xlabel("entered at, s")
    axes.set_ylabel("delay, ms")
    add_legend(axes, "best")


def run_class(length):
    """Runs are counted in classes 1, 2, 3-4, 5-8, ...: the class's number."""
    return (length - 1).bit_length()


def class_name(number):
    low, high = (1 << number - 1) + 1 if number else 1, 1 << number
    return str(high) if low >= high else f"{low}-{high}"


def draw_runs(axes, ways):
    classes = 0
    width = 0.8 / max(len(ways), 1)
    for index, (way, packets) in enumerate(ways.items()):
        shift = (index + 0.5) * width - 0.4
        runs = loss_runs(packets)
        if not runs:
            continue
        counts = [sum(run_class(r) == n for r in runs) for n in range(run_class(max(runs)) + 1)]
        classes = max(classes, len(counts))
        axes.bar([n + shift for n in range(len(counts))], counts, width=width, color=color(way),
                 label=f"{way}: {100 * sum(runs) / len(packets):.2f} % lost, runs of {sum(runs) / len(runs):.1f} on average")
    axes.set_xlabel("packets lost in a row")
    axes.set_ylabel("runs")
    axes.set_xticks(range(classes), [class_name(n) for n in range(classes)])
    if classes:
        axes.set_yscale("log")
        axes.set_ylim(bottom=0.5)
        axes.set_xlim(-0.5, classes - 0.5)
        add_legend(axes, "upper right")
    else:
        axes.set_yticks([])
        axes.text(0.5, 0.5, "nothing was lost", ha="center", va="center", transform=axes.transAxes)


def draw_throughput(axes, ways, window):
    for way, packets in ways.items():
        axes.plot(*throughput(packets, "arrived", window), color=color(way), linewidth=1, linestyle=":",
                  label=f"{way}: offered")
        axes.plot(*throughput(packets, "delivered", window), color=color(way), linewidth=1.2, label=f"{way}: came out")
    axes.set_ylim(bottom=0)
    axes.set_xlabel("time, s")
    axes.set_ylabel(f"Mbps, over {window * 1e3:.0f} ms")
    add_legend(axes, "best")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("log")
    parser.add_argument("out")
    parser.add_argument("--title", default="")
    parser.add_argument("--window", type=float, default=0.1, help="seconds that throughput is averaged over")
    options = parser.parse_args()
    if not options.window > 0:
        parser.error("--window must be positive")
    try:
        ways = read_log(options.log)
    except (OSError, KeyError, TypeError, ValueError) as error:
        sys.exit(f"plot_profile.py: error: {options.log}: not a decision log: {error}")
    figure, (delay, runs, rate) = plt.subplots(3, 1, figsize=(9, 10), constrained_layout=True)
    figure.suptitle(options.title or options.log)
    draw_delay(delay, ways)
    draw_runs(runs, ways)
    draw_throughput(rate, ways, options.window)
    try:
        figure.savefig(options.out, dpi=110)
    except (OSError, ValueError) as error:
        sys.exit(f"plot_profile.py: error: cannot write {options.out}: {error}")


if __name__ == "__main__":
    main()
