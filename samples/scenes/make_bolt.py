#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes bolt.obj, plate.obj and bolt.json: a bolt that a hand screws into a plate; in millimetres.

Both threads are r = RADIUS + DEPTH / 2 * cos(2 pi z / PITCH - angle), the hole wider by CLEARANCE.
The bolt turns by an angle about z and moves by PITCH * angle / (2 pi) along z. The hand shakes: it
shifts the bolt by up to SHAKE along x and y, and tilts it by up to TILT. Usage: make_bolt.py FOLDER
"""
import math
import pathlib
import sys

from mesh_text import obj
from scene_text import text_of

RADIUS, DEPTH, PITCH, CLEARANCE = 10, 2, 4, 0.5
COLUMNS = 40  # about the axis
ROWS_PER_PITCH = 8
BOLT_LENGTH, HEAD_RADIUS, HEAD_HEIGHT = 24, 16, 6
PLATE_SIDE, PLATE_HEIGHT = 44, 12
TURNS, KEYS_PER_TURN, SECONDS_PER_TURN = 5, 8, 0.8
SHAKE, TILT = 0.1, 0.004


def thread(clearance, low, high):
    """Rings of points of a thread, from below."""
    count = round((high - low) / PITCH * ROWS_PER_PITCH)
    rings = []
    for row in range(count + 1):
        z = low + (high - low) * row / count
        ring = []
        for column in range(COLUMNS):
            angle = 2 * math.pi * column / COLUMNS
            r = RADIUS + clearance + DEPTH / 2 * math.cos(2 * math.pi * z / PITCH - angle)
            ring.append((r * math.cos(angle), r * math.sin(angle), z))
        rings.append(ring)
    return rings


def circle(radius, z):
    angles = [2 * math.pi * column / COLUMNS for column in range(COLUMNS)]
    return [(radius * math.cos(a), radius * math.sin(a), z) for a in angles]


def square(half, z):
    """Points on the edge of a square, one in the direction of each column."""
    ring = []
    for x, y, _ in circle(1, 0):
        scale = half / max(abs(x), abs(y))
        ring.append((x * scale, y * scale, z))
    return ring


def mesh(rings, name, closes):
    """A tube through rings. It is closed by the middles of its ends, or by the first ring."""
    points = [point for ring in rings for point in ring]
    faces = []
    count = len(rings)
    for row in range(count if closes == "ring" else count - 1):
        for column in range(COLUMNS):
            near, far = row * COLUMNS, (row + 1) % count * COLUMNS
            after = (column + 1) % COLUMNS
            faces.append((near + column, near + after, far + after))
            faces.append((near + column, far + after, far + column))
    if closes == "middles":
        for row, order in ((0, -1), (count - 1, 1)):
            points.append((0, 0, rings[row][0][2]))
            for column in range(COLUMNS):
                edge = [row * COLUMNS + column, row * COLUMNS + (column + 1) % COLUMNS][::order]
                faces.append((len(points) - 1, *edge))
    return obj(name, (points, faces), ".4f", "millimetres")


def bolt():
    rings = thread(0, 0, BOLT_LENGTH)
    rings += [circle(HEAD_RADIUS, BOLT_LENGTH), circle(HEAD_RADIUS, BOLT_LENGTH + HEAD_HEIGHT)]
    return mesh(rings, "A bolt with a thread", "middles")


def plate():
    half = PLATE_SIDE / 2
    outside = [square(half, 0), square(half, PLATE_HEIGHT)]
    return mesh(outside + thread(CLEARANCE, 0, PLATE_HEIGHT)[::-1], "A plate with a threaded hole",
                "ring")


def key(number):
    """The pose after some turns, of which the last ends the motion."""
    turns = number / KEYS_PER_TURN
    angle = -2 * math.pi * turns
    z = PITCH * (TURNS - turns)
    x, y = SHAKE * math.sin(1.7 * number), SHAKE * math.sin(2.3 * number)
    about_x, about_y = TILT / 2 * math.sin(1.1 * number), TILT / 2 * math.sin(0.7 * number)
    w, k = math.cos(angle / 2), math.sin(angle / 2)
    # The product of the tilt 1 + about_x i + about_y j and the turn w + k k.
    quaternion = [w, about_x * w + about_y * k, about_y * w - about_x * k, k]
    return {"time_s": round(turns * SECONDS_PER_TURN, 6),
            "pose": {"translation": [round(c, 6) for c in (x, y, z)],
                     "quaternion": [round(c, 9) for c in quaternion]}}


def scene():
    keys = [key(number) for number in range(TURNS * KEYS_PER_TURN + 1)]
    start = PITCH * TURNS
    keys[0]["pose"] = {"translation": [0, 0, start]}
    return {
        "$schema": "../../tools/scene_file/scene.schema.json",
        "cdprep_scene": 1,
        "metres_per_unit": 0.001,
        "step_s": 0.05,
        "duration_s": keys[-1]["time_s"],
        "layers": ["bolts", "plates"],
        "pairs": [{"layers": ["bolts", "plates"], "effects": ["overlap", "distance", "within"],
                   "tolerance": 0.3, "max_distance": 20}],
        "objects": [
            {"name": "plate", "model": "plate.obj", "layer": "plates"},
            {"name": "bolt", "model": "bolt.obj", "layer": "bolts", "motion": {"path": keys}}]}


def main():
    folder = pathlib.Path(sys.argv[1])
    (folder / "bolt.obj").write_text(bolt())
    (folder / "plate.obj").write_text(plate())
    (folder / "bolt.json").write_text(text_of(scene()))


if __name__ == "__main__":
    main()
