#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Repairs hard files through the program and asks an independent checker.

For each preset and file: the verdict before and after, triangles changed, distance moved and
seconds; every file must come out as the preset promises, account for every triangle, and
repairing it again must change no byte. The checker is check_mesh.py of the test models.
By default the files that take little time; all 30, and how many come out closed and solid,
with CDPREP_ALL_POSES=yes.
Usage: repair.py CDPREP [PRESET...]
"""
import concurrent.futures
import math
import os
import pathlib
import sys
import tempfile
import time

from schemas import report_of
from shared_models import IS_SLOW, checker, hard_files, must, run, shared_folder, small

PRESETS = ("safe", "closed", "solid")
LOST = 1e-5  # of the diagonal
CLOSED = 26  # at least so many of the 30 by `closed`
SOLID = 12   # and by `solid`
WORSE = "worse than the input: "  # the crossings are
# Small, but with so many crossings that cutting them takes long: only in the long form.
SLOW = {"b9_mesh.off", "regr01.obj", "openscad-nonmanifold-crash.obj", "illformated_mesh.dae"}


def flags(found, words=("closed", "two_manifold", "oriented")):
    return "".join(word[0].upper() if found[word] else "-" for word in words)


def repaired(program, preset, path, output):
    begun = time.time()
    done = run(program, "repair", path, "-o", output, "--preset", preset, "--format", "json")
    must(done.returncode in (0, 1), f"{path.name}: exit {done.returncode}: {done.stderr}")
    report = report_of("repair", done.stdout)
    must((done.returncode == 0) == report["goal"] and report["exit"] == done.returncode,
         f"{path.name}: exit {done.returncode}, goal {report['goal']}: {done.stderr}")
    must(report["goal"] or f"not {preset}: " in done.stderr or WORSE in done.stderr,
         f"{path.name}: no sentence of what is missed: {done.stderr}")
    return report, time.time() - begun


def check_accounts(name, report):
    counts = report["counts"]
    must(counts["kept"] + counts["reversed"] + counts["cut"] + counts["dropped"]
         == counts["source_triangles"], f"{name}: source triangles do not add up: {counts}")
    must(len(report["triangle_source"]) == report["triangles"], f"{name}: sources of triangles")
    there = set(report["triangle_source"])
    listed = {triangle["triangle"] for step in report["steps"] if "undone" not in step
              for triangle in step["dropped"]}
    for triangle in range(counts["source_triangles"]):
        must(triangle in there or triangle in listed, f"{name}: triangle {triangle} is not told of")
    for source, step in zip(report["triangle_source"], report["triangle_step"]):
        must(source >= 0 or step, f"{name}: a triangle without source or step")


def repair_one(program, checks, preset, path, folder):
    """A row of the table, and whether the file is closed, and free of crossings."""
    output, again = folder / f"{path.name}.{preset}.ply", folder / f"{path.name}.{preset}2.ply"
    report, seconds = repaired(program, preset, path, output)
    check_accounts(path.name, report)
    positions, polygons, _ = checks.load(str(output))
    triangles, _ = checks.triangulate(polygons)
    found = checks.analyse(positions, triangles)
    crossings = checks.selfx(*checks.weld(positions, triangles))
    must("error" not in crossings, f"{path.name}: {crossings}")
    crosses = any(value for key, value in crossings.items() if key != "zero_area_skipped")
    low, high = found["bbox"]
    diagonal = math.dist(low, high)
    lost, added = (report[key]["upper"] / diagonal for key in ("input_to_output",
                                                              "output_to_input"))
    before, after = report["before"], report["after"]
    must(before["crossings_complete"] and after["crossings_complete"],
         f"{path.name}: crossings were not counted to the end")
    must(after["self_crossing"] or not crosses, f"{path.name}: the checker finds crossings")
    is_worse = WORSE in report.get("missed", "")
    must(preset != "safe" or not is_worse, f"{path.name}: safe makes crossings")
    must(not is_worse or after["crossing_pairs"] > before["crossing_pairs"],
         f"{path.name}: worse with {before['crossing_pairs']} and {after['crossing_pairs']} pairs")
    for ours, theirs in (("closed", "closed"), ("two_manifold", "two_manifold"),
                         ("oriented", "oriented"), ("boundary_edges", "boundary_edges")):
        must(after[ours] == found[theirs], f"{path.name}: {ours} {after[ours]}, "
             f"the checker says {found[theirs]}")
    must(found["two_manifold"] and found["oriented"], f"{path.name}: {preset} leaves {found}")
    if preset != "solid":  # which drops what lies inside
        must(lost < LOST, f"{path.name}: {preset} loses {lost} of the diagonal")
    repaired(program, preset, output, again)
    must(output.read_bytes() == again.read_bytes(), f"{path.name}: {preset} twice changes bytes")
    is_solid = found["closed"] and not crosses
    if preset == "solid" and not is_solid:
        refused = [refusal for step in report["steps"] for refusal in step["refused"]
                   if len(refusal["triangles"]) == 2 or refusal["vertices"]]
        must(refused, f"{path.name}: not solid, and no pair or loop is named")
    reached = {"safe": True, "closed": bool(found["closed"]) and not is_worse, "solid": bool(is_solid)}[preset]
    must(report["goal"] == reached, f"{path.name}: {preset} says goal {report['goal']}, the "
         f"checker {reached}: {report.get('missed')}")
    counts = report["counts"]
    row = (f"{path.name:42} {preset:6} {flags(report['before'])} {flags(found)}"
           f"{'X' if crosses else '-'} {counts['reversed']:7} {counts['cut']:6}"
           f" {counts['dropped']:6} {counts['made']:6} {lost:9.1e} {added:9.1e} {seconds:7.2f}")
    return row, bool(found["closed"]), bool(is_solid)


def says_what_is_missed(program, folder):
    """By hand: a square is safe and, its hole left open, not closed; steps have no goal; and a
    triangle with a bad number leaves nothing."""
    square, nothing, output = folder / "square.off", folder / "nothing.off", folder / "small.ply"
    square.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n")
    nothing.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n")
    for path, arguments, code, goal, sentence in (
            (square, ["--preset", "safe"], 0, True, ""),
            (square, ["--preset", "closed", "--hole-size", "0.5"], 1, False,
             "not closed: 4 edges are still open."),
            (square, ["--steps", "weld"], 0, None, ""),
            (nothing, ["--preset", "solid"], 1, False,
             "the output has no triangles, but the input has 1."),
            (nothing, ["--steps", "drop-bad-numbers"], 1, None, "the output has no triangles")):
        output.unlink(missing_ok=True)
        done = run(program, "repair", path, "-o", output, *arguments, "--format", "json")
        report = report_of("repair", done.stdout)
        must((done.returncode, report["exit"], report["goal"]) == (code, code, goal),
             f"{path.name} {arguments}: exit {done.returncode}, goal {report['goal']}")
        must(sentence in done.stderr and bool(sentence) == bool(done.stderr), done.stderr)
        must(output.is_file(), f"{path.name} {arguments}: nothing was written")
        must((report["input_to_output"]["upper"] is None) == (path is nothing),
             "what is lost is as far away as can be")


def box(low, high, count, without=()):
    """Corners and outward triangles of a box, numbered from `count`, without some sides."""
    corners = [[(low, high)[n >> axis & 1][axis] for axis in range(3)] for n in range(8)]
    sides = {"bottom": (0, 2, 3, 1), "top": (4, 5, 7, 6), "front": (0, 1, 5, 4),
             "right": (1, 3, 7, 5), "back": (3, 2, 6, 7), "left": (2, 0, 4, 6)}
    quads = [side for name, side in sides.items() if name not in without]
    return corners, [[count + v for v in t] for a, b, c, d in quads
                     for t in ((a, b, c), (a, c, d))]


def tells_of_crossings(program, folder):
    """By hand: a lid over an open box crosses the post that stands in it. Where other boxes
    cross already, the lid stays; the goal is missed, and the pairs before and after are told."""
    parts = ((((0, 0, 0), (4, 4, 4), ("top",)), ((1, 1, 1), (2, 2, 6), ())),
             (((9, 0, 0), (11, 2, 2), ()), ((10, 1, 1), (12, 3, 3), ())))
    meshes = {}
    for name, used in (("alone.off", parts[:1]), ("crossing.off", parts)):
        corners, triangles = [], []
        for low, high, without in (part for group in used for part in group):
            more, faces = box(low, high, len(corners), without)
            corners, triangles = corners + more, triangles + faces
        meshes[name] = folder / name
        meshes[name].write_text(
            f"OFF\n{len(corners)} {len(triangles)} 0\n"
            + "".join(" ".join(map(str, c)) + "\n" for c in corners)
            + "".join("3 " + " ".join(map(str, t)) + "\n" for t in triangles))
    output = folder / "crossing.ply"

    def repair(name, *arguments):
        done = run(program, "repair", meshes[name], "-o", output, *arguments, "--format", "json")
        report = report_of("repair", done.stdout)
        pairs = [report[when]["crossing_pairs"] for when in ("before", "after")]
        must(done.returncode == report["exit"], f"{name}: {done.returncode}")
        counts, = report_of("validate", run(program, "validate", output, "--format",
                                            "json").stdout)["meshes"]
        must(counts["counts"]["self_intersecting_pairs"] == pairs[1],
             f"{name}: {pairs[1]} pairs after, validate finds {counts['counts']}")
        return done, report, pairs

    done, report, pairs = repair("alone.off", "--preset", "closed")
    must(pairs == [0, 0] and "still open" in done.stderr, f"{pairs}: {done.stderr}")
    for preset in ("safe", "closed"):
        done, report, pairs = repair("crossing.off", "--preset", preset)
        if preset == "safe":
            must(done.returncode == 0 and pairs[0] == pairs[1] > 0, f"{pairs}: {done.stderr}")
            continue
        must(done.returncode == 1 and report["goal"] is False, f"closed: {done.returncode}")
        must(pairs[1] > pairs[0] > 0, f"{pairs}: a lid must cross the post")
        must(f"{WORSE}{pairs[1]} pairs of triangles cross or touch, compared with "
             f"{pairs[0]} before" in done.stderr, done.stderr)
        text = run(program, "repair", meshes["crossing.off"], "-o", output, "--preset", preset)
        for words in (f"{pairs[0]} pairs that cross", f"{pairs[1]} pairs that cross"):
            must(words in text.stdout, text.stdout)
    done, report, pairs = repair("crossing.off", "--steps", "fill-holes")
    must(done.returncode == 1 and report["goal"] is None and
         f"compared with {pairs[0]} before" in report["missed"],
         f"steps: {done.stderr}")
    done, report, pairs = repair("crossing.off", "--preset", "solid")
    must(pairs[1] == 0 and report["goal"] and done.returncode == 0, f"solid: {done.stderr}")


def main():
    program, presets = sys.argv[1], sys.argv[2:] or PRESETS
    models = shared_folder() / "models"
    hard = hard_files(models)
    must(len(hard) == 30, f"{len(hard)} hard files instead of 30")
    everything = os.environ.get("CDPREP_ALL_POSES") == "yes"
    if not everything:
        hard = [path for path in small(hard) if path.name not in SLOW][::2 if IS_SLOW else 1]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        checks = checker(models, folder)
        says_what_is_missed(program, folder)
        tells_of_crossings(program, folder)
        print("Flags: Closed, Two-manifold, Oriented; X: triangles meet.")
        print(f"{'file':42} {'preset':6} bef aft  {'turned':>7} {'cut':>6} {'dropped':>6}"
              f" {'new':>6} {'lost/diag':>9} {'added':>9} {'seconds':>7}")
        for preset in presets:
            with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
                rows = list(pool.map(
                    lambda path: repair_one(program, checks, preset, path, folder), hard))
            print("\n".join(row for row, _, _ in rows))
            closed, solid = sum(row[1] for row in rows), sum(row[2] for row in rows)
            print(f"{preset}: all {len(hard)} files 2-manifold and oriented, "
                  f"{closed} closed, {solid} without crossings too", flush=True)
            if not everything:
                continue
            must(preset == "safe" or closed >= CLOSED, f"only {closed} files are closed")
            must(preset != "solid" or solid >= SOLID, f"only {solid} files are solid")


main()
