#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Nothing is lost in an import without a word: parts that are missing, empty files, packages of 3MF,
units, and the files that were once read wrongly.

Usage: imports.py CDPREP
"""
import json
import pathlib
import re
import sys
import tempfile
import zipfile

from schemas import report_of
from shared_models import bake, must, run, shared_models_if_there

try:
    import h5py
except ImportError:
    h5py = None

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
RELATIONSHIPS = """<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"""
MESH = """<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1.000000000001" y="0" z="0"/>
<vertex x="0" y="2" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/>
<triangle v1="0" v2="0" v3="{corner}"/></triangles></mesh>"""


def model(body, extensions=""):
    return (f'<?xml version="1.0"?><model unit="inch" xmlns="{CORE}" xmlns:p="{PRODUCTION}" '
            f'xmlns:b="http://example.org/balls" {extensions}>{body}</model>')


def package(path, root, parts=()):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", RELATIONSHIPS)
        archive.writestr("3D/3dmodel.model", root)
        for name, content in parts:
            archive.writestr(name, content)


def placed(use, corner=2):
    """A model that uses object 1, a mesh, as `use` says."""
    return model(f'<resources><object id="1" name="leaf">{MESH.format(corner=corner)}</object>'
                 f'</resources><build>{use}</build>')


def validated(program, path, code=None):
    done = run(program, "validate", path, "--format", "json")
    must(code is None or done.returncode == code,
         f"validate {path} exited {done.returncode}: {done.stdout}{done.stderr}")
    return report_of("validate", done.stdout)["meshes"][0]


def refused(program, path, *words, options=()):
    done = run(program, "bake", path, "-o", path.with_suffix(".cdp.h5"), *options)
    must(done.returncode == 3 and all(word in done.stderr for word in words),
         f"bake {path} exited {done.returncode}: {done.stderr}")
    must(not path.with_suffix(".cdp.h5").exists(), f"{path} left a bake")


def info(program, path):
    return report_of("info", run(program, "info", path, "--format", "json").stdout)


def packages_of_3mf(program, folder):
    """Items, components in other parts, transforms, units, triangles as they are."""
    file = folder / "a.3mf"
    package(file, placed('<item objectid="1"/><item objectid="1" '
                         'transform="0 1 0 -1 0 0 0 0 1 10 20 30"/>'))
    bake(program, file, "-o", folder / "a.cdp.h5")
    said = info(program, folder / "a.cdp.h5")
    must(said["triangles"] == 4, f"two items of two triangles: {said['triangles']}")
    must(said["metres_per_unit"] == 0.0254 and said["up_axis"] == "z", f"unit and axis: {said}")
    # Row vectors: (1.000000000001, 0, 0) goes to (10, 21.000000000001, 30), in double.
    (folder / "points").write_text("10 21.000000000001 30\n")
    done = run(program, "query", "closest", folder / "a.cdp.h5", "--points", folder / "points",
               "--format", "ndjson")
    answer = json.loads(done.stdout)
    must(answer["found"] and answer["upper"] < 1e-14, f"the second item lies elsewhere: {answer}")

    components = ('<resources><object id="7"><components><component objectid="1" '
                  'p:path="/3D/parts/leaf.model" transform="1 0 0 0 1 0 0 0 1 5 0 0"/><component '
                  'objectid="1" p:path="/3D/parts/leaf.model"/></components></object></resources>'
                  '<build><item objectid="7"/></build>')
    needs = 'requiredextensions="p"'
    package(file, model(components, needs), [("3D/parts/leaf.model", placed(""))])
    must(validated(program, file)["triangles"] == 4, "components of another part")

    package(file, placed('<item objectid="1"/>', corner=3))
    report = validated(program, file, 1)
    must(report["counts"]["out_of_range_triangles"] == 1, "an index out of range was lost")

    refusals = [
        (model(components, needs), [], ["3D/parts/leaf.model", "missing"]),
        (placed('<item objectid="2"/>'), [], ["object 2", "does not exist"]),
        (model('<resources><object id="1"><b:ball/></object></resources><build><item objectid="1"/>'
               "</build>"), [], ["object 1", "neither triangles nor components"]),
        (model('<resources><object id="1"><components><component objectid="1"/></components>'
               '</object></resources><build><item objectid="1"/></build>'), [],
         ["object 1", "contains itself"]),
        (model("<resources/><build/>", 'requiredextensions="b"'), [], ["http://example.org/balls"]),
        (placed(""), [], ["no triangle"]),
        (placed('<item objectid="1" transform="1 2"/>'), [], ["12 finite numbers"]),
        ("<model", [], ["3D/3dmodel.model", "XML"]),
    ]
    for root, parts, words in refusals:
        package(folder / "bad.3mf", root, parts)
        refused(program, folder / "bad.3mf", *words)
    whole = file.read_bytes()
    for size in range(2, len(whole), 7):
        (folder / "cut.3mf").write_bytes(whole[:size])
        refused(program, folder / "cut.3mf", "cut.3mf")


def corners_of_3mf(program, folder, root):
    """Of a 3MF file: each triangle's corners in source order, nodes, and metres per unit."""
    package(folder / "b.3mf", root)
    bake(program, folder / "b.3mf", "-o", folder / "b.cdp.h5")
    with h5py.File(folder / "b.cdp.h5") as file:
        data = file["cdprep"]
        stored = data["positions_f64" if "positions_f64" in data else "positions_f32"][:].tolist()
        corners = zip(data["source_triangle"][:], data["triangles"][:])
        found = [[stored[v] for v in triangle] for _, triangle in sorted(corners, key=lambda c: c[0])]
        nodes = bytes(data["instance_names"][:]).decode().split("\0")[:-1]
    first = [triangle.index(min(triangle)) for triangle in found]
    return ([triangle[k:] + triangle[:k] for triangle, k in zip(found, first)], nodes,
            info(program, folder / "b.cdp.h5")["metres_per_unit"])


def corners_of_3mf_files(program, folder):
    """Every number of a transform, every unit, and elements with a prefix."""
    transform = "1 2 3 4 5 7 6 8 9 10 11 12"
    root = placed(f'<item objectid="1" transform="{transform}"/>').replace("1.000000000001", "1")
    found, nodes, _ = corners_of_3mf(program, folder, root)
    must(found[0] == [[10, 11, 12], [11, 13, 15], [18, 21, 26]], f"rows of a transform: {found}")
    must(nodes == ["build/leaf"], f"names: {nodes}")
    for unit, metres in (("micron", 1e-6), ("millimeter", 1e-3), ("centimeter", 1e-2),
                         ("foot", 0.3048), ("meter", 1), ("", 1e-3)):
        said = corners_of_3mf(program, folder, root.replace('unit="inch"', f'unit="{unit}"'))[2]
        must(said == metres, f"{unit}: {said}")
    prefixed = root.replace(f'xmlns="{CORE}"', f'xmlns:m="{CORE}"')
    prefixed = re.sub(r"<(/?)(?!\?)(\w)", r"<\1m:\2", prefixed)
    must(corners_of_3mf(program, folder, prefixed)[0] == found, "elements with a prefix")
    twice = placed('<item objectid="1"/><item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>')
    both = corners_of_3mf(program, folder, twice.replace("1.000000000001", "1"))[0]
    must(both[2] == [[-1, 0, 0], [0, 0, 0], [0, 2, 0]], f"a mirrored item is turned: {both}")


def wrong_numbers_of_3mf(program, folder):
    plain = placed('<item objectid="1"/>')
    for old, new, words in (
            ('y="2"', 'y="two"', ['y="two"', "not a number"]),
            ('v2="1"', 'v2="-1"', ['v2="-1"', "not a vertex number"]),
            ('v2="1"', "", ['v2=""', "not a vertex number"]),
            ("</mesh>", "<beamlattice/></mesh>", ["beams, which are not supported"]),
            ('unit="inch"', 'unit="yard"', ['"yard"', "not a unit of 3MF"])):
        package(folder / "bad.3mf", plain.replace(old, new))
        refused(program, folder / "bad.3mf", *words)
    package(folder / "bad.3mf", placed('<item objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0 inf"/>'))
    refused(program, folder / "bad.3mf", "12 finite numbers")


def damaged_parts_of_3mf(program, folder):
    """One digit of a part is changed, so that its checksum is wrong."""
    root = placed('<item objectid="1"/>')
    with zipfile.ZipFile(folder / "stored.3mf", "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("_rels/.rels", RELATIONSHIPS)
        archive.writestr("3D/3dmodel.model", root)
    whole = (folder / "stored.3mf").read_bytes()
    must(validated(program, folder / "stored.3mf")["triangles"] == 2, "a stored package")
    (folder / "stored.3mf").write_bytes(whole.replace(b'y="2"', b'y="9"'))
    refused(program, folder / "stored.3mf", "3D/3dmodel.model", "CRC")


def source(name, values, stride, parameter):
    return (f'<source id="{name}">{values}<technique_common><accessor source="#{name}a" count="1" '
            f'stride="{stride}"><param {parameter}/></accessor></technique_common></source>')


# A triangle whose only bone is 5 away.
SKIN = ('<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>'
        '<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">'
        '0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#pa" count="3" '
        'stride="3"><param name="X" type="float"/><param name="Y" type="float"/>'
        '<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">'
        '<input semantic="POSITION" source="#p"/></vertices><triangles count="1">'
        '<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh>'
        '</geometry></library_geometries><library_controllers><controller id="c">'
        '<skin source="#g">' +
        source("j", '<Name_array id="ja" count="1">bone</Name_array>', 1,
               'name="JOINT" type="name"') +
        source("b", '<float_array id="ba" count="16">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array>',
               16, 'name="TRANSFORM" type="float4x4"') +
        source("w", '<float_array id="wa" count="1">1</float_array>', 1,
               'name="WEIGHT" type="float"') +
        '<joints><input semantic="JOINT" source="#j"/>'
        '<input semantic="INV_BIND_MATRIX" source="#b"/></joints><vertex_weights count="3">'
        '<input semantic="JOINT" source="#j" offset="0"/>'
        '<input semantic="WEIGHT" source="#w" offset="1"/><vcount>1 1 1</vcount>'
        '<v>0 0 0 0 0 0</v></vertex_weights></skin></controller></library_controllers>'
        '<library_visual_scenes><visual_scene id="s"><node id="n"><instance_controller url="#c">'
        '<skeleton>#bone</skeleton></instance_controller></node><node id="bone" sid="bone" '
        'type="JOINT"><translate>5 0 0</translate></node></visual_scene></library_visual_scenes>'
        '<scene><instance_visual_scene url="#s"/></scene></COLLADA>')


def skins_that_are_not_applied(program, folder):
    """Every command that reads such a mesh says so."""
    file = folder / "skin.dae"
    file.write_text(SKIN)
    words = "1 mesh has a skin or morph weights, which are not applied"
    must(words in validated(program, file)["remarks"][0], "validate is silent on a skin")
    done = run(program, "bake", file, "-o", folder / "skin.cdp.h5")
    must(done.returncode == 0 and words in done.stdout, f"bake: {done.stdout}{done.stderr}")
    for command in (["hull", "-o", folder / "h.obj"], ["repair", "-o", folder / "r.obj"],
                    ["decompose"]):
        done = run(program, command[0], file, *command[1:])
        must(words in done.stderr, f"{command} is silent on a skin: {done.stdout}{done.stderr}")


def missing_parts(program, folder):
    (folder / "s.lws").write_text("LWSC\n3\n\nLoadObjectLayer 1 gone.lwo\nShowObject 5 7\n\n"
                                  "LoadObjectLayer 1 lost.lwo\nShowObject 5 7\n")
    refused(program, folder / "s.lws", "gone.lwo", "lost.lwo")


def empty_files(program, folder):
    for name, content, word in (("lfs.obj", "version https://git-lfs.github.com/spec/v1\n", "LFS"),
                                ("page.obj", "<!DOCTYPE html><html></html>", "web page"),
                                ("any.obj", "hello\n", "--allow-empty"),
                                ("points.obj", "v 0 0 0\nv 1 0 0\n", "2 vertices")):
        (folder / name).write_text(content)
        refused(program, folder / name, name, word)
        for command in (["validate"], ["hull", "-o", folder / "h.obj"],
                        ["repair", "-o", folder / "r.obj"], ["decompose"]):
            done = run(program, command[0], folder / name, *command[1:])
            must(done.returncode == 3 and word in done.stderr,
                 f"{command} {name} exited {done.returncode}: {done.stderr}")
    done = run(program, "bake", folder / "points.obj", "--allow-empty")
    must(done.returncode == 0, f"--allow-empty exited {done.returncode}: {done.stderr}")


def sources_and_units(program, folder):
    """What was read, and what was said about it, stands in the file."""
    (folder / "t.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for options, metres, axis in (([], 0, "unknown"), (["--unit", "mm"], 0.001, "unknown"),
                                  (["--unit", "in", "--up-axis", "y"], 0.0254, "y"),
                                  (["--unit", "ft", "--up-axis", "z"], 0.3048, "z")):
        bake(program, folder / "t.obj", *options)
        said = info(program, folder / "t.cdp.h5")
        must((said["metres_per_unit"], said["up_axis"]) == (metres, axis), f"{options}: {said}")
        text = run(program, "info", folder / "t.cdp.h5").stdout
        unit = options[1] if options else "unknown"
        must(f"unit: {unit}, up axis: {axis}\n" in text, f"{options}: {text}")


def files_read_wrongly_once(program):
    """The models that are not ours: triangles, or the words of the refusal."""
    expected = {"lws/in.lws": 22144, "lws/miss.lws": ["missing.lwo"], "pyramids.3mf": 3276,
                "production_components.3mf": 8, "counterX.3MF": 8080, "nff1.nff": 3,
                "WithCamera.nff": 15362, "inspired_mesh_quads_Conjugate.off": 3266,
                "sparse100m.gltf": ["inside.bin"],
                "issue-140-zero-face-idx.obj": ["vertex 0", "from 1"]}
    found = 0
    for name, wanted in expected.items():
        for path in shared_models_if_there("found/" + name):
            found += 1
            report = validated(program, path)
            if isinstance(wanted, int):
                must(report["triangles"] == wanted, f"{name}: {report['triangles']} triangles")
                continue
            done = run(program, "bake", path, "-o", "/dev/null")
            must(done.returncode == 3 and all(word in done.stderr for word in wanted),
                 f"{name} exited {done.returncode}: {done.stderr}")
    print(f"{found} of {len(expected)} files that were read wrongly once")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        packages_of_3mf(program, folder)
        if h5py is None:
            print("skipped: the corners of 3MF files: no h5py")
        else:
            corners_of_3mf_files(program, folder)
        wrong_numbers_of_3mf(program, folder)
        damaged_parts_of_3mf(program, folder)
        skins_that_are_not_applied(program, folder)
        missing_parts(program, folder)
        empty_files(program, folder)
        sources_and_units(program, folder)
    files_read_wrongly_once(program)


main()
