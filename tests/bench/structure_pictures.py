#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pictures of what structures make of a model, to be looked at.

  structure_pictures.py CDPREP FOLDER MODEL.cdp.h5...

Each model, baked with --structures octree,tetra-tree, gives three PNG files in FOLDER:
NAME_octree.png      cells of the octree's level 3 in colours, darker where it goes deeper
NAME_layers.png      cones by their layers: 1 green, 2 yellow, 3 orange, more red, none grey
NAME_inaccessible.png  red: what nothing reaches straight towards the centre

Rounded arithmetic: good enough to look at.
"""
import json
import pathlib
import struct
import subprocess
import sys
import zlib

import h5py
import numpy

SIZE = 800  # pixels along an edge of a view
FINER = 2  # times as many are drawn and then mixed, along each edge
VIEWS = ((0.6, 0.35), (0.6 + numpy.pi, -0.6))  # turn about y, tilt
LARGE = 32  # pixels drawn: a triangle beyond is drawn on its own
SHOWN_LEVEL = 3  # cells of the octree have one colour
SHARED = 0x80000000
INNER = 0x80000000
LAYER_COLOURS = numpy.array(
    [[150, 150, 150], [90, 170, 90], [230, 200, 60], [240, 140, 40], [210, 50, 45]], float)


def write_png(path, pixels):
    """8-bit RGB, rows from the top."""
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels.astype(numpy.uint8))

    def chunk(name, data):
        body = name + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                     chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


class Model:
    def __init__(self, path):
        with h5py.File(path) as file:
            group = file["cdprep"]
            name = "positions_f32" if "positions_f32" in group else "positions_f64"
            self.positions = group[name][:].astype(float)
            self.triangles = group["triangles"][:].astype(int)
            self.source = group["source_triangle"][:].astype(int)
            self.sections = {key: group[key][:] for key in group
                             if key.startswith(("octree_", "tetra_"))}
        self.corners = self.positions[self.triangles]


def view_rotation(turn, tilt):
    c, s = numpy.cos(turn), numpy.sin(turn)
    about_y = numpy.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    c, s = numpy.cos(tilt), numpy.sin(tilt)
    return numpy.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ about_y


def draw(model, colours):
    """All views, side by side."""
    return numpy.concatenate([draw_view(model, colours, *view) for view in VIEWS], axis=1)


def draw_view(model, colours, turn, tilt):
    """Triangles in these colours, lit from the eye; the nearest point wins a pixel drawn."""
    size = FINER * SIZE
    corners = model.corners @ view_rotation(turn, tilt).T
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    scale = 0.94 * size / max(high[0] - low[0], high[1] - low[1])
    flat = (corners - (low + high) / 2) * scale + [size / 2, size / 2, 0]
    normal = numpy.cross(flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0])
    length = numpy.linalg.norm(normal, axis=1)
    light = 0.35 + 0.65 * numpy.abs(normal[:, 2]) / numpy.where(length > 0, length, 1)
    lit = colours * light[:, None]
    extent = (flat.max(axis=1) - flat.min(axis=1))[:, :2].max(axis=1)
    # So close that every pixel of a triangle has a sample of it.
    steps_of = 2 ** numpy.ceil(numpy.log2(1.5 * numpy.maximum(extent, 1))).astype(int)
    depth = numpy.full(size * size, -numpy.inf)
    samples = []
    for large in numpy.flatnonzero(steps_of > LARGE):
        pixel, z = pixels_of(flat[large], size)
        numpy.maximum.at(depth, pixel, z)
        samples.append((pixel, z, numpy.full(len(pixel), large)))
    for steps in numpy.unique(steps_of[steps_of <= LARGE]):
        chosen = numpy.flatnonzero(steps_of == steps)
        for i in range(steps + 1):
            for j in range(steps + 1 - i):
                u, v = i / steps, j / steps
                p = (flat[chosen, 0] * (1 - u - v) + flat[chosen, 1] * u + flat[chosen, 2] * v)
                x = p[:, 0].astype(int).clip(0, size - 1)
                y = (size - 1 - p[:, 1].astype(int)).clip(0, size - 1)
                pixel = y * size + x
                numpy.maximum.at(depth, pixel, p[:, 2])
                samples.append((pixel, p[:, 2], chosen))
    image = numpy.full((size * size, 3), 255.0)
    for pixel, z, chosen in samples:
        front = z >= depth[pixel]
        image[pixel[front]] = lit[chosen[front]]
    return image.reshape(SIZE, FINER, SIZE, FINER, 3).mean(axis=(1, 3))


def pixels_of(triangle, size):
    """The pixels whose middle is in a triangle, and its depth there."""
    a, b, c = triangle
    low = numpy.floor(triangle.min(axis=0)[:2]).astype(int).clip(0, size - 1)
    high = numpy.ceil(triangle.max(axis=0)[:2]).astype(int).clip(0, size)
    x, y = numpy.meshgrid(numpy.arange(low[0], high[0]), numpy.arange(low[1], high[1]))
    along, up = x.ravel() + 0.5 - a[0], y.ravel() + 0.5 - a[1]
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    if area == 0:
        return numpy.zeros(0, int), numpy.zeros(0)
    u = (along * (c[1] - a[1]) - up * (c[0] - a[0])) / area
    v = ((b[0] - a[0]) * up - (b[1] - a[1]) * along) / area
    inside = (u >= 0) & (v >= 0) & (u + v <= 1)
    pixel = (size - 1 - y.ravel()) * size + x.ravel()
    z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])
    return pixel[inside], z[inside]


def lists(nodes, references, is_leaf):
    """Of each leaf: its node and the triangles it lists."""
    for node in nodes[is_leaf]:
        first, count = int(node["first"]), int(node["count"])
        yield node, references[first:first + count] & (SHARED - 1)


def octree_colours(model):
    nodes = model.sections["octree_nodes"]
    references = model.sections["octree_references"]
    colours = numpy.full((len(model.triangles), 3), 200.0)
    for node, triangles in lists(nodes, references, nodes["count"] < INNER):
        key = int(node["key"])
        level = (key.bit_length() - 1) // 3
        above = key >> 3 * max(0, level - SHOWN_LEVEL)
        shade = numpy.random.default_rng(above).uniform(110, 255, 3)
        colours[triangles] = shade * (1 - 0.06 * max(0, level - SHOWN_LEVEL))
    return colours


def generators(key):
    levels = (int(key).bit_length() - 4) // 2
    octant = int(key) >> (2 * levels) & 7
    v = numpy.diag([-1.0 if octant >> axis & 1 else 1.0 for axis in range(3)])
    for level in range(levels - 1, -1, -1):
        a, b, c = v
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        v = numpy.array([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]][int(key) >> (2 * level) & 3])
    return v


def layer_colours(model):
    nodes = model.sections["tetra_nodes"]
    references = model.sections["tetra_references"]
    centre = numpy.array(model.sections["tetra_tree"][0]["centre"].tolist(), float).reshape(3)
    colours = numpy.full((len(model.triangles), 3), 200.0)
    relative = model.corners - centre
    for node, triangles in lists(nodes, references, (nodes["flags"] & 0x10) == 0):
        middle = generators(node["key"]).sum(axis=0)
        a, b, c = (relative[triangles, k] for k in range(3))
        sides = numpy.array([numpy.cross(a, b) @ middle, numpy.cross(b, c) @ middle,
                             numpy.cross(c, a) @ middle])
        layers = int(((sides > 0).all(axis=0) | (sides < 0).all(axis=0)).sum())
        colours[triangles] = LAYER_COLOURS[min(layers, len(LAYER_COLOURS) - 1)]
    return colours


def inaccessible_colours(model, cdprep, path):
    answer = subprocess.run([cdprep, "query", "inaccessible", path, "--format", "json"],
                            check=True, capture_output=True, text=True)
    hidden = numpy.zeros(len(model.triangles), bool)
    hidden[json.loads(answer.stdout)["inaccessible"]] = True
    return numpy.where(hidden[model.source][:, None], [220.0, 50, 47], [200.0, 200, 200])


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    cdprep, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    for path in sys.argv[3:]:
        model = Model(path)
        name = pathlib.Path(path).name.split(".")[0]
        for what, colours in (("octree", octree_colours(model)), ("layers", layer_colours(model)),
                              ("inaccessible", inaccessible_colours(model, cdprep, path))):
            target = folder / f"{name}_{what}.png"
            write_png(target, draw(model, colours))
            print(target)


if __name__ == "__main__":
    main()
