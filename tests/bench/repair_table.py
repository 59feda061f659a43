#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Mends the hard models by preset, and beside it by CGAL's and MeshLab's functions called
plainly; prints a CSV row for each file and way, and then a summary of each way. Rows go to
stderr too as they are found.

Every result is a file, and judged by the same: check_mesh.py of the test models says
whether it is closed, 2-manifold and oriented, by its vertex numbers, and, with equal
positions joined, how many pairs of triangles meet (2-manifold there also asks that no two
triangles have the same corners, which CGAL does not); repair_bench --distance proves how far
the surfaces are from each other. The row `as_read` is the file before, with equal positions
joined. Where a peer is missing, its rows say `not measured`.

  gone, new, turned: triangles, by their corners rounded to floats.
  lost, added:  no point of the input is farther from the result, and of the result from the
                input, in diagonals of the input's box; some point is lost_least away. Of
                cdprep's results the report knows more, and may have the smaller bound.
                `solid` drops what lies inside.
  seconds:      cdprep: reading, mending, writing and the report. CGAL: the functions alone.
                MeshLab: the whole process, reading the triangles that cdprep read.

Usage: repair_table.py CDPREP REPAIR_BENCH [MESHLABSERVER] > results/MACHINE/repair.csv
MeshLab (Debian: meshlab, and xvfb where there is no screen) is optional.
"""
import collections
import concurrent.futures
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "pipeline"))
from shared_models import checker, hard_files, must, shared_folder  # noqa: E402

LIMIT = 120   # seconds for any one run
KILLED = (-9, 137)
LOST = 1e-5   # of the diagonal: what counts as kept
MEETINGS = {  # columns, and what the checker calls them
    "crossing": ("cross_pairs", "share1_cross"),
    "touching": ("touch_pairs",),
    "coplanar": ("coplanar_overlap_pairs", "share1_coplanar", "share2_fold"),
}
PRESETS = ("safe", "closed", "solid")
MESHLAB = ("Remove Duplicate Vertices", "Remove Duplicate Faces", "Remove Zero Area Faces",
           "Repair non Manifold Edges by removing faces",
           "Repair non Manifold Vertices by splitting", "Re-Orient all faces coherentely")
CLOSE_HOLES = ('<filter name="Close Holes">'
               '<Param type="RichInt" name="MaxHoleSize" value="1000000"/>'
               '<Param type="RichBool" name="Selected" value="false"/>'
               '<Param type="RichBool" name="NewFaceSelected" value="false"/>'
               '<Param type="RichBool" name="SelfIntersection" value="false"/></filter>')
WAYS = ("as_read", "safe", "cgal_a", "meshlab_a", "closed", "cgal_b", "meshlab_b", "solid")
COLUMNS = ("file", "way", "state", "closed", "two_manifold", "oriented", "triangles", "gone",
           "new", "turned", "crossing", "touching", "coplanar", "lost_least", "lost", "added",
           "seconds")

Tools = collections.namedtuple("Tools", "cdprep bench meshlab checks folder")


def limited(*command):
    """Runs a command; returns its process, and seconds."""
    at_most = ["timeout", "--signal=KILL", str(LIMIT)]
    place = 2 if command[0] == "xvfb-run" else 0  # which must outlive the program
    begun = time.time()
    done = subprocess.run([*command[:place], *at_most, *command[place:]], text=True,
                          stdin=subprocess.DEVNULL, capture_output=True, check=False)
    return done, time.time() - begun


def meshlab_script(folder, way):
    lines = [f'<filter name="{name}"/>' for name in MESHLAB]
    if way == "meshlab_b":
        lines.append(CLOSE_HOLES)
    path = folder / f"{way}.mlx"
    path.write_text("<!DOCTYPE FilterScript>\n<FilterScript>\n" + "\n".join(lines)
                    + "\n</FilterScript>\n")
    return path


def mend(tools, path, way, output):
    """Writes the result; returns "" or why there is none, the seconds it took, and how far
    the surfaces are from each other as cdprep's report has it."""
    told = math.inf, math.inf
    if way in PRESETS:
        done, seconds = limited(tools.cdprep, "repair", path, "-o", output, "--preset", way,
                                "--jobs", "1", "--format", "json")
        if done.returncode == 0:
            report = json.loads(done.stdout)
            seconds = report["seconds"]
            told = tuple(report[key]["upper"] for key in ("input_to_output", "output_to_input"))
    elif way.startswith("meshlab"):
        if not tools.meshlab:
            return "not measured", None, told
        done, seconds = limited(*tools.meshlab, "-i", tools.folder / f"{path.name}.as_read.ply",
                                "-o", output, "-s", tools.folder / f"{way}.mlx")
    else:
        done, seconds = limited(tools.bench, "--way", way, "--write", tools.folder, path)
        if done.returncode == 0:
            seconds = float(done.stdout.split()[-1].split(",")[-1])
    if done.returncode in KILLED:
        return f"over {LIMIT} s", None, told
    if done.returncode != 0 or not output.is_file():
        return f"failed ({done.returncode})", None, told
    return "", seconds, told


def load(tools, path):
    positions, polygons, _ = tools.checks.load(str(path))
    return positions, tools.checks.triangulate(polygons)[0]


def count_changes(before, after):
    """How many triangles are gone, new, and turned, by corners rounded to floats."""
    rounded = numpy.concatenate([positions.astype(numpy.float32) + numpy.float32(0)
                                 for positions, _ in (before, after)])
    number = numpy.unique(rounded, axis=0, return_inverse=True)[1].reshape(-1)
    numbers = number[:len(before[0])], number[len(before[0]):]
    sets, cycles = [], []
    for corners, (_, triangles) in zip(numbers, (before, after)):
        own = corners[triangles].reshape(-1, 3)
        first = own.argmin(1)[:, None]
        cycle = numpy.take_along_axis(own, (first + [0, 1, 2]) % 3, 1)
        cycles.append(collections.Counter(map(tuple, cycle.tolist())))
        sets.append(collections.Counter(map(tuple, numpy.sort(own, 1).tolist())))
    gone = (sets[0] - sets[1]).total()
    return gone, (sets[1] - sets[0]).total(), (cycles[0] - cycles[1]).total() - gone


def diagonal_of(mesh):
    used = mesh[0][numpy.unique(mesh[1])]
    return math.dist(used.min(0), used.max(0))


def judge(tools, path, way, output, before, told):
    """What is true of a result: the columns after `state`, but for the seconds."""
    after = load(tools, output)
    if len(after[1]) == 0:
        return None
    joined = tools.checks.weld(*after)
    found = tools.checks.analyse(*(joined if way == "as_read" else after))
    meetings = tools.checks.selfx(*joined)
    least, lost, added = 0.0, 0.0, 0.0
    if way != "as_read":
        whole = tools.folder / f"{path.name}.as_read.ply"
        done, _ = limited(tools.bench, "--distance", whole, output)
        if done.returncode == 0:
            least, lost, _, added = map(float, done.stdout.split(","))
            lost, added = min(lost, told[0]), min(added, told[1])  # both are proved
            diagonal = diagonal_of(before)
            least, lost, added = min(least, lost) / diagonal, lost / diagonal, added / diagonal
        else:
            least = lost = added = None
    return {**{key: int(found[key]) for key in ("closed", "two_manifold", "oriented")},
            "triangles": len(after[1]),
            **dict(zip(("gone", "new", "turned"), count_changes(before, after))),
            **{column: sum(meetings[key] for key in keys) for column, keys in MEETINGS.items()},
            "lost_least": least, "lost": lost, "added": added}


def shown(value):
    if value is None:
        return ""
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def line(row):
    return ",".join(shown(row.get(column)) for column in COLUMNS)


def measure(tools, path):
    """The rows of one file."""
    rows, before = [], None
    for way in WAYS:
        output = tools.folder / f"{path.name}.{way}.ply"
        why, seconds, told = mend(tools, path, way, output)
        row = {"file": path.name, "way": way, "state": why or "done", "seconds": seconds}
        if not why:
            before = load(tools, output) if way == "as_read" else before
            found = judge(tools, path, way, output, before, told)
            row.update(found or {"state": "empty"})
        rows.append(row)
        sys.stderr.write(line(row) + "\n")  # at once: others write too
    return rows


def print_summary(rows):
    """How many files each way brings where."""
    for way in WAYS:
        of = [row for row in rows if row["way"] == way]
        done = [row for row in of if row["state"] == "done"]
        sound = [row for row in done if row["two_manifold"] and row["oriented"]]
        kept = [row for row in sound if row["lost"] is not None and row["lost"] < LOST]
        closed = [row for row in sound if row["closed"]]
        solid = [row for row in closed
                 if not row["crossing"] and not row["touching"] and not row["coplanar"]]
        open_ = [row for row in sound if row not in kept
                 and (row["lost_least"] is None or row["lost_least"] < LOST)]
        both = [row for row in closed if row in kept]
        print(f"# {way}: {len(done)} of {len(of)} done, {len(sound)} 2-manifold and oriented, "
              f"{len(kept)} of these with the surface kept ({len(open_)} more undecided); "
              f"{len(closed)} closed too, "
              f"{len(both)} of these kept; {len(solid)} without triangles that meet")


def main():
    cdprep, bench, *peers = sys.argv[1:]
    models = shared_folder() / "models"
    hard = hard_files(models)
    must(len(hard) == 30, f"{len(hard)} hard files instead of 30")
    meshlab = [peer for peer in peers[:1] if shutil.which(peer)]
    if meshlab and shutil.which("xvfb-run"):
        meshlab = ["xvfb-run", "-a", *meshlab]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for way in ("meshlab_a", "meshlab_b"):
            meshlab_script(folder, way)
        tools = Tools(cdprep, bench, meshlab, checker(models, folder), folder)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            rows = [row for some in pool.map(lambda path: measure(tools, path), hard)
                    for row in some]
    print("\n".join([",".join(COLUMNS), *map(line, rows)]))
    print_summary(rows)


main()
