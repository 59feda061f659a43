#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Questions through convex pieces are answered as exactly as through boxes.

Four pairs of models, closed and open, at poses whose overlapping sets were computed by CGAL's
exact predicates: the sets are equal; distances are those of the hierarchy of boxes, to the last
digit, and narrower than 1e-12 of themselves; so is every answer about all hard models beside
each other. By default a share of the poses and the small hard models; with CDPREP_ALL_POSES=yes
all of them, and 1,000 random poses of each pair.
Usage: pieces.py CDPREP
"""
import os
import pathlib
import random
import sys
import tempfile

from poses_truth import truth
from shared_models import IS_SLOW, answers, bake, hard_files, must, run, shared_folder, small

PAIRS = ["armadillo-bunny", "armadillo-horse", "buddha-skull", "armadillo-armadillo"]
SHARE = 12  # poses of each pair in the short form: four light, four deep, four near
if IS_SLOW:
    PAIRS, SHARE = PAIRS[1:2], 6
EFFECTS = "collide,overlap,distance,within,pieces"
TOLERANCE = ["--tolerance", "0.01"]
LISTED = 100    # poses, about, of which the pairs within the tolerance are listed
AT_A_TIME = 10


def moved_aside(line, share):
    """The pose, shifted along each axis by up to a share of the diagonal, which is 1."""
    numbers = [float(word) for word in line.split()]
    for i in (9, 10, 11):
        numbers[i] += random.uniform(-share, share)
    return " ".join(repr(number) for number in numbers)


def same_answers(program, question, a, b, poses, *options):
    """What is answered through boxes, which the pieces must answer too."""
    boxes = answers(program, question, a, b, "--poses", poses, *options)
    pieces = answers(program, question, a, b, "--poses", poses, "--structure", "pieces", *options)
    must(len(boxes) == len(pieces) > 0, f"{question}: {len(boxes)} and {len(pieces)} answers")
    for box, piece in zip(boxes, pieces):
        touch = question == "distance" and box.get("upper") == 0
        equal = piece.get("upper") == 0 if touch else box == piece
        must(equal, f"{a.name} {b.name} {question}: boxes {box}, pieces {piece}")
    return boxes


def same_pairs_within(program, a, b, poses):
    """The lists of 1,000 poses do not fit into memory: a few poses at a time, and of 1,000 a share."""
    lines = poses.read_text().splitlines()
    lines = lines[::max(1, len(lines) // LISTED)]
    few = poses.with_suffix(".few")
    for first in range(0, len(lines), AT_A_TIME):
        few.write_text("\n".join(lines[first:first + AT_A_TIME]) + "\n")
        asked = ["query", "within", a, b, "--poses", few, *TOLERANCE, "--pairs", "--format", "ndjson"]
        boxes, pieces = run(program, *asked), run(program, *asked, "--structure", "pieces")
        must(boxes.returncode == pieces.returncode == 0, f"{boxes.stderr}{pieces.stderr}")
        must(boxes.stdout == pieces.stdout and boxes.stdout.count("\n") > 0,
             f"{a.name} {b.name}: boxes and pieces list other pairs within {TOLERANCE[1]}")


def compare(program, a, b, poses):
    hits = [answer["hit"] for answer in same_answers(program, "collide", a, b, poses)]
    same_answers(program, "collide", a, b, poses, "--as", "solid")
    same_answers(program, "within", a, b, poses, *TOLERANCE)
    same_pairs_within(program, a, b, poses)
    for answer in same_answers(program, "distance", a, b, poses):
        width = answer["upper"] - answer["lower"]
        must(width <= 1e-12 * answer["upper"] + 1e-15, f"{a.name} {b.name}: {answer}")
        must((answer["upper"] == 0) == hits[answer["pose"]], f"{a.name} {b.name}: {answer}")
    return sum(hits), len(hits)


def main():
    program = sys.argv[1]
    shared = shared_folder()
    everything = os.environ.get("CDPREP_ALL_POSES") == "yes"
    random.seed(20261122)
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    names = sorted({name for pair in PAIRS for name in pair.split("-")})
    bake(program, "--normalize", "--output-dir", folder, "--effects", EFFECTS,
         *(shared / "models" / "seed" / f"{name}.ply" for name in names))
    deep = run(program, "info", "--deep", folder / "horse.cdp.h5")
    must(deep.returncode == 0, deep.stderr)

    hit = asked = 0
    for pair in PAIRS:
        a, b = (folder / f"{name}.cdp.h5" for name in pair.split("-"))
        lines = (shared / "poses" / f"{pair}.pose").read_text().splitlines()
        exact = truth(shared / "poses" / f"{pair}.truth")
        if not everything:
            lines, exact = lines[:SHARE], exact[:SHARE]
        poses = folder / "some.pose"
        poses.write_text("\n".join(lines) + "\n")
        found = answers(program, "overlap", a, b, "--poses", poses, "--skip-degenerate",
                        "--structure", "pieces")
        for answer, pairs in zip(found, exact):
            must(answer["pairs"] == pairs, f"{pair}, pose {answer['pose']}: {answer['count']} "
                 f"pairs, exact {len(pairs)}")
        if everything:
            lines = [moved_aside(random.choice(lines), 0.1) for _ in range(1000)]
            poses.write_text("\n".join(lines) + "\n")
            same_answers(program, "overlap", a, b, poses, "--count")
        hits, answered = compare(program, a, b, poses)
        hit, asked = hit + hits, asked + answered
        print(f"{pair}: {len(exact)} sets exact, {answered} poses equal, {hits} touch")
    must(0.3 * asked <= hit <= 0.75 * asked, f"{hit} of {asked} touch: one-sided")

    hard = hard_files(shared / "models")
    files = [path for path in (hard if everything else small(hard))
             if run(program, "bake", path, "-o", folder / f"{path.name}.cdp.h5", "--normalize",
                    "--effects", EFFECTS).returncode == 0]
    must(len(files) >= 20, f"only {len(files)} hard models were baked")
    poses = folder / "hard.pose"
    poses.write_text("\n".join(moved_aside("1 0 0 0 1 0 0 0 1 0 0 0", 0.4)
                               for _ in range(60 if everything else 2 if IS_SLOW else 6)) + "\n")
    for one, other in zip(files, files[1:] + files[:1]):
        compare(program, folder / f"{one.name}.cdp.h5", folder / f"{other.name}.cdp.h5", poses)
    print(f"{len(files)} hard models, each beside the next: equal")


if __name__ == "__main__":
    main()
