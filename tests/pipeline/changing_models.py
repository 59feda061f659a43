#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep simulate: models that deform and tear answer as meshes of their positions, baked anew;
threads change nothing; mistakes of motions and vertex streams have their sentences.

Usage: changing_models.py CDPREP
"""
import json
import math
import pathlib
import shutil
import struct
import sys
import tempfile

from shared_models import bake, must, run
from simulate import (OUTPUT_SCHEMA, SCENE_SCHEMA, SCENES, asked, check_schema, plan_of, pose_text,
                      simulate, without_times, write_scene)


def as_float(number):
    """The nearest float: models of meshes with float coordinates keep floats."""
    return struct.unpack("<f", struct.pack("<f", number))[0]


def read_mesh(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    return ([tuple(map(float, line[1:])) for line in lines if line[0] == "v"],
            [line for line in lines if line[0] == "f"])


def write_mesh(path, points, faces):
    rows = [("v", *map(repr, map(as_float, point))) for point in points] + faces
    path.write_text("".join(" ".join(row) + "\n" for row in rows))
    return path


def read_stream(path):
    stream = path.read_bytes()
    magic, version, points, _, _, samples = struct.unpack_from("<12siiffi", stream)
    must(magic == b"POINTCACHE2\0" and version == 1, f"{path}: {magic}")
    numbers = struct.unpack_from(f"<{3 * points * samples}f", stream, 32)
    rows = [numbers[i:i + 3] for i in range(0, len(numbers), 3)]
    return [rows[sample * points:(sample + 1) * points] for sample in range(samples)]


def sheared(points, time):
    """As in cut.json; the middle of the sheet is 0."""
    return [(x + 0.25 * math.sin(2 * math.pi * (time % 2) / 2) * y, y, z) for x, y, z in points]


def twisted(points, time):
    """As in cloth.json: about y, from z to x. The sheet is 3 long."""
    turned = []
    for x, y, z in points:
        turn = 3 * math.sin(2 * math.pi * (time % 2) / 2) * y / 3
        c, s = math.cos(turn), math.sin(turn)
        turned.append((s * z + c * x, y, c * z - s * x))
    return turned


def streamed(samples, time):
    first = min(int(time / 0.25), len(samples) - 1)
    second = min(first + 1, len(samples) - 1)
    share = time / 0.25 - first
    return [tuple(p + share * (q - p) for p, q in zip(a, b))
            for a, b in zip(samples[first], samples[second])]


def crate_pairs(program, folder, points, faces, pose):
    """How many triangles of a sheet with these points overlap those of a crate."""
    bake(program, write_mesh(folder / "now.obj", points, faces), "-o", folder / "now.cdp.h5",
         "--effects", "overlap,distance")
    answer, = asked(program, "overlap", folder / "now.cdp.h5", folder / "crate.cdp.h5", folder,
                    [pose_text(0, pose)], "--count")
    return answer["count"]


def the_cut(program, folder):
    """Until the tear, each frame equals a query about a mesh of the sheared positions. After it the
    crate is in the gap: the two sides are 2 apart, along the normal."""
    scene = json.loads((SCENES / "cut.json").read_text())
    scene["pairs"][0]["events"] = ["begins", "stays", "ends"]
    for name in ("sheet.obj", "crate.obj"):
        shutil.copy(SCENES / name, folder / name)
    (folder / "cut.json").write_text(json.dumps(scene))
    events, summary = simulate(program, folder / "cut.json")
    told = {event["frame"]: event for event in events if event["effect"] == "overlap"}
    bake(program, folder / "crate.obj", "-o", folder / "crate.cdp.h5", "--effects",
         "overlap,distance")
    points, faces = read_mesh(folder / "sheet.obj")
    counts = set()
    for frame in range(0, 12, 2):
        found = crate_pairs(program, folder, sheared(points, 0.125 * frame), faces, (0, 0, 0.45))
        must(told[frame]["triangle_pairs"] == found, f"{frame}: {told[frame]} {found}")
        counts.add(found)
    must(len(counts) > 2, f"the shear changes little: {counts}")
    must(told[12]["event"] == "ends" and max(told) == 12, f"{told}")
    changes = summary["changes"]
    must(changes["deform"] == changes["tear"] == 1 and changes["missed"] == [], f"{changes}")
    must(changes["refits"] == 24 and 0 < changes["torn"] < changes["appended"], f"{changes}")

    plan = plan_of(program, folder / "cut.json")
    must(plan["models"][0]["serves"] == ["tear"], f"{plan['models']}")
    planned, = plan["changes"]
    must(planned["object"] == "sheet" and planned["deform"] == "shear" and
         planned["live_bytes"] > 10000, f"{planned}")
    must({key: planned["tear"][key] for key in ("torn", "appended")} ==
         {key: changes[key] for key in ("torn", "appended")}, f"{planned} {changes}")
    text = run(program, "simulate", folder / "cut.json", "--plan").stdout
    must("live model of object 'sheet': deforms by a shear; tears at 1.5 s: " in text, text)
    text = run(program, "simulate", folder / "cut.json", "--format", "text").stdout
    must(f"1 object deforms, 1 tears: 24 refits, {changes['rebuilt']} triangles rebuilt, " in text,
         text)


def the_cloth(program, folder):
    """Distances of frames are those of meshes with the positions of the stream and the twist."""
    changes = simulate(program, SCENES / "cloth.json")[1]["changes"]
    must(changes["rebuilt"] > 0 and changes["tear"] == 0, f"{changes}")
    scene = json.loads((SCENES / "cloth.json").read_text())
    for name in ("sheet.obj", "crate.obj", "loop.pc2"):
        shutil.copy(SCENES / name, folder / name)
    bake(program, folder / "crate.obj", "-o", folder / "crate.cdp.h5", "--effects", "distance")
    points, faces = read_mesh(folder / "sheet.obj")
    samples = read_stream(folder / "loop.pc2")
    scene["layers"] = ["cloths", "bars"]
    scene["pairs"] = [{"layers": ["cloths", "bars"], "effects": ["distance", "deform"], "max_distance": 9,
                       "events": ["begins"]}]
    bar = {"name": "bar", "model": "crate.obj", "layer": "bars",
           "pose": {"translation": [0.5, 0.25, 3]}}
    for name, shape in (("bent", lambda time: streamed(samples, time)),
                        ("twisted", lambda time: twisted(points, time))):
        cloth, = (each for each in scene["objects"] if each["name"] == name)
        cloth = {key: value for key, value in cloth.items() if key != "pose"}
        distances = set()
        for time in (0, 0.3125, 0.5, 1.875, 2.5):
            # Frame 1 is at this time, and the only one with the bar near.
            away = {"path": [{"time_s": 0, "pose": {"translation": [0.5, 0.25, 90]}},
                             {"time_s": time or 1, "pose": bar["pose"]}]}
            objects = [cloth, bar if time == 0 else {**bar, "motion": away}]
            objects[1] = {key: value for key, value in objects[1].items()
                          if time == 0 or key != "pose"}
            write_scene(folder / "one.json", **{key: value for key, value in scene.items()
                                                if key in ("layers", "pairs")},
                        objects=objects, step_s=time or 1)
            check_schema(SCENE_SCHEMA, json.loads((folder / "one.json").read_text()), name)
            (event,), _ = simulate(program, folder / "one.json", "--frames", 2)
            bake(program, write_mesh(folder / "now.obj", shape(time), faces), "-o",
                 folder / "now.cdp.h5", "--effects", "distance")
            found, = asked(program, "distance", folder / "now.cdp.h5", folder / "crate.cdp.h5",
                           folder, [pose_text(0, (0.5, 0.25, 3))])
            must(max(event["lower"], found["lower"]) <= min(event["upper"], found["upper"]),
                 f"{name} at {time}: {event} {found}")
            distances.add(round(found["lower"], 4))
        must(len(distances) > 3, f"{name} changes little: {distances}")


def the_self_overlaps(program):
    """By hand: the straight ends of the sheet cross when x of its border is 0. Sample 7 has it at
    0.103 and sample 8 at -0.189, so that this is at 1.838 s: between frames 29 and 30."""
    events, _ = simulate(program, SCENES / "cloth.json")
    found, = (event for event in events if event["effect"] == "self")
    must((found["frame"], found["event"], found["a"], found["b"]) == (30, "begins", "bent", "bent")
         and found["triangle_pairs"] > 10, f"{found}")


def the_ways(program, folder):
    """By hand: a crate passes through another within a frame. Of 10 m, they touch after 5."""
    shutil.copy(SCENES / "crate.obj", folder / "crate.obj")
    objects = [{"name": name, "model": "crate.obj", "layer": "a", **placing} for name, placing in (
        ("still", {}), ("fast", {"pose": {"translation": [-6, 0.25, 0]},
                                 "motion": {"velocity": [50, 0, 0]}}))]
    scene = write_scene(folder / "fast.json", layers=["a"], step_s=0.2, objects=objects, pairs=[
        {"layers": ["a", "a"], "effects": ["collide", "continuous"],
         "impact": {"tolerance": 1e-6, "most_steps": 100}}])
    check_schema(SCENE_SCHEMA, json.loads(scene.read_text()), scene)
    (begins, ends), _ = simulate(program, scene, "--frames", 3)
    must((begins["frame"], ends["frame"]) == (1, 2), f"{begins} {ends}")
    must(begins["effect"] == "continuous" and begins["kind"] == "touching" and
         begins["lower"] <= 0.5 <= begins["upper"] <= begins["lower"] + 1e-6, f"{begins}")
    pair, = plan_of(program, scene)["pairs"]
    must(pair["impact"] == {"tolerance": 1e-6, "most_steps": 100}, f"{pair}")


def the_haptic_distances(program, folder):
    """By hand: two crates 1 m apart. With little work the answer is late, and its bounds hold."""
    shutil.copy(SCENES / "crate.obj", folder / "crate.obj")
    objects = [{"name": str(x), "model": "crate.obj", "layer": "a",
                "pose": {"translation": [x, 0, 0]}} for x in (0, 2)]
    for work in (1, 100000):
        scene = write_scene(folder / "haptic.json", layers=["a"], objects=objects, pairs=[
            {"layers": ["a", "a"], "effects": ["haptic"], "max_distance": 5, "work": work}])
        check_schema(SCENE_SCHEMA, json.loads(scene.read_text()), scene)
        (event,), _ = simulate(program, scene)
        must(event["effect"] == "haptic" and event["late"] == (work == 1), f"{event}")
        must(event["lower"] <= 1 <= event.get("upper", 1), f"{event}")
        must(work == 1 or event["upper"] - event["lower"] < 1e-12, f"{event}")
        must(plan_of(program, scene)["pairs"][0]["work"] == work, "the plan lost the work")


def the_refusals(program, folder):
    """Objects that change need layers whose pairs say so, and say it to the plan at once."""
    for name in ("sheet.obj", "crate.obj"):
        shutil.copy(SCENES / name, folder / name)
    scene = json.loads(sheet_scene(folder / "refused.json", a_tear()).read_text())
    for effects, sentences in (
            (["collide"], ["Object 'sheet' in layer 'a' tears. Add tear to the effects of pair 0 "
                           "of layers, 'a' and 'a' (line 1)."]),
            (["collide", "deform"], ["Object 'sheet' in layer 'a' tears. Add tear to "]),
            (["contacts", "tear"], ["contacts is not supported for models that deform or tear"]),
            (["continuous", "tear"],
             ["continuous is not supported for models that deform or tear"])):
        scene["pairs"][0]["effects"] = effects
        (folder / "refused.json").write_text(json.dumps(scene))
        done = run(program, "simulate", folder / "refused.json", "--plan")
        must(done.returncode == 2, f"{effects} exited {done.returncode}: {done.stderr}")
        must(len(done.stderr.splitlines()) == len(sentences), done.stderr)
        for sentence in sentences:
            must(sentence in done.stderr, done.stderr)


def the_same_bytes(program):
    """Neither a second run nor threads change an event or the state."""
    for name in ("cut.json", "cloth.json"):
        first = simulate(program, SCENES / name, "-j", 1)
        for threads in (1, 8):
            again = simulate(program, SCENES / name, "-j", threads)
            must(first[0] == again[0], f"{name}: events depend on threads")
            must(without_times(first[1]) == without_times(again[1]), f"{first[1]} {again[1]}")


def sheet_scene(path, motion, **members):
    sheet = {"name": "sheet", "model": "sheet.obj", "layer": "a", "motion": motion}
    other = {"name": "crate", "model": "crate.obj", "layer": "a"}
    return write_scene(path, layers=["a"], pairs=[{"layers": ["a", "a"], "effects": ["collide", "tear"]}],
                       objects=[sheet, other], **members)


def a_tear(x=0.1, time=0.0):
    return {"tear": {"plane": {"point": [x, 0, 0], "normal": [1, 0, 0]}, "time_s": time,
                     "opening": 3}}


def the_tears(program, folder):
    """A tear at time 0 or before holds in the first frame. One that misses is told."""
    for name in ("sheet.obj", "crate.obj"):
        shutil.copy(SCENES / name, folder / name)
    for time, begins in ((-1, 0), (0, 0), (0.01, 1)):
        events, summary = simulate(program, sheet_scene(folder / "early.json", a_tear(time=time)),
                                   "--frames", 1)
        must(len(events) == begins, f"torn at {time}: {events}")
        must((summary["changes"]["torn"] > 0) == (time <= 0), f"{time}: {summary}")
    for x in (1.5, 40, -1.5):  # at the border of the sheet and beyond
        scene = sheet_scene(folder / "missed.json", a_tear(x))
        events, summary = simulate(program, scene, "--frames", 2)
        changes = summary["changes"]
        must(len(events) == 1 and changes["missed"] == ["sheet"] and changes["torn"] == 0,
             f"{x}: {events} {changes}")
        must(plan_of(program, scene)["changes"][0]["tear"]["misses"], "the plan says nothing")
        text = run(program, "simulate", scene, "--format", "text").stdout
        must("object 'sheet' is not torn: the plane misses its model" in text, text)
        text = run(program, "simulate", scene, "--plan").stdout
        must("does not tear: the plane misses it" in text, text)


def the_mistakes(program, folder):
    for name in ("sheet.obj", "crate.obj", "loop.pc2"):
        shutil.copy(SCENES / name, folder / name)
    whole = (folder / "loop.pc2").read_bytes()
    (folder / "magic.pc2").write_bytes(b"NO" + whole[2:])
    (folder / "short.pc2").write_bytes(whole[:-1])
    (folder / "few.pc2").write_bytes(struct.pack("<12siiffi", b"POINTCACHE2", 1, 168, 0, 1, 1) +
                                     bytes(168 * 12))
    (folder / "nan.pc2").write_bytes(whole[:-4] + struct.pack("<f", math.nan))

    def stream(name):
        return {"deform": {"stream": {"file": name, "step_s": 1}}}

    shear = {"of": "x", "along": "y", "rate_per_s": 1e38}
    plane = {"point": [0, 0, 0], "normal": [0, 0, 0]}
    cases = [
        (stream("none.pc2"), 3, "/motion/deform/stream/file: there is no file "),
        (stream("magic.pc2"), 3, "magic.pc2: byte 0: found "),
        (stream("short.pc2"), 3, "short.pc2: byte 28: found 9 samples of 2028 bytes; expected as "
                                 "many as fit in the 18251 bytes after the header."),
        (stream("few.pc2"), 3, "few.pc2: byte 16: found 168 points; expected at least 169, the "
                               "vertices of "),
        (stream("nan.pc2"), 3, "nan.pc2: sample 8: coordinate z of point 168 is not a number; "),
        ({"deform": {"shear": shear}}, 2, "object 'sheet': at 50 s: "),
        ({"deform": {}}, 3, "a deform has exactly one of shear, twist and stream."),
        ({"tear": {"plane": plane, "time_s": 0}}, 3, "expected a vector with a direction."),
    ]
    for motion, code, words in cases:
        done = run(program, "simulate", sheet_scene(folder / "bad.json", motion, step_s=50),
                   "--frames", 4)
        must(done.returncode == code, f"{motion} exited {done.returncode}: {done.stderr}")
        must(words in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr)
    done = run(program, "query", "distance", "--scene", sheet_scene(folder / "rest.json", a_tear()))
    must(done.returncode == 2 and "object 'sheet' deforms or tears" in done.stderr, done.stderr)


def main():
    program = sys.argv[1]
    the_self_overlaps(program)
    for check in (the_cut, the_cloth, the_tears, the_mistakes, the_ways, the_haptic_distances,
                  the_refusals):
        with tempfile.TemporaryDirectory() as scratch:
            check(program, pathlib.Path(scratch))
    the_same_bytes(program)


if __name__ == "__main__":
    main()
