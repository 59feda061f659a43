#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a scene in which bodies fall into a tray and come to rest: pile.json and its meshes; metres.

Without models, the bodies are jacks: smooth stars with six arms, which hook into each other. Given
OBJ or PLY files, each body is a copy of one of them, scaled to SIZE. PLY is read as text and as
little-endian bytes.
Usage: make_pile.py FOLDER [COUNT [MODEL ...]]
Example: make_pile.py piles 5 horse.ply
"""
import math
import pathlib
import struct
import sys

from mesh_text import icosphere, obj
from scene_text import text_of

INSIDE, WALL, HEIGHT = 1.8, 0.2, 0.6  # of the tray
SIZE = 0.8  # the diagonal of the box of a body
LEVEL = 3  # of the icosphere that becomes a jack
STARTS = ((-0.42, -0.42), (0.42, -0.42), (-0.42, 0.42), (0.42, 0.42), (0, 0))
FIRST_HEIGHT, STORY = 0.4, 0.6


def jack():
    points, faces = icosphere(LEVEL)
    shaped = []
    for point in points:
        x, y, z = (c / math.hypot(*point) for c in point)
        r = 0.3 + 0.7 * (x ** 8 + y ** 8 + z ** 8)
        shaped.append((r * x, r * y, r * z))
    return shaped, faces


def tray():
    """A box without a lid, with thick walls, closed."""
    low, high = INSIDE / 2, INSIDE / 2 + WALL
    around = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    points = []
    for side, z in ((high, -WALL), (high, HEIGHT), (low, HEIGHT), (low, 0)):
        points += [(side * x, side * y, z) for x, y in around]
    faces = [(0, 3, 2, 1), (12, 13, 14, 15)]
    for ring in range(3):
        for side in range(4):
            a, b = 4 * ring + side, 4 * ring + (side + 1) % 4
            faces.append((a, b, b + 4, a + 4))
    return points, faces


def read_obj(path):
    points, faces = [], []
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append(tuple(map(float, words[1:4])))
        if words[:1] == ["f"]:
            faces.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:]))
    return points, faces


# The names of numbers in PLY, and their letters in the module struct.
PLY_LETTERS = {name: letter for letter, names in {
    "b": "char int8", "B": "uchar uint8", "h": "short int16", "H": "ushort uint16", "i": "int int32",
    "I": "uint uint32", "f": "float float32", "d": "double float64"}.items()
    for name in names.split()}


def ply_header(file, path):
    """The format, and the name, the count and the properties of each element."""
    if file.readline().strip() != b"ply":
        sys.exit(f"{path}: the first line is not 'ply'.")
    kind, elements = "", []
    for line in file:
        words = line.decode("latin-1").split()
        if words[:1] == ["format"]:
            kind = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
        elif words[:1] == ["end_header"]:
            break
    if kind not in ("ascii", "binary_little_endian"):
        sys.exit(f"{path}: found the PLY format '{kind}'; expected ascii or binary_little_endian.")
    return kind, elements


def ply_numbers(file, kind):
    """A function that reads the next number of a type."""
    if kind == "ascii":
        words = iter(file.read().split())
        return lambda letter: (float if letter in "fd" else int)(next(words))
    def read(letter):
        size = struct.calcsize("<" + letter)
        return struct.unpack("<" + letter, file.read(size))[0]
    return read


def read_ply(path):
    points, faces = [], []
    with open(path, "rb") as file:
        kind, elements = ply_header(file, path)
        read = ply_numbers(file, kind)
        for name, count, properties in elements:
            for _ in range(count):
                found = {}
                for words in properties:
                    letters = [PLY_LETTERS[word] for word in words[:-1] if word != "list"]
                    found[words[-1]] = ([read(letters[1]) for _ in range(read(letters[0]))]
                                        if words[0] == "list" else read(letters[0]))
                if name == "vertex":
                    points.append((found["x"], found["y"], found["z"]))
                if name == "face":
                    faces.append(tuple(found.get("vertex_indices", found.get("vertex_index"))))
    return points, faces


def read_mesh(path):
    return read_ply(path) if pathlib.Path(path).suffix.lower() == ".ply" else read_obj(path)


def scaled(mesh, size):
    """The mesh about the middle of its box, whose diagonal becomes `size`."""
    points, faces = mesh
    low = [min(p[axis] for p in points) for axis in range(3)]
    high = [max(p[axis] for p in points) for axis in range(3)]
    scale = size / math.dist(low, high)
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    return [tuple(scale * (c - m) for c, m in zip(p, centre)) for p in points], faces


def body(number, model):
    x, y = STARTS[number % len(STARTS)]
    z = FIRST_HEIGHT + STORY * (number // len(STARTS))
    half = 0.35 * number
    axis = [c / math.hypot(1, number, 2) for c in (1, number, 2)]
    quaternion = [math.cos(half)] + [math.sin(half) * c for c in axis]
    return {"name": f"{pathlib.Path(model).stem}{number + 1}", "model": model, "layer": "bodies",
            "pose": {"translation": [x, y, round(z, 6)],
                     "quaternion": [round(c, 9) for c in quaternion]},
            "motion": {"body": {"mass": 10, "linear_damping": 0.05, "angular_damping": 0.3}},
            "material": {"friction": 0.6}}


def scene(count, models):
    asked = {"effects": ["response", "contacts"], "contacts": {"tolerance": 0.001}, "events": []}
    objects = [{"name": "tray", "model": "tray.obj", "layer": "trays"}]
    objects += [body(number, models[number % len(models)]) for number in range(count)]
    # A scan that lies flat has hundreds of contacts. If too many are left out, it jumps.
    most = 128 if models == ["jack.obj"] else 256
    return {
        "$schema": "../../tools/scene_file/scene.schema.json",
        "cdprep_scene": 1,
        "metres_per_unit": 1,
        "duration_s": 5,
        "gravity": [0, 0, -9.81],
        "dynamics": {"most_speed": 12, "most_contacts": most},
        "layers": ["trays", "bodies"],
        "pairs": [{"layers": ["bodies", "trays"], **asked},
                  {"layers": ["bodies", "bodies"], **asked}],
        "objects": objects}


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    given = sys.argv[3:]
    meshes = {pathlib.Path(path).stem + ".obj": read_mesh(path) for path in given}
    for name, mesh in (meshes or {"jack.obj": jack()}).items():
        (folder / name).write_text(obj(f"A body of a pile, {name}", scaled(mesh, SIZE), ".5g"))
    (folder / "tray.obj").write_text(obj("A box without a lid", tray(), ".5g"))
    (folder / "pile.json").write_text(text_of(scene(count, list(meshes) or ["jack.obj"])))


if __name__ == "__main__":
    main()
