#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""All real and broken models in one call, and a sentence for each malformed file.

Prints a table of file, triangles, seconds, bytes and bytes per triangle.
Usage: hard_models.py CDPREP
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from schemas import report_of
from shared_models import must, run, shared_folder

NOT_MODELS = {".md", ".bin"}
# What each malformed file must give: 0 when it can be read after all.
MALFORMED = {
    "AllIndicesOutOfRange.gltf": 3, "BoxWithInfinites.glb": 3, "IndexOutOfRange.gltf": 3,
    "OutOfMemory.off": 3, "RecursiveNodes.gltf": 3, "malformed.obj": 3,
    "concave_polygon.obj": 0, "degtri_sliding.off": 0, "regr_3429812.obj": 0,
    "soup.stl": 0, "wallhole.obj": 0, "whitespace.off": None, "fuze_ascii.ply": None,
}


def expected_triangles(provenance):
    """File name to triangle count, from the tables of the models' provenance."""
    rows = [line.split("|") for line in provenance.read_text().splitlines() if line.startswith("|")]
    return {row[1].strip().removeprefix("malformed/"): int(row[5].replace(",", ""))
            for row in rows if len(row) > 6 and row[5].strip().replace(",", "").isdigit()}


def main():
    program = sys.argv[1]
    models = shared_folder() / "models"
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    seeds = [models / "seed" / f"{name}.ply"
             for name in ("horse", "skull", "bunny", "armadillo", "dragon", "buddha")]
    hard = sorted(path for path in (models / "hard").iterdir()
                  if path.is_file() and path.suffix not in NOT_MODELS)
    must(len(hard) == 30, f"{len(hard)} hard files instead of 30")

    done = run(program, "bake", *seeds, *hard, "--output-dir", folder, "--format", "json",
               "--timings")
    must(done.returncode == 0, f"baking all exited {done.returncode}: {done.stderr}")
    reports = {pathlib.Path(report["input"]).name: report
               for report in report_of("bake", done.stdout)["models"]}
    expected = expected_triangles(models / "hard" / "PROVENANCE.md")
    print(f"{'file':45} {'triangles':>9} {'seconds':>8} {'bytes':>10} {'B/tri':>7}")
    for path in seeds + hard:
        report = reports[path.name]
        output = folder / pathlib.Path(report["output"]).name
        size, triangles = output.stat().st_size, report["triangles"]
        print(f"{path.name:45} {triangles:9} {report['seconds']:8.3f} {size:10} "
              f"{size / max(triangles, 1):7.1f}")
        if path.name in expected:
            must(triangles == expected[path.name],
                 f"{path.name}: {triangles} triangles, measured {expected[path.name]}")
        deep = run(program, "info", output, "--deep")
        must(deep.returncode == 0, f"{path.name}: info --deep says {deep.stdout}{deep.stderr}")

    print()
    malformed = sorted(path for path in (models / "hard" / "malformed").iterdir()
                       if path.suffix not in NOT_MODELS)
    must({path.name for path in malformed} == set(MALFORMED), "the set of malformed files changed")
    for path in malformed:
        begun = time.time()
        done = run(program, "bake", path, "-o", folder / "malformed.cdp.h5", timeout=60)
        sentences = done.stderr.strip()
        print(f"{path.name}: exit {done.returncode}, {time.time() - begun:.2f} s. {sentences}")
        allowed = {0, 3} if MALFORMED[path.name] is None else {MALFORMED[path.name]}
        must(done.returncode in allowed, f"{path.name}: exit {done.returncode}")
        if done.returncode:
            must(len(sentences.splitlines()) == 1 and path.name in sentences
                 and re.search(r"\.$", sentences), f"{path.name}: not one sentence")


main()
