#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pictures of the convex pieces of a model, to be looked at.

  pieces_pictures.py FOLDER FILE...

FILE is what 'cdprep decompose' or 'cdprep hull' wrote, an .obj with a group or an object for
each piece or a .glb with a node for each, or a .cdp.h5 baked with the pieces of its surface,
whose triangles are drawn. Each gives FOLDER/NAME_pieces.png: two views of the pieces, each in
a colour of its own, and below the same with the pieces pulled apart.

Rounded arithmetic: good enough to look at.
"""
import colorsys
import json
import pathlib
import struct
import sys

import h5py
import numpy

from structure_pictures import draw, write_png

APART = 0.6  # of a piece's way from the middle: how far it is pulled out
TURN = 0.61803398875  # of the circle of hues, from one piece to the next


class Pieces:
    """Corners of all triangles, and of which piece each is."""

    def __init__(self, corners, piece):
        self.corners = numpy.asarray(corners, float).reshape(-1, 3, 3)
        self.piece = numpy.asarray(piece, int)

    def pulled_apart(self):
        middle = (self.corners.min(axis=(0, 1)) + self.corners.max(axis=(0, 1))) / 2
        order = numpy.argsort(self.piece, kind="stable")
        _, first, counts = numpy.unique(self.piece[order], return_index=True, return_counts=True)
        sorted_corners = self.corners[order]
        low = numpy.minimum.reduceat(sorted_corners.min(axis=1), first)
        high = numpy.maximum.reduceat(sorted_corners.max(axis=1), first)
        moved = self.corners.copy()
        ways = numpy.repeat(APART * ((low + high) / 2 - middle), counts, axis=0)
        moved[order] += ways[:, None, :]
        return Pieces(moved, self.piece)

    def colours(self):
        count = self.piece.max() + 1
        # Neighbours in number are often neighbours in space: hues far from each other.
        table = [colorsys.hsv_to_rgb(i * TURN % 1, 0.45 + 0.4 * (i % 3) / 2, 0.95 - 0.2 * (i % 2))
                 for i in range(count)]
        return 255 * numpy.array(table)[self.piece]


def read_obj(path):
    vertices, corners, piece, count = [], [], [], 0
    for line in path.read_text().splitlines():
        word, _, rest = line.partition(" ")
        if word == "v":
            vertices.append([float(x) for x in rest.split()[:3]])
        elif word in ("g", "o"):
            count += 1
        elif word == "f":
            corners.append([vertices[int(i.split("/")[0]) - 1] for i in rest.split()])
            piece.append(max(0, count - 1))
    return Pieces(corners, piece)


def read_glb(path):
    data = path.read_bytes()
    length, = struct.unpack_from("<I", data, 12)
    document, binary = json.loads(data[20:20 + length]), data[28 + length:]

    def rows_of_three(number, kind):
        accessor = document["accessors"][number]
        offset = document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0)
        numbers = accessor["count"] * {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        return numpy.frombuffer(binary, kind, numbers, offset).reshape(-1, 3)

    corners, piece = [], []
    for number, node in enumerate(document["nodes"]):
        primitive = document["meshes"][node["mesh"]]["primitives"][0]
        if "indices" not in primitive:
            continue
        triangles = rows_of_three(primitive["indices"], "<u4")
        corners.append(rows_of_three(primitive["attributes"]["POSITION"], "<f4")[triangles])
        piece += [number] * len(triangles)
    return Pieces(numpy.concatenate(corners), piece)


def read_baked(path):
    with h5py.File(path) as file:
        group = file["cdprep"]
        name = "positions_f32" if "positions_f32" in group else "positions_f64"
        positions, triangles = group[name][:].astype(float), group["triangles"][:].astype(int)
        order = group["piece_triangles"][:].astype(int)
        first = group["pieces"]["first_triangle"].astype(int)
    counts = numpy.diff(first, append=len(order))
    return Pieces(positions[triangles[order]], numpy.repeat(numpy.arange(len(counts)), counts))


def read(path):
    readers = {".obj": read_obj, ".glb": read_glb, ".h5": read_baked}
    return readers[path.suffix](path)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for path in map(pathlib.Path, sys.argv[2:]):
        pieces = read(path)
        apart = pieces.pulled_apart()
        rows = [draw(shown, pieces.colours()) for shown in (pieces, apart)]
        target = folder / f"{path.name.split('.')[0]}_pieces.png"
        write_png(target, numpy.concatenate(rows))
        print(target)


if __name__ == "__main__":
    main()
