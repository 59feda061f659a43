#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A bake holds what its effects need and no more. A query that needs more fails with exit code 2 and
names the missing sections.

Usage: effects.py CDPREP
"""
import pathlib
import sys
import tempfile

from killed_bake import write_sheet
from schemas import report_of
from shared_models import bake, must, run

GEOMETRY = {"positions_f32", "triangles", "bvh_nodes", "degenerate_bits"}
# In every file.
ALWAYS = {"bounds", "provenance", "verdicts", "findings"}
SOURCE = {"source_triangle", "source_vertex", "source_face", "group_runs", "group_names",
          "material_runs", "material_names", "instances", "instance_names"}
PAIR = {"bvh_leaves", "oriented_nodes", "swept_nodes"}
CONTACTS = {"piece_adjacency", "edge_convexity", "triangle_piece"}
PIECES = {"pieces", "piece_triangles", "piece_vertices", "piece_facets", "piece_nodes",
          "piece_leaves", "piece_node_hulls", "piece_swept"}
# What each effect may hold; sections that would say nothing are left out.
ALLOWED = {
    "collide": GEOMETRY | PAIR | {"components"}, "inside": GEOMETRY | {"components"},
    "overlap": GEOMETRY | PAIR | SOURCE, "ray": GEOMETRY | SOURCE, "closest": GEOMETRY | SOURCE,
    "distance": GEOMETRY | PAIR | SOURCE, "within": GEOMETRY | PAIR | SOURCE,
    "touch": GEOMETRY | SOURCE, "corners": GEOMETRY | SOURCE | {"components"},
    "pieces": GEOMETRY | PAIR | SOURCE | PIECES,
    "contacts": GEOMETRY | PAIR | SOURCE | PIECES | CONTACTS,
    "response": GEOMETRY | PAIR | SOURCE | PIECES | CONTACTS | {"mass_properties"},
}
MUST_HAVE = {"collide": {"bvh_nodes", "bvh_leaves", "components"}, "inside": {"components"},
             "overlap": {"source_triangle"}, "response": PIECES | CONTACTS, "pieces": PIECES,
             "contacts": PIECES | CONTACTS}


def sections(program, path):
    info = run(program, "info", path, "--deep", "--format", "json")
    must(info.returncode == 0, f"info --deep exited {info.returncode}: {info.stderr}")
    return {section["name"] for section in report_of("info", info.stdout)["sections"]}


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    write_sheet(folder / "sheet.off", 20)
    (folder / "points").write_text("0 0 0\n")
    (folder / "rays").write_text("0.3 0.3 9 0 0 -1\n")

    baked, sizes = {}, {}
    for effect, allowed in ALLOWED.items():
        baked[effect] = folder / f"{effect}.cdp.h5"
        bake(program, folder / "sheet.off", "-o", baked[effect], "--effects", effect)
        found = sections(program, baked[effect])
        must(found <= allowed | ALWAYS, f"--effects {effect} also baked {found - allowed}")
        must(found >= ALWAYS, f"--effects {effect} lacks {ALWAYS - found}")
        must(MUST_HAVE.get(effect, set()) <= found, f"--effects {effect} holds only {found}")
        sizes[effect] = baked[effect].stat().st_size
    must(sizes["collide"] < sizes["overlap"] < sizes["contacts"] <= sizes["response"], f"sizes {sizes}")

    pair = [baked["collide"], baked["collide"]]
    for arguments, served in ((["collide", *pair], True),
                              (["collide", *pair, "--as", "solid"], True),
                              (["collide", baked["overlap"], baked["overlap"]], True),
                              (["collide", baked["overlap"], baked["overlap"], "--as", "solid"],
                               False),
                              (["overlap", *pair], False),
                              (["inside", baked["collide"], "--points", folder / "points"], True),
                              (["inside", baked["ray"], "--points", folder / "points"], True),
                              (["inside", baked["overlap"], "--points", folder / "points"], True),
                              (["ray", baked["ray"], "--rays", folder / "rays"], True),
                              (["closest", baked["inside"], "--points", folder / "points"], False),
                              (["closest", baked["response"], "--points", folder / "points"],
                               True)):
        done = run(program, "query", *arguments)
        must(done.returncode == (0 if served else 2),
             f"query {arguments} exited {done.returncode}: {done.stderr}")
        if not served:
            must("--effects" in done.stderr and len(done.stderr.splitlines()) == 1
                 and any(name in done.stderr
                         for name in ("source_triangle", "components", "bvh_nodes")),
                 f"the sentence names no section: {done.stderr}")

    everything = folder / "all.cdp.h5"
    bake(program, folder / "sheet.off", "-o", everything, "--effects", "all")
    missing = (GEOMETRY - {"degenerate_bits"} | {"components", "source_triangle"}) - sections(program, everything)
    must(not missing, f"--effects all left {missing} out")
    for arguments in (["overlap", everything, everything, "--as", "solid"],
                      ["collide", everything, everything, "--structure", "octree"],
                      ["collide", everything, everything, "--structure", "pieces"]):
        done = run(program, "query", *arguments)
        must(done.returncode == 0, f"query {arguments} exited {done.returncode}: {done.stderr}")

    for effects in ("colide", "collide,,overlap", "collide, overlap"):
        done = run(program, "bake", folder / "sheet.off", "-o", everything, "--effects", effects)
        must(done.returncode == 2 and "overlap" in done.stderr, f"{effects}: {done.stderr}")
    print(sizes)


main()
