#!/usr/bin/env python3
"""Draws [SAS] fig. 11 from `atlas_memory classes`: the atlas's memory by class, strategy and scene.

Usage: plot_atlas_memory.py CLASSES.csv OUT.png
"""
import argparse
import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend must be chosen first

CLASSES = [("allocated", "#46b45a"), ("tails", "#3c6edc"), ("stacks", "#d03c32"), ("inaccessible", "#eb9632"),
           ("free", "#6e5096")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("classes")
    parser.add_argument("out")
    options = parser.parse_args()
    with open(options.classes, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    figure, axes = plt.subplots(1, len(scenes), figsize=(4.2 * len(scenes), 4), sharey=True, squeeze=False)
    for axis, scene in zip(axes[0], scenes):
        mine = [row for row in rows if row["scene"] == scene]
        bottom = [0.0] * len(mine)
        names = [f"{r['strategy']}\n{r['out_of_memory_frames']}\n{r['resets']}" for r in mine]
        for name, colour in CLASSES:
            shares = [float(row[name]) for row in mine]
            axis.bar(names, shares, bottom=bottom, color=colour, label=name)
            bottom = [below + share for below, share in zip(bottom, shares)]
        axis.set_title(scene)
        axis.set_xlabel("name, frames out of memory, resets")
    axes[0][0].set_ylabel("% of the atlas, mean over frames")
    axes[0][-1].legend(bbox_to_anchor=(1.02, 1), loc="upper left", fontsize="small")
    figure.tight_layout()
    figure.savefig(options.out, dpi=90)


if __name__ == "__main__":
    main()
