# SPDX-License-Identifier: MIT
"""The colliders of a mesh, as `cdprep export --for json` writes them, and bodies made of them."""


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u, v):
    return sum(x * y for x, y in zip(u, v))


def read_obj(path):
    """The objects of an OBJ: a name, points, and triangles that number them."""
    objects, vertices, places = [], [], {}
    for line in path.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "o" or (word == "f" and not objects):
            objects.append((rest[0] if word == "o" else path.stem, [], []))
            places = {}
        if word == "v":
            vertices.append(tuple(map(float, rest[:3])))
        if word != "f":
            continue
        _, points, triangles = objects[-1]
        corners = []
        for text in rest:
            vertex = int(text.split("/")[0]) - 1
            if vertex not in places:
                places[vertex] = len(points)
                points.append(vertices[vertex])
            corners.append(places[vertex])
        triangles += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
    return [o for o in objects if o[2]]


def volume_of(points, triangles):
    return sum(dot(points[a], cross(points[b], points[c])) for a, b, c in triangles) / 6


def mass_of(objects):
    """Volume, centre and inertia of closed surfaces, with density 1."""
    volume, first, second = 0.0, [0.0] * 3, [[0.0] * 3 for _ in range(3)]
    for _, points, triangles in objects:
        for corners in ([points[i] for i in t] for t in triangles):
            six = dot(corners[0], cross(corners[1], corners[2]))
            total = [sum(p[i] for p in corners) for i in range(3)]
            volume += six / 6
            for i in range(3):
                first[i] += six / 24 * total[i]
                for k in range(3):
                    products = sum(p[i] * p[k] for p in corners)
                    second[i][k] += six / 120 * (products + total[i] * total[k])
    centre = [x / volume for x in first]
    about = [[second[i][k] - volume * centre[i] * centre[k] for k in range(3)] for i in range(3)]
    trace = sum(about[i][i] for i in range(3))
    inertia = [[(trace if i == k else 0) - about[i][k] for k in range(3)] for i in range(3)]
    return {"volume": volume, "centre": centre, "inertia": inertia, "closed": True}


def colliders_of(mesh, pieces, metres_per_unit):
    """The colliders of a closed mesh, with the pieces that `cdprep decompose` wrote as an OBJ."""
    made = [{"name": f"{mesh.stem}_{i:02}", "points": [x for p in points for x in p],
             "triangles": [i for t in triangles for i in t],
             "volume": volume_of(points, triangles)}
            for i, (_, points, triangles) in enumerate(read_obj(pieces))]
    return {"format": "cdprep colliders", "version": 1, "name": mesh.stem,
            "metres_per_unit": metres_per_unit, "mass": mass_of(read_obj(mesh)), "pieces": made,
            "error": None}


def points_of(colliders):
    """All points, in metres."""
    unit = colliders["metres_per_unit"] or 1
    return [tuple(unit * x for x in piece["points"][i:i + 3]) for piece in colliders["pieces"]
            for i in range(0, len(piece["points"]), 3)]


def moved(quaternion, translation, p):
    """A point, turned by a quaternion x, y, z, w and moved."""
    *v, w = quaternion
    turn = cross(v, [a + w * b for a, b in zip(cross(v, p), p)])
    return tuple(b + 2 * t + d for b, t, d in zip(p, turn, translation))


def lowest(colliders, quaternion, translation):
    """The z of the lowest point."""
    return min(moved(quaternion, translation, p)[2] for p in points_of(colliders))

