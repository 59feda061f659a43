# SPDX-License-Identifier: MIT
"""Meshes that scripts write: a sphere of triangles, and the text of OBJ files."""
import math


def icosphere(level):
    golden = (1 + math.sqrt(5)) / 2
    points = [(x, y * golden, 0.0) for y in (1, -1) for x in (-1, 1)]
    points += [(0.0, x, y * golden) for y in (1, -1) for x in (-1, 1)]
    points += [(x * golden, 0.0, y) for x in (1, -1) for y in (-1, 1)]
    faces = hull_faces(points)
    for _ in range(level):
        middles, finer = {}, []
        for a, b, c in faces:
            ab, bc, ca = (middle(points, middles, *edge) for edge in ((a, b), (b, c), (c, a)))
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    return points, faces


def hull_faces(points):
    """The faces of the icosahedron: its twenty nearest triples, wound outwards."""
    edge = min(math.dist(points[0], p) for p in points[1:]) * 1.01
    near = lambda i, j: math.dist(points[i], points[j]) < edge
    faces = []
    count = len(points)
    for a in range(count):
        for b in range(a + 1, count):
            for c in range(b + 1, count):
                if near(a, b) and near(b, c) and near(c, a):
                    faces.append((a, b, c) if determinant(*(points[i] for i in (a, b, c))) > 0
                                 else (a, c, b))
    return faces


def determinant(a, b, c):
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))


def middle(points, middles, a, b):
    key = (min(a, b), max(a, b))
    if key not in middles:
        middles[key] = len(points)
        points.append(tuple((p + q) / 2 for p, q in zip(points[a], points[b])))
    return middles[key]


def obj(name, mesh, form, unit="metres"):
    """The text of a file. `form` is that of a coordinate, as for format(): ".5g"."""
    points, faces = mesh
    lines = [f"# {name}; {unit}."]
    lines += ["v " + " ".join(format(c, form) for c in point) for point in points]
    lines += ["f " + " ".join(str(index + 1) for index in face) for face in faces]
    return "\n".join(lines) + "\n"
