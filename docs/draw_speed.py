#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/speed.svg of a report of cdprep compare with other libraries.

docs/STUDIES.md has the command that measures. speed.json has the part of its report that the chart
shows:

    docs/draw_speed.py tests/bench/results/epyc_avx2/speed.json

A bar is the geometric mean, over all pairs of models, of the median time of a query over the poses.
"""
import html
import json
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
OURS = "exact BVH"
QUERIES = [("collide", "Do they touch? (overlapping)", "collide_deep"),
           ("collide", "Do they touch? (0.1 to 5 % apart)", "collide_near"),
           ("overlap", "Which triangles overlap?", "overlap_deep"),
           ("distance", "How far apart? (near)", "distance_near")]
# Embree is left out: its boxes do not turn, so that each pose would also pay for a new tree.
NAMES = {OURS: "cdprep", "FCL": "FCL", "ODE": "ODE", "Bullet": "Bullet", "CGAL": "CGAL"}
WIDTH, ROW, LEFT, RIGHT = 770, 17, 272, 110


def shown_name(label):
    for start, name in NAMES.items():
        if label.startswith(start):
            return name
    return None


def tables_of_pairs(report):
    for table in report["tables"]:
        if "median over the poses" in table["title"]:
            yield {row["label"]: row["cells"] for row in table["rows"]}


def means(report, key):
    """By library, the geometric mean in seconds of those that answer at every pair."""
    found = {}
    tables = list(tables_of_pairs(report))
    for rows in tables:
        for label, cells in rows.items():
            name = shown_name(label)
            value = cells.get(key, {}).get("value")
            if name and value:
                found.setdefault(name, []).append(value)
    return {name: math.exp(sum(map(math.log, values)) / len(values))
            for name, values in found.items() if len(values) == len(tables)}


def wrong_of(report):
    """Libraries that gave a wrong answer, with the share of right ones."""
    shares = {}
    for rows in tables_of_pairs(report):
        for label, cells in rows.items():
            name, share = shown_name(label), cells.get("agreement", {}).get("value")
            if name and share is not None:
                shares[name] = min(share, shares.get(name, 1))
    return {name for name, share in shares.items() if share < 1}


def time_text(seconds):
    for unit, scale in (("s", 1), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)):
        if seconds * scale >= 1:
            return f"{seconds * scale:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def draw(report):
    groups = [(title, means(report, key)) for _, title, key in QUERIES]
    values = [value for _, group in groups for value in group.values()]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    wrong = wrong_of(report)
    body, y = [], 44

    def place(value):
        return LEFT + (math.log10(value) - low) / (high - low) * (WIDTH - LEFT - RIGHT)

    top = y
    for title, group in groups:
        body.append(f'<text x="8" y="{y + 13}" class="query">{html.escape(title)}</text>')
        for name, value in sorted(group.items(), key=lambda item: item[1]):
            kind = "ours" if name == "cdprep" else "peer"
            mark = " *" if name in wrong else ""
            times = value / group["cdprep"]
            ratio = "" if name == "cdprep" else f" ({times:,.{0 if times >= 20 else 1}f}x)"
            body.append(f'<rect x="{LEFT}" y="{y + 3}" width="{place(value) - LEFT:.1f}" '
                        f'height="{ROW - 5}" class="{kind}"/>')
            body.append(f'<text x="{LEFT - 6}" y="{y + 13}" class="name">{name}{mark}</text>')
            body.append(f'<text x="{place(value) + 4:.1f}" y="{y + 13}">'
                        f'{time_text(value)}{ratio}</text>')
            y += ROW
        y += 10
    grid = "".join(
        f'<line x1="{place(10.0 ** e):.1f}" y1="{top - 4}" x2="{place(10.0 ** e):.1f}" y2="{y - 6}"/>'
        f'<text x="{place(10.0 ** e):.1f}" y="{top - 10}" class="tick">{time_text(10.0 ** e)}</text>'
        for e in range(low, high + 1))
    machine, pairs = report["machine"], len(list(tables_of_pairs(report)))
    scans = "1 pair" if pairs == 1 else f"{pairs} pairs"
    notes = [f"{scans} of scans, one thread, {machine['processor']}, {machine['compiler']}, "
             f"{machine['kernels']}; logarithmic scale. Less is better."]
    if wrong:
        notes.append("* gave a wrong yes or no at some pose.")
    for note in notes:
        body.append(f'<text x="8" y="{y + 12}" class="note">{html.escape(note)}</text>')
        y += 16
    style = ("text{font:11px sans-serif;fill:#24292f}.query{font-weight:600}.name{text-anchor:end}"
             ".tick{text-anchor:middle;fill:#57606a}.note{fill:#57606a}"
             ".ours{fill:#0a58ca}.peer{fill:#9aa4b2}line{stroke:#d8dee4}")
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {y + 8}" '
            f'width="{WIDTH}" role="img" aria-label="Median time of queries by library">\n'
            f'<style>{style}</style>\n<rect width="{WIDTH}" height="{y + 8}" fill="#fff"/>\n'
            f'<text x="8" y="18" style="font-size:13px;font-weight:600">Median time of a query</text>\n'
            f'{grid}\n' + "\n".join(body) + "\n</svg>\n")


def main():
    report = json.loads(pathlib.Path(sys.argv[1]).read_text())
    (ROOT / "docs/speed.svg").write_text(draw(report))


if __name__ == "__main__":
    main()
