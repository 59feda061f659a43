#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""SIGINT and SIGTERM end every command within 0.2 s, whatever it is at.

Each command works on a mesh that keeps it busy for a second or more, and gets a signal at
several moments of its first three seconds, twice as many with CDPREP_ALL_POSES=yes. It must end
with 130, leave nothing behind, and say one sentence at most. A busy machine may delay a process: a
moment that fails is tried again, and must fail every time to count.
Files are in memory where there is room: no process ends while the system syncs them to a busy disk.
A program that is slower by a factor, as one under a sanitizer, may take longer: CDPREP_SLOWDOWN=10.
Usage: interrupts.py CDPREP
"""
import array
import contextlib
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from shared_models import SLOWDOWN, must

SECONDS = 0.2 * SLOWDOWN
MOMENTS = 4 if os.environ.get("CDPREP_ALL_POSES") == "yes" else 2
TRIES = 5
LONGEST = 3  # seconds of a command in which it is stopped


def write_sheet(path, side):
    """A wavy sheet of 2 * (side - 1)^2 triangles."""
    corners, triangles = array.array("f"), bytearray()
    waves = [math.sin(i / 10) for i in range(side)]
    for i in range(side):
        for j in range(side):
            corners.extend((i, j, 5 * waves[i] * waves[j]))
    for i in range(side - 1):
        for j in range(side - 1):
            a = i * side + j
            triangles += b"\3" + array.array("I", (a, a + side, a + 1)).tobytes()
            triangles += b"\3" + array.array("I", (a + 1, a + side, a + side + 1)).tobytes()
    write_ply(path, corners, triangles, 2 * (side - 1) ** 2)


def write_double_cone(path, count):
    corners, triangles = array.array("f", (0, 0, 1, 0, 0, -1)), bytearray()
    for i in range(count):
        angle = 2 * math.pi * i / count
        corners.extend((math.cos(angle), math.sin(angle), 0))
        a, b = 2 + i, 2 + (i + 1) % count
        triangles += b"\3" + array.array("I", (0, a, b)).tobytes()
        triangles += b"\3" + array.array("I", (1, b, a)).tobytes()
    write_ply(path, corners, triangles, 2 * count)


def write_flat(path, count):
    """Triangles in one plane, each over every other."""
    corners, triangles = array.array("f"), bytearray()
    for i in range(count):
        x, y = i / count / 8, i / count / 32
        corners.extend((x, y, 0, x + 1, y, 0, x, y + 1, 0))
        triangles += b"\3" + array.array("I", (3 * i, 3 * i + 1, 3 * i + 2)).tobytes()
    write_ply(path, corners, triangles, count)


def write_ply(path, corners, triangles, count):
    with open(path, "wb") as file:
        file.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\n"
                   b"property float x\nproperty float y\nproperty float z\nelement face %d\n"
                   b"property list uchar uint vertex_indices\nend_header\n"
                   % (len(corners) // 3, count))
        corners.tofile(file)
        file.write(triangles)


def write_scene(path, model, deform=None):
    """Two objects of a model, which never meet: one turns beside the other."""
    motion = {"turn_rad_per_s": [0, 0, 1], **({"deform": deform} if deform else {})}
    path.write_text(json.dumps({
        "cdprep_scene": 1, "layers": ["a"],
        "pairs": [{"layers": ["a", "a"],
                   "effects": ["collide", "distance", *(["deform"] if deform else [])]}],
        "objects": [{"name": "still", "model": model, "layer": "a"},
                    {"name": "turning", "model": model, "layer": "a",
                     "pose": {"translation": [3000, 0, 0]},
                     "motion": motion}]}))


class Commands:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def start(self, arguments, out):
        return subprocess.Popen([self.program, *arguments], cwd=self.folder, stdout=out,
                                stderr=subprocess.PIPE)

    def stop(self, arguments, moment, number):
        """Seconds from the start to the end, and from the signal to the end: None when there was
        no signal any more."""
        kept = set(os.listdir(self.folder))
        with tempfile.TemporaryFile() as out:
            begun = time.monotonic()
            process = self.start(arguments, out)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(moment)
                ended = time.monotonic() - begun
                process.communicate()
                return ended, None
            sent = time.monotonic()
            process.send_signal(number)
            _, errors = process.communicate(timeout=60)
            ended = time.monotonic()
            out.seek(0)
            text = out.read()
        if process.returncode == 0:  # the signal came at the very end
            return ended - begun, None
        name = " ".join(arguments)
        must(process.returncode == 130, f"{name} at {moment:.2f} s: {process.returncode}: {errors}")
        is_report = arguments[0] == "validate"
        # A report says so itself, and what was just done needs no excuse.
        must(errors.count(b"\n") <= 1 and (b"stopped" in errors or not errors),
             f"{name} at {moment:.2f} s says {errors}")
        left = set(os.listdir(self.folder)) - kept - {"out.h5", "out.ply", "out.obj"}
        must(not left, f"{name} at {moment:.2f} s leaves {left}")
        if is_report:
            report = json.loads(text)
            must(report["summary"]["interrupted"] is True and report["exit"] == 130,
                 f"{name} at {moment:.2f} s: {report['summary']}")
        return ended - begun, ended - sent

    def check(self, *arguments):
        def stop(number, full):
            return self.stop(arguments, full * (number + 0.5) / MOMENTS,
                             (signal.SIGTERM, signal.SIGINT)[number % 2])

        # The last moment of a long command comes first: a short one then says how long it takes.
        last = MOMENTS - 1
        lasted, seconds = stop(last, LONGEST)
        full = lasted if seconds is None else LONGEST
        known = {} if seconds is None else {last: [seconds]}
        worst, stopped = 0, 0
        for number in range(MOMENTS):
            times = known.get(number, [])
            while len(times) < TRIES and (not times or min(times) > SECONDS):
                _, seconds = stop(number, full)
                if seconds is None:
                    break
                times.append(seconds)
            if times:
                stopped += 1
                worst = max(worst, min(times))
        name = " ".join(arguments)
        print(f"{name:75} {full:6.2f} s, stopped in {worst:5.3f} s at most", flush=True)
        must(worst <= SECONDS, f"{name} takes {worst:.2f} s to stop")
        must(2 * stopped >= MOMENTS, f"{name} ends too soon to be stopped")


def folder_in_memory():
    """A folder whose files no disk holds, or None."""
    folder, needed = "/dev/shm", 1 << 30
    is_there = os.path.isdir(folder) and os.access(folder, os.W_OK)
    return folder if is_there and shutil.disk_usage(folder).free > needed else None


def main():
    with tempfile.TemporaryDirectory(dir=folder_in_memory()) as scratch:
        folder = pathlib.Path(scratch)
        commands = Commands(sys.argv[1], folder)
        write_sheet(folder / "sheet.ply", 700)
        write_double_cone(folder / "cone.ply", 200_000)
        write_flat(folder / "flat.ply", 20_000)
        for mesh in ("sheet.ply", "cone.ply"):
            done = subprocess.run([commands.program, "bake", mesh], cwd=folder, check=False,
                                  capture_output=True)
            must(done.returncode == 0, f"bake: {done}")
        for mesh in ("sheet.ply", "cone.ply", "flat.ply"):
            commands.check("validate", mesh, "--format", "json", "--max-pairs", "50000000")
            commands.check("bake", mesh, "-o", "out.h5")
            commands.check("repair", mesh, "-o", "out.ply", "--preset", "closed")
        commands.check("repair", "flat.ply", "-o", "out.ply", "--preset", "solid")
        commands.check("bake", "sheet.ply", "-o", "out.h5", "--effects", "all")
        commands.check("hull", "cone.ply", "-o", "out.obj")
        commands.check("hull", "cone.ply", "-o", "out.obj", "--max-vertices", "64")
        commands.check("decompose", "sheet.ply", "-o", "out.obj")
        commands.check("decompose", "sheet.ply", "-o", "out.obj", "--max-error", "1")
        commands.check("bake", "sheet.ply", "-o", "out.h5", "--structures", "hull",
                       "--max-error", "1")
        commands.check("info", "--deep", "sheet.cdp.h5")
        commands.check("reindex", "sheet.cdp.h5")
        commands.check("query", "overlap", "sheet.cdp.h5", "sheet.cdp.h5", "--count")
        write_scene(folder / "frames.json", "cone.cdp.h5")
        commands.check("simulate", "frames.json", "--frames", "1000000000")
        write_scene(folder / "twist.json", "cone.cdp.h5",
                    {"twist": {"axis": "z", "angle_rad": 1, "period_s": 1}})
        commands.check("simulate", "twist.json", "--frames", "1000000000")
        write_scene(folder / "bake.json", "sheet.ply")
        commands.check("simulate", "bake.json", "--frames", "1")
        commands.check("accuracy", "sheet.cdp.h5", "sheet.cdp.h5", "--quick")
        commands.check("compare", "sheet.ply", "--quick")


if __name__ == "__main__":
    main()
