#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Decomposes and bakes meshes of any size, from a few times the smallest double to the largest
coordinate. Every command ends, its numbers are finite, and 'info --deep' finds no falsehood.
Usage: extreme_sizes.py PROGRAM"""
import math
import pathlib
import signal
import subprocess
import sys
import tempfile

from schemas import report_of
from shared_models import SLOWDOWN, must, run

SIZES = ("0x1p999", "1e300", "1e160", "1e100", "1", "1e-100", "1e-200", "1e-320", "0x1p-1074")
SECONDS = 60 * SLOWDOWN
WORK = ("--work", 1_000_000)

BOX = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
BOX_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
L = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
L_FACES = [tuple(reversed(range(6))), tuple(range(6, 12))]
L_FACES += [(i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i) for i in range(6)]
MESHES = {"box": (BOX, BOX_FACES), "open": (BOX, BOX_FACES[:-1]),
          "l": ([(x, y, z) for z in (0, 1) for x, y in L], L_FACES)}


def write_obj(path, corners, faces, size):
    lines = ["v " + " ".join(repr(x * size) for x in corner) for corner in corners]
    lines += ["f " + " ".join(str(1 + i) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def ended(program, *arguments, codes=(0,)):
    """What a command printed. It must end in time, with one of these codes."""
    try:
        done = run(program, *arguments, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        must(False, f"{arguments} did not end within {SECONDS} s")
    must(done.returncode in codes, f"{arguments}: exit {done.returncode}: {done.stderr}")
    return done.stdout


def report(program, command, *arguments, codes=(0,)):
    return report_of(command, ended(program, command, *arguments, "--format", "json", codes=codes))


def is_distance(number, diagonal):
    """A proved bound is not much more than the whole mesh, up to whole units of the smallest
    double."""
    return number is not None and 0 <= number <= 4 * diagonal + 10 * 5e-324


def check_parts(program, mesh, size, diagonal, *options, work=WORK):
    found = report(program, "decompose", mesh, *options, *work, "--table", codes=(0, 1))
    name = f"{mesh.name} {options}: {found}"
    must(is_distance(found["outer_error"], diagonal), name)
    must(0 <= found["outer_error_at_least"] <= found["outer_error"], name)
    must(found["proof"]["outside"] == 0 and found["parts"] >= 1, name)
    must(all(row["outer_error"] <= found["outer_error"] for row in found["table"]), name)
    must(found["as_asked"] == (found["exit"] == 0), name)
    return found


def check_decompose(program, mesh, name, size, diagonal):
    two = check_parts(program, mesh, size, diagonal, "--parts", 2)
    # One part for a box, two boxes for an L; an open box counts as its sides. The error is known
    # up to 5 %, and up to the smallest double.
    true = {"box": 0, "open": 0.5 * size, "l": 0}[name]
    must(true <= two["outer_error"] <= 1.05 * true + 1e-9 * size + 5e-324, f"{mesh.name}: {two}")
    must(two["outer_error_at_least"] <= true * (1 + 1e-9), f"{mesh.name}: {two}")
    must(two["parts"] == (2 if name == "l" else 1), f"{mesh.name}: {two}")
    check_parts(program, mesh, size, diagonal, "--parts", 2, "--to-surface")
    check_parts(program, mesh, size, diagonal, "--parts", 2, "--max-error", 1e300, "--to-surface")
    check_parts(program, mesh, size, diagonal, "--parts", 3, "--max-vertices", 5)
    check_parts(program, mesh, size, diagonal, "--max-error", 1, work=())
    pieces = report(program, "decompose", mesh)
    must(pieces["outer_error"] == 0 and pieces["pieces"] >= 1, f"{mesh.name}: {pieces}")


def check_bake(program, mesh, folder, diagonal):
    baked = folder / "baked.cdp.h5"
    for options in (("--structures", "hull", "--parts", 1),
                    ("--structures", "hull", "--hull-vertices", 5, "--parts", 2),
                    ("--effects", "all", "--max-error", 1)):
        found = report(program, "bake", mesh, "-o", baked, *options, codes=(0, 1))["models"][0]
        must(is_distance(found["parts"]["outer_error"], diagonal), f"{mesh.name}: {found}")
        ended(program, "info", "--deep", baked)
    ended(program, "bake", mesh, "-o", baked, "--structures", "hull")
    exported = report(program, "export", baked, "--for", "json", "-o", folder / "exported.json")
    must(is_distance(exported["outer_error"], diagonal), f"{mesh.name}: {exported}")


def check_others(program, mesh, folder, diagonal):
    hull = report(program, "hull", mesh, "-o", folder / "hull.obj", "--max-vertices", 5)
    must(is_distance(hull["hulls"][0]["distance"], diagonal), f"{mesh.name}: {hull}")
    ended(program, "validate", mesh, codes=(0, 1))
    ended(program, "repair", mesh, "-o", folder / "repaired.obj", "--preset", "closed")


def check_accuracy(program, one, other):
    """Bounds of all methods are known. A sphere around an L sticks out by much."""
    found = report(program, "accuracy", one, other, "--quick", "--ladder", "geometry")
    rungs = [rung for ladder in found["ladders"] for rung in ladder["rungs"]]
    outer = {rung["name"]: rung["outer"] for rung in rungs if "outer" in rung}
    must(all(bound is not None for bound in outer.values()), f"{one.name}: {outer}")
    must(0.5 < outer["sphere"] < 1, f"{one.name}: {outer}")


def check_interrupt(program, mesh):
    """With a budget of many minutes, a signal ends the search."""
    process = subprocess.Popen([program, "decompose", mesh, "--max-error", "1", "--work",
                                str(10**12)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        process.wait(2 * SLOWDOWN)
        must(False, f"{mesh.name}: ended with {process.returncode} before the signal")
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
    try:
        process.communicate(timeout=SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        must(False, f"{mesh.name}: did not end after a signal")
    must(process.returncode == 130, f"{mesh.name}: exit {process.returncode} after a signal")


def ring(columns, rows):
    """A torus: a search within a small error takes long."""
    corners, faces = [], []
    for i in range(columns):
        for k in range(rows):
            a, b = 2 * math.pi * i / columns, 2 * math.pi * k / rows
            far = 1 + 0.3 * math.cos(b)
            corners.append((far * math.cos(a), far * math.sin(a), 0.3 * math.sin(b)))
            j, n = (i + 1) % columns, (k + 1) % rows
            faces.append((i * rows + k, j * rows + k, j * rows + n, i * rows + n))
    return corners, faces


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for text in SIZES:
            size = float.fromhex(text) if "x" in text else float(text)
            for name, (corners, faces) in MESHES.items():
                mesh = folder / f"{name}_{text}.obj"
                write_obj(mesh, corners, faces, size)
                diagonal = (3 if name == "l" else math.sqrt(3)) * size
                check_decompose(program, mesh, name, size, diagonal)
                check_bake(program, mesh, folder, diagonal)
                check_others(program, mesh, folder, diagonal)
        for text in ("1", "1e160", "1e-320"):
            check_accuracy(program, folder / f"l_{text}.obj", folder / f"box_{text}.obj")
        large = folder / "ring.obj"
        write_obj(large, *ring(24, 12), 1e160)
        check_interrupt(program, large)


main()
