#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The program writes what it wrote before: files, reports and answers have recorded hashes.

That they are right is shown elsewhere. This notices what changes them: an answer, the shape of a
tree, the order of a search. Where a change is meant, --update records the new hashes; --keep
leaves everything that was written in a folder, to be compared with that of another build.
Usage: recorded_outputs.py CDPREP [--update | --keep FOLDER]
"""
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from known_meshes import CUBE
from schemas import OF_COMMANDS, report_of
from shared_models import bake, must, place_of_shared_folder, shared_folder_if_there

ROOT = pathlib.Path(__file__).resolve().parents[2]
RECORD = ROOT / "tests/data/recorded_outputs.txt"
# What differs from run to run or from machine to machine.
UNSTABLE = re.compile(r"_s(_|$)|_[mn]s$|seconds|time|machine|self_check|version|touched_bytes|"
                      "stages|dominated|next_digit|checks|errata|explained")
TIME = re.compile(rb" *\b[0-9.e-]+ [mu]?s\b")
SUM = re.compile(rb" *the rows add up to [0-9.]+ % of it")  # printed of frames of more than 10 us
PASSED = re.compile(rb", \d+ s(, \d+ %)?$")  # behind a step that takes a second

SHIFTED = "1 0 0 0 1 0 0 0 1 {} {} {}"
TURNED = "0.8 -0.6 0 0.6 0.8 0 0 0 1 {} {} {}"
POSES = "\n".join(pose.format(*place) for pose in (SHIFTED, TURNED) for place in
                  [(0, 0, 0), (23, 15, -19.5), (26, 15, -19.5), (5, 3, 1), (12, 9, 4), (40, 0, 2)])
POSES_APART = "\n".join(pose.format(*place) for pose in (SHIFTED, TURNED) for place in
                        [(50, 9, 0), (0, 0, 40), (-30, -40, 7), (3, 60, 1), (15, 10, 30)])


def write_off(path, corners, triangles):
    path.write_text(f"OFF\n{len(corners)} {len(triangles)} 0\n"
                    + "".join("{:.6f} {:.6f} {:.6f}\n".format(*c) for c in corners)
                    + "".join("3 {} {} {}\n".format(*t) for t in triangles))


def write_ring(path, around, across):
    """A torus of radii 10 and 3, as an OFF file."""
    corners = []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            reach = 10 + 3 * math.cos(b)
            corners.append((reach * math.cos(a), reach * math.sin(a), 3 * math.sin(b)))
    triangles = []
    for i in range(around):
        for j in range(across):
            a, b = i * across + j, i * across + (j + 1) % across
            c, d = (i + 1) % around * across, 0
            c, d = c + j, c + (j + 1) % across
            triangles += [(a, c, b), (b, c, d)]
    write_off(path, corners, triangles)


def write_mess(path):
    """A wavy sheet with a fold, holes, a seam, a T-junction, repeats, slivers and crossings."""
    side = 12
    corners = [(i, j, round(math.sin(i) * math.cos(j), 3)) for i in range(side)
               for j in range(side)]
    triangles = []
    for i in range(side - 1):
        for j in range(side - 1):
            a = i * side + j
            triangles += [(a, a + side, a + 1), (a + 1, a + side, a + side + 1)]
    holes = {14, 15, 60, 61, 62, 63, 120}
    triangles = [t for k, t in enumerate(triangles) if k not in holes]
    triangles[5] = triangles[5][::-1]
    triangles += [triangles[7], triangles[9][::-1], (3, 3, 4), (0, side, 2 * side)]
    seam = len(corners)  # a second sheet along an edge of the first, apart by a little
    corners += [(side - 1 + 1e-4, j, round(math.sin(side - 1) * math.cos(j), 3))
                for j in range(side)] + [(side, j, 1) for j in range(side)]
    for j in range(side - 1):
        triangles += [(seam + j, seam + side + j, seam + j + 1),
                      (seam + j + 1, seam + side + j, seam + side + j + 1)]
    cube = len(corners)  # a cube through the sheet, and a small one inside it
    for low, high in ((2.5, 5.25), (3, 4)):
        first = len(corners)
        corners += [(x, y, z - 3) for z in (low, high) for y in (low, high) for x in (low, high)]
        for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2),
                           (1, 3, 7, 5)):
            triangles += [(first + a, first + b, first + c), (first + a, first + c, first + d)]
    corners.append((3.875, 2.5, 2.25))  # in the middle of an edge, and used by one side alone
    triangles += [(cube, cube + 1, len(corners) - 1)]
    write_off(path, corners, triangles)


def write_scenes(folder):
    """Parts that meet and part, asked for everything; and a scene that asks for what is not built."""
    motions = [{"velocity": [-4, 1, 2]}, {"turn_rad_per_s": [0.5, 1, 0]},
               {"path": [{"time_s": 0, "pose": {"translation": [40, 0, 0]}},
                         {"time_s": 4, "pose": {"quaternion": [1, 1, 0, 0]}}]}]
    objects = [{"name": model, "model": model, "layer": layer, "motion": motion}
               for model, layer, motion in zip(("bolt.obj", "bracket.obj", "ring.off"),
                                               ("parts", "parts", "rings"), motions)]
    pairs = [{"layers": ["parts", "parts"], "effects": ["collide", "overlap", "distance", "contacts"],
              "max_distance": 10, "contacts": {"tolerance": 0.5, "most": 4},
              "events": ["begins", "stays", "ends"]},
             {"layers": ["rings", "parts"], "effects": ["within", "collide"], "tolerance": 2,
              "overlap": "proper"}]
    scene = {"cdprep_scene": 1, "step_s": 0.5, "duration_s": 5, "layers": ["parts", "rings"],
             "pairs": pairs, "objects": objects}
    (folder / "parts.json").write_text(json.dumps(scene))
    pairs[1]["effects"] = ["inside", "response"]
    (folder / "unbuilt.json").write_text(json.dumps(scene))
    (folder / "wrong.json").write_text(json.dumps({**scene, "$schema": 1, "colour": 2}))


def write_inputs(folder):
    for name in ("bolt.obj", "bracket.obj"):
        shutil.copy(ROOT / "samples/meshes" / name, folder / name)
    for name in ("meshes", "scenes"):  # scenes name meshes of the other folder
        shutil.copytree(ROOT / "samples" / name, folder / name)
    write_scenes(folder)
    (folder / "cube.off").write_text(CUBE)
    write_ring(folder / "ring.off", 48, 20)
    write_mess(folder / "mess.off")
    (folder / "poses.txt").write_text(POSES + "\n")
    (folder / "apart.txt").write_text(POSES_APART + "\n")
    numbers = [(k * 7919 % 1000 / 40 - 5, k * 104729 % 1000 / 50 - 4, k * 1299709 % 1000 / 60 - 6)
               for k in range(200)]
    (folder / "points.txt").write_text("".join("{} {} {}\n".format(*n) for n in numbers))
    (folder / "rays.txt").write_text("".join(
        "{} {} {} {} {} {}\n".format(*a, *b) for a, b in zip(numbers, numbers[1:])))


MODELS = ("bolt.obj", "bracket.obj", "ring.off", "mess.off")
BAKES = {
    "all": "--effects all --structures all", "plain": "", "paper":
    "--structures all --structure-preset paper", "obb": "--bounds obb", "rss": "--bounds rss",
    "lss": "--bounds lss", "pss": "--bounds pss", "levels":
    "--structures all --octree-level 4 --octree-threshold 20 --tetra-level 3 --tetra-threshold 20",
    "area": "--structures octree-adaptive --split area --octree-bounding cells", "median":
    "--structures octree-adaptive --split median --octree-bounding boxes", "caps":
    "--structures tetra-tree --bounding caps", "tetra": "--structures tetra-tree --bounding tetra",
    "parts": "--structures hull --parts 4", "tight": "--structures hull --parts 9 --max-error 1",
    "few": "--structures hull --hull-vertices 9", "normal": "--normalize --weld 0.01",
    "pieces": "--effects contacts,pieces --piece-tolerance 0.05", "mended": "--repair closed",
}
CELLS = ("octree", "octree-adaptive", "hashed-octree", "tetra-tree")


def bakes():
    """Each with the facts of its file: the file holds the versions of libraries."""
    for model in MODELS:
        for name, options in BAKES.items():
            if model == "bolt.obj" and "--parts" in options:
                continue  # ten seconds
            file = f"{model}.{name}.h5"
            yield [f"bake {model} -o {file} -q --unit mm {options}", f"info {file} --deep --format json",
                   f"rm {file}"]


def pairs(structure, poses="poses.txt"):
    return (f"bolt.obj.h5 bracket.obj.h5 --poses {poses} --structure {structure} --counts"
            " --format ndjson")


def questions():
    for structure in ("bvh", "pieces", *CELLS):
        for query in ("collide", "overlap"):
            yield [f"query {query} {pairs(structure)}"]
            yield [f"query {query} {pairs(structure)} --as solid --contact proper --skip-degenerate"]
        yield [f"query overlap ring.off.h5 mess.off.h5 --poses poses.txt --structure {structure}"
               " --counts --format ndjson"]
    for structure in CELLS:
        yield [f"query overlap {pairs(structure)} --leaf-test feito"]
        yield [f"query inside bolt.obj.h5 --points points.txt --structure {structure}"]
        if structure != "hashed-octree":
            yield [f"query overlap {pairs(structure)} --descent larger"]
    for search in ("sorted", "modulus", "mixed"):
        yield [f"query overlap {pairs('hashed-octree')} --search {search}"]
    for level in (1, 2, 3):
        yield [f"query collide {pairs('tetra-tree')} --level-of-detail {level}"]
    # On the processor depend: of touching pieces the pair of triangles, of a distance with a
    # permitted error how much of that is used.
    for structure, poses in (("bvh", "poses.txt"), ("bvh", "apart.txt"), ("pieces", "apart.txt")):
        yield [f"query distance {pairs(structure, poses)}"]
        yield [f"query distance {pairs(structure, poses)} --as solid"]
        yield [f"query distance ring.off.h5 mess.off.h5 --poses {poses} --structure {structure}"
               " --counts --format ndjson"]
    for structure in ("bvh", "pieces"):
        for tolerance in (0, 0.5, 3):
            yield [f"query within {pairs(structure)} --tolerance {tolerance} --pairs"]
        yield [f"query contacts bolt.obj.h5 bracket.obj.h5 --poses poses.txt --structure {structure}"
               " --tolerance 0.5 --manifold --format ndjson"]
    yield [f"query overlap {pairs('bvh')} --segments"]
    yield ["query collide bolt.obj.h5 bracket.obj.h5 --poses poses.txt --structure hull"]
    yield ["query distance bolt.obj.h5 bracket.obj.h5 --poses poses.txt --structure hull"]
    for model in MODELS:
        yield [f"query inside {model}.h5 --points points.txt --export inside.ply", "keep inside.ply"]
        yield [f"query closest {model}.h5 --points points.txt --format ndjson"]
        yield [f"query ray {model}.h5 --rays rays.txt --format ndjson"]
        yield [f"query inaccessible {model}.h5 --export seen.obj", "keep seen.obj"]


def questions_in_words():
    """Answers as text and as one JSON list, at poses that the options give in other ways."""
    pair = "bolt.obj.h5 bracket.obj.h5"
    for form in ("text", "json"):
        for query in ("collide", "collide --as solid", "collide --structure hull",
                      "collide --structure tetra-tree --level-of-detail 2", "overlap",
                      "overlap --count", "overlap --segments", "within --tolerance 2",
                      "within --tolerance 2 --count", "within --tolerance 2 --pairs",
                      "distance --structure hull", "contacts --tolerance 0.5 --structure pieces",
                      "contacts --tolerance 0.5 --structure pieces --manifold"):
            name, *options = query.split()
            yield [f"query {name} {pair} --poses poses.txt {' '.join(options)} --format {form}"]
        yield [f"query distance {pair} --poses apart.txt --max-distance 20 --format {form}"]
        for model in ("bracket.obj", "mess.off"):
            for query in ("inside {}.h5 --points", "closest {}.h5 --points",
                          "closest {}.h5 --max-distance 2 --points"):
                yield [f"query {query.format(model)} points.txt --format {form}"]
            yield [f"query ray {model}.h5 --rays rays.txt --format {form}"]
            yield [f"query inaccessible {model}.h5 --format {form}"]
    for query in ("collide", "overlap", "distance", "within --tolerance 1",
                  "contacts --tolerance 1"):
        for files in ("missing.h5 cube.h5", "bracket.obj.h5 missing.h5", "points.txt bolt.obj.h5",
                      "bolt.obj.h5 bolt.obj.h5 --poses points.txt",
                      "bolt.obj.h5 bolt.obj.h5 --poses missing.txt"):
            yield [f"query {query} {files}"]
    for query in ("inside {} --points {}", "closest {} --points {}", "ray {} --rays {}"):
        for files in (("missing.h5", "points.txt"), ("bolt.obj.h5", "poses.txt"),
                      ("bolt.obj.h5", "missing.txt")):
            yield ["query " + query.format(*files)]


def words_of_bakes():
    """What is said of a bake, and of the file."""
    for model in MODELS:
        for form in ("text", "json"):
            for options in ("", "--effects all", "--structures hull --hull-vertices 9", "--strict",
                            "--repair solid", "--normalize --weld 0.01 --timings"):
                yield [f"bake {model} -o out.h5 --progress none --format {form} {options}"]
            if model in ("bracket.obj", "cube.off"):
                yield [f"bake {model} -o out.h5 --progress none --format {form} --structures hull"
                       " --parts 3 --max-error 1"]
        yield [f"bake {model} -o out.h5 -q --effects all", "info out.h5", "info out.h5 --deep",
               "info out.h5 --format json"]
    for form in ("text", "json"):
        yield ["bake bolt.obj missing.obj cube.off points.txt --output-dir out --progress plain"
               f" --format {form}"]
    yield ["bake bolt.obj cube.off --output-dir out --dry-run"]
    yield ["bake bolt.obj ./bolt.obj --output-dir out"]
    yield ["bake cube.off -o ./cube.off"]


def reports():
    for model in (*MODELS, "cube.off"):
        for form in ("text", "json"):
            for options in ("", "--max-vertices 9 --per component", "--per node"):
                yield [f"hull {model} -o out.ply --format {form} {options}", "keep out.ply"]
            for options in ("", "--weld 0.001", "--steps weld,orient,drop-duplicates"):
                yield [f"repair {model} -o out.obj --format {form} {options}", "keep out.obj"]
        for options in ("--no-crossings", "--max-pairs 3", "--rule CDP0203=off",
                        "--fail-on note", "--max-issues 2 --format json"):
            yield [f"validate {model} {options}"]
        for form in ("text", "json", "ndjson", "sarif", "junit"):
            yield [f"validate {model} --format {form} --weld 0.01 --seam 0.01"]
        yield [f"validate {model} --html page.html --max-issues 5", "keep page.html"]
        yield [f"validate {model} --html page.html --rule CDP0301=error --rule CDP0204=note -q",
               "keep page.html"]
        for preset in ("safe", "closed", "solid"):
            for end in ("off", "obj", "ply", "stl"):
                yield [f"repair {model} -o out.{end} --preset {preset} --format json",
                       f"keep out.{end}"]
        yield [f"repair {model} -o out.off --preset closed --seam 0.01 --weld 0.001"
               " --drop-components 3 --hole-size 3", "keep out.off"]
        yield [f"repair {model} -o out.off --drop-components 100000 --format json"]
        for options in ("", "--max-vertices 9", "--per component", "--per node"):
            yield [f"hull {model} -o out.obj {options}", "keep out.obj"]
    for words in ("", "--format json", "CDP0203", "sliver --format json", "CDP9999"):
        yield [f"explain {words}"]


def decompositions():
    for model in ("bolt.obj", "bracket.obj", "ring.off", "cube.off"):
        for order in ("greedy", "depth-first", "breadth-first"):
            yield [f"decompose {model} -o out.obj --exact --order {order} --table", "keep out.obj"]
        yield [f"decompose {model} -o out.ply --tolerance 0.1", "keep out.ply"]
        for form in ("text", "json"):
            for options in ("--exact", "--tolerance 0.1 --normalize", "--weld 0.01 --table",
                            "--order cresting"):
                yield [f"decompose {model} -o out.obj {options} --progress none --format {form}"]
            for options in ("--max-parts 2 --max-error 0.1", "--parts 2 --table"):
                yield [f"decompose {model} -o out.obj {options} --work 5000000 --progress none"
                       f" --format {form}"]
        for options in ("--density 7850 --no-visual", "--strict", "--normalize"):
            yield [f"decompose {model} -o out/part.urdf --parts 2 --work 5000000 {options}",
                   "keep out"]
        for options in ("--parts 5", "--max-error 0.5", "--parts 6 --max-vertices 12",
                        "--parts 4 --to-surface", "--parts 3 --merge-components"):
            yield [f"decompose {model} -o out.obj {options} --work 20000000 --format json",
                   "keep out.obj"]
        for end in ("urdf", "sdf", "mjcf", "glb", "stl"):
            yield [f"decompose {model} -o out/{model}.{end} --parts 3 --work 20000000 --unit mm",
                   "keep out"]


def imports():
    """What the program writes is read again; then the shared models, where a checkout has them."""
    for end in ("ply", "stl", "obj"):
        yield [f"repair ring.off -o out.{end} --unit mm", f"validate out.{end} --format json",
               f"bake out.{end} -o out.h5 -q", "info out.h5 --format json"]
    for end in ("glb", "obj"):
        yield [f"decompose bracket.obj -o out.{end} --parts 3 --work 20000000",
               f"validate out.{end} --format json", f"hull out.{end} -o hull.obj --per node"]
    for path in shared_files():
        name = f"models/{path}"
        yield [f"validate {name} --format json"]
        if (place_of_shared_folder() / name).stat().st_size < 500_000:
            yield [f"bake {name} -o out.h5 -q --effects all", "info out.h5 --deep --format json"]
            yield [f"hull {name} -o out.obj", "keep out.obj"]
            yield [f"decompose {name} -o out.obj --exact --table", "keep out.obj"]


def shared_files():
    """The broken models and those handled wrongly before, without what takes seconds."""
    models = place_of_shared_folder() / "models"
    return [path.relative_to(models) for folder in ("found", "hard")
            for path in sorted((models / folder).rglob("*"))
            if path.is_file() and path.suffix not in {".md", ".py", ".bin"}
            and path.name not in {"cp3000.ply", "star20k.ply"}]


def studies():
    yield ["accuracy bolt.obj bracket.obj --quick --format json"]
    yield ["compare bolt.obj bracket.obj --quick --format json"]


def simulations():
    for scene in ("scenes/crates", "scenes/assembly", "parts", "unbuilt", "wrong", "none"):
        for form in ("text", "json"):
            yield [f"simulate {scene}.json --plan --format {form} -j 1"]
        for form in ("text", "json", "ndjson"):
            yield [f"simulate {scene}.json --format {form} --progress none -j 1"]
    yield ["simulate scenes/thousand.json --frames 2 -j 1"]  # each thread has memory of its own
    yield ["simulate parts.json --frames 3 --cache baked -j 1",
           "simulate parts.json --plan --cache baked -j 1"]


def clashes():
    for scene in ("scenes/assembly", "parts", "none"):
        yield [f"query distance --scene {scene}.json --max-distance 100 --progress none"]
        yield [f"query within --scene {scene}.json --tolerance 20 --progress none"]


def stable(value):
    """A report without what differs from run to run."""
    if isinstance(value, dict) and "rounds" in value:
        return sorted(value)  # a measured time, and its spread
    if isinstance(value, dict):
        return {k: stable(v) for k, v in value.items() if not UNSTABLE.search(k)}
    return [stable(each) for each in value] if isinstance(value, list) else value


def told(text):
    lines = []
    for line in text.split(b"\n"):
        try:
            lines.append(json.dumps(stable(json.loads(line))).encode())
        except ValueError:
            lines.append(TIME.sub(b" T s", SUM.sub(b"", PASSED.sub(b"", line))))
    try:
        return json.dumps(stable(json.loads(text)), indent=1).encode()
    except ValueError:
        return b"\n".join(lines)


class Outputs:
    def __init__(self, program, inputs, kept):
        self.program, self.inputs, self.kept = os.path.abspath(program), inputs, kept

    def of(self, steps):
        """The name of a case, and the hash of all that its steps write."""
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            for path in self.inputs.iterdir():
                (folder / path.name).symlink_to(path)
            parts = [self.step(folder, step.split()) for step in steps]
        data = b"\n".join(parts)
        if self.kept:
            (self.kept / re.sub(r"[^\w.-]+", "_", steps[0])[:150]).write_bytes(data)
        return steps[0], hashlib.sha256(data).hexdigest()[:16]

    def step(self, folder, words):
        if words[0] == "rm":
            (folder / words[1]).unlink(missing_ok=True)
            return b""
        if words[0] == "keep":
            path = folder / words[1]
            files = sorted(path.rglob("*")) if path.is_dir() else [path]
            return b"".join(f.read_bytes() for f in files if f.is_file())
        if "-o" in words:
            (folder / words[words.index("-o") + 1]).parent.mkdir(exist_ok=True)
        done = subprocess.run([self.program, *words], cwd=folder, capture_output=True,
                              stdin=subprocess.DEVNULL)
        if words[0] in OF_COMMANDS and "json" in words and done.stdout:
            report_of(words[0], done.stdout)
        return b"%d\n%s\n%s" % (done.returncode, told(done.stdout), told(done.stderr))


def main():
    program, options = sys.argv[1], sys.argv[2:]
    kept = pathlib.Path(options[1]) if options[:1] == ["--keep"] else None
    if kept:
        kept.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        inputs = pathlib.Path(scratch)
        write_inputs(inputs)
        for model in MODELS:
            parts = [] if model == "mess.off" else ["--parts", 3]  # it has no inside
            bake(program, inputs / model, "-o", inputs / f"{model}.h5", "-q", "--effects", "all",
                 "--structures", "all", *parts)
        outputs = Outputs(program, inputs, kept)
        (inputs / "models").symlink_to(place_of_shared_folder() / "models")
        cases = [*bakes(), *words_of_bakes(), *questions(), *questions_in_words(), *reports(),
                 *decompositions(), *imports(), *studies(), *simulations(), *clashes()]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            found = dict(pool.map(outputs.of, cases))
    must(len(found) == len(cases), "two cases have one name")
    if options == ["--update"]:
        RECORD.write_text("".join(f"{hashed}  {name}\n" for name, hashed in found.items()))
        return
    recorded = {line[18:]: line[:16] for line in RECORD.read_text().splitlines()}
    if not shared_folder_if_there():
        print("skipped: the part about shared models, which are not there (set CDPREP_SHARED)")
        recorded = {name: hashed for name, hashed in recorded.items() if " models/" not in name}
    changed = [name for name in {**recorded, **found} if recorded.get(name) != found.get(name)]
    must(not changed, f"{len(changed)} of {len(found)} outputs differ from {RECORD.name}:\n  "
         + "\n  ".join(changed))
    print(f"{len(found)} outputs are as recorded")


main()
