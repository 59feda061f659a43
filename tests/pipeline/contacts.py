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
from schemas import check_schema, schema_of
from shared_models import bake, must, run

SCHEMA = schema_of("query/contacts")

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


def in_a_cavity(program, folder):
    """A unit cube in the cavity of a cube with walls 1 thick: 0.1 from the inside of a wall, and so
    1.1 from its outside, which with a tolerance is one piece around the cavity."""
    corners = [[int(x) for x in line.split()] for line in CUBE.splitlines()[2:10]]
    faces = [line.split()[1:] for line in CUBE.splitlines()[10:]]
    lines = [" ".join(str(5 * x) for x in corner) for corner in corners]
    lines += [" ".join(str(4 * x + 1) for x in corner) for corner in corners]
    lines += ["4 " + " ".join(face) for face in faces]
    lines += ["4 " + " ".join(str(8 + int(i)) for i in face[::-1]) for face in faces]
    (folder / "hollow.off").write_text("\n".join(["OFF", "16 12 0", *lines]) + "\n")
    lines = [" ".join(str(x / 2) for x in corner) for corner in corners]
    lines += ["4 " + " ".join(face) for face in faces]
    (folder / "unit.off").write_text("\n".join(["OFF", "8 6 0", *lines]) + "\n")
    bake(program, folder / "unit.off", "-o", folder / "unit.cdp.h5", "--effects", "contacts")
    for options in ([], ["--piece-tolerance", 0.001]):
        hollow = folder / "hollow.cdp.h5"
        bake(program, folder / "hollow.off", "-o", hollow, "--effects", "contacts", *options)
        found = json.loads(ask(program, hollow, folder / "unit.cdp.h5", "--tolerance", 1.2,
                               "--pose", "1 0 0 0 1 0 0 0 1 1.1 4.5 4.5", "--format", "json"))[0]
        gaps = sorted(round(contact["lower"], 9) for contact in found["contacts"])
        must(gaps == [0.1, 1.1], f"{options}: {found}")


def ask(program, *arguments):
    asked = run(program, "query", "contacts", *arguments)
    must(asked.returncode == 0, f"query {arguments} exited {asked.returncode}: {asked.stderr}")
    arguments = [str(argument) for argument in arguments]
    if "json" in arguments or "ndjson" in arguments:
        lines = asked.stdout.splitlines() if "ndjson" in arguments else [asked.stdout]
        for line in lines:
            check_schema(SCHEMA, json.loads(line), arguments)
    return asked.stdout


def limited(program, folder, cube):
    """A cube in the notch of an L: the walls have normals at right angles. A list is cut short by
    --most and by --budget, and --cluster-deg counts degrees."""
    (folder / "l.off").write_text(prism())
    notch = folder / "notch.cdp.h5"
    bake(program, folder / "l.off", "-o", notch, "--effects", "contacts")

    def listed(*options):
        return json.loads(ask(program, notch, cube, "--pose", "1 0 0 0 1 0 0 0 1 1.0625 1.125 5",
                              "--tolerance", 0.25, "--format", "json", *options))[0]
    all_of = listed()
    walls = {tuple(round(x, 6) for x in contact["normal"]) for contact in all_of["contacts"]}
    must(walls == {(1, 0, 0), (0, 1, 0)}, f"walls of {all_of}")
    must(all_of["complete"] and all_of["found"] == all_of["count"] > 1, f"all: {all_of}")
    deepest = listed("--most", 1)
    must(deepest["count"] == 1 and not deepest["complete"] and deepest["searched"] and
         abs(deepest["contacts"][0]["lower"] - 0.0625) < 1e-9, f"--most 1: {deepest}")
    for degrees, count in ((45, 2), (89.5, 2), (90.5, 1)):
        joined = listed("--most", 64, "--cluster-deg", degrees)
        must(joined["count"] == count, f"--cluster-deg {degrees}: {joined}")
        members = sum(contact["members"] for contact in joined["contacts"])
        must(members == all_of["count"], f"--cluster-deg {degrees}: {joined}")
    short = listed("--budget", 1)
    must(short["count"] < all_of["count"] and not short["complete"] and not short["searched"],
         f"--budget 1: {short}")
    most = listed("--budget", 2**64 - 1)
    must(most == all_of, f"--budget {2**64 - 1}: {most}")
    text = ask(program, notch, cube, "--pose", "1 0 0 0 1 0 0 0 1 1.0625 1.125 5", "--tolerance",
               0.25, "--most", 1)
    must(text.startswith(f"pose 0: 1 contact of {all_of['found']} found\n"), text)


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
    must(asked.returncode == 2 and "--structure: 'octree' is not bvh or pieces." in asked.stderr,
         asked.stderr)
    must("points" not in ask(program, *pair, "--format", "ndjson"), "points without --manifold")
    text = ask(program, *pair)
    must(text.splitlines()[0] == "pose 0: 1 contact" and "normal 0 0 1" in text.replace("-0 ", "0 "),
         text)

    # On a sheet, and asked of a file without contacts.
    found = json.loads(ask(program, sheet, cube, "--tolerance", 0.01, "--format", "json",
                           "--pose", "1 0 0 0 1 0 0 0 1 3.3 4.4 0.005"))[0]
    must(found["count"] == 1 and close(found["contacts"][0]["normal"], (0, 0, 1)), f"{found}")
    asked = run(program, "query", "contacts", cube, bare, "--tolerance", 1)
    must(asked.returncode == 2 and "triangle_piece" in asked.stderr and "--effects" in asked.stderr,
         f"{asked.returncode}: {asked.stderr}")
    enclosed(program, folder, cube)
    limited(program, folder, cube)
    in_a_cavity(program, folder)
    asked = run(program, "query", "contacts", cube, cube)
    must(asked.returncode == 2 and "--tolerance" in asked.stderr, asked.stderr)


main()
