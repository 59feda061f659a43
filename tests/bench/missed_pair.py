#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws a pair of triangles that the talk's search by corners misses, from the JSON that
hashed_recall_bench wrote, as one self-contained SVG.

Two views of the same place: along the normal of B's triangle, and from its side. Grey: A's
surface near by; blue: the triangle of B; orange: its corners and the cells in which they lie (where
no triangle of A is, a cell as small as any); red: the triangle of A that it crosses, and,
dotted, the cells that list that one.

Usage: missed_pair.py MISSED.json > missed_pair.svg
"""
import json
import math
import sys

SIZE = 640
MARGIN = 24


def minus(p, q):
    return [a - b for a, b in zip(p, q)]


def dot(p, q):
    return sum(a * b for a, b in zip(p, q))


def cross(p, q):
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def unit(p):
    length = math.sqrt(dot(p, p))
    return [a / length for a in p]


def corners_of(box):
    lower, upper = box
    return [[(upper if i >> k & 1 else lower)[k] for k in range(3)] for i in range(8)]


def edges_of(box):
    corners = corners_of(box)
    return [(corners[i], corners[i | 1 << k]) for i in range(8) for k in range(3)
            if not i >> k & 1]


class View:
    """Orthographic: right and up are unit vectors; everything that matters fits."""

    def __init__(self, right, up, points, left):
        self.right, self.up, self.left = right, up, left
        flat = [(dot(p, right), dot(p, up)) for p in points]
        self.lower = [min(p[k] for p in flat) for k in range(2)]
        extent = max(max(p[k] for p in flat) - self.lower[k] for k in range(2))
        self.scale = (SIZE - 2 * MARGIN) / extent

    def at(self, p):
        x = (dot(p, self.right) - self.lower[0]) * self.scale + MARGIN + self.left
        y = SIZE - MARGIN - (dot(p, self.up) - self.lower[1]) * self.scale
        return f"{x:.1f},{y:.1f}"

    def polygon(self, triangle, style):
        return f'<polygon points="{" ".join(self.at(p) for p in triangle)}" {style}/>'

    def box(self, box, style):
        lines = []
        for p, q in edges_of(box):
            (x1, y1), (x2, y2) = self.at(p).split(","), self.at(q).split(",")
            lines.append(f'<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" {style}/>')
        return "\n".join(lines)


def draw(view, missed):
    left, right = view.left, view.left + SIZE
    clip = f"clip{left}"
    parts = [f'<clipPath id="{clip}"><rect x="{left}" y="0" width="{SIZE}" height="{SIZE}"/>'
             f'</clipPath><g clip-path="url(#{clip})">']
    for triangle in missed["surface_a"]:
        parts.append(view.polygon(triangle, 'fill="#999" fill-opacity="0.12" stroke="#888" '
                                            'stroke-width="0.4"'))
    for box in missed["listing_cells"]:
        parts.append(view.box(box, 'stroke="#c22" stroke-width="1" stroke-dasharray="1.5 3"'))
    for box in missed["corner_cells"]:
        parts.append(view.box(box, 'stroke="#e80" stroke-width="1.6"'))
    parts.append(view.polygon(missed["triangle_b"],
                              'fill="#26c" fill-opacity="0.18" stroke="#26c" stroke-width="1.6"'))
    parts.append(view.polygon(missed["triangle_a"],
                              'fill="#d22" fill-opacity="0.85" stroke="#a00" stroke-width="1.6"'))
    for p in missed["triangle_b"]:
        x, y = view.at(p).split(",")
        parts.append(f'<circle cx="{x}" cy="{y}" r="4" fill="#e80"/>')
    parts.append(f'</g><line x1="{right}" y1="0" x2="{right}" y2="{SIZE}" stroke="#ccc"/>')
    return "\n".join(parts)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        missed = json.load(file)
    b = missed["triangle_b"]
    along = unit(minus(b[1], b[0]))
    normal = unit(cross(minus(b[1], b[0]), minus(b[2], b[0])))
    points = list(b) + [p for box in missed["corner_cells"] for p in corners_of(box)]
    views = [View(along, cross(normal, along), points, 0), View(along, normal, points, SIZE)]
    first, second = missed["pair"].split("-")
    text = (f"Triangle {missed['b']} of {second} (blue) crosses triangle {missed['a']} of {first} "
            "(red); no cell of its corners (orange) lists that.")
    print(f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * SIZE}" height="{SIZE + 40}" '
          f'viewBox="0 0 {2 * SIZE} {SIZE + 40}">')
    print('<rect width="100%" height="100%" fill="#fff"/>')
    for view in views:
        print(draw(view, missed))
    print(f'<text x="{MARGIN}" y="{SIZE + 16}" font-family="sans-serif" font-size="14">{text}</text>')
    print(f'<text x="{MARGIN}" y="{SIZE + 34}" font-family="sans-serif" font-size="12" '
          'fill="#555">Left: along the normal of the blue triangle. Right: along its plane. Grey: '
          'the surface near by. Dotted: cells that list the red triangle.</text>')
    print("</svg>")


main()
