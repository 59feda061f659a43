#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes crate.obj, gate.obj and ground.obj, the boxes of the sample scenes; lengths in metres.

All are closed, centred at the origin and wound outwards. Usage: make_boxes.py FOLDER
"""
import pathlib
import sys

BOXES = {"crate": (1, 1, 1), "gate": (2, 4, 3), "ground": (20, 20, 1)}
FACES = ((1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6))


def box(name, size):
    corners = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    lines = [f"# The box {name}, {size[0]} x {size[1]} x {size[2]}; metres."]
    lines += ["v " + " ".join(f"{half * side / 2:g}" for half, side in zip(corner, size))
              for corner in corners]
    lines += ["f " + " ".join(map(str, face)) for face in FACES]
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    for name, size in BOXES.items():
        (folder / f"{name}.obj").write_text(box(name, size))


if __name__ == "__main__":
    main()
