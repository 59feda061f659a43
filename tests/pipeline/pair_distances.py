#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""distance and within through the program, against answers known by hand.

Usage: pair_distances.py CDPREP
"""
import json
import math
import pathlib
import re
import sys
import tempfile

from known_meshes import CUBE
from shared_models import bake, must, run


def ask(program, *arguments):
    """Every line of NDJSON that the question prints."""
    asked = run(program, "query", *arguments, "--format", "ndjson")
    must(asked.returncode == 0, f"query {arguments} exited {asked.returncode}: {asked.stderr}")
    return [json.loads(line) for line in asked.stdout.splitlines()]


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    (folder / "cube.off").write_text(CUBE)
    cube = folder / "cube.cdp.h5"
    bake(program, folder / "cube.off", "-o", cube, "--effects", "distance")

    # The cube [0, 2]^3 and itself, moved: the gap is that of two boxes.
    steps = (-5, -2.5, -1, 0, 1.5, 2, 3, 7)
    moves = [(x, y, z) for x in steps for y in steps for z in steps]
    (folder / "poses").write_text(
        "".join(f"1 0 0 0 1 0 0 0 1 {x} {y} {z}\n" for x, y, z in moves))
    poses = [cube, cube, "--poses", folder / "poses"]
    far = [math.sqrt(sum(max(0, abs(x) - 2) ** 2 for x in move)) for move in moves]

    found = ask(program, "distance", *poses)
    must(len(found) == len(moves), f"{len(found)} answers to {len(moves)} poses")
    for number, (truth, answer) in enumerate(zip(far, found)):
        must(answer["pose"] == number and answer["found"], f"{answer}")
        must(answer["lower"] <= truth * (1 + 1e-15) and truth <= answer["upper"] * (1 + 1e-15),
             f"{moves[number]} is {truth} away: {answer}")
        between = math.dist(answer["witness_a"], answer["witness_b"])
        must(abs(between - truth) < 1e-13, f"{moves[number]}: witnesses {between} apart")
        must((truth == 0) == (answer["upper"] == 0), f"{moves[number]}: {answer}")
        must(0 <= answer["triangle_a"] < 12 and 0 <= answer["triangle_b"] < 12, f"{answer}")

    for limit in (0, 1, 3.5):
        near = ask(program, "distance", *poses, "--max-distance", limit)
        must([answer["found"] for answer in near] == [truth <= limit for truth in far],
             f"--max-distance {limit}")
        within = ask(program, "within", *poses, "--tolerance", limit)
        must([answer["within"] for answer in within] == [truth <= limit for truth in far],
             f"--tolerance {limit}")

    # A tolerance of 0 lists what overlaps; the two faces that a gap of 1 parts are the
    # two triangles of each, and those with an edge or a corner there.
    touching = ask(program, "overlap", *poses)
    at_zero = ask(program, "within", *poses, "--tolerance", 0, "--pairs")
    for overlap, near in zip(touching, at_zero):
        must((near["within"], near["count"], near["pairs"]) ==
             (overlap["hit"], overlap["count"], overlap["pairs"]), f"{near}, but {overlap}")
    near = ask(program, "within", *poses, "--tolerance", 1, "--pairs")
    counted = ask(program, "within", *poses, "--tolerance", 1, "--count")
    must([answer["within"] for answer in near] == [truth <= 1 for truth in far], "--pairs")
    for listed, count, before in zip(near, counted, at_zero):
        must(listed["count"] == len(listed["pairs"]) == count["count"] and "pairs" not in count,
             f"{listed}, but {count}")
        must(listed["pairs"] == sorted(listed["pairs"]), f"{listed}")
        must(all(pair in listed["pairs"] for pair in before["pairs"]), f"{listed}")
    text = run(program, "query", "within", cube, cube, "--pose", "1 0 0 0 1 0 0 0 1 3 0.5 0.25",
               "--tolerance", 1, "--pairs").stdout.splitlines()
    must(text[0] == f"pose 0: within, {len(text) - 1} pairs" and len(text) > 5, f"{text}")

    for option, slack in (("--relative-error", lambda d: 0.5 * d), ("--absolute-error",
                                                                     lambda d: 0.5)):
        for truth, answer in zip(far, ask(program, "distance", *poses, option, 0.5)):
            must(answer["upper"] - answer["lower"] <= slack(answer["lower"]) + 1e-12, f"{answer}")
            must(answer["lower"] <= truth + 1e-12 and truth <= answer["upper"] + 1e-12,
                 f"{option}: {truth}, {answer}")

    timed = run(program, "query", "distance", *poses, "--repeat", 3, "--timings")
    must(re.search(r"^1536 queries: median [0-9.]+ us", timed.stderr), timed.stderr)
    must(len(timed.stdout.splitlines()) == len(moves), "--repeat writes each answer once")
    must("distance 3 " in timed.stdout or "distance 2.99" in timed.stdout, timed.stdout[:200])


if __name__ == "__main__":
    main()
