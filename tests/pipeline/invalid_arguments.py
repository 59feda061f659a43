#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Messages and exit codes: an invalid argument, an unreadable input or an unwritable output
gives one sentence that names it, and changes nothing.

Usage: invalid_arguments.py CDPREP
"""
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

from killed_bake import digest, write_sheet
from schemas import report_of
from shared_models import bake, must, run

IDENTITY = "1 0 0 0 1 0 0 0 1 0 0 0"


def write_touching(path, count):
    """Pairs of tetrahedra: the tip of one touches the top of the other, within a triangle. Notes
    say so, and no warning."""
    corners = [(0, 0, 0), (8, 0, 0), (0, 8, 0), (2, 2, -4), (2, 2, 0), (1, 1, 2), (4, 1, 2),
               (1, 4, 2)]
    triangles = [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2), (5, 6, 7), (4, 6, 5), (4, 7, 6),
                 (4, 5, 7)]
    path.write_text(
        f"OFF\n{8 * count} {8 * count} 0\n"
        + "".join(f"{x + 10 * i} {y} {z}\n" for i in range(count) for x, y, z in corners)
        + "".join("3 {} {} {}\n".format(*(8 * i + v for v in triangle))
                  for i in range(count) for triangle in triangles))


def write_triangle(folder):
    """A glTF file with its buffer in buffer.bin, and a link to the buffer."""
    numbers = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    (folder / "buffer.bin").write_bytes(struct.pack("<9f", *numbers))
    (folder / "triangle.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"uri": "buffer.bin", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}]}))
    (folder / "buffer.obj").symlink_to(folder / "buffer.bin")
    (folder / "triangle.json").write_text(json.dumps({
        "cdprep_scene": 1, "layers": ["all"],
        "objects": [{"name": name, "model": "triangle.gltf", "layer": "all"} for name in "ab"],
        "pairs": [{"layers": ["all", "all"], "effects": ["overlap"]}]}))


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    write_sheet(folder / "sheet.off", 4)
    (folder / "again").mkdir()
    write_sheet(folder / "again" / "sheet.off", 5)
    model = folder / "sheet.cdp.h5"
    bake(program, folder / "sheet.off")
    must(model.exists(), "without -o the output is not beside the input")
    before = digest(model)
    for name, unit in (("mm", "mm"), ("inches", "in")):
        run(program, "bake", folder / "sheet.off", "--unit", unit, "--effects", "contacts",
            "--structures", "hull", "-o", folder / f"{name}.cdp.h5")
    (folder / "units.json").write_text(json.dumps({
        "cdprep_scene": 1, "layers": ["all"],
        "objects": [{"name": name, "model": f"{name}.cdp.h5", "layer": "all"}
                    for name in ("mm", "inches")],
        "pairs": [{"layers": ["all", "all"], "effects": ["distance"]}]}))
    (folder / "text.cdp.h5").write_text("not a bake " * 1000)
    (folder / "a folder").mkdir()
    (folder / "notes.xyz").write_text("1 2 3\n")
    write_touching(folder / "touching.off", 64)  # a search of few triangles ends before a limit
    (folder / "still rays").write_text("0 0 1 0 0 1\n0 0 0 0 0 0\n")
    (folder / "link.off").symlink_to(folder / "sheet.off")
    (folder / "same").symlink_to(folder)
    (folder / "list").write_text(f"{folder / 'sheet.off'}\n")
    links = [folder / "link.off", folder / "same" / "sheet.off", folder / "hard.off"]
    (folder / "latest").symlink_to(folder / "new")
    os.link(folder / "sheet.off", folder / "hard.off")
    write_triangle(folder)
    (folder / "kept.toml").write_text("[validate]\nmax-issues = 3\n")
    triangle, buffer = folder / "triangle.gltf", folder / "buffer.bin"
    read = [folder / "sheet.off", folder / "list", buffer, folder / "kept.toml"]
    known = [digest(path) for path in read]
    (folder / "poses").write_text(IDENTITY + "\n1 0 0 0 1 0 0 0 -1 0 0 0\n")
    (folder / "words").write_text(IDENTITY + "\n1 0 0 0 1 0 0 0 x 0 0 0\n")
    (folder / "empty poses").write_text("# none\n")
    pair = ["query", "overlap", model, model]

    cases = [  # arguments, exit code, words of the sentence
        ([], 2, ["a command is missing", "bake"]),
        (["bake"], 2, ["input is required: Mesh files", "'cdprep bake input'"]),
        (["frobnicate"], 2, ["'frobnicate'", "is not a command. Choose from bake"]),
        (["bakee", folder / "sheet.off"], 2, ["Did you mean 'bake'?"]),
        (["valdiate", folder / "sheet.off"], 2, ["Did you mean 'validate'?"]),
        (["query", "colide", model, model], 2, ["cdprep query: 'colide'", "'collide'"]),
        (["query"], 2, ["a command is missing", "collide"]),
        (["bake", folder / "sheet.off", "--no-such-option"], 2, ["not an option", "--help"]),
        (["bake", folder / "sheet.off", "--outptu", "x"], 2, ["Did you mean '--output'?"]),
        (["query", "within", model, model, "--tolerence", "3"], 2, ["'--tolerance'"]),
        (["info", "--dep", model], 2, ["Did you mean '--deep'?"]),
        (["info", model, model], 2, ["one argument too many", "'cdprep info file'"]),
        (["bake", folder / "sheet.off", "-o"], 2, ["--output needs a value"]),
        (["bake", folder / "sheet.off", "-o", "a", "-o", "b"], 2, ["--output", "more than once"]),
        (["bake", folder / "sheet.off", "-j", "99999"], 2, ["--jobs", "'99999'", "from 0 to 4096"]),
        (["bake", folder / "sheet.off", "--weld", "1e9"], 2, ["--weld 1e+09", "diagonal"]),
        (["decompose", folder / "sheet.off", "--weld", "1e9"], 2, ["--weld 1e+09", "diagonal"]),
        (["repair", folder / "sheet.off", "-o", folder / "x.ply", "--weld", "1e9"], 2,
         ["--weld 1e+09"]),
        (["bake", folder / "sheet.off", "--unit", "yard"], 2, ["--unit", "mm, cm, m, in or ft"]),
        (["bake", folder / "sheet.off", "--up-axis", "w"], 2, ["--up-axis", "y or z"]),
        (["bake", folder / "sheet.off", "--effects", "colide"], 2, ["Did you mean 'collide'?"]),
        (["bake", folder / "sheet.off", "--structures", "octre"], 2, ["Did you mean 'octree'?"]),
        (["bake", folder / "sheet.off", "-o", "-"], 2, ["binary"]),
        (["repair", folder / "sheet.off", "-o", folder / "x.ply", "--time", "-3"], 2,
         ["'-3' is not a finite number of seconds, 0 or more."]),
        (["repair", folder / "sheet.off", "-o", folder / "x.ply", "--steps", "weldd"], 2,
         ["Did you mean 'weld'?"]),
        *((["repair", folder / "sheet.off", "-o", folder / "x.ply", *options], 2, words)
          for options, words in (
              (["--seam-width", "0.01"],
               ["--seam-width has no effect with the preset safe: choose --preset closed or solid, "
                "or remove the option."]),
              (["--seam", "0", "--preset", "safe"], ["--seam-width has no effect"]),
              (["--hole-size", "3"], ["--hole-size has no effect", "safe", "closed or solid"]),
              (["--time", "3", "--preset", "closed"],
               ["--time has no effect with the preset closed: choose --preset solid"]),
              (["--seam-width", "0.01", "--steps", "weld,fill-holes"],
               ["--seam-width has no effect: add stitch-seams or resolve-t-junctions to --steps"]),
              (["--hole-size", "3", "--steps", "stitch-seams"], ["add fill-holes to --steps"]),
              (["--weld", "0.01", "--steps", "orient"], ["add weld to --steps"]))),
        *((["repair", folder / "sheet.off", "-o", folder / "x.ply", *options], 0, [])
          for options in (["--seam-width", "0.01", "--steps", "weld,resolve-t-junctions"],
                          ["--seam-width", "0.01", "--steps", "stitch-seams"],
                          ["--hole-size", "3", "--time", "3", "--steps",
                           "fill-holes,resolve-self-intersections"])),
        (["bake", folder / "sheet.off", "--piece-tolerance", "0.1"], 2,
         ["--piece-tolerance has no effect: add pieces, contacts or response to --effects"]),
        (["bake", folder / "sheet.off", "--effects", "ray,inside", "--piece-tolerance", "0"], 2,
         ["--piece-tolerance has no effect"]),
        *((["bake", folder / "sheet.off", "-o", folder / "tolerant", "--effects", effect,
            "--piece-tolerance", "0.1"], 0, []) for effect in ("pieces", "contacts", "response")),
        (["bake", folder / "touching.off", "--strict", "--max-pairs", "1"], 1,
         ["touching.off: the search for crossing triangles ended early, at --max-pairs 1, after",
          "--strict requires a complete search: raise --max-pairs"]),
        (["bake", folder / "touching.off", "-o", folder / "touched", "--strict"], 0, []),
        (["query", "ray", model, "--rays", folder / "still rays"], 3,
         ["still rays: line 2", "is 0 0 0; at least one of the three must not be 0."]),
        (["hull", folder / "sheet.off", "-o", folder / "x.ply", "--max-vertices", "2"], 2,
         ["from 4 to"]),
        (["decompose", folder / "sheet.off", "--parts", "0"], 2, ["1 or more"]),
        (["decompose", folder / "sheet.off", "--parts", "3", "--density", "0"], 2, ["above 0"]),
        (["query", "collide", folder / "sheet.off", model], 3, ["Bake it first with 'cdprep bake "]),
        (["info", folder / "sheet.off"], 3, ["Bake it first with 'cdprep bake "]),
        (["bake", model], 3, ["is a baked model"]),
        (["query", "collide", model], 2, ["b is required: The second baked model", "collide a b'"]),
        (["query", "ray", model], 2, ["--rays is required: A file with rays"]),
        (["explain", "slivr"], 2, ["Did you mean 'sliver'?"]),
        (["validate", folder / "sheet.off", "--rule", "slivr=off"], 2, ["Did you mean 'sliver'?"]),
        (["bake", folder / "missing.off"], 3, ["missing.off"]),
        (["bake", folder / "a folder"], 3, ["a folder"]),
        (["bake", folder / "notes.xyz"], 3, ["notes.xyz", "unsupported format"]),
        (["bake", "/dev/null", "-o", folder / "null"], 3, ["/dev/null"]),
        (["bake", folder / "sheet.off", folder / "again" / "sheet.off", "--output-dir",
          folder / "out"], 2, [str(folder / "sheet.off"), "again/sheet.off"]),
        (["bake", folder / "sheet.off", folder / "again" / "sheet.off", "-o", model], 2,
         ["again/sheet.off"]),
        (["bake", folder / "sheet.off", "-o", model, "--output-dir", folder], 2, []),
        (["bake", folder / "sheet.off", "-o", folder / "sheet.off"], 2, ["sheet.off"]),
        (["bake", folder / "sheet.off", "-o", folder / "no" / "m.cdp.h5"], 4, [str(folder / "no"), "does not exist"]),
        (["bake", folder / "sheet.off", "--output-dir", model], 4, ["sheet.cdp.h5"]),
        *(([command, folder / "sheet.off", f"{option}={word}"], 2,
           [f"{option}: '{word}' is not a finite number of 0 or more."])
          for command, option in (("bake", "--weld"), ("validate", "--weld"),
                                  ("validate", "--seam-width"))
          for word in ("-1", "nan", "inf", "abc", "1e999")),
        (["bake", folder / "sheet.off", "--progress", "loud"], 2, ["loud"]),
        (["bake", folder / "sheet.off", "--import-file-size", "10"], 5, ["sheet.off"]),
        (["bake", folder / "sheet.off", "-j", "-1"], 2, []),
        (["bake", folder / "sheet.off", "--import-memory", "-1"], 2, ["such as 500MB"]),
        (["bake", folder / "sheet.off", "--import-memory", "0"], 2, ["from 1B to 1PB"]),
        (["bake", folder / "sheet.off", "--import-memory", "2XB"], 2, ["'2XB'", "500MB"]),
        (["bake", folder / "sheet.off", "--import-time", "-1"], 2, []),
        (["decompose", folder / "sheet.off", "--exact", "--parts", "3"], 2,
         ["--exact and --parts cannot be given together."]),
        (["info", folder / "text.cdp.h5"], 3, ["text.cdp.h5"]),
        (["info", folder / "missing.cdp.h5"], 3, ["missing.cdp.h5"]),
        (["info", folder / "a folder"], 3, ["a folder"]),
        (["info", folder / "sheet.off"], 3, ["sheet.off"]),
        (["reindex", folder / "text.cdp.h5"], 3, ["text.cdp.h5"]),
        (["query", "overlap", model], 2, []),
        (["query", "within", model, model], 2, ["--tolerance"]),
        (["query", "within", model, model, "--tolerance", "-1"], 2, ["--tolerance"]),
        (["query", "within", model, model, "--tolerance", "near"], 2, ["--tolerance"]),
        (["query", "within", model, model, "--tolerance", "1", "--pairs", "--count"], 2,
         ["--pairs"]),
        (["query", "distance", model, model, "--relative-error", "-1"], 2, ["--relative-error"]),
        (["query", "distance", model, model, "--repeat", "0"], 2, ["--repeat"]),
        (["query", "overlap", model, folder / "missing.cdp.h5"], 3, ["missing.cdp.h5"]),
        ([*pair, "--pose", "1 2 3"], 2, ["found 3 numbers", "expected 12"]),
        ([*pair, "--pose", "1 0 0 0 1 0 0 0 1 0 0 nan"], 2, ["nan"]),
        ([*pair, "--pose", "2 0 0 0 1 0 0 0 1 0 0 0"], 2, ["scales or shears"]),
        ([*pair, "--poses", folder / "poses"], 3, ["poses", "line 2", "mirrors"]),
        ([*pair, "--poses", folder / "words"], 3, ["words", "line 2", "'x'"]),
        ([*pair, "--poses", folder / "missing"], 3, ["missing"]),
        ([*pair, "--poses", folder / "poses", "--pose", IDENTITY], 2, []),
        ([*pair, "--poses", folder / "poses", "--pose-a", IDENTITY, "--pose-b", IDENTITY], 2,
         ["--pose"]),
        ([*pair, "--pose", IDENTITY, "--pose-b", IDENTITY, "--pose-a", IDENTITY], 2, ["--pose"]),
        ([*pair, "--structure", "octree"], 2, ["octree"]),
        ([*pair, "--structure", "nonsense"], 2, ["nonsense"]),
        ([*pair, "--as", "liquid"], 2, ["liquid"]),
        ([*pair, "--format", "xml"], 2, ["xml"]),
        (["query", "inside", model], 2, ["--points"]),
        ([*pair, "--poses", folder / "empty poses"], 0, []),
        (["validate"], 2, ["--files-from"]),
        (["validate", folder / "sheet.off", "--fail-on", "panic"], 2, ["panic", "explain"]),
        (["validate", folder / "sheet.off", "--rule", "sliver"], 2, ["sliver", "="]),
        (["validate", folder / "sheet.off", "--rule", "slivers=off"], 2, ["slivers", "explain"]),
        (["validate", folder / "sheet.off", "--rule", "sliver=loud"], 2, ["loud"]),
        (["validate", folder / "sheet.off", "--rule", "sliver=off", "--fail-on", "CDP0203"], 2,
         ["CDP0203"]),
        (["validate", folder / "sheet.off", "--format", "xml"], 2, ["xml"]),
        (["validate", folder / "sheet.off", "--max-issues", "-1"], 2, []),
        (["validate", folder / "sheet.off", "--weld", "inf"], 2, ["--weld"]),
        (["validate", folder / "sheet.off", "--seam", "-1"], 2, []),
        (["validate", folder / "sheet.off", "-j", "-1"], 2, []),
        (["validate", folder / "sheet.off", "--progress", "loud"], 2, ["loud"]),
        (["validate", folder / "sheet.off", "-o", folder / "sheet.off"], 2, ["sheet.off"]),
        (["validate", folder / "sheet.off", "-o", folder / "no" / "report"], 4, ["report"]),
        (["validate", "--files-from", folder / "list", "-o", folder / "list"], 2, ["list"]),
        *(([*words, buffer], 2, ["buffer.bin is an input or another output"]) for words in (
            ["validate", triangle, "-o"], ["validate", folder / "sheet.off", triangle, "-o"],
            ["validate", triangle, "--format", "json", "-o"], ["bake", triangle, "-o"],
            ["compare", triangle, "--quick", "-o"],
            ["accuracy", folder / "sheet.off", triangle, "--quick", "-o"],
            ["simulate", triangle, "--frames", "1", "-o"],
            ["simulate", folder / "triangle.json", "--frames", "1", "-o"],
            ["simulate", folder / "triangle.json", "--plan", "--format", "json", "-o"])),
        *(([command, triangle, *words, "-o", folder / "buffer.obj"], 2,
           ["buffer.obj is an input or another output"]) for command, *words in (
               ["hull"], ["repair"], ["decompose"], ["decompose", "--parts", "2"])),
        *((["--config", folder / "kept.toml", command, folder / "sheet.off", "-o",
            folder / "kept.toml"], 2, ["kept.toml is an input"])
          for command in ("validate", "bake")),
        (["validate", folder / "sheet.off", "-o", folder / "new", "--html", folder / "latest"], 2,
         ["latest is an input or another output"]),
        (["compare", ""], 2, ["the value is empty."]),
        (["accuracy", "", folder / "sheet.off"], 2, ["the value is empty."]),
        (["bake", ""], 2, ["the value is empty."]),
        *(([*pair, option, ""], 2, [f"{option}: the value is empty."])
          for option in ("--pose", "--poses", "--pose-a", "--pose-b")),
        *((["query", "inside", model, "--points", folder / "points.ply", "--export", output], 2,
           [f"{output} is an input or another output"])
          for output in (folder / "points.ply", model)),
        (["query", "inaccessible", model, "--export", model], 2, ["is an input or another output"]),
        *((["repair", *words], 2, ["cdprep repair: --output: the value is empty."])
          for words in (["--output=", folder / "sheet.off"], ["--output", "", folder / "sheet.off"],
                        [folder / "sheet.off", "--output="])),
        *(([*words, "validate", folder / "sheet.off"], 2, ["--config: the value is empty."])
          for words in (["--config", ""], ["--config="])),
        (["query", "distance", model, model, "--repeat", "0x2"], 2, ["'0x2' is not a whole number"]),
        *(([*question, folder / "mm.cdp.h5", folder / "inches.cdp.h5"], 2,
           ["mm.cdp.h5 is in mm, but ", "inches.cdp.h5 is in in. "])
          for question in (["query", "distance"], ["query", "contacts", "--tolerance", "1"],
                           ["query", "distance", "--structure", "hull"],
                           ["accuracy", "--quick"])),
        (["accuracy", "--quick", "--unit", "in", folder / "mm.cdp.h5", folder / "sheet.off"], 2,
         ["mm.cdp.h5 is in mm, but ", "sheet.off is in in. "]),
        (["query", "distance", "--scene", folder / "units.json"], 2,
         ["mm.cdp.h5 is in mm, but ", "inches.cdp.h5 is in in. "]),
        *(([*command, "-o", link], 2, [str(link), "replaced"]) for link in links for command in (
            ["bake", folder / "sheet.off"], ["validate", folder / "sheet.off"],
            ["hull", folder / "sheet.off"], ["repair", folder / "sheet.off"],
            ["decompose", folder / "sheet.off"], ["compare", folder / "sheet.off", "--quick"],
            ["accuracy", folder / "sheet.off", folder / "sheet.off", "--quick"])),
        (["accuracy", folder / "sheet.off", folder / "sheet.off", "--quick", "-o", folder / "x.csv",
          "--save", folder / "same" / "x.csv"], 2, ["same/x.csv", "another output"]),
        (["repair", folder / "sheet.off", "-o", folder / "sheet.off"], 2, ["sheet.off", "input"]),
        (["repair", folder / "sheet.off", "-o", folder / "x.pdf"], 2, ["x.pdf", ".ply"]),
        (["bake", folder / "sheet.off", "-o", "/dev/full"], 4, ["/dev/full", "device"]),
        (["validate", folder / "sheet.off", "--html", folder / "sheet.off"], 2, ["sheet.off"]),
        (["validate", folder / "sheet.off", "--html", folder / "x", "-o", folder / "x"], 2, ["x"]),
        (["validate", folder / "sheet.off", "--html", folder / "no" / "page"], 4, ["page"]),
        (["validate", "--files-from", folder / "missing"], 3, ["missing"]),
        (["validate", "--files-from", folder / "a folder"], 3, ["a folder"]),
        (["validate", folder / "sheet.off", "--baseline", folder / "missing"], 3, ["missing"]),
        (["validate", folder / "sheet.off", "--baseline", folder / "a folder"], 3, ["a folder"]),
        (["validate", folder / "sheet.off", "--baseline", folder / "sheet.off"], 3, ["byte"]),
        (["explain", "CDP9999"], 2, ["CDP9999"]),
        (["explain", "sliver", "--format", "xml"], 2, ["xml"]),
        (["explain", "--help"], 0, []),
        (["validate", "--help"], 0, []),
        (["--help"], 0, []),
        (["bake", "--help"], 0, []),
        (["--version"], 0, []),
    ]
    for arguments, code, words in cases:
        done = run(program, *arguments)
        must(done.returncode == code, f"{arguments}: exit {done.returncode} instead of {code}: "
                                      f"{done.stderr}{done.stdout}")
        if code == 0:
            must(not done.stderr, f"{arguments}: {done.stderr}")
            continue
        must(not done.stdout, f"{arguments} fails but prints {done.stdout}")
        must(done.stderr.strip() and all(word in done.stderr for word in words),
             f"{arguments}: {done.stderr}")
        must([digest(path) for path in read] == known, f"{arguments}: an input was changed")
        must(done.stderr.count("\n") == 1 and len(done.stderr) < 1000
             and done.stderr.rstrip()[-1] in ".?", f"{arguments}: not one sentence: {done.stderr}")
        must(digest(model) == before, f"{arguments} changed the model")
    must(not (folder / "out").exists() or not list((folder / "out").iterdir()),
         "something was baked although two inputs have one output")
    must(not (folder / "touching.cdp.h5").exists(), "--strict wrote a mesh not fully examined")

    # One bad input does not stop the others; the JSON has each.
    done = run(program, "bake", folder / "missing.off", folder / "sheet.off", "--output-dir",
               folder / "batch", "--format", "json")
    reports = report_of("bake", done.stdout)["models"]
    must(done.returncode == 3 and [report["exit"] for report in reports] == [3, 0],
         f"a batch exited {done.returncode}: {done.stdout}")
    must((folder / "batch" / "sheet.cdp.h5").exists(), "the good input was not baked")

    # Names in any bytes.
    odd = os.fsencode(folder) + b"/\xff\xfe odd\n.off"
    os.link(folder / "sheet.off", odd)
    done = subprocess.run([program, "bake", odd, "--format", "json"], capture_output=True)
    must(done.returncode == 0 and report_of("bake", done.stdout.decode("utf-8", "replace")),
         f"a name that is not UTF-8: {done}")

    # Options from a file, which must be known too.
    settings = folder / "settings.toml"
    for text, code, words in (("[bake]\nunit = 'mm'\n", 0, ""), ("[bake]\nunti = 'mm'\n", 2, "unti"),
                              ("[bake]\nunit = 'yard'\n", 2, "mm, cm, m, in or ft")):
        settings.write_text(text)
        done = run(program, "--config", settings, "bake", folder / "sheet.off")
        must(done.returncode == code and words in done.stderr, f"{text!r}: {done}")
    said = report_of("info", run(program, "info", model, "--format", "json").stdout)
    must(said["metres_per_unit"] == 0.001, "an option of a file was not taken")

    # Colours where they are requested, and nowhere else.
    for choice, has_colours in (("always", True), ("never", False), ("auto", False)):
        said = run(program, "validate", folder / "sheet.off", "--color", choice).stdout
        must(("\x1b[" in said) == has_colours, f"--color {choice}: {said!r}")

    # Who reads only the start of an answer needs no complaint.
    reader = subprocess.Popen(["true"], stdin=subprocess.PIPE)
    reader.wait()
    done = subprocess.run([program, "info", str(model)], stdout=reader.stdin,
                          stderr=subprocess.PIPE)
    must(done.returncode == 130 and not done.stderr, f"a closed pipe exited {done}")

    # Answers that nobody can take.
    for words in (pair, ["--version"], ["bake", "--help"]):
        with open("/dev/full", "w") as full:
            done = subprocess.run([program, *map(str, words)], stdout=full, stderr=subprocess.PIPE)
        must(done.returncode == 4 and done.stderr, f"{words}, stdout full: {done.returncode}")
    print(f"{len(cases)} commands")


main()
