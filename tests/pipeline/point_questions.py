#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""inside, closest and ray through the program, against answers known by hand.

Usage: point_questions.py CDPREP
"""
import math
import pathlib
import sys
import tempfile

from known_meshes import CUBE
from shared_models import answers, bake, must, run


def box_distance(p):
    """To the surface of [0, 2]^3, from inside or outside."""
    outside = math.sqrt(sum(max(0 - x, 0, x - 2) ** 2 for x in p))
    return outside if outside > 0 else min(min(x, 2 - x) for x in p)


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    (folder / "cube.off").write_text(CUBE)
    (folder / "open.off").write_text(CUBE.replace("8 6 0", "8 5 0").replace("4 3 0 4 7\n", ""))
    for name in ("cube", "open"):
        bake(program, folder / f"{name}.off", "-o", folder / name, "--effects", "all")

    steps = (-1, -0.5, 0, 0.5, 1, 2, 2.5)
    points = [(x, y, z) for x in steps for y in steps for z in steps]
    (folder / "points").write_text("# x y z\n\n" + "".join(f"{x} {y} {z}\n" for x, y, z in points))

    inside = answers(program, "inside", folder / "cube", "--points", folder / "points")
    must(len(inside) == len(points), f"{len(inside)} answers to {len(points)} points")
    for number, (point, answer) in enumerate(zip(points, inside)):
        within = all(0 <= x <= 2 for x in point)
        must(answer["point"] == number and answer["inside"] == ("yes" if within else "no"),
             f"{point}: {answer}")
    unsure = answers(program, "inside", folder / "open", "--points", folder / "points")
    must({answer["inside"] for answer in unsure} == {"yes", "no", "unknown"},
         "an open cube guesses")

    closest = answers(program, "closest", folder / "cube", "--points", folder / "points")
    for point, answer in zip(points, closest):
        distance = box_distance(point)
        must(answer["lower"] <= distance <= answer["upper"] or
             math.isclose(answer["upper"], distance, rel_tol=1e-15), f"{point}: {answer}")
        # point_triangle_distance.h: 200 u of the farthest corner's distance at most.
        farthest = max(math.dist(point, (x, y, z)) for x in (0, 2) for y in (0, 2) for z in (0, 2))
        must(answer["upper"] - answer["lower"] <= 200 * 2**-53 * farthest,
             f"{point}: a wide interval {answer}")
        must(math.isclose(math.dist(point, answer["at"]), distance, abs_tol=1e-14),
             f"{point}: {answer}")

    rays = [((1, 0.5, 9), (0, 0, -1), 7), ((1, 0.5, 9), (0, 0, -2), 3.5),
            ((1, 0.5, 1), (0, 0, -1), 1), ((-3, 0, 0), (1, 0, 0), 3), ((-1, -1, -1), (1, 1, 1), 1),
            ((1, 0.5, 9), (0, 0, 1), None), ((3, 3, 9), (0, 0, -1), None)]
    (folder / "rays").write_text(
        "".join(" ".join(map(str, origin + direction)) + "\n" for origin, direction, _ in rays))
    for (origin, direction, t), answer in zip(
            rays, answers(program, "ray", folder / "cube", "--rays", folder / "rays")):
        must(answer["hit"] == (t is not None) and answer.get("t") == t,
             f"{origin} {direction}: {answer}")

    for content, word in (("1 2\n", "line 1"), ("1 2 3\n1 x 3\n", "line 2"),
                          ("1 2 nan\n", "nan"), ("1 2 3 4\n", "4 numbers")):
        (folder / "bad").write_text(content)
        done = run(program, "query", "inside", folder / "cube", "--points", folder / "bad")
        must(done.returncode == 3 and word in done.stderr and "bad" in done.stderr,
             f"{content!r}: exit {done.returncode}, {done.stderr}")
    (folder / "bad").write_text("0 0 0 0 0 0\n")
    done = run(program, "query", "ray", folder / "cube", "--rays", folder / "bad")
    must(done.returncode == 3 and "line 1" in done.stderr, f"a ray without direction: {done}")
    # JSON has no infinity: such a member is left out. Points may lie beyond the coordinates of models.
    (folder / "far").write_text("1.7e308 1.7e308 1.7e308\n")
    far, = answers(program, "closest", folder / "cube", "--points", folder / "far")
    must(far["lower"] > 1.7e308 and "upper" not in far and far["triangle"] >= 0, f"{far}")
    (folder / "far rays").write_text("0.5 0.5 -1.7e308 0 0 1e-300\n")
    far, = answers(program, "ray", folder / "cube", "--rays", folder / "far rays")
    must(far["hit"] and "t" not in far and far["at"][2] == 0, f"{far}")
    print(f"{len(points)} points, {len(rays)} rays")


main()
