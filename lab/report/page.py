"""The report's page: one HTML file that needs nothing else, pictures included."""

import base64
import html
import pathlib

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 74rem; margin: 2rem auto; padding: 0 1.2rem; }
h1 { font-size: 1.6rem; margin: 0 0 .2rem; } h2 { font-size: 1.2rem; margin: 2.4rem 0 .6rem; } h3 { font-size: 1rem; }
.note { color: #555; max-width: 52rem; } .warn { color: #a33; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .7rem; border-bottom: 1px solid #e2e2e2; text-align: right; white-space: nowrap; }
th { font-weight: 600; background: #f6f6f6; } th:first-child, td:first-child { text-align: left; }
tr.best td { background: #eef6ee; } .wide { overflow-x: auto; }
figure { display: inline-block; margin: .4rem 1.2rem .4rem 0; vertical-align: top; } figcaption { color: #555; font-size: 13px; }
img { max-width: 100%; } details { margin: .4rem 0; } summary { cursor: pointer; }
"""


def escape(text):
    return html.escape(str(text))


def number(value, digits=4):
    if value is None:
        return ""
    if value == int(value) and abs(value) < 1e9:
        return f"{value:.0f}"
    return f"{value:.{digits}g}"


def data_uri(path):
    kind = {".png": "image/png", ".svg": "image/svg+xml"}[pathlib.Path(path).suffix]
    return f"data:{kind};base64," + base64.b64encode(pathlib.Path(path).read_bytes()).decode()


def table(head, rows, best=()):
    """`rows` of texts; the row numbers in `best` are marked."""
    lines = ["<div class=wide><table><tr>" + "".join(f"<th>{escape(h)}</th>" for h in head) + "</tr>"]
    for index, row in enumerate(rows):
        lines.append(("<tr class=best>" if index in best else "<tr>") + "".join(f"<td>{escape(c)}</td>" for c in row) + "</tr>")
    return "\n".join(lines) + "</table></div>"


def names_of(points, key):
    return list(dict.fromkeys(name for p in points for name in p[key]))


def figure_table(results, key):
    """All points with all their figures (or timings); names of nothing but blanks are left out."""
    points = results["points"]
    names = [n for n in names_of(points, key) if any(p[key].get(n) is not None for p in points)]
    if not names:
        return ""
    rows = [[p["label"]] + [number(p[key].get(n)) for n in names] for p in points]
    front = set(results["analysis"]["front"])
    return table(["point"] + names, rows, {i for i, p in enumerate(points) if p["id"] in front})


def crossover_text(one, reference, x):
    if not one["at"]:
        return f"{reference if one['reference_first'] else one['variant']} is better at every measured {x}"
    parts = [f"from {a['x']:.3g} on {reference if a['rises'] else one['variant']} is better" for a in one["at"]]
    return "; ".join(parts)


def crossovers(results):
    found = results["analysis"]["crossovers"]
    if not found:
        return ""
    rule = results["rules"]["crossover"]
    rows = [[one["variant"], one["group"], crossover_text(one, rule["reference"], rule["x"])] for one in found]
    return (f"<h2>Where {escape(rule['reference'])} crosses the others</h2><p class=note>By {escape(rule['y'])} along "
            f"{escape(rule['x'])}, linear between measured values.</p>" + table(["against", "", ""], rows))


def rates(results):
    found = results["analysis"]["rates"]
    if not found:
        return ""
    rule = results["rules"]["rate"]
    rows = [[one["variant"], one["group"], "" if one["rate_percent"] is None else f"{one['rate_percent']:+.1f} %",
             "" if one["quality"] is None else f"{one['quality']:+.4f}", one["why"]] for one in found]
    return (f"<h2>Bjontegaard differences</h2><p class=note>Against {escape(rule['reference'])}: more "
            f"{escape(rule['rate'])} for the same {escape(rule['quality'])}, and better {escape(rule['quality'])} for the "
            "same rate.</p>" + table(["variant", "", "rate", rule["quality"], ""], rows))


def differences(results):
    """A row a variant, two columns a y: its value, and how much more that is than the reference's."""
    found = results["analysis"]["differences"]
    if not found:
        return ""
    rule = results["rules"]["difference"]
    rows = {}
    for one in found:
        cells = rows.setdefault((one["group"], one["variant"]), dict.fromkeys(rule["y"], ("", "")))
        more = "" if one["more"] is None or one["variant"] == rule["reference"] else f"{one['more']:+.4f}"
        cells[one["y"]] = (number(one["value"]), more)
    shown = [[group, variant] + [text for pair in cells.values() for text in pair] for (group, variant), cells in rows.items()]
    best = {i for i, (_, variant) in enumerate(rows) if variant == rule["reference"]}
    return (f"<h2>Beside {escape(rule['reference'])}</h2><p class=note>All else equal; differences are signed.</p>"
            + table(["", "variant"] + [t for y in rule["y"] for t in (y, "difference")], shown, best))


def advice(results):
    found = results["analysis"]["advice"]
    if not found:
        return ""
    rules = {r["client"]: r for r in results["rules"]["recommend"]}
    by_id = {p["id"]: p for p in results["points"]}
    rows = []
    for one in found:
        rule = rules[one["client"]]
        limits = ", ".join(f"{name} ≤ {most:g}" for name, most in rule["at_most"].items())
        point = by_id.get(one["id"])
        best = number(point["figures"].get(rule["best"])) if point else ""
        rows.append([one["client"], limits, one["label"] or "no point keeps these limits", best])
    return ("<h2>Recommended settings</h2><p class=note>The best measured point within each client's limits; times are this "
            "machine's.</p>" + table(["client", "limits", "point", "value"], rows))


def plot_section(drawn):
    """`drawn`: (title, PNG path) in order."""
    parts, last = [], None
    for title, path in drawn:
        if title != last:
            parts.append(f"<h2>{escape(title)}</h2>")
            last = title
        parts.append(f"<figure><img src='{data_uri(path)}' alt='{escape(title)}'></figure>")
    return "\n".join(parts)


def picture_section(results, folder, most=24):
    """Pictures that points left: ground truth, view and difference. More than `most` points stay files."""
    shown = [(p, name) for p in results["points"] for name in p["pictures"] if name.endswith("worst.png")]
    if not shown:
        return ""
    parts = ["<h2>Pictures</h2><p class=note>Each point's worst measured frame. Further pictures are in points/.</p>"]
    for point, name in shown[:most]:
        parts.append(f"<details><summary>{escape(point['label'])}</summary><img src='{data_uri(folder / name)}' alt=''></details>")
    if len(shown) > most:
        parts.append(f"<p class=note>{len(shown) - most} more are in points/.</p>")
    return "\n".join(parts)


def provenance(results):
    rows = [[name, "; ".join(texts) if len(texts) <= 3 else f"{min(texts)} … {max(texts)} ({len(texts)} values)"]
            for name, texts in results["provenance"].items()]
    return "<h2>Provenance</h2>" + table(["", ""], rows)


def page(results, drawn, folder):
    head = [f"<h1>{escape(results['title'] or results['name'])}</h1>"]
    if results["figure"]:
        head.append(f"<p class=note>Counterpart: {escape(results['figure'])}</p>")
    if results["notes"]:
        head.append(f"<p class=note>{escape(results['notes'])}</p>")
    if results["quick"]:
        head.append("<p class=warn>Made with --quick: a small scene, few frames. Good for a look, not for figures.</p>")
    if len(results["points"]) < results["planned"]:
        head.append(f"<p class=warn>{len(results['points'])} of {results['planned']} points are finished.</p>")
    if len(results["provenance"].get("commit", [])) > 1:
        head.append("<p class=warn>These points were made by different commits.</p>")
    parts = [*head, plot_section(drawn), crossovers(results), rates(results), differences(results), advice(results)]
    figures = figure_table(results, "figures")
    if figures:
        parts.append("<h2>Figures</h2>" + figures)
    timings = figure_table(results, "timings")
    if timings:
        parts.append("<h2>Timings</h2><p class=note>Wall clock: they differ from run to run and machine to machine.</p>" + timings)
    parts += [picture_section(results, folder), provenance(results)]
    return ("<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"
            f"<title>{escape(results['title'] or results['name'])}</title><style>{STYLE}</style>\n" + "\n".join(parts) + "\n</html>\n")
