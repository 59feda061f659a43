#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""kill -9 at random moments of a bake leaves the old file or the new one, whole.

Usage: killed_bake.py CDPREP SHEET_SIZE ROUNDS
"""
import hashlib
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

from shared_models import bake, must, run


def write_sheet(path, n):
    """An n x n wavy sheet as OFF text."""
    rows = [f"OFF\n{(n + 1) ** 2} {2 * n * n} 0"]
    rows += [f"{x} {y} {(x * 7 + y * 13) % 5}" for x in range(n + 1) for y in range(n + 1)]
    for x in range(n):
        for y in range(n):
            a = x * (n + 1) + y
            rows += [f"3 {a} {a + 1} {a + n + 2}", f"3 {a} {a + n + 2} {a + n + 1}"]
    path.write_text("\n".join(rows) + "\n")


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def main():
    program, size, rounds = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    old_mesh, new_mesh, output = folder / "old.off", folder / "new.off", folder / "out" / "m.cdp.h5"
    output.parent.mkdir()
    write_sheet(old_mesh, 8)
    write_sheet(new_mesh, size)

    bake(program, new_mesh, "-o", output)
    new = digest(output)
    begun = time.time()
    bake(program, new_mesh, "-o", output)
    whole = time.time() - begun
    bake(program, old_mesh, "-o", output)
    old = digest(output)

    random.seed(20261121)
    seen = {old: 0, new: 0}
    for round_number in range(rounds):
        # Half of the kills fall into the last third, where the file is written.
        share = random.random() if round_number % 2 else 0.66 + 0.4 * random.random()
        child = subprocess.Popen([program, "bake", new_mesh, "-o", output],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(share * whole)
        child.send_signal(signal.SIGKILL)
        child.wait()
        now = digest(output)
        must(now in seen, f"round {round_number}: neither the old file nor the new one")
        seen[now] += 1
        must(run(program, "info", output, "--deep").returncode == 0, "damaged after a kill")
        bake(program, old_mesh, "-o", output)  # removes what the killed one left
        stray = [path.name for path in output.parent.iterdir() if path != output]
        must(not stray, f"round {round_number}: stray files {stray}")
    # As late as it takes for the new file to be there, and no later.
    late = 1.0
    while seen[new] == 0 and late < 100:
        child = subprocess.Popen([program, "bake", new_mesh, "-o", output],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(late * whole)
        child.send_signal(signal.SIGKILL)
        child.wait()
        now = digest(output)
        must(now in seen, "killed late: neither the old file nor the new one")
        seen[now] += 1
        late *= 1.2
    print(f"{rounds} kills: {seen[old]} left the old file, {seen[new]} the new one, no strays")
    must(seen[old] > 0, "no kill came before the end")
    must(seen[new] > 0, "no kill came after the new file was there")


if __name__ == "__main__":
    main()
