#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep query overlap|within|distance --scene: the clashes of an assembly are those of single
queries about each pair; threads, formats and the cache change nothing; transforms of glTF nodes are
never lost; mistakes have their exit codes.

Usage: clash.py CDPREP
"""
import base64
import itertools
import json
import math
import pathlib
import random
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time

from schemas import check_schema, schema_of
from shared_models import IS_SLOW, bake, must, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "samples/scenes"
SCHEMA = schema_of("query/clash")
IDENTITY = (1, 0, 0, 0, 1, 0, 0, 0, 1)


# --- Meshes and files ----------------------------------------------------------------------


def cube(half=0.5):
    corners = [(x * half, y * half, z * half) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def star(seed):
    """A closed spiky surface around the origin, of floats with few bits."""
    radii = random.Random(seed)
    rows, columns = 7, 9
    points = [(0, 0, -1), (0, 0, 1)]
    for row in range(1, rows):
        for column in range(columns):
            r = radii.choice((0.5, 0.75, 1))
            u, v = math.pi * row / rows - math.pi / 2, 2 * math.pi * column / columns
            points.append(tuple(round(r * x * 256) / 256 for x in (
                math.cos(u) * math.cos(v), math.cos(u) * math.sin(v), math.sin(u))))
    at = lambda row, column: 2 + (row - 1) * columns + column % columns
    triangles = []
    for c in range(columns):
        triangles += [(0, at(1, c + 1), at(1, c)), (1, at(rows - 1, c), at(rows - 1, c + 1))]
        for r in range(1, rows - 1):
            triangles += [(at(r, c), at(r, c + 1), at(r + 1, c)),
                          (at(r, c + 1), at(r + 1, c + 1), at(r + 1, c))]
    return points, triangles


def gltf(meshes, nodes, roots=None, **buffer):
    """The document, and the bytes of its buffer."""
    data, views, accessors = b"", [], []

    def add(content, **accessor):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(content)})
        data += content
        accessors.append({"bufferView": len(views) - 1, **accessor})
        return len(accessors) - 1

    listed = []
    for points, triangles in meshes:
        primitive = {"attributes": {"POSITION": add(
            struct.pack(f"<{3 * len(points)}f", *itertools.chain(*points)), componentType=5126,
            count=len(points), type="VEC3")}}
        primitive["indices"] = add(
            struct.pack(f"<{3 * len(triangles)}I", *itertools.chain(*triangles)),
            componentType=5125, count=3 * len(triangles), type="SCALAR")
        listed.append({"primitives": [primitive]})
    document = {"asset": {"version": "2.0"}, "meshes": listed, "nodes": nodes,
                "accessors": accessors, "bufferViews": views,
                "buffers": [{"byteLength": len(data), **buffer}]}
    if roots is not None:
        document["scenes"] = [{"nodes": roots}]
    return document, data


def write_gltf(path, meshes, nodes, roots=None, **members):
    """Writes .gltf with the buffer in the text, or .glb. `members` are more of the document."""
    document, data = gltf(meshes, nodes, roots)
    document.update(members)
    if path.suffix == ".gltf":
        document["buffers"][0]["uri"] = (
            "data:application/octet-stream;base64," + base64.b64encode(data).decode())
        path.write_text(json.dumps(document))
        return path
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) +
                     struct.pack("<I4s", len(text), b"JSON") + text +
                     struct.pack("<I4s", len(data), b"BIN\0") + data)
    return path


# --- Running -------------------------------------------------------------------------------


def clashes(program, effect, scene, *arguments):
    """The clashes and the summary, held to the schema."""
    done = run(program, "query", effect, "--scene", scene, *arguments)
    must(done.returncode == 0, f"{scene} {arguments} exited {done.returncode}: {done.stderr}")
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    for line in lines:
        check_schema(SCHEMA, line, f"{effect} {scene}")
    must("summary" in lines[-1], f"{scene}: the last line is no summary")
    summary = lines[-1]["summary"]
    must(summary["clashes"] + summary["undecided"] == len(lines) - 1, f"{summary}")
    must(summary["clashes"] <= summary["queried"] <= summary["candidates"] <=
         summary["pairs_possible"], f"{summary}")
    return lines[:-1], summary


def without_times(summary):
    return {key: value for key, value in summary.items() if key != "seconds_per_pair"}


def pose_text(rotation, translation):
    return " ".join(map(repr, (*rotation, *translation)))


def single(program, effect, a, b, *arguments):
    """The answer about two objects (file, rotation, translation), without the number of its pose."""
    done = run(program, "query", effect, a[0], b[0], "--pose-a", pose_text(*a[1:]), "--pose-b",
               pose_text(*b[1:]), "--placement", "world", "--format", "ndjson", *arguments)
    must(done.returncode == 0, done.stderr)
    answer = json.loads(done.stdout)
    del answer["pose"]
    return answer


VERDICT = {"overlap": "hit", "within": "within", "distance": "found"}


def expected(program, effect, placed, *arguments, is_asked=lambda a, b: True):
    """What single queries say about pairs of named objects."""
    found = []
    for a, b in itertools.combinations(placed, 2):
        if not is_asked(a, b):
            continue
        answer = single(program, effect, placed[a], placed[b], *arguments)
        if answer[VERDICT[effect]] or answer.get("containment") == "unknown":
            found.append({"a": a, "b": b, "effect": effect, **answer})
    return found


QUARTERS = (IDENTITY, (0, -1, 0, 1, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, -1, 0, 1, 0),
            (0, 0, 1, 0, 1, 0, -1, 0, 0))


def matrix(rotation, translation):
    """As glTF lists it: column by column."""
    rows = [(*rotation[3 * i:3 * i + 3], translation[i]) for i in range(3)] + [(0, 0, 0, 1)]
    return [rows[row][column] for column in range(4) for row in range(4)]


class Heap:
    """Objects in exact poses, two meshes used by many nodes, below a moved root."""

    def __init__(self, program, folder, count=11, reach=7, shift=(8, -4, 0.5)):
        self.meshes = [star(1), star(2), cube()]
        files = []
        for i, mesh in enumerate(self.meshes):
            files.append(folder / f"mesh{i}.cdp.h5")
            bake(program, write_gltf(folder / f"mesh{i}.glb", [mesh], [{"mesh": 0}]), "-o",
                 files[-1], "--effects", "collide,overlap,distance,within")
        places = random.Random(5)
        self.placed, self.nodes, self.objects = {}, [], []
        for i in range(count):
            mesh, rotation = i % 3, QUARTERS[places.randrange(4)]
            at = tuple(places.randrange(-reach, reach + 1) / 4 for _ in range(3))
            world = tuple(x + y for x, y in zip(at, shift))
            name = f"part {i}"
            self.nodes.append({"name": name, "mesh": mesh, "matrix": matrix(rotation, at)})
            self.placed[f"root/{name}"] = (files[mesh], rotation, world)
            rows = [[*rotation[3 * k:3 * k + 3], world[k]] for k in range(3)]
            self.objects.append({"name": f"root/{name}", "model": files[mesh].name,
                                 "layer": "abc"[mesh], "pose": {"matrix": rows}})
        self.nodes.append({"name": "root", "children": list(range(count)), "translation": shift})
        self.glb = write_gltf(folder / "heap.glb", self.meshes, self.nodes, [count])


def the_heap(program, folder):
    """Every answer is that of a single query, with every option."""
    heap = Heap(program, folder, 6 if IS_SLOW else 11)
    every = math.comb(len(heap.placed), 2)
    cases = [("overlap", []), ("overlap", ["--count"]), ("overlap", ["--segments"]),
             ("overlap", ["--as", "solid", "--count"]),
             ("overlap", ["--contact", "proper", "--skip-degenerate"]),
             ("within", ["--tolerance", 0.25]), ("within", ["--tolerance", 0.25, "--count"]),
             ("within", ["--tolerance", 0.25, "--pairs"]),
             ("within", ["--tolerance", 0]),
             ("distance", ["--max-distance", 0.75]),
             ("distance", ["--max-distance", 2, "--as", "solid"]),
             ("distance", ["--max-distance", 100]),
             ("distance", ["--max-distance", 2, "--relative-error", 0.5])]
    for effect, arguments in cases[::3] if IS_SLOW else cases:
        found, summary = clashes(program, effect, heap.glb, *arguments)
        oracle = expected(program, effect, heap.placed, *arguments)
        must(found == oracle, f"{effect} {arguments}: {len(found)} clashes, not {len(oracle)}:\n"
             f"{[x for x in found if x not in oracle][:1]}\n"
             f"{[x for x in oracle if x not in found][:1]}")
        must(summary["objects"] == len(heap.placed) and summary["models"] == 3 and
             summary["pairs_possible"] == every and summary["rounding"] == 0, f"{summary}")
        all_of_them = 100 in arguments
        must(every > len(found) > 0 or all_of_them, f"{effect} {arguments} says nothing")
        must(not all_of_them or len(found) == every == summary["queried"], f"{summary}")
        is_wide = all_of_them or IS_SLOW and 2 in arguments  # no box of six is farther from another
        must(is_wide or summary["candidates"] < every, f"no pair was pruned: {summary}")
    # Text and JSON say the same.
    found, summary = clashes(program, "overlap", heap.glb)
    whole = run(program, "query", "overlap", "--scene", heap.glb, "--format", "json")
    document = json.loads(whole.stdout)
    check_schema(SCHEMA, document, "--format json")
    must(document["clashes"] == found, "json and ndjson differ")
    must(without_times(document["summary"]) == without_times(summary), f"{document['summary']}")
    text = run(program, "query", "overlap", "--scene", heap.glb, "--format", "text", "--count")
    lines = text.stdout.splitlines()
    must(lines[0] == f"{found[0]['a']} and {found[0]['b']}: hit, {found[0]['count']} pairs", lines[0])
    must(f"{len(found)} clashes" in lines[-1] and f"{len(heap.placed)} objects of 3 models" in lines[-1], lines[-1])
    nothing = run(program, "query", "within", "--scene", write_gltf(
        folder / "one.gltf", [cube()], [{"mesh": 0}]), "--tolerance", 1, "--format", "json")
    document = json.loads(nothing.stdout)
    check_schema(SCHEMA, document, "one object")
    must(document["clashes"] == [] and document["summary"]["pairs_possible"] == 0, f"{document}")


def the_distant_heap(program, folder):
    """Far from 0 no more pairs of boxes meet: there, a float is 16 times an object."""
    summaries = []
    for shift in ((0, 0, 0), (2**27, -2**27, 2**27)):
        heap = Heap(program, folder, 60, 12, shift)
        found, summary = clashes(program, "overlap", heap.glb, "--count")
        must(len(found) > 10, f"{summary}")
        summaries.append((found, summary["candidates"]))
    (near, few), (far, some) = summaries
    must(near == far, "other clashes far from 0")
    must(few <= some <= 1.1 * few, f"{few} candidates near 0, {some} far from it")


def the_default_distance(program, folder):
    """1 % of the diagonal of the box: here of 3 x 4 x 12, so 0.13."""
    at = lambda *translation: {"mesh": 0, "translation": translation}
    scene = write_gltf(folder / "far.gltf", [cube()],
                       [at(0.5, 0.5, 0.5), at(1.625, 0.5, 0.5), at(0.5, 1.75, 0.5),
                        at(2.5, 3.5, 11.5)])
    found, summary = clashes(program, "distance", scene)
    must(abs(summary["max_distance"] - 0.13) < 1e-5, f"{summary}")
    must([(line["a"], line["b"]) for line in found] == [("node_0", "node_1")], f"{found}")
    must(found[0]["lower"] <= 0.125 <= found[0]["upper"] < 0.12500001, f"{found}")


def the_forms(program, folder):
    """A scene file, .gltf, a buffer beside it, threads and the cache give the same lines."""
    heap = Heap(program, folder, 60, 12)
    lines = lambda scene, *more: run(program, "query", "distance", "--scene", scene,
                                     "--max-distance", 1, *more)
    one = lines(heap.glb, "-j", 1)
    must(one.returncode == 0, one.stderr)
    head, _, last = one.stdout.rstrip("\n").rpartition("\n")
    must(head.count("\n") > 40, f"little happens: {one.stdout}")
    scene = folder / "heap.json"
    scene.write_text(json.dumps({"cdprep_scene": 1, "layers": ["a", "b", "c"],
                                 "objects": heap.objects}))
    inline = write_gltf(folder / "heap.gltf", heap.meshes, heap.nodes, [60])
    document, data = gltf(heap.meshes, heap.nodes, [60], uri="heap.bin")
    (folder / "heap.bin").write_bytes(data)
    (folder / "beside.gltf").write_text(json.dumps(document))
    cache = folder / "a cache/deep"
    for arguments in ((heap.glb, "-j", 4), (scene,), (scene, "-j", 4), (inline,),
                      (folder / "beside.gltf",), (heap.glb, "--cache", cache),
                      (heap.glb, "--cache", cache, "-j", 3)):
        other = lines(*arguments)
        must(other.returncode == 0, other.stderr)
        body, _, summary = other.stdout.rstrip("\n").rpartition("\n")
        must(body == head, f"{arguments} gives other lines")
        told = [without_times(json.loads(text)["summary"]) for text in (summary, last)]
        must({**told[0], "scene": ""} == {**told[1], "scene": ""}, f"{arguments}: {told}")
    files = sorted(cache.iterdir())
    must(len(files) == 3, f"instances do not share a file: {files}")
    # A changed buffer is another source.
    changed_at = [file.stat().st_mtime_ns for file in files]
    (folder / "heap.bin").write_bytes(data)
    lines(folder / "beside.gltf", "--cache", cache)
    beside = len(list(cache.iterdir()))
    (folder / "heap.bin").write_bytes(data[:4] + struct.pack("<f", 0.5) + data[8:])
    must(lines(folder / "beside.gltf", "--cache", cache).stdout.rpartition("\n{")[0] != head,
         "a changed buffer is not noticed")
    must(len(list(cache.iterdir())) >= beside, "the cache lost files")
    must([file.stat().st_mtime_ns for file in files] == changed_at, "the cache was not used")


def turned(axis, angle):
    """A unit quaternion x, y, z, w, rounded to floats as exporters do."""
    length = math.hypot(*axis)
    exact = [math.sin(angle / 2) * x / length for x in axis] + [math.cos(angle / 2)]
    return list(struct.unpack("<4f", struct.pack("<4f", *exact)))


def the_transforms(program, folder):
    """Scales, shears and mirrors are applied. The oracle: each node alone, flattened by bake."""
    mesh = star(3)
    nodes = [
        {"name": "plain", "mesh": 0},
        {"name": "turned", "mesh": 0, "translation": [3, 0, 0], "rotation": turned((1, 2, 3), 1)},
        {"name": "turned", "mesh": 0, "translation": [-3, 0, 0], "rotation": turned((3, 1, 0), 2)},
        {"name": "half", "children": [4, 5], "scale": [0.5, 0.5, 0.5], "translation": [0, 3, 0]},
        {"name": "a", "mesh": 0, "rotation": turned((0, 1, 1), 3)},
        {"name": "b", "mesh": 0, "translation": [0, 4, 0], "rotation": turned((1, 1, 1), 0.5)},
        {"name": "long", "mesh": 0, "scale": [1, 3, 1], "translation": [0, -5, 0],
         "rotation": turned((1, 0, 1), 1)},
        {"name": "mirror", "mesh": 0, "scale": [-1, 1, 1], "translation": [0, 0, 3]},
        {"name": "mirror", "mesh": 0, "scale": [-1, 1, 1], "translation": [0, 0, 6]},
        {"name": "skew", "children": [10], "scale": [2, 1, 1], "translation": [0, 0, -4]},
        {"name": "below", "mesh": 0, "rotation": turned((0, 0, 1), math.pi / 4)},
        {"name": "flat", "mesh": 0, "scale": [1, 1, 0], "translation": [4, 4, 0]}]
    roots = [0, 1, 2, 3, 6, 7, 8, 9, 11]
    scene = write_gltf(folder / "transforms.glb", [mesh], nodes, roots)
    names = ["plain", "turned", "turned#2", "half/a", "half/b", "long", "mirror", "mirror#2",
             "skew/below", "flat"]
    # plain and turned, both halves, long, both mirrors, skew, flat.
    found, summary = clashes(program, "distance", scene, "--max-distance", 100)
    must(summary["objects"] == 10 and summary["models"] == 6, f"{summary}")
    must(0 < summary["rounding"] < 1e-6, f"{summary}")
    must([line["a"] for line in found[:9]] == ["plain"] * 9, f"{found[:9]}")
    must([line["b"] for line in found[:9]] == names[1:], f"{[line['b'] for line in found[:9]]}")
    alone = []
    for path in ([0], [1], [2], [3, 4], [3, 5], [6], [7], [8], [9, 10], [11]):
        chain = [dict(nodes[number]) for number in path]
        for depth, node in enumerate(chain):
            node.pop("children", None)
            if depth + 1 < len(chain):
                node["children"] = [depth + 1]
        alone.append(folder / f"alone{len(alone)}.cdp.h5")
        bake(program, write_gltf(folder / "alone.gltf", [mesh], chain, [0]), "-o", alone[-1])
    for line, (a, b) in zip(found, itertools.combinations(alone, 2), strict=True):
        one = single(program, "distance", (a, IDENTITY, (0, 0, 0)), (b, IDENTITY, (0, 0, 0)))
        must(abs(one["lower"] - line["lower"]) < 2e-6, f"{line} is not {one}")
    # A mirror turns a surface inside out, unless its faces are turned too: then solids are.
    inside = [{"mesh": 0, "scale": [-1, 1, 1]}, {"mesh": 1}]
    found, summary = clashes(program, "overlap", write_gltf(
        folder / "mirrored.gltf", [cube(), cube(0.25)], inside), "--as", "solid")
    must([(line["hit"], line["count"], line["containment"], line["winding"]) for line in found] ==
         [(True, 0, "yes", 1)], f"{found}")
    # Sizes that differ are different models, however little: the transforms are exact.
    sizes = [{"mesh": 0, "scale": [s, s, s], "translation": [4 * i, 0, 0]}
             for i, s in enumerate((2, 2.0000001, 2.001, 1.0001, 1, 0.001))]
    _, summary = clashes(program, "distance", write_gltf(
        folder / "sizes.gltf", [cube()], sizes), "--max-distance", 100)
    must(summary["models"] == 6 and summary["rounding"] == 0, f"{summary}")


def the_names(program, folder):
    """Nodes of the same path get numbers, also where such a name is taken."""
    nodes = [{"name": name, "mesh": 0} for name in ("x", "x#2", "x", "x", "y/x", "")]
    nodes += [{"name": "y", "children": [7]}, {"name": "x", "mesh": 0}]
    found, _ = clashes(program, "overlap", write_gltf(
        folder / "names.gltf", [cube()], nodes, [0, 1, 2, 3, 4, 5, 6]), "--count")
    names = [found[0]["a"]] + [line["b"] for line in found[:6]]
    must(names == ["x", "x#2", "x#3", "x#4", "y/x", "node_5", "y/x#2"], f"{names}")
    must(len(found) == 21, f"{len(found)} clashes of 7 cubes in one place")


def the_touching(program, folder):
    """Known by hand: cubes that share a face, an edge or a corner, or are one bit apart."""
    gap = 1 + 2 ** -52
    places = {"centre": (0, 0, 0), "face": (1, 0, 0), "edge": (-1, -1, 0), "corner": (1, -1, 1),
              "apart": (0, gap, 0)}
    nodes = [{"name": name, "mesh": 0, "translation": at} for name, at in places.items()]
    scene = write_gltf(folder / "touching.gltf", [cube()], nodes)
    with_centre = lambda lines: [line["b"] for line in lines if line["a"] == "centre"]
    found, _ = clashes(program, "overlap", scene)
    must(with_centre(found) == ["face", "edge", "corner"], f"{found}")
    found, _ = clashes(program, "overlap", scene, "--contact", "proper")
    must(with_centre(found) == ["face"], f"a shared face is area: {found}")
    found, _ = clashes(program, "within", scene, "--tolerance", 0)
    must(with_centre(found) == ["face", "edge", "corner"], f"{found}")
    found, _ = clashes(program, "within", scene, "--tolerance", 2 ** -52)
    must(with_centre(found) == ["face", "edge", "corner", "apart"], f"{found}")
    found, _ = clashes(program, "distance", scene, "--max-distance", 0)
    must(with_centre(found) == ["face", "edge", "corner"], f"{found}")
    must(all(line["upper"] == 0 for line in found), f"{found}")


def the_pairs(program, folder):
    """Only paired layers are asked, with what the file says of them unless options say more."""
    heap = Heap(program, folder, 24, 10)
    members = {"cdprep_scene": 1, "layers": ["a", "b", "c"], "objects": heap.objects}
    scene = folder / "pairs.json"
    layer = {entry["name"]: entry["layer"] for entry in heap.objects}

    def ask(pairs, effect, *arguments):
        scene.write_text(json.dumps({**members, "pairs": pairs}))
        return clashes(program, effect, scene, *arguments)

    def choose(lines, layers):
        return [line for line in lines if {layer[line["a"]], layer[line["b"]]} == layers]

    def oracle(layers, effect, *arguments):
        return expected(program, effect, heap.placed, *arguments,
                        is_asked=lambda a, b: {layer[a], layer[b]} == layers)

    near = {"layers": ["b", "a"], "effects": ["within"], "tolerance": 0.25}
    nearer = {"layers": ["c", "c"], "effects": ["within", "collide"], "tolerance": 0.0625}
    found, summary = ask([near, nearer], "within")
    must(summary["tolerance"] == 0.25 and summary["objects"] == 24 and
         summary["pairs_possible"] == 64 + 28, f"{summary}")
    must(choose(found, {"a", "b"}) == oracle({"a", "b"}, "within", "--tolerance", 0.25), "a, b")
    must(choose(found, {"c"}) == oracle({"c"}, "within", "--tolerance", 0.0625), "c, c")
    must(len(found) == len(choose(found, {"a", "b"})) + len(choose(found, {"c"})), "others")
    found, summary = ask([near], "within", "--tolerance", 0.5)
    must(found == oracle({"a", "b"}, "within", "--tolerance", 0.5) and found, "--tolerance")
    must(summary["objects"] == 16 and summary["models"] == 2, f"{summary}")
    # The file says that bodies are solid; the option that they are not.
    solid = {"layers": ["a", "b"], "effects": ["collide"], "body": "solid"}
    found, _ = ask([solid], "overlap", "--count")
    must(found == oracle({"a", "b"}, "overlap", "--count", "--as", "solid") and
         "containment" in found[0], "solid")
    found, _ = ask([solid], "overlap", "--count", "--as", "surface")
    must("containment" not in found[0], "--as surface")
    far = {"layers": ["a", "a"], "effects": ["distance"], "max_distance": 0.5}
    found, summary = ask([far], "distance")
    must(found == oracle({"a"}, "distance", "--max-distance", 0.5) and found and
         summary["max_distance"] == 0.5, f"{summary}")
    found, summary = ask([], "overlap")
    must(found == [] and summary["objects"] == summary["pairs_possible"] == 0, f"{summary}")
    # A pair that states no tolerance is not asked, and a sentence says so.
    mixed = {"layers": ["b", "b"], "effects": ["collide"]}
    found, summary = ask([mixed, near], "within")
    must(found == oracle({"a", "b"}, "within", "--tolerance", 0.25) and found and
         summary["objects"] == 16 and summary["pairs_possible"] == 64, f"{summary}")
    told = run(program, "query", "within", "--scene", scene).stderr
    must("pairs.json: 1 of 2 pairs of layers states no tolerance, and is not queried. Give "
         "--tolerance to query all." in told, told)
    found, summary = ask([mixed, near], "within", "--tolerance", 0.5)
    must(summary["pairs_possible"] == 64 + 28 and
         choose(found, {"b"}) == oracle({"b"}, "within", "--tolerance", 0.5), f"{summary}")
    # The sample's layers state a tolerance and a distance. The bolt begins 40 mm above.
    found, summary = clashes(program, "distance", SCENES / "assembly.json", "--max-distance", 50)
    must(len(found) == 1 and summary["models"] == 2, f"{found} {summary}")
    must(clashes(program, "within", SCENES / "assembly.json")[0] == [], "the bolt is not near yet")


def the_crates(program, folder):
    """By hand: of the pairs of layers one has a tolerance. One of its two crates lies on the
    ground."""
    found, summary = clashes(program, "within", SCENES / "crates.json")
    must([(line["a"], line["b"]) for line in found] == [("ground", "sliding")], f"{found}")
    must(summary["objects"] == 3 and summary["pairs_possible"] == 2 and
         summary["tolerance"] == 0.25, f"{summary}")


def the_thousand(program, folder):
    """Cubes of edge 1 with parallel faces: their surfaces meet if they do, and the distance of
    others is that of their boxes."""
    scene = json.loads((SCENES / "thousand.json").read_text())
    layers, places = {}, []
    for entry in scene["objects"]:
        start = entry.get("pose", {"translation": [0, 0, 0]})["translation"]
        grid = entry["instances"]
        for z, y, x in itertools.product(*map(range, reversed(grid["counts"]))):
            layers.setdefault(entry["layer"], []).append(len(places))
            places.append((f"{entry['name']}[{x},{y},{z}]", tuple(
                s + i * d for s, i, d in zip(start, (x, y, z), grid["spacing"]))))
    must(len(places) == 1000, f"{len(places)} crates")
    gap = lambda p, q: math.hypot(*(max(0, abs(x - y) - 1) for x, y in zip(p, q)))
    both = (("resting", "flying"), ("flying", "crossing"))
    for effect, reach, paired in (("overlap", 0, both), ("within", 0.25, both[1:]),
                                  ("distance", 0.5, both)):
        oracle = [(a, b) for first, second in paired
                  for a, b in itertools.product(layers[first], layers[second])
                  if abs(places[a][1][0] - places[b][1][0]) <= 1 + reach
                  and gap(places[a][1], places[b][1]) <= reach]
        arguments = ["--max-distance", reach] if effect == "distance" else []
        found, _ = clashes(program, effect, SCENES / "thousand.json", *arguments)
        must([(line["a"], line["b"]) for line in found] ==
             [(places[a][0], places[b][0]) for a, b in sorted(oracle)],
             f"{effect}: {len(found)} clashes, not {len(oracle)}")
        must(len(oracle) > 50, f"{effect}: {len(oracle)} clashes say little")
        for line, (a, b) in zip(found, sorted(oracle)):
            exact = gap(places[a][1], places[b][1])
            must(effect != "distance" or
                 line["lower"] - 1e-12 <= exact <= line["upper"] + 1e-12, f"{line} is not {exact}")


def the_progress(program, _folder):
    """It counts pairs up to their number, the same on one thread as on two."""
    counts = []
    for threads in (1, 2):
        done = run(program, "query", "within", "--scene", SCENES / "thousand.json", "--tolerance",
                   0.25, "-j", threads, "--progress", "plain")
        told = re.findall(r"^(\d+)/(\d+) pairs$", done.stderr, re.MULTILINE)
        must(done.returncode == 0 and len(told) > 2, f"-j {threads}: {done.stderr}")
        steps, totals = zip(*((int(step), int(total)) for step, total in told))
        must(list(steps) == sorted(set(steps)) and steps[0] == 0, f"-j {threads}: {steps}")
        must(set(totals) == {steps[-1]}, f"-j {threads}: {told}")
        counts.append(steps[-1])
    must(counts[0] == counts[1] > 50, f"{counts} pairs")


def mistakes(program, folder):
    good = write_gltf(folder / "good.glb", [cube()], [{"mesh": 0}, {"mesh": 0}])
    crate = folder / "crate.cdp.h5"
    bake(program, SCENES / "crate.obj", "-o", crate, "--effects", "collide")
    text = folder / "text.gltf"
    text.write_text("{\"asset\": ")
    document, _ = gltf([cube()], [{"mesh": 0}], uri="missing.bin")
    (folder / "buffer.gltf").write_text(json.dumps(document))
    (folder / "cut.glb").write_bytes(good.read_bytes()[:-40])
    empty = write_gltf(folder / "empty.gltf", [], [{"name": "camera"}])
    range_of = write_gltf(folder / "range.glb", [([(0, 0, 0)], [(0, 1, 2)])], [{"mesh": 0}] * 2)
    huge = write_gltf(folder / "huge.gltf", [cube()], [{"mesh": 0, "name": "far",
                                                        "translation": [1e305, 0, 0]}])
    cycle = write_gltf(folder / "cycle.gltf", [cube()], [{"mesh": 0, "children": [0]}], [0])
    scene = lambda name, **members: (folder / name).write_text(json.dumps(
        {"cdprep_scene": 1, "layers": ["a"], **members})) and folder / name
    objects = [{"name": name, "model": "crate.cdp.h5", "layer": "a"} for name in "xy"]
    unserved = scene("unserved.json", objects=objects)
    no_tolerance = scene("tolerance.json", objects=objects,
                         pairs=[{"layers": ["a", "a"], "effects": ["collide"]}])
    bad = scene("bad.json", objects=[{"name": "x", "model": "none.obj", "layer": "b"}])
    tolerance = ["--tolerance", 1]
    cases = [
        ("overlap", [folder / "none.glb"], 3, ["none.glb"]),
        ("overlap", [folder / "none.json"], 3, ["none.json"]),
        ("overlap", [text], 3, ["text.gltf"]),
        ("overlap", [folder / "buffer.gltf"], 3, ["missing.bin"]),
        ("overlap", [folder / "cut.glb"], 3, ["cut.glb"]),
        ("overlap", [empty], 3, ["empty.gltf: has no node with triangles"]),
        ("overlap", [range_of], 3, ["range.glb/node_0: triangle 0 uses vertex 1"]),
        ("overlap", [huge], 3, ["huge.gltf: the transform of node 'far' has the number 1e+305"]),
        ("overlap", [cycle], 3, ["cycle.gltf: node 0 is its own descendant"]),
        ("overlap", [bad], 3, ["bad.json: line 1: /objects/0/model: there is no file",
                               "/objects/0/layer: 'b' is not a layer"]),
        ("distance", [unserved], 2, ["crate.cdp.h5: its layer 'a' needs distance",
                                     "--effects collide,distance."]),
        ("within", [good], 2, ["good.glb: the scene states no tolerance. Give --tolerance."]),
        ("within", [no_tolerance], 2, ["tolerance.json: no pair of layers states a tolerance. Give "
                                       "--tolerance."]),
        ("within", [good, "--tolerance", -1], 2, ["--tolerance", "0 or more"]),
        ("distance", [good, "--max-distance", -1], 2, ["--max-distance", "0 or more"]),
        ("overlap", [good, "--pose", "1 0 0 0 1 0 0 0 1 0 0 0"], 2,
         ["--pose has no meaning with --scene"]),
        ("overlap", [good, "--structure", "octree"], 2, ["--structure has no meaning with"]),
        ("overlap", [good, crate, crate], 2, ["a has no meaning with --scene"]),
        ("overlap", [good, "--cache", text], 4, ["text.gltf"]),
        ("within", [good, *tolerance, "--progress", "loud"], 2, ["loud"]),
    ]
    for effect, arguments, code, words in cases:
        done = run(program, "query", effect, "--scene", *arguments)
        must(done.returncode == code, f"{effect} {arguments} exited {done.returncode}: {done.stderr}")
        must(not done.stdout, f"{arguments} printed {done.stdout}")
        for word in words:
            must(word in done.stderr, f"{arguments}: '{word}' is not in {done.stderr}")
    for arguments, words in ((["overlap", crate, crate, "--cache", folder],
                              "--cache has no meaning without --scene"),
                             (["overlap", crate], "b is required: The second baked model"),
                             (["distance"], "a is required: The first baked model"),
                             (["within", crate, crate], "--tolerance is required"),
                             (["collide", "--scene", good], "--scene")):
        done = run(program, "query", *arguments)
        must(done.returncode == 2 and words in done.stderr, f"{arguments}: {done.stderr}")
    done = run(program, "simulate", unserved)
    must(done.returncode == 3 and "the key 'pairs' is missing" in done.stderr, done.stderr)


def an_interrupt(program, folder):
    """A heap whose pairs take minutes ends within a moment."""
    points = star(9)
    nodes = [{"mesh": 0, "translation": [i / 1024, 0, 0]} for i in range(2000)]
    scene = write_gltf(folder / "dense.glb", [points], nodes)
    running = subprocess.Popen([program, "query", "overlap", "--scene", scene],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(1.5)
    must(running.poll() is None, "the heap is no work")
    begun = time.monotonic()
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=20)
    must(running.returncode == 130, f"interrupted, it exited {running.returncode}: {told}")
    must(time.monotonic() - begun < 5, "the interrupt took long")


def main():
    program = sys.argv[1]
    for check in (the_heap, the_distant_heap, the_default_distance, the_forms, the_transforms,
                  the_names, the_touching, the_pairs, the_crates, the_thousand,
                  the_progress, mistakes, an_interrupt):
        with tempfile.TemporaryDirectory() as scratch:
            check(program, pathlib.Path(scratch))


if __name__ == "__main__":
    main()
