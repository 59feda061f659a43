#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Cuts sample meshes into pieces through the program and reads what it wrote: groups of the
OBJ and colours of the PLY are one partition of the triangles, the same for any number of
threads, and the report says how many there are. Usage: decompose.py PROGRAM"""
import pathlib
import struct
import sys
import tempfile

from schemas import report_of
from shared_models import bake, must, run

SAMPLES = pathlib.Path(__file__).resolve().parent / "../../samples/meshes"


def decompose(program, *arguments, code=0):
    done = run(program, "decompose", *arguments)
    must(done.returncode == code, f"decompose {arguments}: exit {done.returncode}: {done.stderr}")
    return done


def obj_groups(path):
    groups, faces = [], []
    for line in path.read_text().splitlines():
        word, *rest = line.split()
        if word == "g":
            must(rest == [f"piece_{len(groups)}"], f"group {rest} stands at place {len(groups)}")
            groups.append(0)
        elif word == "f":
            groups[-1] += 1
            faces.append(tuple(map(int, rest)))
    return groups, faces


def ply_pieces(path):
    header, body = path.read_bytes().split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    counts = {line.split()[1]: int(line.split()[2]) for line in lines if line.startswith("element")}
    wide = 8 if "property double x" in lines else 4
    row = struct.Struct("<B3i3BI")
    at = 3 * wide * counts["vertex"]
    rows = [row.unpack_from(body, at + i * row.size) for i in range(counts["face"])]
    must(at + len(rows) * row.size == len(body), "the PLY file ends behind its last face")
    colours = {}
    for r in rows:
        must(colours.setdefault(r[7], r[4:7]) == r[4:7], f"piece {r[7]} has two colours")
    return [r[7] for r in rows]


def check_sample(program, folder, name, tolerance):
    source = SAMPLES / name
    options = ["--tolerance", tolerance] if tolerance else ["--exact"]
    report = report_of("decompose", decompose(program, source, "--format", "json", "--table",
                                              *options).stdout)
    must(report["exit"] == 0 and report["method"] == "surface", f"report {report}")
    must(report["outer_error"] <= float(tolerance or 0), f"error {report['outer_error']}")
    must(report["inner_error"] == 0, "hulls hold their pieces")
    must(len(report["table"]) == report["pieces"], "a row for each piece")
    must(sum(row["triangles"] for row in report["table"]) == report["triangles"], "all triangles")

    texts = set()
    for jobs in range(1, 9):
        obj = folder / f"{name}.{jobs}.obj"
        decompose(program, source, "-o", obj, "-j", jobs, *options)
        texts.add(obj.read_text())
    must(len(texts) == 1, "threads change nothing")
    groups, faces = obj_groups(folder / f"{name}.1.obj")
    must(groups == [row["triangles"] for row in report["table"]], "groups are the pieces")
    must(len(set(faces)) == report["triangles"], "every triangle is in one group")

    ply = folder / f"{name}.ply"
    decompose(program, source, "-o", ply, *options)
    pieces = ply_pieces(ply)
    must(len(pieces) == report["triangles"], "every triangle has a colour")
    must([pieces.count(i) for i in range(report["pieces"])] == groups, "colours are the pieces")
    return report["pieces"]


def write_obj(path, *bodies):
    """A group for each (name, corners, faces)."""
    lines, first = [], 1
    for name, corners, faces in bodies:
        lines += [f"v {x} {y} {z}" for x, y, z in corners]
        lines += [f"g {name}"] + ["f " + " ".join(str(first + i) for i in face) for face in faces]
        first += len(corners)
    path.write_text("\n".join(lines) + "\n")


def prism(outline):
    """A polygon from z = 0 to 1: two faces and a square for each edge."""
    n = len(outline)
    faces = [tuple(reversed(range(n))), tuple(range(n, 2 * n))]
    faces += [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return [(x, y, z) for z in (0, 1) for x, y in outline], faces


def check_names(program, folder):
    """Names that say convex: the surface is cut by what it is, what encloses heeds them."""
    box = prism([(4, 0), (5, 0), (5, 1), (4, 1)])
    corner = prism([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])
    tagged, plain = folder / "tagged.obj", folder / "plain.obj"
    write_obj(tagged, ("UCX_box", *box), ("corner_convex", *corner))
    write_obj(plain, ("box", *box), ("corner", *corner))
    count = {}
    for path in (tagged, plain):
        for options in ((), ("--max-error", "1e-3")):
            done = run(program, "decompose", path, "--format", "json", *options)
            must(done.returncode in (0, 1), f"decompose {path}: {done.stderr}")
            of = "parts" if options else "pieces"
            count[path, bool(options)] = report_of("decompose", done.stdout)[of]
    must(count[tagged, False] == count[plain, False] == 3, f"a box and two of an L: {count}")
    must(count[tagged, True] == 2 and count[plain, True] == 3, f"hulls of what is named: {count}")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name in ("bolt.obj", "bracket.obj"):
            exact = check_sample(program, folder, name, "")
            loose = check_sample(program, folder, name, "1e9")
            must(exact > 1, f"{name} is not convex")
            must(loose < exact, f"{name}: any height is tolerated")
            for order in ("depth-first", "breadth-first", "cresting"):
                grown = report_of("decompose", decompose(program, SAMPLES / name, "--order", order,
                                                         "--format", "json").stdout)
                must(grown["order"] == order and grown["pieces"] > 1, f"{order} {grown}")
            baked = folder / f"{name}.cdp.h5"
            bake(program, SAMPLES / name, "-o", baked, "--effects", "pieces")
            done = run(program, "info", "--deep", "--format", "json", baked)
            must(done.returncode == 0, done.stderr)
            counts = {s["name"]: s["count"] for s in report_of("info", done.stdout)["sections"]}
            must(counts["pieces"] == exact, f"{counts['pieces']} pieces baked, {exact} reported")

        check_names(program, folder)
        bolt = SAMPLES / "bolt.obj"
        decompose(program, bolt, "-o", folder / "x.stl", code=2)
        decompose(program, bolt, "--exact", "--tolerance", 1, code=2)
        decompose(program, bolt, "--order", "best", code=2)
        decompose(program, bolt, "--tolerance", -1, code=2)
        # Of a bolt of 34 mm scaled to a diagonal of 1, no unit is known.
        for options, code in (((), 0), (("--strict",), 1)):
            said = decompose(program, bolt, "-o", folder / "x.urdf", "--parts", 1, "--unit", "mm",
                             "--normalize", *options, code=code).stderr
            must("has no unit after --normalize" in said and "Leave out --normalize." in said, said)
        missing = decompose(program, folder / "missing.obj", "--format", "json", code=3)
        must("error" in report_of("decompose", missing.stdout), "the report says why")
        decompose(program, bolt, "-o", folder / "no folder" / "x.obj", code=4)


main()
