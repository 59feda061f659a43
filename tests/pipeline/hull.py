#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Asks the program for hulls and proves them with fractions.

Every vertex of the input must be behind or on every facet as it stands in the file; corners
of exact hulls must be vertices; groups must be named; what cannot be answered must say why
in one sentence, with the right exit code.
Usage: hull.py CDPREP
"""
import fractions
import json
import pathlib
import random
import re
import sys
import tempfile

from schemas import report_of
from shared_models import must, run

F = fractions.Fraction


def write_obj(path, vertices, triangles):
    path.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices)
                    + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles))


def read_obj(path):
    """Vertices, triangles and, by name, the triangles of groups."""
    vertices, triangles, groups = [], [], {}
    group = groups.setdefault("", [])
    for line in path.read_text().splitlines():
        words = line.split()
        if words[0] == "v":
            vertices.append(tuple(map(float, words[1:])))
        elif words[0] == "g":
            group = groups.setdefault(words[1], [])
        elif words[0] == "f":
            group.append(tuple(int(word) - 1 for word in words[1:]))
            triangles.append(group[-1])
    return vertices, triangles, {name: group for name, group in groups.items() if group}


def exact(point):
    return tuple(map(F, point))


def height(a, b, c, p):
    """Above 0 when p is in front of the plane of a, b, c."""
    u, v, w = (tuple(x - y for x, y in zip(q, a)) for q in (b, c, p))
    return (w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2])
            + w[2] * (u[0] * v[1] - u[1] * v[0]))


def must_contain(name, vertices, triangles, points):
    corners = [exact(v) for v in vertices]
    for a, b, c in triangles:
        for p in points:
            must(height(corners[a], corners[b], corners[c], exact(p)) <= 0,
                 f"{name}: {p} is in front of a facet")


def cloud(seed, count):
    draw = random.Random(seed)
    return [tuple(draw.gauss(0, 1) for _ in range(3)) for _ in range(count)]


def soup_over(points):
    """Triangles that use every point."""
    return [(i, (i + 1) % len(points), (i + 2) % len(points)) for i in range(len(points))]


def check_exact_and_enclosing(program, folder):
    source, output = folder / "cloud.obj", folder / "hull.obj"
    points = cloud(1, 300)
    write_obj(source, points, soup_over(points))
    for most in (None, 4, 8, 20):
        options = [] if most is None else ["--max-vertices", most]
        done = run(program, "hull", source, "-o", output, "--format", "json", *options)
        must(done.returncode == 0, done.stderr)
        report = report_of("hull", done.stdout)
        hull, = report["hulls"]
        vertices, triangles, groups = read_obj(output)
        must(list(groups) == ["hull"], f"groups {list(groups)}")
        must_contain(f"{most} vertices", vertices, triangles, points)
        must((len(vertices), len(triangles)) == (hull["points"], hull["facets"]),
             "figures are not the file's")
        must(len(triangles) == 2 * len(vertices) - 4, "V - E + F is not 2")
        must(hull["exact"] == (most is None), "exact where it should not be, or not")
        if most is None:
            must(set(vertices) <= set(points), "a corner is no vertex")
            must(hull["distance"] == 0, "distance of the exact hull")
        else:
            must(len(vertices) <= most and hull["distance"] > 0, f"{len(vertices)} of {most}")


def check_parts(program, folder):
    """Two boxes: one hull for both, one for each."""
    corners = [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]
    points = corners + [(x + 5, y, z) for x, y, z in corners]
    triangles = [tuple(t) for t in soup_over(corners)]
    triangles += [tuple(i + 8 for i in t) for t in soup_over(corners)]
    source, output = folder / "boxes.obj", folder / "parts.obj"
    write_obj(source, points, triangles)
    for scope, hulls in (("whole", 1), ("component", 2), ("node", 1)):
        done = run(program, "hull", source, "-o", output, "--per", scope, "--format", "json")
        must(done.returncode == 0, done.stderr)
        report = report_of("hull", done.stdout)
        must(len(report["hulls"]) == hulls, f"{scope}: {len(report['hulls'])} hulls")
        for hull in report["hulls"]:
            must((hull["dimension"], hull["points"], hull["faces"]) == (3, 8, 6), f"{hull}")
        groups = read_obj(output)[2]
        must(sorted(groups) == sorted(hull["name"] for hull in report["hulls"]), f"{groups}")


def check_low_dimensions(program, folder):
    source, output = folder / "flat.obj", folder / "flat_hull.off"
    for dimension, points in ((0, [(1.0, 2.0, 3.0)] * 3), (1, [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0),
                                                              (2.0, 2.0, 2.0)]),
                              (2, [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)])):
        write_obj(source, points, [(0, 1, 2)])
        done = run(program, "hull", source, "-o", output, "--format", "json")
        must(done.returncode == 0, done.stderr)
        hull, = report_of("hull", done.stdout)["hulls"]
        must((hull["dimension"], hull["points"]) == (dimension, dimension + 1), f"{hull}")


def check_every_format(program, folder):
    """Read back by the program itself, the hull of a hull has as many corners."""
    source = folder / "floats.obj"
    points = [tuple(round(x, 3) for x in p) for p in cloud(2, 100)]
    write_obj(source, points, soup_over(points))
    for extension in ("obj", "ply", "stl", "off"):
        first, second = folder / f"a.{extension}", folder / f"b.{extension}"
        run(program, "hull", source, "-o", first)
        counts = [report_of("hull", run(program, "hull", path, "-o", second, "--format",
                                        "json").stdout)["hulls"][0]["points"]
                  for path in (source, first)]
        must(counts[0] == counts[1], f"{extension}: {counts}")
        # STL has no shared vertices, whose numbers decide on the order of facets.
        must(extension == "stl" or first.read_bytes() == second.read_bytes(),
             f"{extension}: another hull of a hull")


def check_baked(program, folder):
    """What bake stores is what info tells, proved by --deep, and read by h5py."""
    source, baked = folder / "two.obj", folder / "two.cdp.h5"
    points = cloud(4, 80) + [(x + 9, y, z) for x, y, z in cloud(5, 40)]
    write_obj(source, points, soup_over(points[:80])
              + [tuple(i + 80 for i in t) for t in soup_over(points[80:])])
    done = run(program, "bake", source, "-o", baked, "--structures", "hull")
    must(done.returncode == 0, done.stderr)
    done = run(program, "info", baked, "--deep", "--format", "json")
    must(done.returncode == 0, done.stderr)
    hulls = report_of("info", done.stdout)["hulls"]
    must([(hull["around"], hull["number"]) for hull in hulls]
         == [("whole", 0), ("component", 0), ("component", 1)], f"{hulls}")
    try:
        import h5py
    except ImportError:
        return
    with h5py.File(baked, "r") as file:
        data = file["cdprep"]
        for told, stored in zip(hulls, data["hulls"][:]):
            must(told["points"] == stored["point_count"], f"{told}: {stored}")
            for lane in range(stored["point_count"]):
                block, place = divmod(8 * stored["first_block"] + lane, 8)
                vertex = points[data["hull_vertices"][8 * block + place]]
                must(tuple(data["hull_blocks"][block]["at"][:, place]) == vertex,
                     f"point {lane} is not its vertex")


def check_queries(program, folder):
    """Hulls answer for the models that they contain: never too far, never apart that touch."""
    boxes = []
    for name, seed in (("a", 6), ("b", 7)):
        source, baked = folder / f"{name}.obj", folder / f"{name}.cdp.h5"
        points = cloud(seed, 150)
        write_obj(source, points, soup_over(points))
        done = run(program, "bake", source, "-o", baked, "--structures", "hull")
        must(done.returncode == 0, done.stderr)
        boxes.append(baked)
    poses = folder / "poses.txt"
    poses.write_text("".join(f"1 0 0 0 1 0 0 0 1 {0.75 * i!r} {0.125 * i!r} 0\n"
                             for i in range(24)))

    def ask(*question):
        done = run(program, "query", *question, "--poses", poses, "--format", "json")
        must(done.returncode == 0, done.stderr)
        return json.loads(done.stdout)

    touching = 0
    for model, hull, apart, near in zip(
            ask("collide", *boxes), ask("collide", *boxes, "--structure", "hull"),
            ask("distance", *boxes), ask("distance", *boxes, "--structure", "hull")):
        must(hull["approximate"] and near["approximate"], "not marked as approximate")
        must(hull["hit"] or not model["hit"], f"{model} but {hull}")
        must(near["lower"] <= apart["upper"], f"{near} but {apart}")
        must(hull["hit"] == (near["upper"] == 0), f"{hull} but {near}")
        touching += hull["hit"]
    must(4 < touching < 20, f"{touching} of 24 poses touch: a one-sided test")
    for question in ("collide", "distance"):
        done = run(program, "query", question, *boxes, "--poses", poses, "--structure", "hull",
                   "--counts")
        told = re.fullmatch(r"(\d+) hull pairs, (\d+) steps.* decided (\d+) exactly, in (\d+) "
                            r"steps\n", done.stderr)
        must(told and int(told[1]) == 24 and int(told[2]) >= 24, f"{question}: {done.stderr}")
    bare = folder / "bare.cdp.h5"
    run(program, "bake", folder / "a.obj", "-o", bare)
    for arguments in (("collide", bare, bare), ("overlap", *boxes), ("within", *boxes,
                      "--tolerance", "1"), ("collide", *boxes, "--descent", "larger")):
        done = run(program, "query", *arguments, "--structure", "hull")
        must(done.returncode == 2 and done.stderr, f"{arguments}: exit {done.returncode}")


def check_refusals(program, folder):
    good, bad = folder / "good.obj", folder / "bad.obj"
    write_obj(good, [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.1, 0.0)], [(0, 1, 2)])
    write_obj(bad, [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, float("inf"), 0.0)], [(0, 1, 2)])
    points = cloud(3, 60)
    doubles = folder / "doubles.obj"
    write_obj(doubles, points, soup_over(points))
    for code, arguments in ((3, (bad, "-o", folder / "x.obj")),
                            (3, (folder / "none.obj", "-o", folder / "x.obj")),
                            (2, (good, "-o", folder / "x.step")),
                            (2, (good, "-o", good)),
                            (2, (doubles, "-o", folder / "x.stl")),
                            (2, (good, "-o", folder / "x.obj", "--max-vertices", "3")),
                            (4, (good, "-o", folder / "no_folder" / "x.obj"))):
        done = run(program, "hull", *arguments)
        must(done.returncode == code, f"{arguments}: exit {done.returncode}: {done.stderr}")
        must(done.stderr.strip() and not done.stdout, f"{arguments}: no sentence")
        must(not (folder / "x.obj").exists(), f"{arguments}: written all the same")


def main(program):
    with tempfile.TemporaryDirectory() as name:
        for check in (check_exact_and_enclosing, check_parts, check_low_dimensions,
                      check_every_format, check_baked, check_queries, check_refusals):
            check(program, pathlib.Path(name))
    print("hulls are as proved")


if __name__ == "__main__":
    main(sys.argv[1])
