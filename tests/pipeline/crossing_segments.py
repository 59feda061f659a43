#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""overlap --segments through the program: the pairs are those without it, each end of a
segment lies in both triangles, and two cubes cut each other in a closed line of known
length. Also --counts.

Usage: crossing_segments.py CDPREP
"""
import itertools
import math
import pathlib
import re
import sys
import tempfile
from fractions import Fraction

from shared_models import answers, bake, must, run


CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
FACES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
         (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def write_cube(path, edge):
    rows = [" ".join(str(edge * c) for c in corner) for corner in CORNERS]
    path.write_text("\n".join(["OFF", "8 12 0", *rows,
                               *(f"3 {a} {b} {c}" for a, b, c in FACES)]) + "\n")


def cube_triangles(shift):
    points = [tuple(2 * c + s for c, s in zip(corner, shift)) for corner in CORNERS]
    return [[points[i] for i in face] for face in FACES]


def off_plane(p, t):
    """The volume that p spans with the triangle, by the triangle's area."""
    u, v, w = ([Fraction(a) - b for a, b in zip(q, t[0])] for q in (t[1], t[2], p))
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    return abs(float(sum(a * b for a, b in zip(n, w)))) / math.sqrt(float(sum(a * a for a in n)))


def in_box(p, t):
    return all(min(q[i] for q in t) - 1e-15 <= p[i] <= max(q[i] for q in t) + 1e-15
               for i in range(3))


def check(program, cube, shift):
    pose = ["--pose", "1 0 0 0 1 0 0 0 1 " + " ".join(map(str, shift))]
    plain = answers(program, "overlap", cube, cube, *pose)[0]
    found = answers(program, "overlap", cube, cube, *pose, "--segments")[0]
    must(found["pairs"] == plain["pairs"] and found["count"] == len(found["segments"]),
         f"shift {shift}: {found['count']} pairs, without segments {plain['count']}")
    still = cube_triangles((0, 0, 0))
    moved = cube_triangles([Fraction(s) for s in shift])
    length = flat = points = 0
    for (a, b), segment in zip(found["pairs"], found["segments"]):
        if segment is None:
            flat += 1
            continue
        ends = segment[:3], segment[3:]
        for p, t in itertools.product(ends, (still[a], moved[b])):
            must(off_plane(p, t) < 1e-15 and in_box(p, t), f"shift {shift}: {p} is not in {t}")
        length += math.dist(*ends)
        points += ends[0] == ends[1]
    return length, flat, points, found["count"]


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    write_cube(folder / "cube.off", 2)
    cube = folder / "cube.cdp.h5"
    bake(program, folder / "cube.off", "-o", cube)

    # Two cubes of edge 2, a corner of one inside the other by 1.5, 1.25 and 1: six
    # edges of the common box are cut, two of each length.
    length, flat, points, count = check(program, cube, (0.5, 0.75, 1.0))
    must(abs(length - 2 * (1.5 + 1.25 + 1.0)) < 1e-13 and flat == 0, f"length {length}, {flat} flat")
    must(points < count, f"{points} points of {count}")

    # Face on face: the four triangles in it overlap flatly, and neighbours in points.
    length, flat, points, count = check(program, cube, (2.0, 0.25, 0.5))
    must(0 < flat < count and count > 8, f"{flat} flat of {count}")
    length, flat, points, count = check(program, cube, (2.0, 2.0, 2.0))
    must(flat + points == count > 0 and length == 0, f"corner on corner: {points} of {count}")

    text = run(program, "query", "overlap", cube, cube, "--pose", "1 0 0 0 1 0 0 0 1 2 0 0",
               "--segments", "--counts")
    must(re.search(r"^  \d+ \d+ from \S+ \S+ \S+ to \S+ \S+ \S+$", text.stdout, re.M)
         and re.search(r"^  \d+ \d+ flat$", text.stdout, re.M), text.stdout)
    must(re.search(r"^\d+ box pairs, [1-9]\d* leaf pairs, .* decided \d+ in float", text.stderr),
         text.stderr)

    # A cube in a cube: apart as surfaces, not as solids.
    write_cube(folder / "small.off", 0.5)
    small = folder / "small.cdp.h5"
    bake(program, folder / "small.off", "-o", small)
    pose = ["--pose", "1 0 0 0 1 0 0 0 1 0.75 0.75 0.75"]
    surfaces = answers(program, "distance", cube, small, *pose)[0]
    solids = answers(program, "distance", cube, small, *pose, "--as", "solid")[0]
    must(abs(surfaces["lower"] - 0.75) < 1e-12 and solids["upper"] == 0, f"{surfaces}, {solids}")
    must(run(program, "query", "overlap", cube, cube, "--segments", "--count").returncode == 2,
         "--segments with --count is an invalid argument")
    print("segments of two cubes: all in both triangles, length as known")


main()
