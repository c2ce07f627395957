#!/usr/bin/env python3
"""Plots and report.html of a results folder of atlas-lab, from its results.json.

Usage: report.py FOLDER    writes FOLDER/plots/*.png, *.svg and FOLDER/report.html"""

import json
import pathlib
import re
import sys

import page
import plots


def file_name(index, title, y):
    words = re.sub(r"[^a-z0-9]+", "-", f"{title} {y}".lower()).strip("-")
    return f"{index:02d}-{words}"


def scenes_of(points):
    """The points by scene, for curves of different scenes do not belong into one picture."""
    found = {}
    for point in points:
        found.setdefault(point["settings"]["scene"], []).append(point)
    return found


def draw_all(results, folder):
    """(title, PNG path) of every picture."""
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.*"):
        if old.suffix in (".png", ".svg"):
            old.unlink()
    drawn = []
    front = set(results["analysis"]["front"])
    scenes = scenes_of(results["points"])
    for plot in results["plots"]:
        for scene, points in scenes.items():
            title = plot["title"] if len(scenes) == 1 else f"{plot['title']}: {pathlib.Path(scene).stem}"
            for y, figure in plots.pictures_of(points, plot, front):
                stem = folder / file_name(len(drawn) + 1, title, y)
                figure.savefig(stem.with_suffix(".png"))
                figure.savefig(stem.with_suffix(".svg"), metadata={"Date": None})
                plots.plt.close(figure)
                drawn.append((title, stem.with_suffix(".png")))
    return drawn


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 0 if len(sys.argv) == 2 else 2
    folder = pathlib.Path(sys.argv[1])
    results = json.loads((folder / "results.json").read_text())
    drawn = draw_all(results, folder / "plots")
    part = folder / "report.html.part"
    part.write_text(page.page(results, drawn, folder))
    part.replace(folder / "report.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
