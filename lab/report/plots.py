"""Pictures of a results folder's points: one function a kind of plot. Each returns a matplotlib figure."""

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (the backend comes first)
from matplotlib import ticker  # noqa: E402

# Okabe and Ito's palette: told apart by colour-blind readers too.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D1F"]
MARKERS = "os^Dv<>P"

LABELS = {
    "mssim": "MSSIM", "mssim_lowest": "lowest MSSIM", "psnr": "PSNR, dB", "dssim": "DSSIM", "flip": "FLIP",
    "flicker": "flicker", "holes": "holes, share of pixels", "video_mbps": "video, Mbps", "meta_mbps": "meta, Mbps",
    "total_mbps": "all channels, Mbps", "pose_age_ms": "pose age, ms",
    "shaded_mpix_per_s": "shaded, million texels a second", "forward_mpix_per_s": "forward, million fragments a second",
}

plt.rcParams.update({
    "figure.figsize": (6.4, 4.0), "figure.dpi": 110, "savefig.bbox": "tight", "font.size": 10, "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.axisbelow": True,
    "legend.frameon": False, "legend.fontsize": 9, "svg.hashsalt": "atlas-lab", "lines.linewidth": 1.6, "lines.markersize": 5,
})


def label(name):
    return LABELS.get(name, name)


def value(point, name):
    """A figure, a timing or a numeric setting of a point; None if it has no such number."""
    for table in ("figures", "timings"):
        if name in point[table]:
            return point[table][name]
    try:
        return float(point["settings"][name])
    except (KeyError, ValueError):
        return None


def text(point, name):
    """What `name` is for the point, for legends and categories."""
    if name in ("variant", "varied", "label"):
        return point[name]
    if name in point["settings"]:
        return point["settings"][name]
    number = value(point, name)
    return "" if number is None else f"{number:g}"


def in_order(items):
    """Without repeats, in order of first appearance."""
    return list(dict.fromkeys(items))


def style(index):
    """Beyond eight series colours come again, with hollow marks."""
    look = {"color": COLOURS[index % len(COLOURS)], "marker": MARKERS[index % len(MARKERS)]}
    return look if index < len(COLOURS) else {**look, "markerfacecolor": "white"}


def finish(figure, axes, plot, y_label):
    axes.set_xlabel(plot["x_label"])
    axes.set_ylabel(plot["y_label"] or y_label)
    handles, _ = axes.get_legend_handles_labels()
    if len(handles) > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0))
    return figure


def log_axis(axes, values):
    """Doubling steps are read off the measured values themselves, not off powers of ten."""
    if not values or min(values) <= 0:
        return
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda v, _: f"{v:g}"))
    axes.xaxis.set_minor_formatter(ticker.NullFormatter())


def line(points, plot, ys):
    """`ys` against x, one line a series; with several ys each has its own line style."""
    figure, axes = plt.subplots()
    every_x = []
    for index, name in enumerate(in_order(text(p, plot["series"]) for p in points)):
        for dashes, y in zip(("-", "--", ":", "-."), ys):
            pairs = sorted((value(p, plot["x"]), value(p, y)) for p in points
                           if text(p, plot["series"]) == name and value(p, plot["x"]) is not None and value(p, y) is not None)
            if pairs:
                every_x += [x for x, _ in pairs]
                told = ", ".join(t for t in (name, label(y) if len(ys) > 1 else "") if t)
                axes.plot(*zip(*pairs), linestyle=dashes, label=told, **style(index))
    if plot["log_x"]:
        log_axis(axes, every_x)
    return finish(figure, axes, plot, label(ys[0]))


def bars(points, plot, ys):
    """One group a value of x, one bar a series."""
    y = ys[0]
    groups = in_order(text(p, plot["x"]) for p in points)
    names = [""] if plot["series"] == plot["x"] else in_order(text(p, plot["series"]) for p in points)
    figure, axes = plt.subplots(figsize=(6.4, max(2.2, 0.32 * len(groups) * len(names) + 1)))
    height = 0.8 / len(names)
    for index, name in enumerate(names):
        found = [(groups.index(text(p, plot["x"])), value(p, y)) for p in points
                 if (not name or text(p, plot["series"]) == name) and value(p, y) is not None]
        if found:
            places, widths = zip(*found)
            drawn = axes.barh([g + (index - (len(names) - 1) / 2) * height for g in places], widths, height * 0.9,
                              color=COLOURS[index % len(COLOURS)], label=name)
            axes.bar_label(drawn, fmt="%.4g", padding=3, fontsize=8)
    axes.set_yticks(range(len(groups)), groups)
    axes.xaxis.set_major_locator(ticker.MaxNLocator(5))
    axes.invert_yaxis()
    axes.grid(False, axis="y")
    finish(figure, axes, plot, "")
    axes.set_xlabel(plot["y_label"] or label(y))
    axes.set_ylabel("" if plot["x"] == "variant" else plot["x_label"])
    return figure


def stack(points, plot, ys):
    """One bar a value of x, its parts end to end."""
    names = in_order(text(p, plot["x"]) for p in points)
    figure, axes = plt.subplots(figsize=(6.4, 0.55 * len(names) + 1.2))
    ends = dict.fromkeys(names, 0.0)
    for index, y in enumerate(ys):
        parts = {text(p, plot["x"]): value(p, y) or 0.0 for p in points}
        axes.barh(names, [parts[n] for n in names], 0.6, left=[ends[n] for n in names],
                  color=COLOURS[index % len(COLOURS)], label=label(y))
        ends = {n: ends[n] + parts[n] for n in names}
    for n in names:
        axes.text(ends[n], n, f" {ends[n]:.1f}", va="center", fontsize=9)
    axes.invert_yaxis()
    axes.grid(False, axis="y")
    finish(figure, axes, plot, "")
    axes.set_xlabel(plot["y_label"])
    axes.set_ylabel("")
    return figure


def scatter(points, plot, ys, front):
    """One mark a point; those on the Pareto front are ringed."""
    figure, axes = plt.subplots()
    every_x = []
    for index, name in enumerate(in_order(text(p, plot["series"]) for p in points)):
        found = [(value(p, plot["x"]), value(p, ys[0]), p["id"] in front) for p in points
                 if text(p, plot["series"]) == name and value(p, plot["x"]) is not None and value(p, ys[0]) is not None]
        if found:
            xs, values, best = zip(*found)
            every_x += xs
            axes.plot(xs, values, linestyle="", label=name, **style(index))
            axes.plot([x for x, b in zip(xs, best) if b], [v for v, b in zip(values, best) if b], linestyle="", marker="o",
                      markersize=10, markerfacecolor="none", markeredgecolor="#444444", markeredgewidth=0.9)
    if front:
        axes.plot([], [], linestyle="", marker="o", markersize=10, markerfacecolor="none", markeredgecolor="#444444",
                  label="no other point is better\nin everything")
    if plot["log_x"]:
        log_axis(axes, every_x)
    return finish(figure, axes, plot, label(ys[0]))


def pictures_of(points, plot, front):
    """(y, figure) of one plot of the experiment: one each y, but a stack or a shared y label takes all in one. What no
    point has is left out."""
    measured = [y for y in plot["y"] if any(value(p, y) is not None for p in points)]
    if not measured:
        return []
    if plot["kind"] == "stack":
        return [(measured[0], stack(points, plot, measured))]
    if plot["kind"] == "bars":
        return [(y, bars(points, plot, [y])) for y in measured]
    if plot["kind"] == "scatter":
        return [(y, scatter(points, plot, [y], front)) for y in measured]
    together = [measured] if plot["y_label"] and len(measured) <= 4 else [[y] for y in measured]
    return [(ys[0], line(points, plot, ys)) for ys in together]
