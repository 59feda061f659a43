#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Points inside real models, asked through every structure, against CGAL.

The closed scans skull and armadillo against Side_of_triangle_mesh with an exact kernel;
buddha, which crosses itself, and the balanced hard models that are no 2-manifolds against
counting what exact rays cross. By default some points of each; a million of each scan
and many more of the others with CDPREP_ALL_POSES=yes.
Usage: inclusion.py CDPREP ORACLE
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from shared_models import IS_SLOW, bake, must, shared_folder

SIDES = ("seed/skull.ply", "seed/armadillo.ply")
# Two-sided shells, of which nothing is inside, stand among them.
RAYS = ("seed/buddha.ply", "hard/Kettle.obj", "hard/KitchenPot.obj", "hard/boolean.glb",
        "hard/cycloidal.ply", "hard/dragon_vrip_res2.ply", "hard/mite.obj",
        "hard/openscad-nonmanifold-crash.obj")
EVERYTHING = os.environ.get("CDPREP_ALL_POSES") == "yes"


def compare(oracle, by, baked, count):
    """Numbers of points, of those on the surface and of those inside; all must agree."""
    begun = time.time()
    done = subprocess.run([oracle, by, baked, str(count)], capture_output=True, text=True)
    must(done.returncode == 0, f"{baked.name}: exit {done.returncode}: {done.stdout}{done.stderr}")
    words = done.stdout.split()
    numbers = [int(words[words.index(word) + 1]) for word in ("points", "on_surface", "inside")]
    must(numbers[0] == count, f"{baked.name}: {numbers[0]} points")
    print(f"{baked.name}, {by}: {numbers[0]} points agree, {numbers[1]} on the surface, "
          f"{numbers[2]} inside, {time.time() - begun:.1f} s")
    return numbers


def main():
    program, oracle = sys.argv[1], sys.argv[2]
    models = shared_folder() / "models"
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    share = 5 if IS_SLOW else 1
    for by, names, count in (("sides", SIDES, 1_000_000 if EVERYTHING else 20_000 // share),
                             ("rays", RAYS, 5_000 if EVERYTHING else 400 // share)):
        points = on_surface = inside = 0
        for name in names:
            baked = folder / (pathlib.Path(name).stem + ".cdp.h5")
            bake(program, models / name, "--output-dir", folder)
            numbers = compare(oracle, by, baked, count)
            points, on_surface, inside = (
                sum(pair) for pair in zip((points, on_surface, inside), numbers))
        must(0.05 * points < on_surface < 0.3 * points, f"{on_surface} of {points} on the surface")
        must(0.3 * points < inside < 0.7 * points, f"{inside} of {points} inside")


main()
