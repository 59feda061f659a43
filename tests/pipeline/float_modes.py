#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""No answer and no baked byte depends on the caller's floating-point environment.

Programs run as usual, and again with every thread flushing subnormal numbers, rounding in
another direction or trapping exceptions: the same bytes. pose_answers asks the library about
Table 4's pairs at their poses, a share of them by default, all with CDPREP_ALL_POSES=yes.
Usage: float_modes.py CDPREP POSE_ANSWERS SET_FLOAT_MODE
"""
import os
import pathlib
import platform
import re
import subprocess
import sys
import tempfile

from killed_bake import digest, write_sheet
from shared_models import SKIPPED, bake, must, run, shared_folder_if_there

# As in tests/support/float_modes.h.
MODES = {
    "x86_64": {"flush_to_zero": "0x9FC0", "downwards": "0x3F80", "upwards": "0x5F80",
               "towards_zero": "0x7F80", "trapping": "0x0"},
    "aarch64": {"flush_to_zero": "0x01000000", "downwards": "0x00800000",
                "upwards": "0x00400000", "towards_zero": "0x00C00000"},
}
SHARE = 3  # poses of each pair in the short form: light, deep, near


def write_tiny(path):
    """Two tetrahedra whose coordinates are subnormal, one in the other."""
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    lines = []
    for scale, shift in ((64, 0), (8, 4)):
        for corner in corners:
            lines.append(" ".join(f"{(scale * x + shift) * 2.0**-1060!r}" for x in corner))
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    for first in (0, 4):
        lines += [f"3 {first + a} {first + b} {first + c}" for a, b, c in faces]
    path.write_text(f"OFF\n8 8 0\n" + "\n".join(lines) + "\n")


def outputs_in_modes(program, preload, modes, *arguments):
    """What a command prints as usual, and in each mode."""
    usual = run(program, *arguments)
    must(usual.returncode == 0, f"{arguments} exited {usual.returncode}: {usual.stderr}")
    for name, control in modes.items():
        found = run(program, *arguments, env={
            **os.environ, "LD_PRELOAD": str(preload), "CDPREP_TEST_FLOAT_CONTROL": control})
        must(found.returncode == 0, f"{name}: {arguments} exited {found.returncode}: "
                                    f"{found.stderr}")
        must(plain(found.stdout) == plain(usual.stdout), f"{name}: {arguments} prints other bytes")
    return usual.stdout


def plain(text):
    """Without times, which differ from run to run."""
    return re.sub(r'"(elapsed_s|seconds|[a-z_]*_ms|[a-z_]*_s|date|time)": ?[^,}]*', "", text)


def check_bakes(program, preload, modes, inputs, folder):
    for path in inputs:
        first = folder / "first.cdp.h5"
        bake(program, path, "-o", first, "--effects", "all")
        for name, control in modes.items():
            output = folder / f"{name}.cdp.h5"
            bake(program, path, "-o", output, "--effects", "all", "-j", 3, env={
                **os.environ, "LD_PRELOAD": str(preload), "CDPREP_TEST_FLOAT_CONTROL": control})
            must(digest(output) == digest(first), f"{path.name}, {name}: another bake")
        print(f"{path.name}: the same bake in {len(modes)} modes")


def main():
    program, pose_answers, preload = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
    modes = MODES.get(platform.machine())
    if modes is None:
        print("skipped: this processor has one floating-point environment")
        sys.exit(SKIPPED)
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    sheet, tiny = folder / "sheet.off", folder / "tiny.off"
    write_sheet(sheet, 60)
    write_tiny(tiny)
    shared = shared_folder_if_there()
    inputs = [sheet, tiny]
    if shared is not None:
        inputs.append(shared / "models" / "seed" / "bunny.ply")
    check_bakes(program, preload, modes, inputs, folder)
    baked = folder / "tiny.cdp.h5"
    bake(program, tiny, "-o", baked)
    outputs_in_modes(program, preload, modes, "info", baked, "--deep")
    outputs_in_modes(program, preload, modes, "query", "distance", baked, baked,
                     "--format", "ndjson")
    if shared is None:
        print("skipped: the test models, which are not there (set CDPREP_SHARED)")
        return
    everything = os.environ.get("CDPREP_ALL_POSES") == "yes"
    names = ["horse", "skull", "bunny", "armadillo", "dragon", "buddha"]
    bake(program, "--normalize", "--output-dir", folder,
         *(shared / "models" / "seed" / f"{name}.ply" for name in names))
    pairs = sorted((shared / "poses").glob("*.pose"))
    for poses in pairs:
        a, b = poses.stem.split("-")
        models = [folder / f"{a}.cdp.h5", folder / f"{b}.cdp.h5"]
        done = subprocess.run([pose_answers, *models, poses, "150" if everything else str(SHARE)],
                              capture_output=True, text=True)
        must(done.returncode == 0, f"{poses.stem}: {done.stdout}{done.stderr}")
        print(f"{poses.stem}: {done.stdout.strip()}, the same in every mode")
    a, b = pairs[0].stem.split("-")
    some = folder / "some.pose"
    some.write_text("\n".join(pairs[0].read_text().splitlines()[:SHARE]) + "\n")
    for question in ("overlap", "distance"):
        outputs_in_modes(program, preload, modes, "query", question, folder / f"{a}.cdp.h5",
                         folder / f"{b}.cdp.h5", "--poses", some, "--format", "ndjson")


main()
