#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""contacts through the program, against answers known by hand.

Usage: contacts.py CDPREP
"""
import json
import pathlib
import sys
import tempfile

from known_meshes import CUBE
from shared_models import bake, must, run


SHEET = "OFF 4 2 0\n0 0 0\n9 0 0\n9 9 0\n0 9 0\n3 0 1 2\n3 0 2 3\n"


# An L of three unit squares, 10 high: the notch is where x and y are above 1.
OUTLINE = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
CAP = [(0, 1, 3), (1, 2, 3), (0, 3, 5), (3, 4, 5)]


def prism():
    points = [(x, y, z) for z in (0, 10) for x, y in OUTLINE]
    faces = [f[::-1] for f in CAP] + [tuple(6 + i for i in f) for f in CAP]
    for i in range(6):
        j = (i + 1) % 6
        faces += [(i, j, 6 + j), (i, 6 + j, 6 + i)]
    return (f"OFF {len(points)} {len(faces)} 0\n" + "".join("%g %g %g\n" % p for p in points) +
            "".join("3 %d %d %d\n" % f for f in faces))


def enclosed(program, folder, cube):
    """A small cube inside an L leaves into the notch only where the file has the parts."""
    (folder / "l.off").write_text(prism())
    head, *lines = CUBE.splitlines()
    corners = [line.replace("2", "0.125") for line in lines[1:9]]
    (folder / "small.off").write_text("\n".join([head, lines[0], *corners, *lines[9:]]) + "\n")
    pose = ["--pose", "1 0 0 0 1 0 0 0 1 0.625 1.5 5", "--tolerance", 0, "--format", "json"]
    small = folder / "small.cdp.h5"
    bake(program, folder / "small.off", "-o", small, "--effects", "contacts,collide")
    for options, lower, normal in (([], -0.5, (0, 1, 0)),
                                   (["--structures", "hull"], -0.5, (0, 1, 0)),
                                   (["--structures", "hull", "--parts", "2"], -0.375, (1, 0, 0))):
        bake(program, folder / "l.off", "-o", folder / "l.cdp.h5", "--effects", "contacts,collide",
             *options)
        pair = [folder / "l.cdp.h5", small, *pose]
        must(json.loads(ask(program, *pair))[0]["count"] == 0, "a surface encloses something")
        found = json.loads(ask(program, *pair, "--as", "solid"))[0]
        must(found["count"] == 1 and found["complete"], f"{options}: {found}")
        contact = found["contacts"][0]
        must(contact["deep"] and abs(contact["lower"] - lower) < 1e-9, f"{options}: {contact}")
        must(all(abs(x - y) < 1e-9 for x, y in zip(contact["normal"], normal)), f"{contact}")
    solid = json.loads(ask(program, cube, cube, "--tolerance", 0, "--as", "solid", "--pose",
                           "1 0 0 0 1 0 0 0 1 1 0 1.5", "--format", "json"))[0]
    must(solid["count"] == 1 and not solid["contacts"][0]["deep"], f"touching cubes: {solid}")


def ask(program, *arguments):
    asked = run(program, "query", "contacts", *arguments)
    must(asked.returncode == 0, f"query {arguments} exited {asked.returncode}: {asked.stderr}")
    return asked.stdout


def close(a, b):
    return all(abs(x - y) < 1e-12 for x, y in zip(a, b))


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    (folder / "cube.off").write_text(CUBE)
    cube, bare, sheet = (folder / f"{name}.cdp.h5" for name in ("cube", "bare", "sheet"))
    bake(program, folder / "cube.off", "-o", cube, "--effects", "contacts,collide")
    bake(program, folder / "cube.off", "-o", bare, "--effects", "pieces")
    (folder / "sheet.off").write_text(SHEET)
    bake(program, folder / "sheet.off", "-o", sheet, "--effects", "contacts")
    for path in (cube, sheet):
        deep = run(program, "info", path, "--deep")
        must(deep.returncode == 0, f"info --deep {path}: {deep.stderr}")

    # The cube [0, 2]^3 over itself, apart, touching, in each other, beyond the tolerance.
    gaps = (0.25, 0, -0.5, 1)
    (folder / "poses").write_text("".join(f"1 0 0 0 1 0 0 0 1 1 0 {2 + gap}\n" for gap in gaps))
    pair = [cube, cube, "--poses", folder / "poses", "--tolerance", 0.5]
    answers = json.loads(ask(program, *pair, "--manifold", "--format", "json"))
    lines = ask(program, *pair, "--manifold", "--format", "ndjson").splitlines()
    must([json.loads(line) for line in lines] == answers, "json and ndjson differ")
    must([answer["count"] for answer in answers] == [1, 1, 1, 0], f"counts of {answers}")
    for gap, answer in zip(gaps, answers[:3]):
        contact = answer["contacts"][0]
        must(contact["lower"] - 1e-12 <= gap <= contact["upper"] + 1e-12, f"{gap}: {contact}")
        must(contact["overlap"] == (gap <= 0), f"{gap}: {contact}")
        must(close(contact["normal"], (0, 0, 1)), f"{gap}: {contact}")
        corners = sorted(tuple(round(x, 9) for x in point["on_a"][:2])
                         for point in contact["points"])
        must(corners == [(1, 0), (1, 2), (2, 0), (2, 2)], f"{gap}: {corners}")
        must(close([point["distance"] for point in contact["points"]], [gap] * 4), f"{contact}")
    through = ask(program, *pair, "--manifold", "--format", "json", "--structure", "pieces")
    must(json.loads(through) == answers, f"through pieces: {through}")
    asked = run(program, "query", "contacts", *pair, "--structure", "octree")
    must(asked.returncode == 2 and "bvh, pieces" in asked.stderr, asked.stderr)
    must("points" not in ask(program, *pair, "--format", "ndjson"), "points without --manifold")
    text = ask(program, *pair)
    must(text.splitlines()[0] == "pose 0: 1 contacts" and "normal 0 0 1" in text.replace("-0 ", "0 "),
         text)

    # On a sheet, and asked of a file without contacts.
    found = json.loads(ask(program, sheet, cube, "--tolerance", 0.01, "--format", "json",
                           "--pose", "1 0 0 0 1 0 0 0 1 3.3 4.4 0.005"))[0]
    must(found["count"] == 1 and close(found["contacts"][0]["normal"], (0, 0, 1)), f"{found}")
    asked = run(program, "query", "contacts", cube, bare, "--tolerance", 1)
    must(asked.returncode == 2 and "triangle_piece" in asked.stderr and "--effects" in asked.stderr,
         f"{asked.returncode}: {asked.stderr}")
    enclosed(program, folder, cube)
    asked = run(program, "query", "contacts", cube, cube)
    must(asked.returncode == 2 and "--tolerance" in asked.stderr, asked.stderr)


main()
