#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes sheet.obj, a square sheet of 12 x 12 squares, and loop.pc2, which bends it; lengths in metres.

The sheet lies in the plane z = 0, centred at the origin. The stream has 9 samples. In the first one
the sheet is flat. In the last one the sheet is a loop whose straight ends pass through each other.
Usage: make_sheets.py FOLDER
"""
import math
import pathlib
import struct
import sys

SQUARES, SIDE = 12, 3
SAMPLES = 9
BENT = 0.5  # the sheet is bent where |x| is at most this, and straight beyond
ANGLE = 2.0  # radians by which each end turns in the last sample


def points():
    steps = range(SQUARES + 1)
    place = lambda step: SIDE * (step / SQUARES - 0.5)
    return [(place(column), place(row), 0.0) for row in steps for column in steps]


def sheet():
    lines = [f"# A sheet, {SIDE} x {SIDE}, of {SQUARES} x {SQUARES} squares; metres."]
    lines += ["v " + " ".join(f"{x:g}" for x in point) for point in points()]
    width = SQUARES + 1
    for row in range(SQUARES):
        for column in range(SQUARES):
            a = row * width + column + 1
            lines += [f"f {a} {a + 1} {a + width}", f"f {a + 1} {a + width + 1} {a + width}"]
    return "\n".join(lines) + "\n"


def bent(x, angle):
    """The place of a point at the distance x along the sheet: an arc, then a straight end."""
    if angle == 0:
        return x, 0.0
    radius, arc, rest = BENT / angle, min(abs(x), BENT), max(abs(x) - BENT, 0)
    turn = arc / radius
    across = radius * math.sin(turn) + rest * math.cos(turn)
    return across if x >= 0 else -across, radius * (1 - math.cos(turn)) + rest * math.sin(turn)


def loop():
    rest = points()
    stream = struct.pack("<12siiffi", b"POINTCACHE2", 1, len(rest), 0, 1, SAMPLES)
    for sample in range(SAMPLES):
        for x, y, _ in rest:
            across, height = bent(x, ANGLE * sample / (SAMPLES - 1))
            stream += struct.pack("<3f", across, y, height)
    return stream


def main():
    folder = pathlib.Path(sys.argv[1])
    (folder / "sheet.obj").write_text(sheet())
    (folder / "loop.pc2").write_bytes(loop())


if __name__ == "__main__":
    main()
