#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs samples/engines/bolt_in_hole.cpp. A bolt of radius 6 hangs by its head in a hole of radius 7
of the exact bracket, from a start on the hole's axis and from one 0.8 mm off it. The hull of the
whole bracket closes the hole: the bolt slides off. Hulls of parts stick out by up to 0.5 mm, those
of the bolt too, and margins add 0.2: together more than the play of 1 mm. From the start off the
axis, the bolt does not enter then. From the other start, it may.
Usage: bolt_in_hole.py CDPREP SAMPLE"""
import pathlib
import re
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "pipeline"))
from shared_models import bake, must, run  # noqa: E402

MESHES = pathlib.Path(__file__).resolve().parents[2] / "samples/meshes"


def main():
    program, sample = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        bake(program, MESHES / "bracket.obj", MESHES / "bolt.obj", "--output-dir", scratch,
             "--effects", "touch,corners,contacts,response", "--structures", "hull",
             "--max-error", 0.5)
        done = run(sample, f"{scratch}/bracket.cdp.h5", f"{scratch}/bolt.cdp.h5")
        print(done.stdout)
        must(done.returncode == 0, done.stderr)
        heights = {}
        for line in done.stdout.splitlines():
            what, rest = line.split(": ")
            found = re.search(r"head is (-?[0-9.]+) mm above the plate, ([0-9.]+) mm aside", rest)
            heights.setdefault(what, []).append(tuple(map(float, found.groups())))
        must(len(heights) == 4 and all(len(rows) == 2 for rows in heights.values()), f"{heights}")
        for what, gap in (("hulls of the bolt", 0.2), ("exact bolt", 0)):
            for height, aside in heights[f"exact bracket, {what}"]:
                must(abs(height - gap) <= 0.05 and aside < 1, f"{what}: {height}, {aside}")
        for height, aside in [*heights["hull of the whole bracket"],
                              heights["hulls of the bracket's parts"][1]]:
            must(abs(height) > 5 and aside > 2, f"the hull lets the bolt in: {height}, {aside}")


main()
