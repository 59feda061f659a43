#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes organ.obj, probe.obj and probe.json: a probe moves over a soft organ that twists; metres.

The organ is an ellipsoid with smooth bumps. The probe follows a curve, now above the organ and now
inside it. Usage: make_probe.py FOLDER
"""
import math
import pathlib
import sys

from mesh_text import icosphere, obj
from scene_text import text_of

LEVEL = 4  # of the icosphere that becomes the organ: 5,120 triangles
RADII = (0.12, 0.08, 0.06)
BUMP, WAVES = 0.08, (7, 5, 6)
TIP_RADIUS, TIP_LENGTH = 0.006, 0.04
SECONDS, KEYS = 4, 40


def organ():
    points, faces = icosphere(LEVEL)
    shaped = []
    for point in points:
        x, y, z = (c / math.hypot(*point) for c in point)
        bump = 1 + BUMP * math.sin(WAVES[0] * x) * math.cos(WAVES[1] * y) * math.cos(WAVES[2] * z)
        shaped.append(tuple(bump * radius * c for radius, c in zip(RADII, (x, y, z))))
    return shaped, faces


def probe():
    """A rounded rod whose tip is at the origin, along z."""
    points, faces = icosphere(2)
    shaped = []
    for point in points:
        x, y, z = (TIP_RADIUS * c / math.hypot(*point) for c in point)
        shaped.append((x, y, z + TIP_RADIUS + (TIP_LENGTH if z > 0 else 0)))
    return shaped, faces


def key(number):
    share = number / KEYS
    x = 0.09 * math.cos(2 * math.pi * share)
    y = 0.05 * math.sin(4 * math.pi * share)
    height = RADII[2] * math.sqrt(max(1 - (x / RADII[0]) ** 2 - (y / RADII[1]) ** 2, 0))
    z = height + 0.01 * math.sin(10 * math.pi * share)
    tilt = 0.3 * math.sin(2 * math.pi * share)
    return {"time_s": round(SECONDS * share, 6),
            "pose": {"translation": [round(c, 6) for c in (x, y, z)],
                     "quaternion": [round(math.cos(tilt / 2), 9), 0, round(math.sin(tilt / 2), 9), 0]}}


def scene():
    return {
        "$schema": "../../tools/scene_file/scene.schema.json",
        "cdprep_scene": 1,
        "metres_per_unit": 1,
        "step_s": 0.02,
        "duration_s": SECONDS,
        "layers": ["organs", "probes"],
        "pairs": [{"layers": ["organs", "probes"],
                   "effects": ["haptic", "overlap", "within", "deform"], "tolerance": 0.004,
                   "max_distance": 0.1, "work": 20000}],
        "objects": [
            {"name": "organ", "model": "organ.obj", "layer": "organs",
             "motion": {"deform": {"twist": {"axis": "x", "angle_rad": 0.5, "period_s": 2}}}},
            {"name": "probe", "model": "probe.obj", "layer": "probes",
             "motion": {"path": [key(number) for number in range(KEYS + 1)]}}]}


def main():
    folder = pathlib.Path(sys.argv[1])
    (folder / "organ.obj").write_text(obj("A soft organ", organ(), ".4g"))
    (folder / "probe.obj").write_text(obj("A probe, its tip at the origin", probe(), ".4g"))
    (folder / "probe.json").write_text(text_of(scene()))


if __name__ == "__main__":
    main()
