#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bake --strict refuses what validate warns of; bake --repair repairs it, and the file
records the findings and the origins of its triangles.

Usage: bake_repaired.py CDPREP
"""
import pathlib
import sys
import tempfile

from schemas import report_of
from shared_models import SKIPPED, bake, must, run

try:
    import h5py
except ImportError:
    print("skipped: no h5py")
    sys.exit(SKIPPED)

VERTICES = ["0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"]
CUBE = ["0 3 2", "0 2 1", "4 5 6", "4 6 7", "0 1 5", "0 5 4", "1 2 6", "1 6 5", "2 3 7", "2 7 6",
        "3 0 4", "3 4 7"]
MADE = 2 ** 32 - 1


def write_off(path, triangles):
    rows = "\n".join(VERTICES + ["3 " + t for t in triangles])
    path.write_text(f"OFF\n{len(VERTICES)} {len(triangles)} 0\n{rows}\n")
    return path


def found(program, path):
    info = run(program, "info", path, "--deep", "--format", "json")
    must(info.returncode == 0, f"info --deep exited {info.returncode}: {info.stderr}")
    return report_of("info", info.stdout)


def strict_refuses(program, folder, bad, good):
    output = folder / "strict.cdp.h5"
    done = run(program, "bake", bad, "-o", output, "--strict")
    must(done.returncode == 1, f"--strict exited {done.returncode}: {done.stderr}")
    must("CDP0204" in done.stderr and "12" in done.stderr,
         f"the sentence names neither rule nor triangle: {done.stderr}")
    must(not output.exists(), "--strict left a file")
    bake(program, good, "-o", output, "--strict")
    must(found(program, output)["found"]["findings"] == [], "a cube has findings")


def says_what_it_is(program, folder, good):
    bake(program, good, "-o", folder / "good.cdp.h5")
    info = found(program, folder / "good.cdp.h5")
    must("simple-solid" in info["promises"], f"a cube promises {info['promises']}")
    with h5py.File(folder / "good.cdp.h5") as file:
        verdict = file["cdprep/verdicts"][0]
        must(verdict["volume"] == 1.0 and verdict["area"] == 6.0 and verdict["genus"] == 0,
             f"the cube's verdict is {verdict}")
        must("repaired_from" not in file["cdprep"], "nothing was repaired")


def mends(program, folder):
    # By hand: triangle 12 repeats 5, 3 is wound the other way, 8 is missing and makes a hole.
    triangles = CUBE[:3] + ["4 7 6"] + CUBE[4:8] + CUBE[9:] + [CUBE[5]]
    broken = write_off(folder / "broken.off", triangles)
    output = folder / "repaired.cdp.h5"
    bake(program, broken, "-o", output, "--repair", "closed", "--strict")
    info = found(program, output)
    must("simple-solid" in info["promises"], f"repaired, it promises {info['promises']}")
    counts = info["found"]["repair"]["counts"]
    must((counts["source_triangles"], counts["reversed"], counts["dropped"], counts["made"]) ==
         (12, 1, 1, 1), f"it counts {counts}")
    with h5py.File(output) as file:
        come_from = [int(x) for x in file["cdprep/repaired_from"][:]]
        must(come_from == [*range(11), MADE], f"triangles come from {come_from}")
        must(file["cdprep/verdicts"][0]["volume"] == 1.0, "a repaired cube has volume 1")
    same = folder / "repaired_again.cdp.h5"
    bake(program, broken, "-o", same, "--repair", "closed", "-j", "1")
    must(same.read_bytes() == output.read_bytes(), "the bytes depend on threads")


def mends_bad_numbers(program, folder, good):
    text = good.read_text().replace("0 1 1\n", "nan 1 1\n", 1)
    (folder / "nan.off").write_text(text)
    done = run(program, "bake", folder / "nan.off", "-o", folder / "nan.cdp.h5")
    must(done.returncode == 3, f"NaN exited {done.returncode}")
    bake(program, folder / "nan.off", "-o", folder / "nan.cdp.h5", "--repair", "safe")
    must(found(program, folder / "nan.cdp.h5")["triangles"] == 8, "four triangles use that vertex")


def keeps_numbers_of_vertices(program, folder, good):
    (folder / "first.off").write_text(good.read_text().replace("\n0 0 0\n", "\nnan 0 0\n", 1))
    bake(program, folder / "first.off", "-o", folder / "first.cdp.h5", "--repair", "safe")
    with h5py.File(folder / "first.cdp.h5") as file:
        sources = [VERTICES[i] for i in file["cdprep/source_vertex"]]
        corners = [" ".join(str(int(x)) for x in p) for p in file["cdprep/positions_f64"]]
        must(sources == corners and len(corners) == 7,
             f"vertices come from {sources} and lie at {corners}")


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    good = write_off(folder / "good.off", CUBE)
    strict_refuses(program, folder, write_off(folder / "bad.off", CUBE + [CUBE[5]]), good)
    says_what_it_is(program, folder, good)
    mends(program, folder)
    mends_bad_numbers(program, folder, good)
    keeps_numbers_of_vertices(program, folder, good)


main()
