#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--bounds decides which section bounds a model's triangles, and no answer.

Usage: bounds.py CDPREP
"""
import pathlib
import random
import sys
import tempfile

from killed_bake import digest, write_sheet
from schemas import report_of
from shared_models import answers, bake, must, run, shared_models_if_there

SECTION = {"aabb": set(), "obb": {"oriented_nodes"}, "pss": {"swept_nodes"},
           "lss": {"swept_nodes"}, "rss": {"swept_nodes"},
           "obb+rss": {"oriented_nodes", "swept_nodes"}}
BOUNDS = {"oriented_nodes", "swept_nodes"}
QUESTIONS = (["overlap"], ["collide"], ["distance"], ["within", "--tolerance", "0.01"])


def random_pose(source):
    """A rotation and a small shift, row by row."""
    w, x, y, z = (source.gauss(0, 1) for _ in range(4))
    n = w * w + x * x + y * y + z * z
    rows = (1 - 2 * (y * y + z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n,
            2 * (x * y + w * z) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - w * x) / n,
            2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, 1 - 2 * (x * x + y * y) / n)
    return " ".join(map(repr, [*rows, *(source.uniform(-0.55, 0.55) for _ in range(3))]))


def sections(program, path, bounds):
    info = run(program, "info", path, "--deep", "--format", "json")
    must(info.returncode == 0, f"info --deep exited {info.returncode}: {info.stderr}")
    told = report_of("info", info.stdout)
    must(told["bounds"] == bounds and told["provenance"]["options"]["bounds"] == bounds, f"{told}")
    return {s["name"]: s["bytes"] for s in told["sections"]}


def without_timing(lines):
    return [{k: v for k, v in line.items() if not k.endswith("_s")} for line in lines]


def check(program, path, folder):
    """Returns how many of the poses collide."""
    baked = {}
    for name, expected in SECTION.items():
        baked[name] = folder / f"{name}.cdp.h5"
        bake(program, path, "-o", baked[name], "--normalize", "--bounds", name, "-j", 1)
        found = sections(program, baked[name], name)
        must(BOUNDS & set(found) == expected, f"{name}: {set(found)}")
        for section in expected:
            must(found[section] == 2 * found["bvh_nodes"], f"{name}: {found}")
        other = folder / "threads.cdp.h5"
        bake(program, path, "-o", other, "--normalize", "--bounds", name, "-j", 4)
        must(digest(other) == digest(baked[name]), f"{name}: threads change the bytes")
    must(len({digest(p) for p in baked.values()}) == len(SECTION), "two bounds, one content")

    poses = ["--poses", folder / "poses"]
    hits = 0
    for question in QUESTIONS:
        name, *options = question
        truth = without_timing(answers(program, name, baked["aabb"], baked["aabb"], *poses,
                                       *options))
        for a, b in [(x, x) for x in SECTION] + [("rss", "lss"), ("obb", "rss"), ("obb+rss", "rss")]:
            found = without_timing(answers(program, name, baked[a], baked[b], *poses, *options))
            must(len(found) == len(truth), f"{name}: {len(found)} lines with {a}, {b}")
            for one, other in zip(found, truth):
                if one.get("upper") == 0:  # of many contacts any may be named
                    one = {k: one[k] for k in ("pose", "lower", "upper")}
                    other = {k: other[k] for k in ("pose", "lower", "upper")}
                must(one == other, f"{name} with {a}, {b}: {one} is not {other}")
        if name == "distance":
            hits = sum(answer["upper"] == 0 for answer in truth)
    return hits


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    source = random.Random(20261121)
    count = 40
    (folder / "poses").write_text("".join(random_pose(source) + "\n" for _ in range(count)))
    write_sheet(folder / "sheet.off", 40)
    hits = []
    for path in [folder / "sheet.off", *shared_models_if_there("seed/bunny.ply")]:
        hits.append(check(program, path, folder))
        must(0.2 * count < hits[-1] < 0.8 * count, f"{path.name}: {hits[-1]} of {count} collide")

    for effects, chosen in (("collide,overlap", "obb"), ("collide,within", "obb+rss"),
                            ("distance", "obb+rss")):
        auto = folder / "auto.cdp.h5"
        bake(program, folder / "sheet.off", "-o", auto, "--effects", effects)
        must(set(sections(program, auto, chosen)) & BOUNDS == SECTION[chosen], effects)

    done = run(program, "bake", folder / "sheet.off", "--bounds", "sphere")
    must(done.returncode == 2 and "rss" in done.stderr, f"{done.returncode}: {done.stderr}")
    print(f"{hits} of {count} poses collide")


if __name__ == "__main__":
    main()
