#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws what octree_search_bench printed, as one SVG.

Above: what a search takes by depth, for one mesh, a panel for each state and set of points.
Below: what each search by key saves of each descent's time, a dot for each case (mesh,
depth, points, state), beside the 80 % that the talk claims. Losses beyond 100 % are drawn
at its edge.

Usage: octree_search_plot.py TABLE.csv PICTURE.svg [MESH]
Without MESH the last one of the table is drawn above.
"""
import collections
import csv
import math
import sys

COLOURS = {"H0": "#999999", "H1": "#666666", "H2": "#222222", "H3": "#c49c6b",
           "K0": "#d62728", "K1": "#ff7f0e", "K2": "#e377c2",
           "L1": "#6baed6", "L2": "#1f4fb4"}
MEANINGS = {"H0": "recursion, boxes", "H1": "centres", "H2": "bits of a key, pointers",
            "H3": "bits of a key, masks", "K0": "hashed: modulus", "K1": "hashed: mixed",
            "K2": "hashed: levels bisected", "L1": "sorted leaves", "L2": "with a top table"}
STATES = {"warm": "#d62728", "in_turn": "#2ca02c", "cold": "#1f4fb4"}
SETS = ("uniform", "surface", "walk")
CLAIM = 0.8
WIDTH, PANEL_WIDTH, PANEL_HEIGHT, GAP, LEFT, TOP = 1120, 260, 190, 50, 70, 90


def read(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Picture:
    def __init__(self):
        self.parts = []

    def text(self, x, y, words, size=12, anchor="middle", colour="#222"):
        words = words.replace("&", "&amp;").replace("<", "&lt;")
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" '
                          f'text-anchor="{anchor}" fill="{colour}">{words}</text>')

    def line(self, x1, y1, x2, y2, colour="#ddd", width=1, dash=""):
        dash = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
                          f'stroke="{colour}" stroke-width="{width}"{dash}/>')

    def dot(self, x, y, radius, colour, opacity=1):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{colour}" '
                          f'fill-opacity="{opacity}"/>')

    def written(self, path, height):
        with open(path, "w", encoding="utf-8") as file:
            file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" '
                       f'height="{height}" viewBox="0 0 {WIDTH} {height}" '
                       'font-family="sans-serif">\n'
                       f'<rect width="{WIDTH}" height="{height}" fill="white"/>\n')
            file.write("\n".join(self.parts) + "\n</svg>\n")


def draw_times(picture, rows, x, y, with_labels):
    """One panel: ns over depth, both ends of the scale the same in a state."""
    depths = sorted({int(row["depth"]) for row in rows["panel"]})
    low, high = rows["range"]

    def place(depth, ns):
        along = depths.index(depth) / max(1, len(depths) - 1)
        up = (math.log(ns) - math.log(low)) / (math.log(high) - math.log(low))
        return x + 15 + along * (PANEL_WIDTH - 30), y + PANEL_HEIGHT * (1 - up)

    for power in range(0, 5):
        for step in (1, 2, 5):
            ns = step * 10 ** power
            if low <= ns <= high:
                _, at = place(depths[0], ns)
                picture.line(x, at, x + PANEL_WIDTH, at)
                if with_labels:
                    picture.text(x - 6, at + 4, str(ns), 11, "end")
    for depth in depths:
        at, _ = place(depth, low)
        picture.text(at, y + PANEL_HEIGHT + 15, str(depth), 11)
    by_name = collections.defaultdict(list)
    for row in rows["panel"]:
        by_name[row["contender"]].append((int(row["depth"]), float(row["median_ns"])))
    for name, points in by_name.items():
        places = [place(*point) for point in sorted(points)]
        for a, b in zip(places, places[1:]):
            picture.line(*a, *b, COLOURS[name], 2, "5,3" if name.startswith("H") else "")
        for at in places:
            picture.dot(*at, 3, COLOURS[name])


def draw_all_times(picture, rows, mesh):
    picture.text(WIDTH / 2, 24, f"Finding the leaf of a point in octrees of {mesh}: "
                 "ns a search, by depth", 17)
    for i, name in enumerate(COLOURS):
        x, y = LEFT + 200 * (i % 5), 44 + 18 * (i // 5)
        picture.line(x, y, x + 24, y, COLOURS[name], 3, "5,3" if name.startswith("H") else "")
        picture.text(x + 30, y + 4, f"{name} {MEANINGS[name]}", 12, "start")
    for i, state in enumerate(STATES):
        of_state = [row for row in rows if row["state"] == state and row["mesh"] == mesh]
        all_ns = [float(row["median_ns"]) for row in of_state]
        for j, points in enumerate(SETS):
            x = LEFT + j * (PANEL_WIDTH + GAP + 30)
            y = TOP + 20 + i * (PANEL_HEIGHT + GAP)
            picture.text(x + PANEL_WIDTH / 2, y - 6, f"{points} points, {state}", 13)
            panel = [row for row in of_state if row["points"] == points]
            draw_times(picture, {"panel": panel,
                                 "range": (min(all_ns) * 0.9, max(all_ns) * 1.1)}, x, y, True)


def savings(rows):
    """{(baseline, contender): [(state, share saved)]}"""
    cases = collections.defaultdict(dict)
    for row in rows:
        case = tuple(row[key] for key in ("mesh", "depth", "points", "state"))
        cases[case][row["contender"]] = float(row["median_ns"])
    saved = collections.defaultdict(list)
    for case, ns in cases.items():
        for baseline in ns:
            for name in ns:
                if baseline.startswith("H") and not name.startswith("H"):
                    saved[baseline, name].append((case[3], 1 - ns[name] / ns[baseline]))
    return saved


def draw_savings(picture, rows, top):
    picture.text(WIDTH / 2, top, "Share of the descent's time that a search by key saves, "
                 "a dot for each case; dashed: the talk's 80 %", 17)
    for i, (state, colour) in enumerate(STATES.items()):
        picture.dot(LEFT + 380 + 100 * i, top + 18, 4, colour)
        picture.text(LEFT + 390 + 100 * i, top + 22, state, 12, "start")
    saved = savings(rows)
    names = [name for name in COLOURS if not name.startswith("H")]
    width, height = 225, 260
    for i, baseline in enumerate(name for name in COLOURS if name.startswith("H")):
        x, y = LEFT + i * (width + 36), top + 54

        def place(share):
            return y + height * (1 - max(-1, share)) / 2

        picture.text(x + width / 2, y - 8, f"against {baseline}: {MEANINGS[baseline]}", 13)
        for percent in (-100, -50, 0, 50, 100):
            picture.line(x, place(percent / 100), x + width, place(percent / 100),
                         "#888" if percent == 0 else "#ddd")
            if i == 0:
                picture.text(x - 6, place(percent / 100) + 4, f"{percent} %", 11, "end")
        picture.line(x, place(CLAIM), x + width, place(CLAIM), "#d62728", 1.5, "6,4")
        for j, name in enumerate(names):
            middle = x + (j + 0.5) * width / len(names)
            picture.text(middle, y + height + 16, name, 12)
            for state, share in saved[baseline, name]:
                at = middle + 11 * (list(STATES).index(state) - 1)
                picture.dot(at, place(share), 2.5, STATES[state], 0.6)
    return top + 54 + height + 30


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__.split("\n\n")[2])
    rows = read(sys.argv[1])
    mesh = sys.argv[3] if len(sys.argv) == 4 else rows[-1]["mesh"]
    picture = Picture()
    draw_all_times(picture, rows, mesh)
    bottom = draw_savings(picture, rows, TOP + 30 + 3 * (PANEL_HEIGHT + GAP) + 20)
    picture.written(sys.argv[2], bottom)


main()
