#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a kettle as an OBJ, in metres: an open pot with a wall, a bent spout and a round handle.
The three are closed surfaces and overlap. Usage: make_kettle.py FILE"""
import math
import pathlib
import sys

AROUND = 48
# Radius and height of the pot, from the middle of its base up outside, then down inside.
OUTSIDE = [(0.07, 0.0), (0.095, 0.02), (0.1, 0.05), (0.098, 0.08), (0.09, 0.11), (0.075, 0.135),
           (0.06, 0.15), (0.06, 0.165)]
INSIDE = [(0.054, 0.165), (0.054, 0.152), (0.07, 0.131), (0.084, 0.107), (0.092, 0.079),
          (0.094, 0.05), (0.089, 0.024), (0.066, 0.006)]


class Mesh:
    def __init__(self):
        self.lines, self.count = [], 0

    def ring(self, points):
        self.lines += [f"v {x:.7g} {y:.7g} {z:.7g}" for x, y, z in points]
        self.count += len(points)
        return list(range(self.count - len(points) + 1, self.count + 1))

    def face(self, *corners):
        self.lines.append("f " + " ".join(map(str, corners)))

    def join(self, low, high):
        """The strip between two rings that turn left about the way from low to high."""
        for i, a in enumerate(low):
            k = (i + 1) % len(low)
            self.face(a, low[k], high[k])
            self.face(a, high[k], high[i])

    def cap(self, ring, middle):
        """Triangles from a point to a ring that turns left, seen from outside."""
        apex, = self.ring([middle])
        for i, a in enumerate(ring):
            self.face(apex, a, ring[(i + 1) % len(ring)])


def turned(radius, z, count):
    return [(radius * math.cos(2 * math.pi * i / count), radius * math.sin(2 * math.pi * i / count),
             z) for i in range(count)]


def add_pot(mesh):
    mesh.lines.append("o pot")
    rings = [mesh.ring(turned(r, z, AROUND)) for r, z in OUTSIDE + INSIDE]
    for low, high in zip(rings, rings[1:]):
        mesh.join(low, high)
    mesh.cap(rings[0][::-1], (0, 0, OUTSIDE[0][1]))
    mesh.cap(rings[-1], (0, 0, INSIDE[-1][1]))


def add_tube(mesh, name, path, radii, count):
    """A closed tube along a path in the plane y = 0."""
    mesh.lines.append(f"o {name}")
    rings = []
    for i, (x, z) in enumerate(path):
        before, after = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        length = math.dist(before, after)
        u, w = (after[0] - before[0]) / length, (after[1] - before[1]) / length
        # Across the path: the y axis, and (-w, u) in the plane. They turn left about the path.
        ring = []
        for k in range(count):
            a = 2 * math.pi * k / count
            c, s = radii[i] * math.cos(a), radii[i] * math.sin(a)
            ring.append((x - w * c, -s, z + u * c))
        rings.append(mesh.ring(ring))
    for low, high in zip(rings, rings[1:]):
        mesh.join(low, high)
    mesh.cap(rings[0][::-1], (path[0][0], 0, path[0][1]))
    mesh.cap(rings[-1], (path[-1][0], 0, path[-1][1]))


def spout():
    steps = 10
    path = [(0.096 + 0.07 * t / steps, 0.04 + 0.1 * (t / steps) ** 2) for t in range(steps + 1)]
    return path, [0.018 - 0.009 * t / steps for t in range(steps + 1)]


def handle():
    steps = 16
    angles = [math.pi * (0.45 + 1.1 * t / steps) for t in range(steps + 1)]
    return [(-0.088 + 0.05 * math.cos(a), 0.08 + 0.045 * math.sin(a)) for a in angles], \
        [0.007] * (steps + 1)


def main():
    mesh = Mesh()
    mesh.lines.append("# A kettle; metres.")
    add_pot(mesh)
    add_tube(mesh, "spout", *spout(), 16)
    add_tube(mesh, "handle", *handle(), 12)
    pathlib.Path(sys.argv[1]).write_text("\n".join(mesh.lines) + "\n")


if __name__ == "__main__":
    main()
