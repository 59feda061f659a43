#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bake --structures and query --structure: a file holds the octrees and the tetra-tree
that were requested and no others, h5py reads them as tables, and queries through each
have the answers of the hierarchy of boxes.

With the test models also every pair of Table 4 against the exact sets: by default some
poses of each, a slow program those of two models; all of them with CDPREP_ALL_POSES=yes. Then
every option of a bake is also left out for a scanned model.
Usage: structures.py CDPREP
"""
import math
import os
import pathlib
import random
import sys
import tempfile

from bounds import random_pose
from killed_bake import digest, write_sheet
from known_meshes import CUBE
from poses_truth import truth
from schemas import report_of
from shared_models import (IS_SLOW, answers, bake, must, run, shared_folder_if_there,
                           shared_models_if_there)

OCTREE = {"octree_grid", "octree_nodes", "octree_references", "octree_boxes"}
SECTIONS = {
    "octree": OCTREE,
    "hashed-octree": OCTREE | {"octree_leaf_codes", "octree_leaf_nodes", "octree_top",
                               "octree_modulus_table", "octree_mixed_table"},
    "octree-adaptive": {"adaptive_octree", "adaptive_octree_nodes", "adaptive_octree_references",
                        "adaptive_octree_boxes"},
    "tetra-tree": {"tetra_tree", "tetra_nodes", "tetra_references", "tetra_top", "tetra_boxes",
                   "tetra_oriented"},
}
ALL = set().union(*SECTIONS.values())
# Where cells have boxes, as they do unless others are asked for.
CONE_BOXES = {"tetra_boxes", "tetra_oriented"}
BOXES = {"octree_boxes", "adaptive_octree_boxes"} | CONE_BOXES
FIELDS = {
    "octree_grid": ("origin", "step", "level", "threshold", "top_level", "slot_bits"),
    "octree_nodes": ("key", "first", "count"),
    "adaptive_octree": ("lower", "upper", "level", "threshold", "rule", "reserved"),
    "adaptive_octree_nodes": ("split", "first", "count"),
    "octree_boxes": ("lower", "upper"),
    "adaptive_octree_boxes": ("lower", "upper"),
    "tetra_boxes": ("lower", "upper"),
    "tetra_oriented": ("axis", "centre", "half"),
    "tetra_tree": ("centre", "level", "threshold", "top_level", "bounding", "centre_count",
                   "flags"),
    "tetra_nodes": ("key", "first", "count", "radius_min", "radius_max", "flags"),
}
EVERYTHING = os.environ.get("CDPREP_ALL_POSES") == "yes"
INNER, SHARED = 0x80000000, 0x80000000
POSES = 30
# Each way to ask, beside the structure: no answer may depend on it.
STEPS = {
    "octree": (["--descent", "a-first"], ["--descent", "b-first"], ["--descent", "larger"],
               ["--leaf-test", "feito"]),
    "octree-adaptive": (["--descent", "a-first"], ["--descent", "b-first"], ["--descent", "larger"],
                        ["--leaf-test", "feito"]),
    "tetra-tree": (["--descent", "a-first"], ["--descent", "b-first"], ["--descent", "larger"],
                   ["--leaf-test", "feito"]),
    "hashed-octree": (["--search", "modulus"], ["--search", "sorted"], ["--leaf-test", "feito"]),
}


def write_torus(path, big, small, n, m):
    """Closed and outward; through its centre runs nothing, past it many layers."""
    rows = [f"OFF\n{n * m} {2 * n * m} 0"]
    for i in range(n):
        for j in range(m):
            u, v = 2 * math.pi * i / n, 2 * math.pi * j / m
            r = big + small * math.cos(v)
            rows.append(f"{r * math.cos(u)!r} {r * math.sin(u)!r} {small * math.sin(v)!r}")
    for i in range(n):
        for j in range(m):
            a, b = i * m + j, (i + 1) % n * m + j
            c, d = (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m
            rows += [f"3 {a} {b} {c}", f"3 {a} {c} {d}"]
    path.write_text("\n".join(rows) + "\n")


def told(program, path):
    info = run(program, "info", path, "--deep", "--format", "json")
    must(info.returncode == 0, f"info --deep {path.name} exited {info.returncode}: {info.stderr}")
    return report_of("info", info.stdout)


def holds_what_was_asked(program, mesh, folder):
    """A scene pays only for what it asks."""
    wanted = [(["--structures", name], sections) for name, sections in SECTIONS.items()]
    wanted += [([], set()), (["--structures", "none"], set()), (["--effects", "all"], ALL),
               (["--structures", "all"], ALL), (["--effects", "all", "--structures", "none"], set()),
               (["--effects", "all", "--structures", "octree"], OCTREE),
               (["--structures", "tetra-tree,octree,octree"], OCTREE | SECTIONS["tetra-tree"]),
               (["--structures", "all", "--structure-preset", "paper"], ALL - BOXES),
               (["--structures", "all", "--octree-bounding", "cells", "--bounding", "caps"],
                ALL - BOXES),
               (["--structures", "octree", "--structure-preset", "paper", "--octree-bounding",
                 "boxes"], OCTREE)]
    for options, sections in wanted:
        baked = folder / "some.cdp.h5"
        report = report_of("bake", bake(program, mesh, "-o", baked, *options, "--allow-empty",
                                        "--format", "json").stdout)
        info = told(program, baked)
        names = {section["name"] for section in info["sections"]}
        must(names & ALL == sections, f"{options} baked {names & ALL}")
        sizes = {section["name"]: section["bytes"] for section in info["sections"]}
        structures = {name for name, parts in SECTIONS.items() if parts - BOXES <= sections}
        settings = info["provenance"]["options"]["structures"]
        must(set(settings) == structures, f"{options}: provenance has {settings}")
        told_of = info.get("structures", {})
        must(set(told_of) == structures, f"{options}: info tells of {set(told_of)}")
        for name in structures:
            stored = sum(sizes.get(part, 0) for part in SECTIONS[name])
            must(told_of[name]["bytes"] == stored or not info["triangles"],
                 f"{options}: {name} has {told_of[name]['bytes']} bytes")
            must(settings[name].items() <= told_of[name].items(), f"{options}: {told_of[name]}")
            must(report["models"][0]["structures"][name] == told_of[name],
                 f"{options}: bake and info tell of different trees")
        text = run(program, "info", baked).stdout
        must(all(f"\n  {name} " in text for name in structures), f"{options}: info says {text}")


def opens_in_h5py(program, mesh, folder):
    """The trees as a scientist reads them."""
    try:
        import h5py
        import numpy
    except ImportError:
        print("no h5py: the tables are not looked at")
        return
    baked = folder / "tables.cdp.h5"
    bake(program, mesh, "-o", baked, "--structures", "all", "--octree-level", 5,
         "--octree-threshold", 4, "--tetra-level", 4, "--tetra-threshold", 4)
    with h5py.File(baked, "r") as file:
        data = file["cdprep"]
        triangles = len(data["triangles"])
        for name in ALL:
            must(data[name].attrs["units"] and data[name].attrs["description"],
                 f"{name} has no units or no description")
            must(data[name].dtype.names == FIELDS.get(name), f"{name}: {data[name].dtype}")

        def lists(nodes, references, is_leaf, counts):
            leaves = nodes[is_leaf]
            must(counts.sum() == len(references), "leaves and references differ")
            must(len(numpy.unique(references & ~numpy.uint32(SHARED))) == triangles,
                 "a triangle is in no leaf")
            numbers, times = numpy.unique(references & ~numpy.uint32(SHARED), return_counts=True)
            shared = references >= SHARED
            must(numpy.array_equal(shared, times[references & ~numpy.uint32(SHARED)] > 1),
                 "shared triangles are not marked so")
            return leaves

        grid, nodes = data["octree_grid"][0], data["octree_nodes"][:]
        must((grid["level"], grid["threshold"]) == (5, 4), f"{grid}")
        must(nodes["key"][0] == 1 and numpy.all(numpy.diff(nodes["key"].astype(object)) > 0),
             "keys do not rise")
        is_leaf = nodes["count"] < INNER
        lists(nodes, data["octree_references"][:], is_leaf, nodes["count"][is_leaf])
        for k, node in enumerate(nodes[~is_leaf]):
            children = nodes["key"][node["first"]:][:bin(node["count"] & 255).count("1")]
            must(all(int(child) >> 3 == int(node["key"]) for child in children),
                 f"inner node {k} has other children")
        must(len(data["octree_leaf_codes"]) == is_leaf.sum() == len(data["octree_leaf_nodes"]),
             "as many codes as leaves")
        must(numpy.all(is_leaf[data["octree_leaf_nodes"][:]]), "a code's node is no leaf")
        must(data["octree_top"][-1] == is_leaf.sum(), "the top table counts other leaves")

        nodes = data["adaptive_octree_nodes"][:]
        is_leaf = nodes["count"] < INNER
        lists(nodes, data["adaptive_octree_references"][:], is_leaf, nodes["count"][is_leaf])
        for boxes in (data["octree_boxes"][:], data["adaptive_octree_boxes"][:]):
            must(numpy.all(boxes["lower"] <= boxes["upper"]), "boxes end before they begin")
            must(numpy.array_equal(boxes["lower"].min(axis=0), boxes["lower"][0])
                 and numpy.array_equal(boxes["upper"].max(axis=0), boxes["upper"][0]),
                 "a root's box does not hold all")

        tree, nodes = data["tetra_tree"][0], data["tetra_nodes"][:]
        is_leaf = nodes["flags"] & 0x10 == 0
        listed = nodes["count"][is_leaf].sum() + tree["centre_count"]
        must(listed == len(data["tetra_references"]), "cones list other triangles")
        must(numpy.all(nodes["radius_min"] <= nodes["radius_max"]), "radii are swapped")
        positions = data["positions_f64" if "positions_f64" in data else "positions_f32"][:]
        must(numpy.allclose(tree["centre"], positions.astype(float).mean(axis=0)),
             f"centre {tree['centre']}")
    print("tables: every dataset with its named fields")


def same_bytes(program, mesh, folder):
    options = ["--structures", "all", "--split", "median", "--bounding", "tetra",
               "--octree-bounding", "cells", "--octree-level", "7", "--octree-threshold", "5",
               "--tetra-level", "5", "--tetra-threshold", "6"]
    digests = set()
    for threads in (1, 2, 4):
        bake(program, mesh, "-o", folder / "threads.cdp.h5", "-j", threads, *options)
        digests.add(digest(folder / "threads.cdp.h5"))
    must(len(digests) == 1, f"{mesh.name}: threads change the bytes")
    settings = told(program, folder / "threads.cdp.h5")["provenance"]["options"]["structures"]
    must(settings["octree-adaptive"] == {"level": 7, "threshold": 5, "split": "median",
                                          "bounding": "cells"}
         and settings["tetra-tree"] == {"level": 5, "threshold": 6, "bounding": "tetra"}
         and settings["octree"] == {"level": 7, "threshold": 5, "bounding": "cells"},
         f"provenance: {settings}")
    for i in range(0, len(options), 2):
        if options[i] == "--structures" or mesh.suffix == ".ply" and not EVERYTHING:
            continue
        bake(program, mesh, "-o", folder / "other.cdp.h5", *options[:i], *options[i + 2:])
        must(digest(folder / "other.cdp.h5") not in digests, f"{options[i]} says nothing")


def agree(program, a, b, poses, questions, what):
    """Returns how many of the poses hit and how many pairs hashed-octree-literal missed."""
    hits = missed = 0
    for question in questions:
        ask = [*question, a, b, "--poses", poses]
        expected = answers(program, *ask)
        hits = sum(answer["hit"] for answer in expected)
        for structure, steps in STEPS.items():
            for step in ([], *(steps[:1] if IS_SLOW else steps)):
                found = answers(program, *ask, "--structure", structure, *step)
                must(found == expected, f"{what}: {question} {structure} {step} differs")
        if question[0] != "overlap" or "solid" in question:
            continue
        for answer, literal in zip(expected, answers(program, *ask, "--structure",
                                                     "hashed-octree-literal")):
            must(literal.pop("approximate") is True, "hashed-octree-literal claims to be exact")
            if "pairs" in answer:
                must(set(map(tuple, literal["pairs"])) <= set(map(tuple, answer["pairs"])),
                     f"{what}: hashed-octree-literal finds a false pair")
            must(literal["count"] <= answer["count"], f"{what}: {literal}")
            missed += answer["count"] - literal["count"]
    return hits, missed


def answers_agree(program, meshes, folder):
    """Sets, flags and counts through every structure are those of the hierarchy."""
    source = random.Random(20261121)
    poses = folder / "poses"
    poses.write_text("".join(random_pose(source) + "\n" for _ in range(POSES)))
    questions = (["overlap"], ["overlap", "--count", "--repeat", "2"], ["collide"],
                 ["overlap", "--contact", "proper"], ["collide", "--skip-degenerate"],
                 ["collide", "--as", "solid"], ["overlap", "--as", "solid"])
    questions = questions[::3] if IS_SLOW else questions
    for mesh in meshes:
        tuned, coarse = folder / "tuned.cdp.h5", folder / "coarse.cdp.h5"
        bake(program, mesh, "-o", tuned, "--normalize", "--structures", "all")
        bake(program, mesh, "-o", coarse, "--normalize", "--structures", "all",
             "--structure-preset", "paper", "--split", "area", "--bounding", "tetra")
        hits, _ = agree(program, tuned, coarse, poses, questions, mesh.name)
        must(0.2 * POSES < hits < POSES, f"{mesh.name}: {hits} of {POSES} poses hit")
        print(f"{mesh.name}: {hits} of {POSES} poses hit, all structures agree")


def inclusion_agrees(program, meshes, folder):
    source = random.Random(7)
    points = [[source.uniform(-0.5, 0.5) for _ in range(3)] for _ in range(200)]
    points += [[source.randrange(-4, 5) / 8 for _ in range(3)] for _ in range(200)]
    (folder / "points").write_text("".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points))
    for mesh in meshes:
        baked = folder / "solid.cdp.h5"
        bake(program, mesh, "-o", baked, "--normalize", "--structures", "all", "--effects",
             "inside")
        ask = ["inside", baked, "--points", folder / "points"]
        expected = answers(program, *ask)
        for structure in STEPS:
            must(answers(program, *ask, "--structure", structure) == expected,
                 f"{mesh.name}: inside differs through {structure}")
        inside = sum(answer["inside"] == "yes" for answer in expected)
        print(f"{mesh.name}: {inside} of {len(points)} points inside, all structures agree")


def invalid_arguments(program, mesh, folder):
    plain, octree = folder / "plain.cdp.h5", folder / "octree.cdp.h5"
    bake(program, mesh, "-o", plain)
    bake(program, mesh, "-o", octree, "--structures", "octree")
    (folder / "points").write_text("0 0 0\n")
    pair, points = [octree, octree], ["--points", folder / "points"]
    cases = [
        (["bake", mesh, "--structures", "kd-tree"], ["'kd-tree'", "octree-adaptive", "none"]),
        (["bake", mesh, "--structures", "bvh"], ["'bvh'"]),
        (["bake", mesh, "--structures", "octree, tetra-tree"], ["' tetra-tree'"]),
        (["bake", mesh, "--structures", "none,octree"], ["'none'"]),
        (["bake", mesh, "--structures", "octree", "--octree-level", "22"], ["--octree-level", "21"]),
        (["bake", mesh, "--structures", "octree", "--octree-level", "-1"], ["--octree-level"]),
        (["bake", mesh, "--structures", "octree", "--octree-level", "deep"], ["--octree-level"]),
        (["bake", mesh, "--structures", "octree", "--octree-threshold", "0"],
         ["--octree-threshold", "1"]),
        (["bake", mesh, "--structures", "tetra-tree", "--tetra-level", "15"],
         ["--tetra-level", "14"]),
        (["bake", mesh, "--structures", "tetra-tree", "--tetra-threshold", "0"],
         ["--tetra-threshold"]),
        (["bake", mesh, "--structure-preset", "best"], ["best", "paper"]),
        (["bake", mesh, "--structure-preset", "paper"], ["--structure-preset", "--structures"]),
        (["bake", mesh, "--octree-level", "4"], ["--octree-level", "--structures"]),
        (["bake", mesh, "--structures", "octree", "--tetra-level", "4"], ["--tetra-level"]),
        (["bake", mesh, "--structures", "octree", "--split", "area"], ["octree-adaptive"]),
        (["bake", mesh, "--structures", "octree", "--bounding", "caps"], ["tetra-tree"]),
        (["bake", mesh, "--structures", "tetra-tree", "--bounding", "box"], ["box", "caps"]),
        (["query", "overlap", *pair, "--structure", "kd-tree"], ["'kd-tree'", "tetra-tree"]),
        (["query", "overlap", *pair, "--structure", "pieces"], ["piece_nodes", "--effects pieces"]),
        (["query", "collide", *pair, "--structure", "sphere-tree"],
         ["'sphere-tree'", "collide", "tetra-tree or hull."]),
        (["query", "collide", *pair, "--structure", "hashed-octree-literal"],
         ["hashed-octree-literal", "collide"]),
        (["query", "distance", *pair, "--structure", "octree"], ["'octree'", "distance", "bvh"]),
        (["query", "within", *pair, "--tolerance", "1", "--structure", "octree"], ["within"]),
        (["query", "overlap", *pair, "--structure", "octree", "--segments"], ["--segments", "bvh"]),
        (["query", "overlap", *pair, "--structure", "octree", "--search", "mixed"], ["--search"]),
        (["query", "overlap", *pair, "--leaf-test", "feito"], ["--leaf-test", "bvh"]),
        (["query", "overlap", *pair, "--descent", "both"], ["--descent", "bvh"]),
        (["query", "overlap", *pair, "--structure", "hashed-octree", "--descent", "both"],
         ["--descent", "hashed-octree"]),
        (["query", "overlap", *pair, "--structure", "hashed-octree-literal", "--as", "solid"],
         ["--as solid", "misses"]),
        (["query", "overlap", plain, octree, "--structure", "octree"],
         ["plain", "octree_grid, octree_nodes, octree_references", "--structures octree"]),
        (["query", "overlap", octree, plain, "--structure", "octree"], ["plain"]),
        (["query", "overlap", *pair, "--structure", "hashed-octree"],
         ["octree_leaf_codes", "--structures hashed-octree"]),
        (["query", "overlap", *pair, "--structure", "hashed-octree-literal"],
         ["octree_modulus_table", "--structures hashed-octree."]),
        (["query", "collide", *pair, "--structure", "tetra-tree"],
         ["tetra_nodes", "--structures tetra-tree"]),
        (["query", "inside", octree, *points, "--structure", "tetra-tree"], ["tetra_nodes"]),
        (["query", "inside", octree, *points, "--structure", "hull"], ["'hull'", "inside"]),
        (["query", "closest", octree, *points, "--structure", "octree"], ["closest"]),
    ]
    for arguments, words in cases:
        done = run(program, *arguments)
        must(done.returncode == 2 and not done.stdout,
             f"{arguments}: exit {done.returncode}: {done.stderr}{done.stdout}")
        must(all(word in done.stderr for word in words), f"{arguments}: {done.stderr}")


def pairs_of_the_papers(program, shared, folder):
    """The sets beside the poses, which CGAL's exact predicates computed."""
    names = ["horse", "armadillo"]
    if not IS_SLOW:
        names += ["skull", "bunny", "dragon", "buddha"]
    bake(program, "--normalize", "--structures", "all", "--output-dir", folder,
         *(shared / "models" / "seed" / f"{name}.ply" for name in names))
    checked = pairs = missed = 0
    for poses in sorted((shared / "poses").glob("*.pose")):
        a, b = poses.stem.split("-")
        if IS_SLOW and not {a, b} <= set(names):
            continue
        expected = truth(poses.with_suffix(".truth"))
        if not EVERYTHING:
            expected = expected[:3]  # one light, one deep, one near
        some = folder / "some.pose"
        some.write_text("\n".join(poses.read_text().splitlines()[:len(expected)]) + "\n")
        ask = ["overlap", folder / f"{a}.cdp.h5", folder / f"{b}.cdp.h5", "--poses", some,
               "--skip-degenerate", "--structure"]
        for structure in STEPS:
            found = [answer["pairs"] for answer in answers(program, *ask, structure)]
            must(found == expected, f"{poses.stem}: {structure} finds other pairs")
        literal = sum(answer["count"] for answer in
                      answers(program, *ask, "hashed-octree-literal", "--count"))
        count = sum(map(len, expected))
        must(literal <= count, f"{poses.stem}: hashed-octree-literal finds {literal} of {count}")
        checked, pairs, missed = checked + len(expected), pairs + count, missed + count - literal
    must(checked > 0, "no pair of models was tested")
    print(f"{checked} poses, {pairs} pairs, all structures equal to the exact sets; "
          f"hashed-octree-literal misses {missed}")


def random_poses_of_the_papers(program, folder):
    """200 random poses for each of six pairs; the hierarchy is proved by the exact sets."""
    source = random.Random(5)
    count = 200
    (folder / "random.pose").write_text("".join(random_pose(source) + "\n" for _ in range(count)))
    for a, b in (("horse", "skull"), ("skull", "bunny"), ("bunny", "armadillo"),
                 ("armadillo", "horse"), ("dragon", "buddha"), ("buddha", "bunny")):
        ask = ["overlap", folder / f"{a}.cdp.h5", folder / f"{b}.cdp.h5", "--poses",
               folder / "random.pose"]
        expected = answers(program, *ask)
        for structure in STEPS:
            must(answers(program, *ask, "--structure", structure) == expected,
                 f"{a}, {b}: {structure} finds other pairs")
        hits = sum(answer["hit"] for answer in expected)
        must(0.2 * count < hits < 0.9 * count, f"{a}, {b}: {hits} of {count} poses hit")
        print(f"{a}, {b}: {hits} of {count} random poses hit, all structures agree")


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    write_sheet(folder / "sheet.off", 20)
    write_torus(folder / "torus.off", 2, 0.7, 40, 20)
    (folder / "cube.off").write_text(CUBE)
    (folder / "empty.off").write_text("OFF\n0 0 0\n")
    (folder / "point.off").write_text("OFF\n1 1 0\n1 2 3\n3 0 0 0\n")
    torus, sheet = folder / "torus.off", folder / "sheet.off"

    for name in ("torus", "empty", "point"):
        holds_what_was_asked(program, folder / f"{name}.off", folder)
    opens_in_h5py(program, torus, folder)
    for mesh in (torus, sheet, *shared_models_if_there("seed/bunny.ply")):
        same_bytes(program, mesh, folder)
    answers_agree(program, (sheet, torus, folder / "cube.off"), folder)
    inclusion_agrees(program, (sheet, torus, folder / "cube.off"), folder)
    invalid_arguments(program, torus, folder)
    shared = shared_folder_if_there()
    if shared is None:
        print("skipped: pairs of the test models, which are not there (set CDPREP_SHARED)")
        return
    pairs_of_the_papers(program, shared, folder)
    if EVERYTHING:
        random_poses_of_the_papers(program, folder)


main()
