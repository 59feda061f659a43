#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What a tetra-tree alone answers: inaccessible parts and levels of detail, and what is
exported in colours.

Usage: cones.py CDPREP
"""
import json
import pathlib
import sys
import tempfile

from known_meshes import CUBE
from shared_models import answers, bake, must, run


def off_lines(text):
    return [line for line in text.splitlines() if line]


def nested_cubes():
    """[0, 2]^3 around the cube of half its size about the same centre: faces 0 to 5 and 6
    to 11."""
    lines = off_lines(CUBE)
    outer = [[float(x) for x in line.split()] for line in lines[2:10]]
    inner = [[0.5 + x / 2 for x in p] for p in outer]
    faces = [[int(i) for i in line.split()[1:]] for line in lines[10:16]]
    text = "OFF\n16 12 0\n"
    text += "".join(f"{x} {y} {z}\n" for x, y, z in outer + inner)
    for shift in (0, 8):
        text += "".join("4 " + " ".join(str(i + shift) for i in face) + "\n" for face in faces)
    return text


def ply_face_colours(path, vertices, faces):
    """Of a binary PLY with triangles of single precision."""
    data = path.read_bytes()
    body = data.index(b"end_header\n") + len(b"end_header\n") + 12 * vertices
    return [tuple(data[body + 16 * i + 13:body + 16 * i + 16]) for i in range(faces)]


def inaccessible(program, folder):
    (folder / "nested.off").write_text(nested_cubes())
    bake(program, folder / "nested.off", "-o", folder / "nested", "--effects", "inaccessible")
    done = run(program, "query", "inaccessible", folder / "nested", "--format", "json",
               "--export", folder / "nested.ply")
    must(done.returncode == 0, done.stderr)
    must(json.loads(done.stdout) == {"count": 12, "edge_on": 0, "triangles": 24,
                                     "inaccessible": list(range(12, 24))}, done.stdout)
    colours = ply_face_colours(folder / "nested.ply", 16, 24)
    must(sorted(map(colours.count, set(colours))) == [12, 12], f"colours {colours}")
    counted = run(program, "query", "inaccessible", folder / "nested", "--count")
    must(counted.stdout == "12 of 24 triangles are occluded along every ray to the tetra-tree's "
                           "centre.\n", counted.stdout)
    obj = run(program, "query", "inaccessible", folder / "nested", "--count", "--export",
              folder / "nested.obj")
    must(obj.returncode == 0 and (folder / "nested.mtl").is_file(), obj.stderr)

    bake(program, folder / "nested.off", "-o", folder / "bare")
    without = run(program, "query", "inaccessible", folder / "bare")
    must(without.returncode == 2 and "--effects inaccessible" in without.stderr, without.stderr)
    stl = run(program, "query", "inaccessible", folder / "nested", "--export", folder / "x.stl")
    must(stl.returncode == 2 and not (folder / "x.stl").exists(), stl.stderr)


def levels_of_detail(program, folder):
    (folder / "cube.off").write_text(CUBE)
    bake(program, folder / "cube.off", "-o", folder / "cube", "--structures", "tetra-tree",
         "--tetra-level", "4", "--tetra-threshold", "1")

    def coarse(level, gap):
        answer, = answers(program, "collide", folder / "cube", folder / "cube", "--structure",
                          "tetra-tree", "--level-of-detail", level,
                          "--pose", f"1 0 0 0 1 0 0 0 1 {gap} 0.1 0.2")
        must(answer["approximate"] and answer["error_a"] == answer["error_b"], f"{answer}")
        return answer["answer"], answer["error_a"]

    # A face seen from the centre is 1 away, its corners sqrt(3): by the octants' normals
    # from 1 / sqrt(3) to sqrt(3), and a ray is sqrt(3) longer at most.
    must(abs(coarse(0, 9)[1] - 2) < 1e-5, f"error {coarse(0, 9)[1]}")
    must(coarse(3, 9)[1] < coarse(1, 9)[1] < coarse(0, 9)[1], "errors do not fall")
    must(coarse(0, 9)[0] == "no" and coarse(0, 0.1)[0] == "yes" and coarse(3, 2.3)[0] != "yes"
         and coarse(3, 1.9)[0] != "no", "coarse answers contradict")
    refused = run(program, "query", "collide", folder / "cube", folder / "cube",
                  "--level-of-detail", "2")
    must(refused.returncode == 2 and "tetra-tree" in refused.stderr, refused.stderr)


def coloured_points(program, folder):
    (folder / "points").write_text("1 1 1\n3 3 3\n0 1 1\n")
    done = run(program, "query", "inside", folder / "cube", "--points", folder / "points",
               "--export", folder / "points.obj", "--structure", "tetra-tree")
    must(done.returncode == 0, done.stderr)
    lines = (folder / "points.obj").read_text().splitlines()
    places = [line.split()[1:4] for line in lines if line.startswith("v ")]
    shades = [tuple(line.split()[4:]) for line in lines if line.startswith("v ")]
    must(places == [["1", "1", "1"], ["3", "3", "3"], ["0", "1", "1"]], f"{places}")
    must(len(set(shades)) == 3 and all(len(shade) == 3 for shade in shades), f"{shades}")


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    inaccessible(program, folder)
    levels_of_detail(program, folder)
    coloured_points(program, folder)


if __name__ == "__main__":
    main()
