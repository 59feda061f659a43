#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Exports convex parts in every format and has them read by those who shall read them: OBJ and
GLB by assimp, URDF by ROS's check_urdf and by MuJoCo, SDF by Gazebo's reader, MJCF
by MuJoCo. What they find is what the report says: names, number, limits, mass. By default threads
are compared in two formats; in all with CDPREP_ALL_POSES=yes.
Usage: exported_parts.py CDPREP SIMULATOR_READERS"""
import fractions
import json
import math
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml

from schemas import report_of
from shared_models import must, run

SAMPLES = pathlib.Path(__file__).resolve().parent / "../../samples/meshes"
FORMATS = ("obj", "glb", "urdf", "sdf", "mjcf")
ROBOTS = ("urdf", "sdf", "mjcf")
EVERYTHING = os.environ.get("CDPREP_ALL_POSES") == "yes"
LITTLE_WORK = ["--work", 20_000_000]  # of the bolt, whose parts nobody judges here
FLOAT = 2.0 ** -23  # what a rounding to float takes, of the largest coordinate


def box(low, high, first=1):
    """Vertices and outward triangles as lines of an OBJ."""
    corners = [[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    lines = ["v " + " ".join(map(repr, c)) for c in corners]
    for a, b, c, d in quads:
        lines += [f"f {a + first} {b + first} {c + first}", f"f {a + first} {c + first} {d + first}"]
    return "\n".join(lines) + "\n"


def write_l_prism(path, first=0):
    """An L of 2 x 2 squares less one, 1 high: no fewer than two convex parts are it. It begins at
    `first` along x."""
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    lines = [f"v {first + x!r} {y} {z}" for z in (0, 1) for x, y in outline]
    for i in range(6):
        k = (i + 1) % 6
        lines += [f"f {i + 1} {k + 1} {k + 7}", f"f {i + 1} {k + 7} {i + 7}"]
    for a, b, c in ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)):
        lines += [f"f {a + 1} {c + 1} {b + 1}", f"f {a + 7} {b + 7} {c + 7}"]
    path.write_text("\n".join(lines) + "\n")


def write_torus(path, around, across):
    lines = []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = 1 + 0.4 * math.cos(b)
            lines.append(f"v {r * math.cos(a)!r} {r * math.sin(a)!r} {0.4 * math.sin(b)!r}")
    for i in range(around):
        for j in range(across):
            p, q = i * across + 1, (i + 1) % around * across + 1
            k = (j + 1) % across
            lines += [f"f {p + j} {q + j} {q + k}", f"f {p + j} {q + k} {p + k}"]
    path.write_text("\n".join(lines) + "\n")


def decompose(program, *arguments, code=0):
    done = run(program, "decompose", *arguments, "--format", "json")
    must(done.returncode == code, f"decompose {arguments}: exit {done.returncode}: {done.stderr}")
    return report_of("decompose", done.stdout)


def read_with(reader, path):
    done = run(reader, path)
    must(done.returncode == 0, f"{path.name} is refused: {done.stderr}{done.stdout}")
    return json.loads(done.stdout)


def near(found, wanted, relative=1e-12):
    scale = max(abs(x) for x in wanted)
    return all(abs(x - y) <= relative * scale for x, y in zip(found, wanted, strict=True))


def must_be_closed_and_convex(name, part, rounding):
    """Edges in both directions; no vertex in front of a facet by more than what `rounding` of
    its corners turns that: a thin one by more."""
    points = part["vertices"]
    place = {}
    number = [place.setdefault(tuple(p), len(place)) for p in points]
    edges = set()
    for facet in part["facets"]:
        must(len(facet) == 3, f"{name}: a facet of {len(facet)} corners")
        a, b, c = (points[i] for i in facet)
        u, v = ([q[k] - a[k] for k in range(3)] for q in (b, c))
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = math.hypot(*normal)
        edges |= {(number[facet[k]], number[facet[(k + 1) % 3]]) for k in range(3)}
        longest = max(math.dist(b, c), math.hypot(*u), math.hypot(*v))
        for p in points if length > 0 else ():
            height = sum(n * (x - y) for n, x, y in zip(normal, p, a)) / length
            slack = 4 * rounding * (1 + math.dist(p, a) * longest / length)
            must(height <= slack, f"{name}: a vertex is {height} in front of a facet")
    must(len(edges) == 3 * len(part["facets"]), f"{name}: an edge twice in one direction")
    must(all((b, a) in edges for a, b in edges), f"{name}: not closed")
    return len(place)


def check_meshes(name, found, report):
    """What assimp found in an OBJ or a GLB."""
    table = report["table"]
    must([p["name"] for p in found["parts"]] == [f"part_{i}" for i in range(len(table))],
         f"{name}: names {[p['name'] for p in found['parts']]}")
    largest = max(abs(x) for p in found["parts"] for v in p["vertices"] for x in v)
    for part, row in zip(found["parts"], table):
        if len(part["facets"]) != row["facets"]:
            must(False, f"{name}: {part['name']} has {len(part['facets'])} facets, not {row}")
        count = must_be_closed_and_convex(f"{name}: {part['name']}", part, FLOAT * largest)
        must(count <= row["vertices"], f"{name}: {count} vertices of {row['vertices']}")


def references(path):
    """The mesh files that a URDF or SDF names, as written."""
    tree = xml.parse(path).getroot()
    names = [e.get("filename") for e in tree.iter("mesh") if e.get("filename")]
    return names + [e.text for e in tree.iter("uri")]


def check_references(path, has_visual):
    names = references(path)
    for name in names:
        must("/" not in name and (path.parent / name).is_file(), f"{path.name} names {name}")
    visual = [name for name in names if name.endswith("_visual.obj")]
    must(len(visual) == (1 if has_visual else 0), f"{path.name} shows {visual}")


def check_urdf(path, parts, mass):
    done = run("check_urdf", path)
    must(done.returncode == 0, f"check_urdf refuses {path.name}: {done.stderr}{done.stdout}")
    link = xml.parse(path).getroot().find("link")
    names = [collision.get("name") for collision in link.findall("collision")]
    must(names == parts, f"{path.name}: {names}")
    must(float(link.find("inertial/mass").get("value")) == mass, f"{path.name}: mass")
    return link


def check_every_format(program, reader, folder, source, options):
    """The number of parts, which is the same in every format."""
    for kind in FORMATS:
        output = folder / f"{source.stem}.{kind}"
        report = decompose(program, source, "-o", output, "--table", *options)
        found = read_with(reader, output)
        solid = [f"part_{i}" for i, row in enumerate(report["table"]) if row["facets"] > 0]
        must(report["parts"] == len(report["table"]), f"{kind}: {report}")
        if kind in ("obj", "glb"):
            check_meshes(output.name, found, report)
            continue
        must(len(found["parts"]) == report["parts"] - report["left_out"], f"{kind}: {found}")
        if kind == "urdf":
            names = [n[len(source.stem) + 1:-4] for n in references(output)]
            parts = [name for name in names if name != "visual"]
            check_urdf(output, parts, report["mass"])
            must(set(parts) <= set(solid), f"{parts}")
        if kind == "sdf":
            must(found["is_valid"], "an inertia that Gazebo refuses")
        if kind != "mjcf":
            check_references(output, has_visual=True)
        if kind != "urdf":  # MuJoCo makes one body of a lone link and the world
            must(near([found["mass"]], [report["mass"]]), f"{kind}: mass {found['mass']}")
    return report


def check_limits(program, reader, folder):
    bracket = SAMPLES / "bracket.obj"
    for most in (4, 8, 16):
        report = check_every_format(program, reader, folder, bracket,
                                    ["--parts", 6, "--max-vertices", most])
        must(report["most_vertices"] <= most, f"{report['most_vertices']} vertices of {most}")
        must(report["parts"] <= 6 and report["as_asked"], f"{report}")
        found = read_with(reader, folder / "bracket.mjcf")
        must(all(part["vertices"] <= most for part in found["parts"]), f"MuJoCo: {found['parts']}")
    report = decompose(program, bracket, "--max-error", 1, "--max-parts", 3, code=1)
    must(report["parts"] <= 3 and not report["as_asked"], f"{report}")
    must(report["outer_error"] > 1, "three parts are not so tight")


def check_box_weighs_as_by_hand(program, reader, folder):
    """m = 8000 kg / m^3 * 2 * 3 * 4 m^3; moments are m (b^2 + c^2) / 12."""
    low, high = (1.0, -2.0, 5.0), (3.0, 1.0, 9.0)
    inwards = box(low, high).splitlines()
    inwards = [" ".join(["f", *reversed(line.split()[1:])]) if line[0] == "f" else line
               for line in inwards]
    for name, text in (("box", box(low, high)), ("inwards", "\n".join(inwards) + "\n")):
        source = folder / f"{name}.obj"
        source.write_text(text)
        mass = 8000 * 24
        moments = [mass * (9 + 16) / 12, mass * (4 + 16) / 12, mass * (4 + 9) / 12]
        centre = [2.0, -0.5, 7.0]
        for kind in ROBOTS:
            output = folder / f"{name}_out.{kind}"
            report = decompose(program, source, "-o", output, "--parts", 1, "--density", 8000)
            must(report["parts"] == 1 and report["outer_error"] == 0, f"{name}: {report}")
            must(report["mass_of"] == "solid" and near([report["mass"]], [mass]), f"{report}")
            found = read_with(reader, output)
            if kind == "urdf":
                link = check_urdf(output, ["part_0"], report["mass"])
                inertia = [float(link.find("inertial/inertia").get(n))
                           for n in ("ixx", "iyy", "izz", "ixy", "iyz", "ixz")]
                place = list(map(float, link.find("inertial/origin").get("xyz").split()))
            else:
                inertia = found.get("inertia") or found["moments"] + [0, 0, 0]
                place = found["centre"]
            if kind == "mjcf":  # principal moments, largest first
                must(near(inertia[:3], sorted(moments, reverse=True)), f"{kind}: {inertia}")
            else:
                must(near(inertia, moments + [0, 0, 0]), f"{kind}: {inertia}")
            must(near(place, centre), f"{kind}: centre {place}")


def check_units(program, reader, folder):
    """Collada says what a unit is: centimetres become metres where a format has them."""
    source = folder / "box.obj"
    dae = folder / "box.dae"
    vertices = [line.split()[1:] for line in source.read_text().splitlines() if line[0] == "v"]
    faces = [[int(i) - 1 for i in line.split()[1:]]
             for line in source.read_text().splitlines() if line[0] == "f"]
    dae.write_text(f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="24">{" ".join(x for v in vertices for x in v)}</float_array>
<technique_common><accessor source="#pa" count="8" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{len(faces)}"><input semantic="VERTEX" source="#v" offset="0"/>
<p>{" ".join(str(i) for f in faces for i in f)}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
""")
    report = decompose(program, dae, "-o", folder / "units.sdf", "--parts", 1)
    found = read_with(reader, folder / "units.sdf")
    must(found["parts"][0]["scale"] == [0.01, 0.01, 0.01], f"scale {found['parts'][0]}")
    must(near([found["mass"]], [1000 * 24e-6]), f"mass {found['mass']}, {report}")
    must(near(found["centre"], [0.02, -0.005, 0.07]), f"centre {found['centre']}")


def check_what_is_weighed(program, folder):
    """Beside a box of 8 cubic metres is another: apart, over half of it, or inside out."""
    first = box((0.0, 0.0, 0.0), (2.0, 2.0, 2.0))
    apart = box((3.0, 0.0, 0.0), (5.0, 2.0, 2.0), 9)
    across = box((1.0, 0.0, 0.0), (3.0, 2.0, 2.0), 9)
    inverted = "".join(" ".join(word[i] for i in ((0, 2, 1, 3) if word[0] == "f" else range(4)))
                       + "\n" for word in map(str.split, apart.splitlines()))
    for second, of in ((apart, "solid"), (across, "mesh"), (inverted, "parts")):
        source = folder / "lapping.obj"
        source.write_text(first + second)
        report = decompose(program, source, "-o", folder / "two.urdf", "--parts", 2, "--unit", "m")
        must(report["mass_of"] == of and near([report["mass"]], [16000]), f"{of}: {report}")


def check_given_units(program, reader, folder):
    """--unit and --up-axis hold where the file says nothing, and that is said where they miss."""
    bolt = SAMPLES / "bolt.obj"
    for kind in ROBOTS:
        output = folder / f"bolt_mm.{kind}"
        report = decompose(program, bolt, "-o", output, "--parts", 2, "--unit", "mm")
        must(abs(report["mass"] - 0.005) < 0.0001, f"{kind}: {report['mass']} kg")
        if kind == "urdf":
            check_urdf(output, [f"part_{i}" for i in range(report["parts"])], report["mass"])
        else:
            must(near([read_with(reader, output)["mass"]], [report["mass"]]), f"{kind}: mass")
    source = folder / "upright.obj"
    source.write_text(box((0.0, 0.0, 0.0), (2.0, 3.0, 4.0)))
    for kind in ROBOTS:
        output = folder / f"unknown.{kind}"
        for options, code in ((["--unit", "mm"], 0), ([], 0), (["--strict"], 1)):
            output.unlink(missing_ok=True)
            done = run(program, "decompose", source, "-o", output, "--parts", "1", *options)
            warns = "states no unit" in done.stderr and "--unit" in done.stderr
            must(done.returncode == code and warns == ("--unit" not in options),
                 f"{kind} {options}: exit {done.returncode}, {done.stderr}")
            must(output.exists() == (code == 0), f"{kind} {options}: {output.name}")
            must(options or "2 x 3 x 4 m and 24000 kg" in done.stderr, done.stderr)
    # What is up is +z for simulators: of a box of 2 x 3 x 4, the 3 of y.
    for axis, size, centre in (("y", [2, 4, 3], [1, -2, 1.5]), ("z", [2, 3, 4], [1, 1.5, 2])):
        output = folder / "upright.sdf"
        decompose(program, source, "-o", output, "--parts", 1, "--unit", "m", "--up-axis", axis)
        found = read_with(reader, output)
        must(near(found["centre"], centre), f"{axis} up: centre {found['centre']}")
        corners = [[float(x) for x in line.split()[1:]]
                   for line in (folder / "upright_part_0.obj").read_text().splitlines()
                   if line.startswith("v ")]
        extent = [max(c[i] for c in corners) - min(c[i] for c in corners) for i in range(3)]
        must(extent == size, f"{axis} up: {extent}")


def check_nodes_stay_apart(program, reader, folder):
    """Two boxes with a face in common are one box: only for who asks for that."""
    for word in ("o", "g"):
        source = folder / f"two_{word}.obj"
        source.write_text(f"{word} left\n" + box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
                          + f"{word} right\n" + box((1.0, 0.0, 0.0), (3.0, 1.0, 1.0), 9))
        output = folder / "two_out.obj"
        report = decompose(program, source, "-o", output, "--max-error", 5, "--table")
        must([row.get("node", "").split("/")[-1] for row in report["table"]] == ["left", "right"],
             f"{word}: {report['table']}")
        must(report["outer_error"] == 0, "boxes are convex")
        xs = [sorted({v[0] for v in part["vertices"]})
              for part in read_with(reader, output)["parts"]]
        must(xs == [[0, 1], [1, 3]], f"{word}: parts from {xs}")
        few = decompose(program, source, "--parts", 1, code=1)
        must(few["parts"] == 2 and not few["as_asked"], "two nodes are two parts at least")
        one = decompose(program, source, "-o", output, "--max-error", 5, "--merge-components")
        must(one["parts"] == 1, "merged when asked")
        part, = read_with(reader, output)["parts"]
        must(sorted({v[0] for v in part["vertices"]}) == [0, 3], "one box around both")


def check_odd_names(program, reader, folder):
    """No name of a file can break what refers to it."""
    prism = folder / "prism.obj"
    write_l_prism(prism)
    texts = {}
    for number, stem in enumerate(("a b", "a_b", "q\"uo'te<&>", "pér cent%20", "line\nend", "-o")):
        place = folder / f"odd{number % 2}"
        place.mkdir(exist_ok=True)
        for kind in ROBOTS:
            output = place / f"{stem}.{kind}"
            report = decompose(program, prism, f"--output={output}", "--parts", 2)
            must(report["parts"] == 2, f"{report}")
            if kind != "mjcf":
                check_references(output, has_visual=True)
                for name in references(output):
                    must(texts.setdefault((place, name), stem) == stem, f"{name} is of two files")
            # check_urdf and MuJoCo open the file by its own name, which may be any.
            found = read_with(reader, output)
            must(len(found["parts"]) == report["parts"] - report["left_out"], f"{stem}: {found}")
    output = folder / "plain.urdf"
    decompose(program, prism, "-o", output, "--parts", 2, "--no-visual")
    check_references(output, has_visual=False)


def check_same_bytes(program, folder):
    for options in (["--parts", 7], ["--max-error", 4], ["--parts", 9, "--max-vertices", 12]):
        for kind in FORMATS if EVERYTHING else ("obj", "sdf"):
            texts = set()
            for jobs in (1, 2, 4):
                output = folder / f"same.{kind}"
                decompose(program, SAMPLES / "bracket.obj", "-o", output, "-j", jobs, *options)
                texts.add(tuple(sorted((f.name, f.read_bytes()) for f in folder.glob("same*"))))
            must(len(texts) == 1, f"{kind} {options}: threads change something")


def fraction_of(word):
    return fractions.Fraction(float(word))


def fraction_of_float(word):
    """Of a text number with few digits, which is taken for a float."""
    return fractions.Fraction(struct.unpack("f", struct.pack("f", float(word)))[0])


def check_enclosure(program, folder):
    """Every vertex of the mesh is in a part, exactly, as the numbers stand in the OBJ."""
    for name in ("bracket.obj", "bolt.obj"):
        for options in ([*LITTLE_WORK, "--parts", 5],
                        [*LITTLE_WORK, "--parts", 5, "--max-vertices", 8],
                        ["--work", 1, "--parts", 9]):
            output = folder / "enclosed.obj"
            done = run(program, "decompose", SAMPLES / name, "-o", output, *options)
            must(done.returncode in (0, 1), done.stderr)
            parts, vertices = [], []
            for line in output.read_text().splitlines():
                word, *rest = line.split()
                if word == "o":
                    parts.append([])
                elif word == "v":
                    vertices.append(tuple(map(fraction_of, rest)))
                else:
                    parts[-1].append([vertices[int(i) - 1] for i in rest])
            planes = [[plane_of(*facet) for facet in part] for part in parts if part]
            for line in (SAMPLES / name).read_text().splitlines():
                if not line.startswith("v "):
                    continue
                p = tuple(map(fraction_of_float, line.split()[1:4]))
                must(any(all(sum(n * x for n, x in zip(normal, p)) <= most
                             for normal, most in plane) for plane in planes),
                     f"{name} {options}: {line} is in no part")


def plane_of(a, b, c):
    u, v = (tuple(x - y for x, y in zip(q, a)) for q in (b, c))
    normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    return normal, sum(n * x for n, x in zip(normal, a))


def check_budget_and_report(program, folder):
    bracket = SAMPLES / "bracket.obj"
    report = decompose(program, bracket, "--max-error", 1, "--work", 1, code=1)
    must(report["ran_out_of_work"] and not report["as_asked"], f"{report}")
    must(report["proof"]["outside"] == 0, "what is looser encloses too")
    report = decompose(program, bracket, "--max-error", 4)
    must(report["outer_error"] <= 4 and report["inner_error"] == 0 and report["parts"] > 1,
         f"{report}")
    must(report["outer_error_at_least"] <= report["outer_error"], f"{report}")


def check_rounding(program, folder):
    """A GLB far from 0 rounds corners. Errors count that, which may exceed what was asked."""
    source = folder / "far_l.obj"
    write_l_prism(source, 10000.0003)
    for kind, error, is_met in (("obj", 1e-4, True), ("glb", 1e-4, False), ("glb", 1e-2, True)):
        output = folder / f"far_l_out.{kind}"
        report = decompose(program, source, "-o", output, "--max-error", error, "--table",
                           code=0 if is_met else 1)
        rounding = report.get("rounding", 0)
        must((rounding > 1e-4) == (kind == "glb") and report["inner_error"] == rounding, f"{report}")
        must(report["outer_error"] >= rounding, f"{report}")
        must(max(row["outer_error"] for row in report["table"]) == report["outer_error"], f"{report}")
        must(report["as_asked"] == is_met == (report["outer_error"] <= error), f"{report}")
        must(report["outer_error_at_least"] <= report["outer_error"], f"{report}")
    done = run(program, "decompose", source, "-o", output, "--max-error", 1e-4)
    must(done.returncode == 1 and "because corners were rounded" in done.stdout, done.stdout)


def check_progress_and_interrupt(program, folder):
    bracket, empty = SAMPLES / "bracket.obj", folder / "stopped"
    empty.mkdir()
    done = run(program, "decompose", bracket, "--parts", 3, "--progress", "plain", "-o",
               folder / "told.obj")
    stages = [line.split(": ")[-1] for line in done.stderr.splitlines()]
    must(stages == ["import", "enclose", "write"], f"progress: {done.stderr}")
    torus = folder / "torus.obj"
    write_torus(torus, 400, 200)
    for kind in ("obj", "urdf"):
        process = subprocess.Popen([program, "decompose", torus, "--parts", "400", "--progress",
                                    "plain", "-o", empty / f"x.{kind}"], stderr=subprocess.PIPE,
                                   text=True)
        while not process.stderr.readline().endswith(": enclose\n"):
            must(process.poll() is None, "the search begins")
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        rest = process.communicate(timeout=120)[1]
        must(process.returncode == 130, f"interrupted: exit {process.returncode}: {rest}")
        must("stopped" in rest and not list(empty.iterdir()), f"left {list(empty.iterdir())}")


def check_baked(program, folder):
    """Parts in a baked file are those of decompose, and --deep proves that they hold all."""
    bracket, baked = SAMPLES / "bracket.obj", folder / "bracket.cdp.h5"
    limits = ["--parts", 6]
    found = decompose(program, bracket, *limits, "--max-vertices", 16)
    done = run(program, "bake", bracket, "-o", baked, "--structures", "hull", *limits,
               "--hull-vertices", 16, "--format", "json")
    must(done.returncode == 0, done.stderr)
    parts = report_of("bake", done.stdout)["models"][0]["parts"]
    must(parts["count"] == found["parts"] and parts["as_asked"], f"{parts}, {found}")
    must(parts["outer_error"] == found["outer_error"], f"{parts}, {found}")
    proof = {key: found["proof"][key] for key in ("fragments", "outside")}
    must(parts["proof"] == proof and proof["outside"] == 0, f"{parts}, {proof}")
    done = run(program, "info", baked, "--deep", "--format", "json")
    must(done.returncode == 0, done.stderr)
    hulls = report_of("info", done.stdout)["hulls"]
    must([h["around"] for h in hulls] == ["whole"] + ["part"] * found["parts"], f"{hulls}")
    must(all(h["points"] <= 16 for h in hulls), f"{hulls}")
    must(max(h["distance"] for h in hulls[1:]) == found["outer_error"], f"{hulls}")
    again = folder / "again.cdp.h5"
    run(program, "bake", bracket, "-o", again, "--structures", "hull", *limits,
        "--hull-vertices", 16, "-j", 1)
    must(again.read_bytes() == baked.read_bytes(), "threads change nothing")
    done = run(program, "bake", bracket, "-o", again, "--structures", "hull", "--max-error", 1,
               "--parts", 2)
    must(done.returncode in (0, 1), done.stderr)
    for option in ("--parts", "--max-error", "--hull-vertices"):
        done = run(program, "bake", bracket, "-o", again, option, 8)
        must(done.returncode == 2 and option in done.stderr, f"{option}: {done.stderr}")


def check_invalid_arguments(program, folder):
    bolt = SAMPLES / "bolt.obj"

    def refused(code, word, *arguments):
        done = run(program, "decompose", *arguments)
        must(done.returncode == code, f"{arguments}: exit {done.returncode}, not {code}")
        must(word in done.stderr, f"{arguments}: {done.stderr}")
        must(code == 2 or len(done.stderr.splitlines()) == 1, f"{arguments}: {done.stderr}")

    for option in ("--merge-components", "--to-surface", "--no-visual"):
        refused(2, option, bolt, option)
    for option in ("--max-vertices", "--work", "--density"):
        refused(2, option, bolt, option, 9)
    # Of the formats, some have no mass, some no visual mesh, and some no unit.
    for option, formats in ((["--density", 9], ("obj", "glb")), (["--strict"], ("obj", "glb")),
                            (["--no-visual"], ("obj", "glb", "mjcf", "xml"))):
        refused(2, f"{option[0]} has no effect", bolt, "--parts", 3, *option)
        for kind in formats:
            refused(2, f"{option[0]} has no effect", bolt, "--parts", 3, *option,
                    "-o", folder / f"idle.{kind}")
    must(not list(folder.glob("idle*")), "options without effect were accepted")
    refused(2, "--tolerance", bolt, "--parts", 3, "--tolerance", 1)
    refused(2, "--order", bolt, "--parts", 3, "--order", "greedy")
    refused(2, "--exact", bolt, "--parts", 3, "--exact")
    for option, word in (("--max-error", "-1"), ("--max-error", "nan"), ("--parts", "0"),
                         ("--parts", "-2"), ("--max-parts", "0"), ("--density", "-1")):
        refused(2, option, bolt, "--parts", 3, option, word)
    refused(2, "--max-vertices", bolt, "--parts", 3, "--max-vertices", 3)
    refused(2, ".obj, .glb, .urdf", bolt, "--parts", 3, "-o", folder / "x.stl")
    refused(2, "Choose another name", bolt, "--parts", 3, "-o", bolt)
    source = folder / "robot_part_0.obj"
    source.write_text(bolt.read_text())
    refused(2, "Choose another output", source, "--parts", 3, "-o", folder / "robot.urdf")
    refused(3, "missing.obj", folder / "missing.obj", "--parts", 3)
    for kind in FORMATS:
        refused(4, "no folder", bolt, "--parts", 3, *LITTLE_WORK, "-o",
                folder / "no folder" / f"x.{kind}")
    nothing = folder / "nothing.obj"
    nothing.write_text("v 0 0 0\n")
    report = decompose(program, nothing, "--parts", 3, "--allow-empty", "-o",
                       folder / "nothing_out.glb")
    must(report["parts"] == 0, f"{report}")


def main():
    program, reader = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        check_box_weighs_as_by_hand(program, reader, folder)
        check_units(program, reader, folder)
        check_what_is_weighed(program, folder)
        check_given_units(program, reader, folder)
        check_nodes_stay_apart(program, reader, folder)
        check_every_format(program, reader, folder, SAMPLES / "bolt.obj",
                           ["--parts", 5, *LITTLE_WORK])
        check_limits(program, reader, folder)
        check_odd_names(program, reader, folder)
        check_same_bytes(program, folder)
        check_enclosure(program, folder)
        check_budget_and_report(program, folder)
        check_rounding(program, folder)
        check_progress_and_interrupt(program, folder)
        check_baked(program, folder)
        check_invalid_arguments(program, folder)


main()
