#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Seconds and bytes of convex pieces and the hierarchy over them, beside the published table.

The published figures are SWIFT++'s, in seconds and MB, on a machine and on meshes of its authors:
it refused the two models that are no 2-manifold. Ours: the stages "pieces" and "piece tree" of a
bake, and the sections that they fill.
Usage: preprocessing_table.py CDPREP FOLDER    (NAME.ply of each model)
Prints a CSV table.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

PUBLISHED = {"horse": ("0.599", "2.95"), "skull": ("8.094", "20.61"), "bunny": ("8.148", "31.62"),
             "armadillo": ("380.121", "162.37"), "buddha": ("refused", "refused"),
             "dragon": ("refused", "refused")}


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    print("model,triangles,pieces,pieces_s,hierarchy_s,mb,bytes_per_triangle,swift_s,swift_mb")
    with tempfile.TemporaryDirectory() as scratch:
        for name, (swift_s, swift_mb) in PUBLISHED.items():
            baked = pathlib.Path(scratch) / f"{name}.cdp.h5"
            done = subprocess.run([program, "bake", folder / f"{name}.ply", "-o", baked, "--effects",
                                   "pieces", "--timings"], capture_output=True, text=True,
                                  check=True)
            seconds = dict(re.findall(r"^  (pieces|piece tree) +([0-9.]+) s", done.stdout +
                                      done.stderr, re.M))
            info = json.loads(subprocess.run([program, "info", baked, "--format", "json"],
                                             capture_output=True, text=True, check=True).stdout)
            size = {s["name"]: s["bytes"] for s in info["sections"] if "piece" in s["name"]}
            total = sum(size.values())
            triangles = size["piece_triangles"] // 4
            print(f"{name},{triangles},{size['pieces'] // 32},{seconds['pieces']},"
                  f"{seconds['piece tree']},{total / 1e6:.2f},{total / triangles:.1f},{swift_s},"
                  f"{swift_mb}", flush=True)


if __name__ == "__main__":
    main()
