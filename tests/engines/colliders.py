# SPDX-License-Identifier: MIT
"""Colliders as `cdprep export --for json` writes them."""


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def points_of(colliders):
    """All points, in metres."""
    unit = colliders["metres_per_unit"] or 1
    return [tuple(unit * x for x in part["points"][i:i + 3]) for part in colliders["parts"]
            for i in range(0, len(part["points"]), 3)]


def moved(quaternion, translation, p):
    """A point, turned by a quaternion x, y, z, w and moved."""
    *v, w = quaternion
    turn = cross(v, [a + w * b for a, b in zip(cross(v, p), p)])
    return tuple(b + 2 * t + d for b, t, d in zip(p, turn, translation))


def lowest(colliders, quaternion, translation):
    """The z of the lowest point."""
    return min(moved(quaternion, translation, p)[2] for p in points_of(colliders))

