#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Hard triangle pairs and meshes, shifted by 2^20 and scaled by 2^-40, through the
program: the overlapping sets are those of CGAL's exact predicates.

Coordinates are multiples of 2^-20, so shift and scale are exact in double.
Usage: hard_placements.py CDPREP ORACLE
"""
import math
import pathlib
import subprocess
import sys
import tempfile

from shared_models import answers, bake, must

G = 2.0 ** -20
A = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]


def soup(*triangles):
    points = [point for triangle in triangles for point in triangle]
    return points, [(i, i + 1, i + 2) for i in range(0, len(points), 3)]


def grid(x):
    return round(x / G) * G


def torus(big, small, n, m, turn, shift):
    points = []
    for i in range(n):
        for j in range(m):
            u, v = 2 * math.pi * i / n, 2 * math.pi * j / m
            r = big + small * math.cos(v)
            p = (r * math.cos(u), r * math.sin(u), small * math.sin(v))
            p = (p[0], -p[2], p[1]) if turn else p
            points.append(tuple(grid(c + s) for c, s in zip(p, shift)))
    faces = []
    for i in range(n):
        for j in range(m):
            a, b = i * m + j, ((i + 1) % n) * m + j
            c, d = ((i + 1) % n) * m + (j + 1) % m, i * m + (j + 1) % m
            faces += [(a, b, c), (a, c, d)]
    return points, faces


def fan(n):
    ring = [(grid(8 * math.cos(2 * math.pi * i / n)), grid(8 * math.sin(2 * math.pi * i / n)), 1)
            for i in range(n)]
    return [(0, 0, 0)] + ring, [(0, i + 1, (i + 1) % n + 1) for i in range(n)]


def sheet(n, z):
    points = [(x / 4, y / 4, z(x, y)) for x in range(n + 1) for y in range(n + 1)]
    faces = []
    for x in range(n):
        for y in range(n):
            a = x * (n + 1) + y
            faces += [(a, a + n + 1, a + n + 2), (a, a + n + 2, a + 1)]
    return points, faces


def slivers(n, flip):
    rows = []
    for i in range(n):
        t = i / n
        rows.append([(grid(t), 0, 0), (grid(1 - t) if flip else grid(t), 1, 1),
                     (grid(t) + G, 0, 0)])
    return soup(*rows)


def scaled(triangle, factor):
    return [tuple(c * factor for c in p) for p in triangle]


CASES = {
    "T01 shared vertex": (soup(A), soup([(0, 0, 0), (-1, 0, 1), (0, -1, 1)])),
    "T02 shared edge": (soup(A), soup([(0, 0, 0), (1, 0, 0), (0, -1, 1)])),
    "T03 vertex on face": (soup(A), soup([(.25, .25, 0), (0, 0, 1), (1, 1, 1)])),
    "T04 vertex on edge": (soup(A), soup([(.5, 0, 0), (0, -1, 1), (1, -1, 1)])),
    "T05 edges cross": (soup(A), soup([(.5, .5, -1), (.5, .5, 1), (2, 2, 0)])),
    "T06 coplanar overlap": (soup(A), soup([(.25, .25, 0), (1.25, .25, 0), (.25, 1.25, 0)])),
    "T07 part of an edge": (soup(A), soup([(.25, 0, 0), (.75, 0, 0), (.5, -1, 0)])),
    "T08 coplanar vertex": (soup(A), soup([(1, 0, 0), (2, 0, 0), (2, 1, 0)])),
    "T09 nested": (soup(A), soup([(.125, .125, 0), (.5, .125, 0), (.125, .5, 0)])),
    "T10 coplanar apart": (soup(A), soup([(1, 1, 0), (1, G, 0), (G, 1, 0)])),
    "T11 one step above": (soup(A), soup([(0, 0, G), (1, 0, G), (0, 1, G)],
                                         [(0, 0, 0), (1, 0, G), (0, 1, G)],
                                         [(0, 0, G), (1, 0, -G), (0, 1, 0)])),
    "T19 identical": (soup(A), soup(A, [A[0], A[2], A[1]])),
    "T22 edge in the plane": (soup(A), soup([(2, 0, 0), (2, 1, 0), (2, 0, 1)],
                                            [(.25, -1, 0), (.25, 1, 0), (.25, 0, 1)])),
    "T23 near-parallel": (soup(scaled([(-.25, -.25, 0), (.75, -.25, 0), (-.25, .75, 0)], 1024)),
                          soup([(-256, -256, -G), (768, -256, 2 * G), (-256, 768, -G)])),
    "B01 a sheet and itself": (sheet(12, lambda x, y: (x * 7 + y * 5) % 3 / 8),
                               sheet(12, lambda x, y: (x * 7 + y * 5) % 3 / 8)),
    "B03 sheets one step apart": (sheet(12, lambda x, y: 0), sheet(12, lambda x, y: G)),
    "B04 interlocked tori": (torus(2, .5, 24, 12, False, (0, 0, 0)),
                             torus(2, .5, 24, 12, True, (2, 0, 0))),
    "B04 tori that cross": (torus(2, .75, 24, 12, False, (0, 0, 0)),
                            torus(2, .75, 24, 12, True, (1.5, .25, .125))),
    "B06 fan": (fan(500), soup([(0, 0, 0), (1, 0, -1), (0, 1, -1)])),
    "B08 diagonal slivers": (slivers(120, False), slivers(120, True)),
    "B12 big triangle": (torus(1, .5, 20, 10, False, (0, 0, 0)),
                         soup([(-10, -10, 0), (10, -10, .25), (0, 10, -.25)])),
}


def write_off(path, mesh, shift, scale):
    points, faces = mesh
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    for point in points:
        moved = [(c + shift) * scale for c in point]
        must(all(m / scale - shift == c for m, c in zip(moved, point)), f"{point} moves inexactly")
        lines.append(" ".join(repr(float(m)) for m in moved))
    lines += [f"3 {a} {b} {c}" for a, b, c in faces]
    path.write_text("\n".join(lines) + "\n")


def main():
    program, oracle = sys.argv[1], sys.argv[2]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    a, b = folder / "a.off", folder / "b.off"
    baked = [folder / "a.cdp.h5", folder / "b.cdp.h5"]
    for shift, scale in ((0, 1), (2.0 ** 20, 1), (0, 2.0 ** -40), (2.0 ** 20, 2.0 ** -40)):
        empty = total = 0
        for name, (mesh_a, mesh_b) in CASES.items():
            write_off(a, mesh_a, shift, scale)
            write_off(b, mesh_b, shift, scale)
            bake(program, a, b, "--output-dir", folder)
            found = answers(program, "overlap", *baked)[0]["pairs"]
            done = subprocess.run([oracle, a, b], capture_output=True, text=True, check=True)
            exact = [list(map(int, line.split())) for line in done.stdout.splitlines()]
            must(found == exact, f"{name}, shift {shift}, scale {scale}: {len(found)} pairs, "
                                 f"exact {len(exact)}")
            empty, total = empty + (not exact), total + len(exact)
        must(0 < empty < len(CASES) / 2 and total > 1000, "the cases became one-sided")
        print(f"shift {shift:g}, scale {scale:g}: {len(CASES)} cases, {total} pairs, all exact")


main()
