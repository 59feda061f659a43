#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A baked file that is truncated while the program reads it gives one sentence and exit 3.

Replacing it by rename changes nothing for who reads the old one.
Usage: truncated_file.py CDPREP SHEET_SIZE ROUNDS
"""
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

from killed_bake import write_sheet
from shared_models import bake, must, run

# The option that names a file of places, and a place near the sheet. The program opens that file
# when it has opened and checked the models.
PLACES = {"closest": ("--points", "1.5 2.5 9"), "inside": ("--points", "1.5 2.5 1"),
          "ray": ("--rays", "1.5 2.5 9 0 0 -1"),
          "overlap": ("--poses", "1 0 0 0 1 0 0 0 1 0.5 0.25 0.125")}


def ask_through_pipe(program, question, baked, pipe, change, *more):
    """Asks; once the file is open and checked, changes it, and only then gives the places."""
    os.mkfifo(pipe)
    option, place = PLACES[question]
    models = [baked, baked] if option == "--poses" else [baked]
    asking = subprocess.Popen(
        [program, "query", question, *models, option, pipe, "--format", "ndjson", *more],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    with open(pipe, "w", encoding="ascii") as places:  # waits until the program opens it
        change()
        try:
            places.write(f"{place}\n" * 10)
        except BrokenPipeError:
            pass
    out, errors = asking.communicate(timeout=60)
    pipe.unlink()
    return asking.returncode, out, errors


def must_be_told(code, errors, path, what):
    must(code == 3, f"{what}: exit {code} instead of 3: {errors}")
    lines = errors.splitlines()
    must(len(lines) == 1 and str(path) in lines[0] and "truncated" in lines[0]
         and lines[0].endswith("."), f"{what}: not one sentence that names the file: {errors}")


def truncated_while_asked(program, folder, sound):
    for question in PLACES:
        baked = folder / "truncated.cdp.h5"
        shutil.copy(sound, baked)
        code, _, errors = ask_through_pipe(program, question, baked, folder / "pipe",
                                           lambda: os.truncate(baked, 4096))
        must_be_told(code, errors, baked, f"query {question}")
    shutil.copy(sound, baked)
    export = folder / "export.ply"
    code, _, errors = ask_through_pipe(program, "inside", baked, folder / "pipe",
                                       lambda: os.truncate(baked, 4096), "--export", export)
    must_be_told(code, errors, baked, "query inside --export")
    must(not export.exists(), "an export of answers that were not given")
    # A file without a name, and one with an odd name, are named too.
    odd = folder / "odd (deleted) name\x01.cdp.h5"
    shutil.copy(sound, odd)
    code, _, errors = ask_through_pipe(program, "closest", odd, folder / "pipe",
                                       lambda: (os.truncate(odd, 4096), odd.unlink()))
    must_be_told(code, errors, folder / "odd (deleted) name?.cdp.h5", "a file that was removed")


def replaced_while_asked(program, folder, sound, other):
    baked = folder / "replaced.cdp.h5"
    for question in PLACES:
        shutil.copy(sound, baked)
        before = ask_through_pipe(program, question, baked, folder / "pipe", lambda: None)
        must(before[0] == 0 and before[1].count("\n") >= 10, f"query {question}: {before}")
        new = folder / "new"
        shutil.copy(other, new)
        during = ask_through_pipe(program, question, baked, folder / "pipe",
                                  lambda new=new: os.replace(new, baked))
        must(during == before, f"query {question} after a rename: {during} instead of {before}")
        after = ask_through_pipe(program, question, baked, folder / "pipe", lambda: None)
        must(after[0] == 0, f"query {question} of the new file: {after}")
        if question != "inside":  # no point is inside a sheet
            must(after[1] != before[1], f"query {question}: the old file again")


def truncated_at_random(program, folder, mesh, sound, rounds):
    """Info and bake, whatever they are doing: success, or a sentence and exit 3."""
    output = folder / "out" / "m.cdp.h5"
    output.parent.mkdir()
    begun = time.time()
    must(run(program, "info", "--deep", sound).returncode == 0, "a sound file is damaged")
    whole_info = time.time() - begun
    begun = time.time()
    bake(program, mesh, "-o", output)
    whole_bake = time.time() - begun
    random.seed(20261122)
    seen = {0: 0, 3: 0}
    for i in range(rounds):
        source = folder / ("read.off" if i % 2 else "read.cdp.h5")
        shutil.copy(mesh if i % 2 else sound, source)
        output.unlink(missing_ok=True)
        command = ["bake", source, "-o", output] if i % 2 else ["info", "--deep", source]
        child = subprocess.Popen([program, *map(str, command)], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True)
        # A bake reads its mesh at the beginning.
        time.sleep(random.random() * (0.2 * whole_bake if i % 2 else whole_info))
        os.truncate(source, 4096)
        _, errors = child.communicate(timeout=120)
        must(child.returncode in seen, f"{command[0]} exited {child.returncode}: {errors}")
        seen[child.returncode] += 1
        if child.returncode == 3:
            must(len(errors.splitlines()) == 1 and str(source) in errors,
                 f"{command[0]}: not one sentence that names the file: {errors}")
        if i % 2:
            must(output.exists() == (child.returncode == 0), "an output of a bake that failed")
            bake(program, sound_mesh(folder), "-o", output)  # removes what was left
            stray = [path.name for path in output.parent.iterdir() if path != output]
            must(not stray, f"stray files {stray}")
    print(f"{rounds} truncations: {seen[0]} came too late, {seen[3]} were told")
    must(seen[3] > 0, "no truncation came before the end")


def sound_mesh(folder):
    path = folder / "small.off"
    if not path.exists():
        write_sheet(path, 4)
    return path


def main():
    program, size, rounds = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    mesh = folder / "sheet.off"
    write_sheet(mesh, size)
    sound, other = folder / "sound.cdp.h5", folder / "other.cdp.h5"
    bake(program, mesh, "-o", sound, "--effects", "all")
    one = folder / "one.off"
    write_sheet(one, 1)
    bake(program, one, "-o", other, "--effects", "all")
    truncated_while_asked(program, folder, sound)
    replaced_while_asked(program, folder, sound, other)
    truncated_at_random(program, folder, mesh, sound, rounds)


if __name__ == "__main__":
    main()
