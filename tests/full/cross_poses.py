#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Bakes models and writes poses for tests/full/cross: the pairs of the test models at some of their
poses, or sample meshes at random ones where a checkout has no test models.

Writes FOLDER/pairs.txt: a line "A B POSES" for each pair. Also FOLDER/damaged.cdp.h5, a copy of a
model with a wrong bit. Usage: cross_poses.py CDPREP FOLDER
"""
import math
import pathlib
import random
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/pipeline"))
from shared_models import place_of_shared_folder  # noqa: E402

SHARE = 12  # poses of each pair: four light, four deep, four near


def bake(program, folder, meshes):
    subprocess.run([program, "bake", "--normalize", "--output-dir", folder, *meshes], check=True,
                   stdout=subprocess.DEVNULL)


def rotation(draw):
    """Rows of the rotation of a random quaternion."""
    w, x, y, z = (draw.gauss(0, 1) for _ in range(4))
    s = 2 / (w * w + x * x + y * y + z * z)
    return [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w),
            s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w),
            s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)]


def random_poses(count):
    draw = random.Random(1)
    lines = []
    for _ in range(count):
        direction = [draw.gauss(0, 1) for _ in range(3)]
        size = draw.uniform(0.1, 1) / math.hypot(*direction)
        lines.append(" ".join(repr(x) for x in rotation(draw) + [size * x for x in direction]))
    return "\n".join(lines) + "\n"


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    shared, lines = place_of_shared_folder(), []
    if (shared / "poses").is_dir():
        names = ["horse", "skull", "bunny", "armadillo", "dragon", "buddha"]
        bake(program, folder, [shared / "models" / "seed" / f"{name}.ply" for name in names])
        for poses in sorted((shared / "poses").glob("*.pose")):
            some = "\n".join(poses.read_text().splitlines()[:SHARE]) + "\n"
            (folder / poses.name).write_text(some)
            lines.append(" ".join([*poses.stem.split("-"), poses.name]))
    else:
        meshes = sorted((ROOT / "samples/meshes").glob("*.obj"))
        bake(program, folder, meshes)
        (folder / "random.pose").write_text(random_poses(100))
        names = [mesh.stem for mesh in meshes]
        lines = [f"{a} {b} random.pose" for a in names for b in names]
    (folder / "pairs.txt").write_text("\n".join(lines) + "\n")
    damaged = bytearray((folder / f"{lines[0].split()[0]}.cdp.h5").read_bytes())
    damaged[len(damaged) // 2] ^= 0x10
    (folder / "damaged.cdp.h5").write_bytes(damaged)


if __name__ == "__main__":
    main()
