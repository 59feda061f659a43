#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A full disk: exit 4, one sentence, the old file whole, nothing half-written left.

Mounts a small memory file system, so it runs only as root.
Usage: full_disk.py CDPREP
"""
import contextlib
import os
import pathlib
import subprocess
import sys
import tempfile

from killed_bake import digest, write_sheet
from shared_models import SKIPPED, bake, must, run


@contextlib.contextmanager
def small_disk(folder, size):
    if os.geteuid() != 0 or subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder],
            capture_output=True).returncode:
        print("skipped: mounting a small file system needs root")
        sys.exit(SKIPPED)
    try:
        yield
    finally:
        subprocess.run(["umount", folder], check=True)


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    disk = folder / "disk"
    disk.mkdir()
    write_sheet(folder / "small.off", 8)
    write_sheet(folder / "large.off", 150)
    with small_disk(disk, "512k"):
        output = disk / "m.cdp.h5"
        bake(program, folder / "small.off", "-o", output)
        old = digest(output)
        full = run(program, "bake", folder / "large.off", "-o", output)
        must(full.returncode == 4, f"exit {full.returncode} on a full disk: {full.stderr}")
        must(len(full.stderr.strip().splitlines()) == 1 and "m.cdp.h5" in full.stderr,
             f"not one sentence that names the file: {full.stderr}")
        must(digest(output) == old, "the old file changed")
        must([path.name for path in disk.iterdir()] == ["m.cdp.h5"], "a stray file was left")
        bake(program, folder / "small.off", "-o", output)

        with open(disk / "filler", "wb", buffering=0) as filler, contextlib.suppress(OSError):
            while True:
                filler.write(bytes(4096))
        last = run(program, "bake", folder / "small.off", folder / "small.off", "-o", disk / "n")
        must(last.returncode == 2, f"exit {last.returncode} for one output of two inputs")
        last = run(program, "bake", folder / "large.off", folder / "small.off",
                   "--output-dir", disk)
        must(last.returncode == 4 and len(last.stderr.strip().splitlines()) == 2,
             f"exit {last.returncode} when no byte is free: {last.stderr}")
        must(sorted(path.name for path in disk.iterdir()) == ["filler", "m.cdp.h5"],
             "a stray file was left on a disk without a free byte")
        # The chart has room and the page has none: neither appears.
        (disk / "filler").unlink()
        scene = pathlib.Path(__file__).resolve().parents[2] / "samples/scenes/crates.json"
        pages = run(program, "simulate", scene, "--html", disk / "p.html", "--svg", disk / "p.svg")
        must(pages.returncode == 4 and "p.html" in pages.stderr,
             f"exit {pages.returncode} without room for a page: {pages.stderr}")
        must([path.name for path in disk.iterdir()] == ["m.cdp.h5"], "a chart was left alone")
    print(full.stderr.strip())
    print(last.stderr.strip())


main()
