#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes dominoes.gltf: a ball rolls into a row of dominoes, and the last one falls into a trigger.

The file has the extension KHR_physics_rigid_bodies; metres, y up. Its buffer is in the text.
Usage: make_dominoes.py FOLDER
"""
import base64
import itertools
import json
import math
import pathlib
import struct
import sys

from mesh_text import icosphere

EXTENSION = "KHR_physics_rigid_bodies"
COUNT = 8
SIZE, GAP = (0.1, 1.0, 0.5), 0.45  # of a domino, and between two of them; x runs along the row
RADIUS, SPEED = 0.3, 2.5  # of the ball
FLOOR = (8.0, 0.2, 3.0)


def box(size):
    points = [tuple(s * half / 2 for s, half in zip(signs, size))
              for signs in itertools.product((-1, 1), repeat=3)]
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return points, [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]


def ball():
    points, faces = icosphere(2)
    return [tuple(RADIUS * c / math.hypot(*point) for c in point) for point in points], faces


def buffer_of(meshes):
    """The bytes of all meshes, and the members of the document that describe them."""
    data, views, accessors, described = b"", [], [], []
    for name, (points, faces) in meshes:
        indices = [index for face in faces for index in face]
        for packed, kind, form, count, bounds in (
                (struct.pack(f"<{3 * len(points)}f", *(c for p in points for c in p)), 5126, "VEC3",
                 len(points), {"min": [min(c) for c in zip(*points)],
                               "max": [max(c) for c in zip(*points)]}),
                (struct.pack(f"<{len(indices)}H", *indices), 5123, "SCALAR", len(indices), {})):
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
            accessors.append({"bufferView": len(views) - 1, "componentType": kind, "type": form,
                              "count": count, **bounds})
            data += packed + b"\0" * (-len(packed) % 4)
        described.append({"name": name, "primitives": [
            {"attributes": {"POSITION": len(accessors) - 2}, "indices": len(accessors) - 1}]})
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return {"buffers": [{"byteLength": len(data), "uri": uri}], "bufferViews": views,
            "accessors": accessors, "meshes": described}


def node(name, mesh, x, y, **physics):
    return {"name": name, "mesh": mesh, "translation": [round(x, 3), round(y, 3), 0],
            "extensions": {EXTENSION: physics}}


def nodes():
    surface = lambda mesh: {"geometry": {"mesh": mesh}, "physicsMaterial": 0, "collisionFilter": 0}
    places = [GAP * i for i in range(COUNT)]
    all_nodes = [node("floor", 0, 1.5, -FLOOR[1] / 2, collider=surface(0))]
    all_nodes += [node(f"domino {i}", 1, x, SIZE[1] / 2, collider=surface(1), motion={"mass": 1})
                  for i, x in enumerate(places)]
    all_nodes.append(node("ball", 2, -1.2, RADIUS, collider=surface(2),
                          motion={"mass": 3, "linearVelocity": [SPEED, 0, 0],
                                  "angularVelocity": [0, 0, -SPEED / RADIUS]}))
    all_nodes.append(node("end", 3, places[-1] + 0.7, 0.2,
                          trigger={"geometry": {"mesh": 3}, "collisionFilter": 1}))
    return all_nodes


def document():
    content = {"asset": {"version": "2.0"}, "extensionsUsed": [EXTENSION],
               "extensions": {EXTENSION: {
                   "physicsMaterials": [{"staticFriction": 0.5, "dynamicFriction": 0.5,
                                         "restitution": 0}],
                   "collisionFilters": [
                       {"collisionSystems": ["solid"]},
                       {"collisionSystems": ["sensor"], "collideWithSystems": ["solid"]}]}}}
    content.update(buffer_of([("floor", box(FLOOR)), ("domino", box(SIZE)), ("ball", ball()),
                              ("end", box((0.4, 0.3, 1.0)))]))
    content["nodes"] = nodes()
    content["scenes"] = [{"nodes": list(range(len(content["nodes"])))}]
    return content


def main():
    path = pathlib.Path(sys.argv[1]) / "dominoes.gltf"
    path.write_text(json.dumps(document(), indent=1) + "\n")


if __name__ == "__main__":
    main()
