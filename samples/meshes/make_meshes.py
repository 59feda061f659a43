#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes bracket.obj and bolt.obj, the sample meshes; lengths in millimetres.

Both are closed, 2-manifold and wound outwards. Usage: make_meshes.py FOLDER
"""
import math
import pathlib
import sys


class Mesh:
    def __init__(self):
        self.vertices, self.groups = [], []

    def vertex(self, x, y, z):
        self.vertices.append((x, y, z))
        return len(self.vertices)

    def group(self, name):
        self.groups.append((name, []))

    def face(self, *corners):
        self.groups[-1][1].append(corners)

    def write(self, path, title):
        lines = [f"# {title}"]
        lines += [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in self.vertices]
        for name, faces in self.groups:
            lines.append(f"g {name}")
            lines += ["f " + " ".join(map(str, face)) for face in faces]
        path.write_text("\n".join(lines) + "\n")


def circle(mesh, cx, cy, radius, z, count, start):
    """Vertices counter-clockwise seen from above, the first at angle `start`."""
    step = 2 * math.pi / count
    return [mesh.vertex(cx + radius * math.cos(start + i * step),
                        cy + radius * math.sin(start + i * step), z) for i in range(count)]


def ring(mesh, outer, inner, up):
    """Fills between a polygon and a finer one inside it; both start at one angle."""
    per = len(inner) // len(outer)
    for q, corner in enumerate(outer):
        following = outer[(q + 1) % len(outer)]
        # The corner sees the inner points half a sector to either side.
        for k in range(-per // 2, per // 2):
            a, b = inner[(q * per + k) % len(inner)], inner[(q * per + k + 1) % len(inner)]
            mesh.face(*((corner, b, a) if up else (corner, a, b)))
        middle = inner[(q * per + per // 2) % len(inner)]
        mesh.face(*((corner, following, middle) if up else (following, corner, middle)))


def wall(mesh, lower, upper, outward):
    for i, a in enumerate(lower):
        j = (i + 1) % len(lower)
        b, c, d = lower[j], upper[j], upper[i]
        mesh.face(*((a, b, c, d) if outward else (d, c, b, a)))


def bracket():
    """An L profile, 40 x 30 x 40 and 6 thick, with a hole of radius 7 in its foot."""
    m = Mesh()
    at = {}
    for y in (0, 30):
        for x, z in ((0, 0), (40, 0), (40, 6), (6, 6), (6, 40), (0, 40)):
            at[x, y, z] = m.vertex(x, y, z)
    low = circle(m, 23, 15, 7, 0, 48, -3 * math.pi / 4)
    high = circle(m, 23, 15, 7, 6, 48, -3 * math.pi / 4)
    m.group("foot")
    ring(m, [at[0, 0, 0], at[40, 0, 0], at[40, 30, 0], at[0, 30, 0]], low, up=False)
    ring(m, [at[6, 0, 6], at[40, 0, 6], at[40, 30, 6], at[6, 30, 6]], high, up=True)
    m.face(at[40, 0, 0], at[40, 30, 0], at[40, 30, 6], at[40, 0, 6])
    m.group("hole")
    wall(m, low, high, outward=False)
    m.group("upright")
    m.face(at[6, 0, 6], at[6, 30, 6], at[6, 30, 40], at[6, 0, 40])
    m.face(at[6, 0, 40], at[6, 30, 40], at[0, 30, 40], at[0, 0, 40])
    m.face(at[0, 0, 0], at[0, 0, 40], at[0, 30, 40], at[0, 30, 0])
    m.group("sides")
    profile = ((0, 0), (40, 0), (40, 6), (6, 6), (6, 40), (0, 40))
    m.face(*(at[x, 0, z] for x, z in profile))
    m.face(*(at[x, 30, z] for x, z in reversed(profile)))
    return m


def bolt():
    """A hexagon head of circumradius 10 on a shank of radius 6, 26 long."""
    m = Mesh()
    tip = circle(m, 0, 0, 6, 0, 48, 0)
    neck = circle(m, 0, 0, 6, 26, 48, 0)
    head_low = circle(m, 0, 0, 10, 26, 6, 0)
    head_high = circle(m, 0, 0, 10, 34, 6, 0)
    m.group("shank")
    m.face(*reversed(tip))
    wall(m, tip, neck, outward=True)
    m.group("head")
    ring(m, head_low, neck, up=False)
    wall(m, head_low, head_high, outward=True)
    m.face(*head_high)
    return m


def main():
    folder = pathlib.Path(sys.argv[1])
    bracket().write(folder / "bracket.obj", "An angle bracket with one hole; millimetres.")
    bolt().write(folder / "bolt.obj", "A hexagon bolt; millimetres.")


if __name__ == "__main__":
    main()
