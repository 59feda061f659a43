#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Schemas say no: reports of every kind follow theirs, and no longer do with an unknown key or a
value of another type, wherever that is. Every key is described, in sentences that are short; a
definition that two schemas share is the same in both.

Usage: strict_schemas.py CDPREP
"""
import copy
import json
import pathlib
import re
import sys
import tempfile

import jsonschema

from known_meshes import CUBE
from schemas import TOOLS, errors_in, report_of, schema_of
from shared_models import must, run

MESHES = TOOLS.parent / "samples/meshes"
COMMANDS = ("bake", "decompose", "hull", "info", "repair")
WORDS = 20  # of a sentence
# A sheet with a hole, a triangle twice and the other way round, one without area, a vertex that is
# not finite and a T-junction; and a post through it.
BROKEN = """OFF
15 19 0
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
0 2 0
1 2 0
2 2 0
nan 0 0
0.5 0 0
0.2 0.3 -1
0.3 0.2 -1
0.3 0.3 1
0.2 0.2 -1
3 0 1 4
3 0 4 3
3 0 4 3
3 3 4 7
3 3 7 6
3 7 4 8
3 4 5 8
3 9 1 2
3 1 2 5
3 0 1 10
3 11 12 13
3 12 14 13
3 14 11 13
3 11 14 12
3 1 1 2
3 0 4 3
3 4 5 8
3 1 5 4
3 20 1 2
"""


# --- The schemas ---------------------------------------------------------------------------


def objects_in(schema):
    """Each part of a schema that is an object of JSON."""
    if isinstance(schema, dict):
        yield schema
        schema = list(schema.values())
    if isinstance(schema, list):
        for part in schema:
            yield from objects_in(part)


def resolved(schema, part):
    return schema["$defs"][part["$ref"].removeprefix("#/$defs/")] if "$ref" in part else part


def check_form(path):
    """Valid, and what is defined is what is used."""
    schema = json.loads(path.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    used = set()
    for part in objects_in(schema):
        if isinstance(part.get("$ref"), str):
            used.add(part["$ref"])
    defined = {f"#/$defs/{name}" for name in schema.get("$defs", {})}
    must(used == defined, f"{path.name}: {used ^ defined}")


def check_words(command):
    schema = schema_of(f"{command}/{command}")
    for part in objects_in(schema):
        if part.get("type") == "object":
            must("additionalProperties" in part, f"{command}: {part} permits unknown keys")
            for key, value in part.get("properties", {}).items():
                told = value.get("description") or resolved(schema, value).get("description")
                must(told and told.endswith("."), f"{command}: {key} is described as {told}")
        if isinstance(part.get("description"), str):
            for sentence in re.split(r"(?<=[.])\s", part["description"]):
                must(len(sentence.split()) <= WORDS, f"{command}: {sentence}")


def check_copies():
    """bake.schema.json and repair.schema.json define what info.schema.json defines too."""
    bake, info, repair = (schema_of(f"{name}/{name}")["$defs"] for name in
                          ("bake", "info", "repair"))
    names = ["structures", "promises"]
    for name in names:
        must(info[name] == bake[name], f"info and bake differ in {name}")
        for part in objects_in(info[name]):
            found = part.get("$ref", "").removeprefix("#/$defs/")
            if found and found not in names:
                names.append(found)
    for name in ("moved", "length", "step_name"):
        must(info[name] == repair[name], f"info and repair differ in {name}")
    must(info["repair_counts"] == repair["counts"], "info and repair differ in counts")
    facts = repair["verdict"]["properties"]
    own = {"self_crossing", "crossing_pairs", "crossings_complete"}
    must(info["stored_facts"]["properties"] == {k: v for k, v in facts.items() if k not in own},
         "info and repair differ in facts")
    found = schema_of("validate/validation")["$defs"]
    must(info["defects"]["required"] == found["counts"]["required"], "kinds of defects")
    for name in ("place", "verdict"):
        must(info[name]["required"] == found[name]["required"] and
             set(info[name]["properties"]) == set(found[name]["properties"]), f"keys of {name}")


# --- The reports ---------------------------------------------------------------------------


def reports(program, folder):
    """A command and its report, of every kind."""
    def told(command, *arguments, code=0):
        done = run(program, command, *arguments, "--format", "json")
        must(done.returncode == code, f"{command} {arguments}: {done.returncode}: {done.stderr}")
        return command, report_of(command, done.stdout)

    broken, cube, empty, named = (folder / name for name in
                                  ("broken.off", "cube.off", "empty.off", "named.obj"))
    broken.write_text(BROKEN)
    cube.write_text(CUBE)
    empty.write_text("OFF\n0 0 0\n")
    named.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng UCX_a\nf 1 2 3\ng UCX_b\nf 1 3 4\n")
    bracket, missing, out = MESHES / "bracket.obj", folder / "missing.obj", folder / "out.obj"
    baked, few = folder / "baked.cdp.h5", ["--max-error", 9, "--work", 5_000_000]

    yield told("bake", bracket, "-o", baked, "--effects", "all", "--structures", "all", "--parts",
               2, "--max-error", 0.001, "--hull-vertices", 12, "--unit", "mm", code=1)
    yield told("info", baked, "--deep")
    yield told("bake", broken, "-o", baked, "--repair", "solid", "--structures",
               "octree-adaptive,tetra-tree", "--structure-preset", "paper", "--max-pairs", 99)
    yield told("info", baked)
    yield told("bake", missing, cube, empty, "--output-dir", folder, code=3)
    yield told("bake", empty, "-o", baked, "--allow-empty", "--effects", "all", "--max-error", 1)
    yield told("info", baked, "--deep")

    yield told("hull", bracket, "-o", out, "--max-vertices", 20)
    yield told("hull", bracket, "-o", out, "--per", "component")
    yield told("hull", empty, "-o", out, "--allow-empty")
    yield told("hull", missing, "-o", out, code=3)

    yield told("decompose", bracket, "--table", "-o", folder / "pieces.ply")
    yield told("decompose", empty, "--allow-empty", "--order", "cresting", "--table")
    yield told("decompose", bracket, "--table", "-o", folder / "bracket.urdf", "--unit", "mm", *few)
    yield told("decompose", empty, "--allow-empty", *few)
    yield told("decompose", named, "--table", *few)
    yield told("decompose", bracket, "--max-error", 0, "--max-parts", 1, code=1)
    yield told("decompose", bracket, "-o", folder / "x.urdf", "--strict", *few, code=1)
    for options in ([], few):
        yield told("decompose", missing, *options, code=3)

    yield told("repair", broken, "-o", out, "--preset", "closed", "--hole-size", 0.5, code=1)
    yield told("repair", broken, "-o", out, "--steps", "weld,orient,drop-bad-numbers")
    yield told("repair", broken, "-o", out, "--weld", 0.3)
    yield told("repair", cube, "-o", out, "--preset", "solid")
    yield told("repair", empty, "-o", out, "--allow-empty", code=1)
    yield told("repair", missing, "-o", out, code=3)


def places_in(value, path=()):
    """The paths of all values in JSON. Of a list only the first and the last item count."""
    yield path
    if isinstance(value, dict):
        for key, each in value.items():
            yield from places_in(each, (*path, key))
    if isinstance(value, list) and value:
        for i in {0, len(value) - 1}:
            yield from places_in(value[i], (*path, i))


def value_at(report, path):
    for key in path:
        report = report[key]
    return report


def with_value(report, path, value):
    if not path:
        return value
    changed = copy.copy(report)
    changed[path[0]] = with_value(report[path[0]], path[1:], value)
    return changed


def spoilt(report):
    """What is wrong, and the report with that."""
    for path in places_in(report):
        value = value_at(report, path)
        if isinstance(value, dict):
            yield f"an unknown key in {path}", with_value(report, path, {**value, "unknown": None})
        other = [] if not isinstance(value, (dict, list)) else 0.5
        yield f"{other} at {path}", with_value(report, path, other)


def check_refusals(command, report):
    """The number of reports that are refused."""
    schema, count = schema_of(f"{command}/{command}"), 0
    for what, wrong in spoilt(report):
        must(next(errors_in(schema, wrong), None) is not None, f"{command} permits {what}")
        count += 1
    return count


def main():
    program = sys.argv[1]
    for path in sorted(TOOLS.glob("*/*.schema.json")):
        check_form(path)
    for command in COMMANDS:
        check_words(command)
    check_copies()
    with tempfile.TemporaryDirectory() as scratch:
        count = sum(check_refusals(*each) for each in reports(program, pathlib.Path(scratch)))
    print(f"{count} wrong reports are refused")


if __name__ == "__main__":
    main()
