#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every pair of Table 4 at its poses: the overlapping set is the exact one.

The sets beside the poses were computed by CGAL's exact predicates. By default a
share of the poses (every kind, every pair); all of them with CDPREP_ALL_POSES=yes.
Usage: poses_truth.py CDPREP
"""
import array
import os
import pathlib
import sys
import tempfile
import time

from shared_models import answers, bake, must, shared_folder

SHARE = 12  # poses of each pair in the short form: four light, four deep, four near


def truth(path):
    numbers = array.array("i", path.read_bytes())
    at, sets = 1, []
    for _ in range(numbers[0]):
        count = numbers[at]
        flat = numbers[at + 1: at + 1 + 2 * count]
        sets.append([list(pair) for pair in zip(flat[0::2], flat[1::2])])
        at += 1 + 2 * count
    return sets


def main():
    program = sys.argv[1]
    shared = shared_folder()
    everything = os.environ.get("CDPREP_ALL_POSES") == "yes"
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    names = ["horse", "skull", "bunny", "armadillo", "dragon", "buddha"]
    bake(program, "--normalize", "--output-dir", folder,
         *(shared / "models" / "seed" / f"{name}.ply" for name in names))

    checked = triangles = 0
    for poses in sorted((shared / "poses").glob("*.pose")):
        a, b = poses.stem.split("-")
        expected = truth(poses.with_suffix(".truth"))
        if not everything:
            expected = expected[:SHARE]
        some = folder / "some.pose"
        some.write_text("\n".join(poses.read_text().splitlines()[:len(expected)]) + "\n")
        begun = time.time()
        found = answers(program, "overlap", folder / f"{a}.cdp.h5", folder / f"{b}.cdp.h5",
                        "--poses", some, "--skip-degenerate")
        must(len(found) == len(expected), f"{poses.stem}: {len(found)} answers")
        for pose, (answer, pairs) in enumerate(zip(found, expected)):
            must(answer["pose"] == pose and answer["count"] == len(pairs)
                 and answer["pairs"] == pairs and answer["hit"] == bool(pairs),
                 f"{poses.stem}, pose {pose}: {answer['count']} pairs, exact {len(pairs)}")
            checked, triangles = checked + 1, triangles + len(pairs)
        print(f"{poses.stem}: {len(expected)} poses equal, {time.time() - begun:.2f} s")
    must(checked == (1800 if everything else 12 * SHARE) and triangles > 10000,
         "too few poses or pairs to prove anything")
    print(f"{checked} poses, {triangles} pairs, all equal to the exact sets")


if __name__ == "__main__":
    main()
