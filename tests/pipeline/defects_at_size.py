#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Defects of meshes that are made to explode: memory stays linear, limits are said.

20,000 triangles in one plane, each over every other, are 199,990,000 pairs by hand; a double
cone is free of crossings, whatever its valence. Processor time is bounded generously: the
bounds tell near-linear from quadratic, not one machine from another. A program with sanitizers
needs FACTOR times as much.
Usage: defects_at_size.py CDPREP [FACTOR]
"""
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

from schemas import report_of
from shared_models import must

MEGABYTES = 300
SECONDS = 60  # of processor time; quadratic work takes many minutes


def write_ply(path, corners, triangles):
    with open(path, "wb") as file:
        file.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\n"
                   b"property float x\nproperty float y\nproperty float z\nelement face %d\n"
                   b"property list uchar uint vertex_indices\nend_header\n"
                   % (len(corners), len(triangles)))
        file.write(b"".join(struct.pack("<3f", *corner) for corner in corners))
        file.write(b"".join(struct.pack("<B3I", 3, *triangle) for triangle in triangles))
    return path


def shifted_triangles(count):
    """In the plane z = 0, each overlapping every other: shifts add up to less than a side."""
    corners = []
    for i in range(count):
        x, y = i / count / 8, i / count / 32
        corners += [(x, y, 0), (x + 1, y, 0), (x, y + 1, 0)]
    return corners, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(count)]


def double_cone(count):
    """Two vertices of valence `count`."""
    corners = [(0, 0, 1), (0, 0, -1)]
    triangles = []
    for i in range(count):
        angle = 2 * math.pi * i / count
        corners.append((math.cos(angle), math.sin(angle), 0))
        a, b = 2 + i, 2 + (i + 1) % count
        triangles += [(0, a, b), (1, b, a)]
    return corners, triangles


class Program:
    def __init__(self, path, folder, factor):
        self.path, self.folder = os.path.abspath(path), folder
        self.megabytes, self.seconds = MEGABYTES * factor, SECONDS * factor

    def __call__(self, *arguments):
        """Exit code, standard output, and what the process used."""
        command = [self.path, *map(str, arguments)]
        with tempfile.TemporaryFile("w+") as out:
            process = subprocess.Popen(command, stdout=out, stderr=subprocess.PIPE, text=True,
                                       cwd=self.folder)
            errors = process.stderr.read()
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            text = out.read()
        seconds = used.ru_utime + used.ru_stime
        must(used.ru_maxrss < self.megabytes * 1024, f"{arguments}: {used.ru_maxrss // 1024} MB")
        must(seconds < self.seconds, f"{arguments}: {seconds:.1f} s of processor time")
        print(f"{' '.join(map(str, arguments)):70} {seconds:6.2f} s {used.ru_maxrss >> 10:4} MB")
        return process.returncode, text, errors

    def validate(self, *arguments):
        code, text, errors = self("validate", *arguments, "--format", "json")
        report = report_of("validate", text)
        must(code == report["exit"], f"{arguments}: exit {code}: {errors}")
        return report["meshes"][0]


def finding(mesh, rule):
    return next(found for found in mesh["findings"] if found["rule"] == rule)


def counts_what_there_is(program):
    """Without a limit that is reached: n (n - 1) / 2 pairs, of triangles and of components."""
    count = 1500
    write_ply(program.folder / "some.ply", *shifted_triangles(count))
    mesh = program.validate("some.ply", "--max-issues", "3")
    pairs = count * (count - 1) // 2
    for name in ("coplanar_overlap_pairs", "self_intersecting_pairs", "overlapping_components"):
        must(mesh["counts"][name] == pairs, f"{name}: {mesh['counts'][name]}, not {pairs}")
    must(mesh["crossings_complete"] and "remarks" not in mesh, "it is complete")
    overlap = finding(mesh, "CDP0503")
    must([place["triangles"] for place in overlap["places"]] == [[0, 1], [0, 2], [0, 3]],
         f"the first places: {overlap['places']}")
    must("lower_bound" not in overlap, "no lower bound")


def t_junctions_have_a_limit(program):
    """Sides along one line, of which each holds a corner of every other: n (n - 1) in all."""
    count = 20_000
    corners, triangles = [], []
    for i in range(count):
        x = i / count / 8
        triangles.append((3 * i, 3 * i + 1, 3 * i + 2))
        corners += [(x, 0, 0), (x + 1, 0, 0), (x, 1, 1 + x)]
    write_ply(program.folder / "line.ply", corners, triangles)
    mesh = program.validate("line.ply", "--no-crossings")
    found = finding(mesh, "CDP0307")
    must(found["lower_bound"] and mesh["t_junctions_complete"] is False, "it has a limit")
    must(0 < found["count"] == mesh["counts"]["t_junctions"] < count * (count - 1),
         f"{found['count']} T-junctions")
    must("CDP0307" in mesh["remarks"][0], f"{mesh['remarks']}")


def says_where_it_ended(program):
    """At a limit of n pairs: at least n, not all, the same for any number of threads."""
    for limit in (1, 1000, 100_000):
        arguments = ("some.ply", "--max-pairs", limit)
        mesh = program.validate(*arguments)
        found = mesh["counts"]["coplanar_overlap_pairs"]
        must(limit <= found < 1500 * 1499 // 2, f"{found} pairs at a limit of {limit}")
        must(not mesh["crossings_complete"], "it is not complete")
        must("--max-pairs" in mesh["remarks"][0], f"remarks: {mesh['remarks']}")
        must(finding(mesh, "CDP0503")["lower_bound"] and finding(mesh, "CDP0403")["lower_bound"]
             and "lower_bound" not in finding(mesh, "CDP0301"), "what is a lower bound")
        verdicts = mesh["components"]
        unknown = [v for v in verdicts if "crossings-examined" not in v["facts"]]
        must(all("simple-solid" not in v["promises"] for v in verdicts), "a promise")
        must(unknown or limit == 100_000, "components that nothing is known of")
        texts = {program("validate", *arguments, "-j", jobs)[1] for jobs in (1, 2, 5)}
        must(len(texts) == 1, f"{len(texts)} reports for three numbers of threads")
        must(f"at least {found} (coplanar-overlap)" in texts.pop(), "text")
    code, _, errors = program("validate", "some.ply", "--max-pairs", "0")
    must(code == 2 and "max-pairs" in errors, f"--max-pairs 0: exit {code}: {errors}")
    code, _, _ = program("validate", "some.ply", "--max-pairs", "1000", "--fail-on", "CDP0501")
    must(code == 1, f"what was not examined does not pass: exit {code}")
    code, _, _ = program("validate", "some.ply", "--fail-on", "CDP0501")
    must(code == 0, f"nothing crosses: exit {code}")


def bakes_to_a_limit(program):
    code, text, errors = program("bake", "some.ply", "-o", "some.h5", "--max-pairs", "1000",
                                 "--format", "json")
    model, = report_of("bake", text)["models"]
    must(code == 0 and model["crossings_complete"] is False and "--max-pairs" in
         model["remarks"][0], f"bake: exit {code}: {text}{errors}")
    code, _, errors = program("info", "--deep", "some.h5")
    must(code == 0, f"what was left open is not false: {errors}")
    code, text, _ = program("bake", "some.ply", "-o", "some.h5", "--format", "json")
    model, = report_of("bake", text)["models"]
    must(model["crossings_complete"] is True and "remarks" not in model, f"bake: {text}")
    # Examined for the file beyond the limit of a bake: 6 million pairs.
    write_ply(program.folder / "more.ply", *shifted_triangles(3500))
    code, _, _ = program("bake", "more.ply", "-o", "more.h5", "--max-pairs", "10000000")
    must(code == 0 and program("info", "--deep", "more.h5")[0] == 0, "more than by default")


def stays_small(program):
    count = 20_000
    write_ply(program.folder / "many.ply", *shifted_triangles(count))
    mesh = program.validate("many.ply", "-j", "1")
    found = mesh["counts"]["coplanar_overlap_pairs"]
    must(not mesh["crossings_complete"] and 5_000_000 <= found < count * (count - 1) // 2,
         f"{found} pairs")
    must(program("bake", "many.ply", "-o", "many.h5", "-j", "1")[0] == 0, "bake")
    must(program("info", "--deep", "many.h5")[0] == 0, "the same limit")


def large_stars(program):
    write_ply(program.folder / "cone.ply", *double_cone(200_000))
    mesh = program.validate("cone.ply", "-j", "1")
    must(mesh["crossings_complete"] and not mesh["findings"], f"a cone: {mesh['findings']}")
    must("simple-solid" in mesh["verdict"]["promises"], f"a cone: {mesh['verdict']}")
    must(program("bake", "cone.ply", "-o", "cone.h5", "-j", "1")[0] == 0, "bake")


def main():
    with tempfile.TemporaryDirectory() as scratch:
        factor = int(sys.argv[2]) if len(sys.argv) > 2 else 1
        program = Program(sys.argv[1], pathlib.Path(scratch), factor)
        counts_what_there_is(program)
        says_where_it_ended(program)
        t_junctions_have_a_limit(program)
        bakes_to_a_limit(program)
        stays_small(program)
        large_stars(program)


if __name__ == "__main__":
    main()
