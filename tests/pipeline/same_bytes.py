#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A bake's bytes depend on the input and the options, on nothing else.

Threads, time, folder, names, environment and limits change nothing. More numbers of threads are
tried with CDPREP_ALL_POSES=yes.
Usage: same_bytes.py CDPREP
"""
import os
import pathlib
import shutil
import sys
import tempfile
import time

from killed_bake import digest, write_sheet
from shared_models import IS_SLOW, bake, must, shared_models_if_there


EVERYTHING = os.environ.get("CDPREP_ALL_POSES") == "yes"
THREADS = (2, 3, 4, 16) if EVERYTHING else (5,) if IS_SLOW else (2, 5)


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    sheet = folder / "sheet.off"
    write_sheet(sheet, 150)
    inputs = [sheet, *shared_models_if_there("seed/bunny.ply", "hard/CesiumMilkTruck.glb",
                                             "hard/cubes_with_mirroring_and_pivot.fbx")]
    for path in inputs:
        first = folder / "first.cdp.h5"
        bake(program, path, "-o", first, "-j", 1, "--effects", "all")
        digests = {digest(first)}
        for threads in THREADS:
            output = folder / f"threads_{threads}.cdp.h5"
            bake(program, path, "-o", output, "-j", threads, "--effects", "all")
            digests.add(digest(output))
        time.sleep(1.1)  # a stored time of one-second resolution would show
        other = folder / "another folder"
        other.mkdir(exist_ok=True)
        copy = other / ("renamed" + path.suffix)
        shutil.copy(path, copy)
        bake(program, copy, "-o", other / "elsewhere.cdp.h5", "--effects", "all",
             "--import-memory", "1GB", env={**os.environ, "LC_ALL": "C", "TZ": "Asia/Tokyo",
                                            "HOME": "/", "USER": "nobody"})
        digests.add(digest(other / "elsewhere.cdp.h5"))
        must(len(digests) == 1, f"{path.name}: {len(digests)} different files of the same")
        bake(program, path, "-o", folder / "other.cdp.h5", "--effects", "all", "--normalize")
        must(digest(folder / "other.cdp.h5") not in digests, f"{path.name}: an option says nothing")
        print(f"{path.name}: {len(THREADS) + 2} bakes, one content")


main()
