#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Exports baked files for every engine, and has the outputs read back: GLB by assimp and by cdprep
itself, MJCF and URDF by MuJoCo, URDF by check_urdf, SDF by SDFormat, JSON by its schema.

Usage: exports.py CDPREP SIMULATOR_READERS
"""
import fractions
import itertools
import json
import math
import pathlib
import struct
import sys
import tempfile
import xml.etree.ElementTree as xml

from schemas import check_schema, report_of, schema_of
from shared_models import bake, must, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "samples/meshes"
EXTENSION = {"godot": "glb", "unreal": "glb", "unity": "glb", "mujoco": "xml", "gazebo": "sdf",
             "urdf": "urdf", "json": "json"}
GLB = ("godot", "unreal", "unity")
ROBOTS = ("mujoco", "gazebo", "urdf")
COLLIDERS = schema_of("export/colliders")


# --- Meshes ----------------------------------------------------------------------------------


def write_obj(path, points, triangles, before=""):
    lines = [before] if before else []
    lines += ["v " + " ".join(map(repr, p)) for p in points]
    lines += ["f " + " ".join(str(i + 1) for i in t) for t in triangles]
    path.write_text("\n".join(lines) + "\n")
    return path


def box(size):
    points = [tuple(size[k] * (i >> k & 1) for k in range(3)) for i in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def l_prism():
    """An L of 2 x 2 squares less one, 1 high: two convex parts are it."""
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    points = [(float(x), float(y), float(z)) for z in (0, 1) for x, y in outline]
    triangles = []
    for i in range(6):
        k = (i + 1) % 6
        triangles += [(i, k, k + 6), (i, k + 6, i + 6)]
    for a, b, c in ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)):
        triangles += [(a, c, b), (a + 6, b + 6, c + 6)]
    return points, triangles


def torus(around, across):
    points, triangles = [], []
    for i, j in itertools.product(range(around), range(across)):
        a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
        r = 1 + 0.4 * math.cos(b)
        points.append((r * math.cos(a), r * math.sin(a), 0.4 * math.sin(b)))
        p, q, k = i * across, (i + 1) % around * across, (j + 1) % across
        triangles += [(p + j, q + j, q + k), (p + j, q + k, p + k)]
    return points, triangles


# --- Running and reading ---------------------------------------------------------------------


def export(program, model, engine, output, *options, code=0):
    """The report, and what the command said on stderr."""
    done = run(program, "export", model, "--for", engine, "-o", output, "--format", "json",
               *options)
    must(done.returncode == code, f"export for {engine}: exit {done.returncode}: {done.stderr}")
    return report_of("export", done.stdout), done.stderr


def read_with(reader, path):
    done = run(reader, path)
    must(done.returncode == 0, f"{path.name} is refused: {done.stderr}{done.stdout}")
    return json.loads(done.stdout)


def node_scales(path):
    """The scales of the nodes of a GLB, by name; without those that have none."""
    data = path.read_bytes()
    size, = struct.unpack_from("<I", data, 12)
    nodes = json.loads(data[20:20 + size])["nodes"]
    return {node["name"]: node["scale"][0] for node in nodes if "scale" in node}


def colliders(program, model, folder, *options):
    """The colliders of a model as JSON, and the report."""
    output = folder / "colliders.json"
    report, _ = export(program, model, "json", output, *options)
    found = json.loads(output.read_text())
    check_schema(COLLIDERS, found, "colliders")
    must(found["error"] == report["outer_error"], f"{found['error']}, {report}")
    return found, report


def points_of(part):
    flat = part["points"]
    return [tuple(flat[i:i + 3]) for i in range(0, len(flat), 3)]


def facets_of(part):
    flat = part["triangles"]
    return [tuple(flat[i:i + 3]) for i in range(0, len(flat), 3)]


def near(found, wanted, relative=1e-12):
    scale = max(abs(x) for x in wanted) or 1
    return len(found) == len(wanted) and all(
        abs(x - y) <= relative * scale for x, y in zip(found, wanted))


def to_float(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def exactly(points):
    return [tuple(map(fractions.Fraction, p)) for p in points]


def holds(part, points):
    """Whether a part contains points, by exact arithmetic. Its facets face outwards."""
    corners = exactly(points_of(part))
    for a, b, c in facets_of(part):
        at = corners[a]
        u, v = ([q[k] - at[k] for k in range(3)] for q in (corners[b], corners[c]))
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        if any(sum(n[k] * (p[k] - at[k]) for k in range(3)) > 0 for p in points):
            return False
    return True


def must_be_closed(part):
    edges = {(t[k], t[(k + 1) % 3]) for t in facets_of(part) for k in range(3)}
    must(len(edges) == len(part["triangles"]), f"{part['name']}: an edge twice in one direction")
    must(all((b, a) in edges for a, b in edges), f"{part['name']}: not closed")
    must({i for t in facets_of(part) for i in t} == set(range(len(points_of(part)))),
         f"{part['name']}: a point without a triangle")


# --- Checks ----------------------------------------------------------------------------------


def check_json(program, folder, model):
    """An L of volume 3, whose numbers are known by hand."""
    found, report = colliders(program, model, folder)
    must(found["name"] == "colliders" and found["metres_per_unit"] == 0.001, f"{found}")
    must([p["name"] for p in found["parts"]] == ["colliders_00", "colliders_01"], "names")
    must(near([found["mass"]["volume"]], [3]) and found["mass"]["of_solid"], f"{found['mass']}")
    must(near(found["mass"]["centre"], [5 / 6, 5 / 6, 1 / 2]), f"{found['mass']}")
    # Three cubes of side 1: 1/6 each about its own centre, and the squared distances.
    away = [(x - 5 / 6, y - 5 / 6) for x, y in ((.5, .5), (1.5, .5), (.5, 1.5))]
    xx = 3 / 6 + sum(y * y for x, y in away)
    zz = 3 / 6 + sum(x * x + y * y for x, y in away)
    xy = -sum(x * y for x, y in away)
    inertia = found["mass"]["inertia"]
    must(near([inertia[0][0], inertia[1][1], inertia[2][2]], [xx, xx, zz], 1e-9), f"{inertia}")
    must(near([inertia[0][1], inertia[1][0], inertia[0][2], inertia[1][2]], [xy, xy, 0, 0], 1e-9),
         f"{inertia}")
    must(near(found["mass"]["moments"], sorted((xx + xy, xx - xy, zz)), 1e-9), "moments")
    x, y, z, w = found["mass"]["axes"]
    first = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
    must(near([abs(v) for v in first], [0.5 ** 0.5, 0.5 ** 0.5, 0], 1e-9) and
         first[0] * first[1] < 0, f"the first axis is the diagonal of the L: {first}")
    must(near([sum(p["volume"] for p in found["parts"])], [3], 1e-9), "volumes of the parts")
    must(report["of"] == "parts" and report["left_out"] == 0 and not report["visual"], f"{report}")
    for part in found["parts"]:
        must_be_closed(part)
    done = run(program, "export", model, "--for", "json", "-o", "-", "-q")
    named = json.loads(done.stdout)
    must(named["name"] == "prism" and named["mass"] == found["mass"], "JSON on standard output")
    return found


def check_glb(program, reader, folder, model, parts):
    """Nodes have the names that engines know, and corners are those of the JSON in metres, y up.
    Unity cooks meshes before nodes scale them: those that are small are written larger."""
    for engine in GLB:
        output = folder / f"{engine}.glb"
        report, said = export(program, model, engine, output)
        must(report["visual"] and report["written_up"] == "y" and not said, f"{report} {said}")
        found = read_with(reader, output)["parts"]
        names = {"godot": [f"godot_{i:02}-convcolonly" for i in range(len(parts))],
                 "unreal": [f"UCX_unreal_{i:02}" for i in range(len(parts))],
                 "unity": [f"unity_{i:02}" for i in range(len(parts))]}[engine]
        given = [p["name"] for p in found]
        must(given == [engine] + names, f"{engine}: {given}")
        must(all((p["parent"] == "colliders") == (engine == "unity") for p in found[1:]),
             f"{engine}: {[p['parent'] for p in found]}")
        must(len(found[0]["facets"]) == len(l_prism()[1]), f"{engine}: {len(found[0]['facets'])}")
        scales = node_scales(output)
        must(set(scales) == (set(names) if engine == "unity" else set()), f"{engine}: {scales}")
        for written, part in zip(found[1:], parts):
            corners = written["vertices"]
            half = sum(max(p[k] for p in corners) - min(p[k] for p in corners)
                       for k in range(3)) / 2
            must(engine != "unity" or 1 <= half < 2,
                 f"{engine}: {written['name']} is {half} large")
            scale = scales.get(written["name"], 1)
            wanted = {tuple(map(to_float, (x * .001, z * .001, -y * .001)))
                      for x, y, z in points_of(part)}
            must({tuple(scale * x for x in p) for p in corners} == wanted,
                 f"{engine}: {written['name']}")
        alone, _ = (export(program, model, engine, output, "--no-visual") if engine != "unreal"
                    else (None, None))
        if alone:
            must(len(read_with(reader, output)["parts"]) == len(parts), f"{engine} --no-visual")


def check_import_knows_names(program, folder, model, parts):
    """What was exported is imported as the same parts."""
    for engine in ("godot", "unreal", "unity"):
        output = folder / f"again_{engine}.glb"
        export(program, model, engine, output)
        done = run(program, "hull", output, "-o", folder / "hulls.obj", "--per", "node", "--format",
                   "json")
        must(done.returncode == 0, done.stderr)
        hulls = [h for h in report_of("hull", done.stdout)["hulls"] if "_0" in h["name"]]
        must(len(hulls) == len(parts), f"{engine}: {hulls}")
        for hull, part in zip(hulls, parts):
            must(hull["points"] == len(points_of(part)), f"{engine}: {hull}")
        done = run(program, "decompose", output, "--max-error", 1, "--format", "json", "--table")
        must(done.returncode == 0, done.stderr)
        rows = [r for r in report_of("decompose", done.stdout)["table"] if "_0" in r["node"]]
        must([r["vertices"] for r in rows] == [len(points_of(p)) for p in parts], f"{rows}")


def check_import_knows_tags(program, folder):
    """An L is its hull where its name says so, and stays two parts of their own elsewhere."""
    points, triangles = l_prism()
    for name, count in (("a-convcolonly", 1), ("a-convcol", 1), ("UCX_a_00", 1), ("a-colonly", 2),
                        ("a", 2)):
        source = write_obj(folder / "tagged.obj", points, triangles, f"o {name}")
        text = source.read_text() + "o other\nv 9 9 9\nv 10 9 9\nv 9 10 9\nv 9 9 10\n"
        source.write_text(text + "f 13 15 14\nf 13 14 16\nf 14 15 16\nf 13 16 15\n")
        done = run(program, "decompose", source, "--max-error", "1e-3", "--format", "json",
                   "--table")
        # The hull of an L sticks out by more than asked.
        must(done.returncode == (1 if count == 1 else 0), f"{name}: {done.stderr}")
        rows = [r for r in report_of("decompose", done.stdout)["table"]
                if r.get("node", "").endswith(name)]
        must(len(rows) == count, f"{name}: {rows}")


def baked_mesh(program, source, folder, *options):
    """The report of a bake of a mesh file, and its volume in cubic metres."""
    model = folder / "again.cdp.h5"
    done = bake(program, source, "-o", model, "--structures", "hull", "--format", "json", *options)
    report, = report_of("bake", done.stdout)["models"]
    found, _ = colliders(program, model, folder)
    return report, found["metres_per_unit"] ** 3 * found["mass"]["volume"]


def check_bake_leaves_colliders_out(program, folder):
    """What bake and validate read of an exported bolt is the bolt: its parts are left out, and
    named. They are not the bolt: its thread has grooves."""
    bolt = folder / "thread.cdp.h5"
    bake(program, SAMPLES / "bolt.obj", "-o", bolt, "--structures", "hull", "--max-error", 0.5,
         "--unit", "mm")
    kept, _ = colliders(program, bolt, folder)
    wanted, triangles = 1e-9 * kept["mass"]["volume"], 212
    of_parts = 1e-9 * sum(part["volume"] for part in kept["parts"])
    must(of_parts > 1.01 * wanted, f"{of_parts} is the volume of the bolt too")
    # The last model has the name of the node above its parts.
    names = [("godot", "left", "left_00-convcolonly"), ("unreal", "left", "UCX_left_00"),
             ("unity", "left", "colliders/left_00"),
             ("unity", "colliders", "colliders/colliders_00")]
    for engine, model, name in names:
        output = folder / f"{model}.glb"
        export(program, bolt, engine, output)
        report, volume = baked_mesh(program, output, folder)
        must(report["triangles"] == triangles and near([volume], [wanted], 1e-6),
             f"{engine}: {volume}, not {wanted}: {report}")
        said = " ".join(report["remarks"])
        must("2 colliders were left out" in said and name in said, f"{engine}: {said}")
        whole, volume = baked_mesh(program, output, folder, "--with-colliders")
        must(whole["triangles"] > triangles and "remarks" not in whole, f"{engine}: {whole}")
        must(near([volume], [wanted + of_parts], 1e-4), f"{engine}: {volume} with the parts")
        for options, count in (((), triangles), (("--with-colliders",), whole["triangles"])):
            done = run(program, "validate", output, "--format", "json", *options)
            found, = report_of("validate", done.stdout)["meshes"]
            must(found["triangles"] == count, f"{engine}: {found['triangles']} triangles")
            told = "colliders were left out" in " ".join(found.get("remarks", []))
            must(told == (not options), f"{engine}: {found.get('remarks')}")
    output = folder / "alone.glb"
    export(program, bolt, "godot", output, "--no-visual")
    report, volume = baked_mesh(program, output, folder)
    must("remarks" not in report and near([volume], [of_parts], 1e-4), f"{report}")


def check_kept_colliders_are_told(program, folder):
    """hull and decompose keep colliders, and say how many. They can leave them out too."""
    bolt, triangles = folder / "thread.cdp.h5", 212
    for engine in GLB:
        output = folder / f"kept_{engine}.glb"
        export(program, bolt, engine, output)
        for command in (("hull", "-o", folder / "hull.obj"), ("decompose",),
                        ("decompose", "--max-error", 1)):
            done = run(program, *command, output, "--format", "json")
            must("kept_" + engine in done.stderr and
                 "2 colliders are a part of the mesh: " in done.stderr and
                 "Leave them out with --without-colliders." in done.stderr,
                 f"{engine}, {command[0]}: {done.stderr}")
            report = report_of(command[0], done.stdout)
            must(report["triangles"] > triangles, f"{engine}: {done.stdout}")
            done = run(program, *command, output, "--format", "json", "--without-colliders")
            must(not done.stderr, f"{engine}, {command[0]}: {done.stderr}")
            report = report_of(command[0], done.stdout)
            must(report["triangles"] == triangles, f"{engine}: {done.stdout}")
        scene = folder / "kept.json"
        parts = [{"name": name, "model": output.name, "layer": "parts"} for name in ("a", "b")]
        scene.write_text(json.dumps({"cdprep_scene": 1, "metres_per_unit": 1, "layers": ["parts"],
                                     "objects": parts}))
        done = run(program, "query", "overlap", "--scene", scene)
        must(f"{output}: 2 colliders are a part of the mesh: " in done.stderr and
             "Leave them out by naming a baked file." in done.stderr,
             f"{engine}: {done.stderr}")


def check_package(program, model, output, names):
    """Meshes of a URDF in a ROS package; nothing else changes."""
    before = output.read_text()
    for package in ("my_robot", "my-robot.2/meshes/new"):
        export(program, model, "urdf", output, "--package", package, "--density", 8000)
        found = [e.get("filename") for e in xml.parse(output).getroot().iter("mesh")]
        must(found == [f"package://{package}/{name}" for name in names], f"{found}")
        must(output.read_text().replace(f"package://{package}/", "") == before, f"{package}")
    done = run("check_urdf", output)
    must(done.returncode == 0, f"check_urdf: {done.stderr}{done.stdout}")


def check_robots(program, reader, folder, model, parts):
    """Mass by hand: 1,000 kg a cubic metre of 3 mm^3; density 8,000 gives eight times that."""
    for engine in ROBOTS:
        output = folder / f"{engine}.{EXTENSION[engine]}"
        for density, mass in ((1000, 3e-6), (8000, 24e-6)):
            report, said = export(program, model, engine, output, "--density", density)
            must(near([report["mass"]], [mass]) and report["mass_of"] == "solid", f"{report}")
            must(report["written_up"] == "z" and report["visual"] and not said, f"{report} {said}")
        found = read_with(reader, output)
        solid = [p for p in found["parts"] if p.get("collides", True)]
        must(len(solid) == len(parts), f"{engine}: {found['parts']}")
        if engine == "urdf":
            done = run("check_urdf", output)
            must(done.returncode == 0, f"check_urdf: {done.stderr}{done.stdout}")
            link = xml.parse(output).getroot().find("link")
            must(float(link.find("inertial/mass").get("value")) == report["mass"], "URDF: mass")
            names = [e.get("filename") for e in link.iter("mesh")]
            must(names == ["urdf_visual.obj", "urdf_collider_00.obj", "urdf_collider_01.obj"],
                 f"{names}")
            must(all((folder / n).is_file() for n in names), "a mesh of the URDF is missing")
            check_package(program, model, output, names)
            continue
        must(near([found["mass"]], [mass]), f"{engine}: mass {found['mass']}")
        must(near(found["centre"], [0.5e-3 * 5 / 3, 0.5e-3 * 5 / 3, 0.5e-3]), f"{found['centre']}")
        if engine == "gazebo":
            must(found["is_valid"] and len(found["shown"]) == 1, f"{found}")
            must([p["name"] for p in found["parts"]] == ["collider_00", "collider_01"], f"{found}")
            must(all((folder / p["file"]).is_file() for p in found["parts"] + found["shown"]),
                 "a mesh of the SDF is missing")


def check_mujoco(program, reader, folder, model):
    output = folder / "free.mjcf"
    for options, positions, shown in (((), 0, 1), (("--floating",), 7, 1),
                                      (("--floating", "--no-visual"), 7, 0)):
        for old in folder.glob("free*"):
            old.unlink()
        report, _ = export(program, model, "mujoco", output, *options)
        found = read_with(reader, output)
        must(found["positions"] == positions, f"{options}: {found['positions']} positions")
        collides = [p["collides"] for p in found["parts"]]
        must(collides == [False] * shown + [True, True], f"{options}: {found['parts']}")
        must(near([found["mass"]], [report["mass"]]), f"{options}: {found['mass']}")
        must((folder / "free_visual.obj").exists() == bool(shown), f"{options}: visual mesh")
        must([p["name"] for p in found["parts"]][shown:] == ["free_00", "free_01"], f"{found}")
    # An unbalanced mesh has no volume for MuJoCo: its parts are shown instead, and it is said.
    points, triangles = l_prism()
    open_mesh = write_obj(folder / "open.obj", points, triangles[:-1])
    bake(program, open_mesh, "--structures", "hull", "--parts", 2, "--unit", "mm")
    report, _ = export(program, folder / "open.cdp.h5", "mujoco", folder / "open.xml")
    must(not report["visual"] and report["mass_of"] == "parts", f"{report}")
    found = read_with(reader, folder / "open.xml")
    must(all(p["collides"] for p in found["parts"]), f"{found}")
    done = run(program, "export", folder / "open.cdp.h5", "--for", "mujoco", "-o",
               folder / "open.xml")
    must("not balanced" in done.stdout and "overlaps count twice" in done.stdout, done.stdout)
    as_json, _ = colliders(program, folder / "open.cdp.h5", folder)
    must(not as_json["mass"]["of_solid"], f"{as_json['mass']}")


def check_points_are_dropped(program, folder):
    """Parts with fewer points enclose the stored ones and the mesh, by exact arithmetic."""
    ring = write_obj(folder / "ring.obj", *torus(40, 20))
    bracket = folder / "bracket.cdp.h5"
    bake(program, ring, "--structures", "hull", "--max-error", "0.08")
    bake(program, SAMPLES / "bracket.obj", "-o", bracket, "--structures", "hull", "--max-error", 2)
    dropped = 0
    for model in (folder / "ring.cdp.h5", bracket):
        kept, before = colliders(program, model, folder, "--keep-points")
        found, report = colliders(program, model, folder)
        must(before["growth"] == 0 and before["points"] == before["stored_points"], f"{before}")
        must(report["stored_points"] == before["points"], f"{report}")
        must(report["points"] == sum(len(points_of(p)) for p in found["parts"]), f"{report}")
        must(report["growth"] < before["outer_error"], f"{report} {before}")
        must(found["error"] <= before["outer_error"] + report["growth"], f"{report} {before}")
        must(report["low_points"] <= report["points"] / 20, f"{report}")
        dropped += before["points"] - report["points"]
        for part, old in zip(found["parts"], kept["parts"], strict=True):
            must_be_closed(part)
            must(holds(part, exactly(points_of(old))), f"{part['name']} is too small")
    must(dropped > 0, "nothing was dropped: the check tests nothing")
    found, _ = colliders(program, folder / "ring.cdp.h5", folder)
    for point in exactly(torus(40, 20)[0]):
        must(any(holds(part, [point]) for part in found["parts"]), f"{point} is outside")


def check_units(program, folder):
    """A model without a unit: one warning with size and mass, or a refusal."""
    source = write_obj(folder / "plain.obj", *box((2.0, 3.0, 4.0)))
    model = folder / "plain.cdp.h5"
    bake(program, source, "--structures", "hull", "--parts", 1)
    for engine in GLB + ROBOTS:
        output = folder / f"unit.{EXTENSION[engine]}"
        _, said = export(program, model, engine, output)
        must(said.count("\n") == 1 and "states no unit" in said and "2 x 3 x 4 m" in said, said)
        must("Bake it with --unit mm" in said, said)
        must(("24000 kg" in said) == (engine in ROBOTS), said)
        for old in folder.glob("unit*"):
            old.unlink()
        report, said = export(program, model, engine, output, "--strict", code=1)
        must("--unit mm" in said and "--unit mm" in report["error"], said)
        must(not list(folder.glob("unit*")), f"{engine}: --strict wrote something")
    _, said = export(program, model, "json", folder / "unit.json")
    must(not said, said)
    must(json.loads((folder / "unit.json").read_text())["metres_per_unit"] is None, "unit of JSON")
    normal = folder / "normal.cdp.h5"
    bake(program, source, "-o", normal, "--structures", "hull", "--parts", 1, "--unit", "mm",
         "--normalize")
    report, said = export(program, normal, "godot", folder / "unit.glb")
    # Its unit was given, but is not that of its lengths: its box has a diagonal of 1.
    must(report["metres_per_unit"] == 0 and said.count("\n") == 1, said)
    must("states no unit" not in said, said)
    for words in ("baked with --normalize, so its lengths have no unit; ",
                  "takes them as metres, 0.371391 x 0.557086 x 0.742781 m. ",
                  "Bake it without --normalize and with --unit mm"):
        must(words in said, said)
    report, said = export(program, normal, "urdf", folder / "unit.urdf", "--strict", code=1)
    must("lengths have no unit" in report["error"] and "without --normalize" in said, said)
    # The sample bolt weighs 5 g, not 5,000 t.
    bolt = folder / "bolt.cdp.h5"
    bake(program, SAMPLES / "bolt.obj", "-o", bolt, "--structures", "hull", "--unit", "mm")
    report, said = export(program, bolt, "urdf", folder / "bolt.urdf")
    must(abs(report["mass"] - 0.00501) < 1e-5 and not said, f"{report} {said}")


def check_up_axis(program, reader, folder):
    """What is up is +y in a GLB and +z in an SDF: of a box of 2 x 3 x 4 the 3 or the 4."""
    source = write_obj(folder / "upright.obj", *box((2.0, 3.0, 4.0)))
    for axis, up in (("y", 3), ("z", 4)):
        model = folder / f"up_{axis}.cdp.h5"
        bake(program, source, "-o", model, "--structures", "hull", "--unit", "m", "--up-axis", axis)
        for engine, height in (("unity", 1), ("gazebo", 2)):
            output = folder / f"up.{EXTENSION[engine]}"
            report, _ = export(program, model, engine, output)
            must(report["size"][height] == up, f"{axis} {engine}: {report['size']}")
            found = read_with(reader, output)
            if engine == "unity":
                ys = {v[1] for part in found["parts"] for v in part["vertices"]}
                must(ys == {0, up}, f"{axis}: y from {ys}")
            else:
                must(near([found["centre"][2]], [up / 2]), f"{axis}: {found['centre']}")


def check_whole(program, folder):
    """Without parts, the hull of the whole: (1.5, 1.5) is 0.5 from both arms of the L."""
    source = write_obj(folder / "whole.obj", *l_prism())
    bake(program, source, "--structures", "hull", "--unit", "m")
    found, report = colliders(program, folder / "whole.cdp.h5", folder)
    must(report["of"] == "whole" and len(found["parts"]) == 1, f"{report}")
    must(near([found["parts"][0]["volume"]], [3.5]), f"{found['parts'][0]['volume']}")
    must(0.5 <= found["error"] <= 1.03 * 0.5, f"{found['error']}")


def check_same_bytes(program, folder):
    for engine, extension in EXTENSION.items():
        texts = set()
        for jobs in (1, 4):
            output = folder / f"same.{extension}"
            export(program, folder / "ring.cdp.h5", engine, output, "-j", jobs)
            texts.add(tuple(sorted((f.name, f.read_bytes()) for f in folder.glob("same*"))))
        must(len(texts) == 1, f"{engine}: threads change something")


def check_refusals(program, folder, model):
    def refused(code, word, *arguments):
        before = {p.name for p in folder.iterdir()}
        done = run(program, "export", *arguments)
        must(done.returncode == code, f"{arguments}: exit {done.returncode}, not {code}")
        must(word in done.stderr, f"{arguments}: {done.stderr}")
        must(code == 2 or len(done.stderr.splitlines()) == 1, f"{arguments}: {done.stderr}")
        must({p.name for p in folder.iterdir()} == before, f"{arguments}: wrote something")

    refused(2, "godot, unreal, unity, mujoco, gazebo, urdf or json", model, "--for", "blender")
    refused(2, "Did you mean 'godot'?", model, "--for", "godto")
    refused(2, "--for", model)
    refused(3, "missing.cdp.h5", folder / "missing.cdp.h5", "--for", "json")
    refused(3, "Bake it first", SAMPLES / "bolt.obj", "--for", "json", "-o", folder / "x.json")
    refused(2, ".glb", model, "--for", "unity", "-o", folder / "x.fbx")
    refused(2, "is an input", model, "--for", "json", "-o", model)
    for option, engine in (("--floating", "gazebo"), ("--no-visual", "unreal"),
                           ("--no-visual", "json"), ("--strict", "json")):
        refused(2, option, model, "--for", engine, option)
    for engine in GLB + ("json",):
        refused(2, "--density", model, "--for", engine, "--density", 9)
    refused(2, "above 0", model, "--for", "urdf", "--density", "0")
    for engine in ("gazebo", "mujoco", "json"):
        refused(2, "--package", model, "--for", engine, "--package", "robot")
    for package in ("", "/robot", "robot/", "a//b", "../a", "a b", "package://a"):
        refused(2, "--package", model, "--for", "urdf", "-o", folder / "x.urdf", "--package",
                package)
    for engine, extension in EXTENSION.items():
        output = folder / "no folder" / f"x.{extension}"
        refused(4, "no folder", model, "--for", engine, "-o", output)
    plain = folder / "no_hull.cdp.h5"
    bake(program, SAMPLES / "bolt.obj", "-o", plain)
    refused(2, "--structures hull", plain, "--for", "json", "-o", folder / "x.json")
    sheet = write_obj(folder / "sheet.obj", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    bake(program, sheet, "--structures", "hull", "--parts", 1)
    refused(2, "no convex part with a volume", folder / "sheet.cdp.h5", "--for", "json", "-o",
            folder / "x.json")
    # All files or none: the mesh of the second part cannot be written.
    place = folder / "blocked"
    (place / "r_collider_01.obj").mkdir(parents=True)
    done = run(program, "export", model, "--for", "urdf", "-o", place / "r.urdf")
    must(done.returncode == 4 and "r_collider_01.obj" in done.stderr, done.stderr)
    must([p.name for p in place.iterdir()] == ["r_collider_01.obj"], "a part of a URDF was written")
    # The default output never replaces a file: it may be the source.
    (folder / "prism.glb").write_text("source")
    refused(2, "prism.glb", model, "--for", "unity")
    refused(2, "prism.glb", model, "--for", "unity", "-o", folder)
    must((folder / "prism.glb").read_text() == "source", "the source was replaced")
    for _ in range(2):
        done = run(program, "export", model, "--for", "unity", "-o", place)
        is_glb = (place / "prism.glb").read_bytes()[:4] == b"glTF"
        must(done.returncode == 0 and is_glb, done.stderr)
    done = run(program, "export", model, "--for", "unity", "-o", folder / "prism.glb")
    must(done.returncode == 0 and (folder / "prism.glb").read_bytes()[:4] == b"glTF", done.stderr)


def main():
    program, reader = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        write_obj(folder / "prism.obj", *l_prism())
        model = folder / "prism.cdp.h5"
        bake(program, folder / "prism.obj", "--structures", "hull", "--parts", 2, "--unit", "mm",
             "--up-axis", "z")
        found = check_json(program, folder, model)
        check_glb(program, reader, folder, model, found["parts"])
        check_import_knows_names(program, folder, model, found["parts"])
        check_import_knows_tags(program, folder)
        check_bake_leaves_colliders_out(program, folder)
        check_kept_colliders_are_told(program, folder)
        check_robots(program, reader, folder, model, found["parts"])
        check_mujoco(program, reader, folder, model)
        check_points_are_dropped(program, folder)
        check_units(program, folder)
        check_up_axis(program, reader, folder)
        check_whole(program, folder)
        check_same_bytes(program, folder)
        check_refusals(program, folder, model)


main()
