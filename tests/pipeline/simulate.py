#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep simulate: plans and events of the sample scenes are as their schema says and equal the
answers of single queries; threads and the cache change nothing; mistakes have their exit codes.

Usage: simulate.py CDPREP
"""
import json
import math
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from schemas import check_schema, schema_of
from shared_models import bake, must, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "samples/scenes"
SCENE_SCHEMA, OUTPUT_SCHEMA = schema_of("scene_file/scene"), schema_of("simulate/simulate")


def simulate(program, scene, *arguments):
    """The events of a simulation and its summary, held to the schema."""
    done = run(program, "simulate", scene, *arguments)
    must(done.returncode == 0, f"{scene} {arguments} exited {done.returncode}: {done.stderr}")
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    for line in lines[:200] + lines[-1:]:
        check_schema(OUTPUT_SCHEMA, line, scene)
    must("summary" in lines[-1], f"{scene}: the last line is no summary")
    return lines[:-1], lines[-1]["summary"]


def without_times(summary):
    """The memory is left out too: each thread has its own."""
    return untimed(dict(summary, effects=[untimed(effect) for effect in summary["effects"]]))


def untimed(values):
    return {key: value for key, value in values.items()
            if not key.endswith("_ms") and key not in ("explained", "state_bytes")}


def plan_of(program, scene, *arguments):
    done = run(program, "simulate", scene, "--plan", "--format", "json", *arguments)
    must(done.returncode == 0, f"{scene}: --plan exited {done.returncode}: {done.stderr}")
    plan = json.loads(done.stdout)
    check_schema(OUTPUT_SCHEMA, plan, scene)
    return plan


def write_scene(path, **members):
    path.write_text(json.dumps({"cdprep_scene": 1, **members}))
    return path


def the_plans(program):
    """By hand: what the scenes ask for."""
    plan = plan_of(program, SCENES / "crates.json")
    must([layer["objects"] for layer in plan["layers"]] == [1, 2, 1, 60], f"{plan['layers']}")
    must(plan["not_computed"] == ["overlap", "distance", "contacts", "continuous", "self", "haptic",
                                  "response"], f"{plan['not_computed']}")
    # Nobody asks for the debris: none of its 1770 pairs, nor those with other layers.
    must(plan["layers_in_no_pair"] == ["debris"], f"{plan['layers_in_no_pair']}")
    must(plan["not_built"] == ["inside"], f"{plan['not_built']}")
    unpaired = {"-".join(layers["layers"]): layers["pairs"] for layers in plan["unpaired"]}
    must(unpaired == {"ground-triggers": 1, "ground-debris": 60, "crates-debris": 120,
                      "triggers-debris": 60, "debris-debris": 1770}, f"{unpaired}")
    must(plan["pairs"][0]["layers"] == ["crates", "triggers"], f"{plan['pairs']}")
    serves = {pathlib.Path(model["path"]).name: model["serves"] for model in plan["models"]}
    must(serves == {"ground.obj": ["within"], "gate.obj": ["collide", "solid"],
                    "crate.obj": ["collide", "within", "solid"]}, f"{serves}")
    for model in plan["models"]:
        names = {section["name"] for section in model["read"]}
        must("bvh_nodes" in names, f"{model}")
        must(("swept_nodes" in names) == ("within" in model["serves"]), f"{model}")
        must("findings" in {section["name"] for section in model["untouched"]}, f"{model}")
        must(model["read_bytes"] == sum(s["bytes"] for s in model["read"]) > 1000, f"{model}")
    text = run(program, "simulate", SCENES / "crates.json", "--plan").stdout
    for words in ("layer 'debris': 60 objects", "layers 'crates' and 'triggers': collide of solids",
                  "not requested by any pair of layers: overlap, distance, contacts, continuous, "
                  "self, haptic, response\n", "never touched: 4 sections",
                  "layers in no pair, whose objects are never tested: debris\n",
                  "layers never tested against each other: ground-triggers (1 pair of objects)",
                  "debris-debris (1770 pairs of objects)\n"):
        must(words in text, f"the plan does not say '{words}':\n{text}")
    the_state(program)


def the_state(program):
    """The bytes of the scene are told. Effects, objects and threads add to them."""
    one = plan_of(program, SCENES / "crates.json", "-j", 1)["state"]
    text = run(program, "simulate", SCENES / "crates.json", "--plan", "-j", 1).stdout
    must(f"the state of the scene: {one['bytes']} bytes for {one['pairs']} pairs of boxes and "
         "1 thread\n" in text, text)
    more = plan_of(program, SCENES / "crates.json", "-j", 4)["state"]
    must(one["threads"] == 1 and more["threads"] == 4 and more["bytes"] > one["bytes"] > 10000,
         f"{one} {more}")
    less = plan_of(program, SCENES / "assembly.json", "-j", 1)["state"]
    large = plan_of(program, SCENES / "thousand.json", "-j", 1)["state"]
    must(large["pairs"] > less["pairs"] and large["bytes"] > less["bytes"], f"{less} {large}")
    # What a run tells of an effect is the share of it.
    _, summary = simulate(program, SCENES / "crates.json", "--frames", 1, "-j", 1)
    shares = sum(effect["state_bytes"] for effect in summary["effects"])
    must(0 < shares < one["bytes"], f"{shares} of {one}")


def pose_text(angle, translation):
    """A turn about z, then a translation, as --poses reads it."""
    c, s = math.cos(angle), math.sin(angle)
    return " ".join(map(repr, (c, -s, 0, s, c, 0, 0, 0, 1, *translation)))


def asked(program, question, a, b, folder, poses, *arguments):
    (folder / "poses").write_text("".join(pose + "\n" for pose in poses))
    done = run(program, "query", question, a, b, "--poses", folder / "poses", "--format", "ndjson",
               *arguments)
    must(done.returncode == 0, done.stderr)
    return [json.loads(line) for line in done.stdout.splitlines()]


def states(events, frames, effect, a, b):
    """For each frame whether an effect holds, from its events."""
    holds, state = [], False
    mine = [e for e in events if (e["effect"], e["a"], e["b"]) == (effect, a, b)]
    for frame in range(frames):
        for event in mine:
            if event["frame"] == frame:
                must((event["event"] == "begins") != state, f"not bookended: {event}")
                state = event["event"] == "begins"
        holds.append(state)
    return holds


def the_crates(program, folder):
    """Each frame equals a single query; the motions are repeated here by hand."""
    events, summary = simulate(program, SCENES / "crates.json")
    must(summary["frames"] == 32 and summary["objects"] == 4, f"{summary}")
    for name in ("crate", "gate", "ground"):
        bake(program, SCENES / f"{name}.obj", "--output-dir", folder)
    crate, gate, ground = (folder / f"{name}.cdp.h5" for name in ("crate", "gate", "ground"))
    times = [0.125 * frame for frame in range(32)]
    slides = [(-6 + 3 * t, 0, 0.5) for t in times]
    falls = [(4.25, 0, 6 - 5.5 * min(t, 2) / 2) for t in times]
    turns = [math.pi / 4 * min(t, 2) for t in times]

    def expect(effect, a, b, found):
        answers = [answer["within" if effect == "within" else "hit"] for answer in found]
        must(any(answers) and not all(answers), f"{effect} of {a} and {b} says nothing")
        told = states(events, 32, effect, a, b)
        must(told == answers, f"{effect} of {a} and {b}:\n{told}\n{answers}")

    minus = lambda p, q: tuple(x - y for x, y in zip(p, q))
    expect("collide", "gate", "sliding", asked(
        program, "collide", gate, crate, folder,
        [pose_text(0, minus(p, (0, 0, 1.5))) for p in slides], "--as", "solid"))
    expect("collide", "sliding", "tumbling", asked(
        program, "collide", crate, crate, folder,
        [pose_text(turn, minus(q, p)) for turn, p, q in zip(turns, slides, falls)]))
    # The scene reports where `within` begins. It never ends.
    expect("within", "ground", "tumbling", asked(
        program, "within", ground, crate, folder,
        [pose_text(turn, minus(p, (0, 0, -0.5))) for turn, p in zip(turns, falls)],
        "--tolerance", 0.25))
    must(not any(event["a"] == "debris" for event in events), "debris was looked at")


def the_assembly(program, folder):
    """Distances are those of single queries."""
    events, _ = simulate(program, SCENES / "assembly.json")
    for name in ("bracket", "bolt"):
        bake(program, ROOT / f"samples/meshes/{name}.obj", "--output-dir", folder)
    begins = {event["effect"]: event for event in events}
    must(set(begins) == {"distance", "within", "collide"}, f"{begins}")
    pair = (folder / "bracket.cdp.h5", folder / "bolt.cdp.h5", folder)
    must(begins["distance"]["frame"] == 0, f"{begins}")
    distance = asked(program, "distance", *pair, [pose_text(0, (23, 15, 40))])[0]
    must((distance["lower"], distance["upper"]) ==
         (begins["distance"]["lower"], begins["distance"]["upper"]), f"{distance} {begins}")
    # Between 1 s and 2 s: down by 28, and from a quarter of a turn to a half.
    frame = begins["within"]["frame"]
    poses = [pose_text(math.pi / 2 * (1 + u), (23, 15, 8 - 28 * u))
             for u in ((f / 16 - 1) for f in (frame - 1, frame))]
    found = [a["within"] for a in asked(program, "within", *pair, poses, "--tolerance", 1.5)]
    must(frame > 16 and found == [False, True], f"within begins in frame {frame}: {found}")
    must(begins["collide"]["frame"] == 32, f"the head touches the bracket at 2 s: {begins}")


def the_lists(program, folder):
    """Lists of triangles and of contacts are those of single queries; what goes on is told."""
    crate = SCENES / "crate.obj"
    xs = (3, 1.75, 0.5, -1.25)
    moving = {"path": [{"time_s": t, "pose": {"translation": [x, 0.5, 0.25]}}
                       for t, x in ((0, 3), (0.5, 0.5), (1, -3))]}
    objects = [{"name": "still", "model": str(crate), "layer": "a"},
               {"name": "moving", "model": str(crate), "layer": "a", "motion": moving}]
    scene = write_scene(folder / "lists.json", step_s=0.25, duration_s=1, layers=["a"],
                        pairs=[{"layers": ["a", "a"], "effects": ["overlap", "contacts"],
                                "contacts": {"tolerance": 1, "most": 4},
                                "events": ["begins", "stays", "ends"]}], objects=objects)
    check_schema(SCENE_SCHEMA, json.loads(scene.read_text()), scene)
    events, summary = simulate(program, scene)
    bake(program, crate, "-o", folder / "lists.cdp.h5", "--effects", "overlap,contacts")
    pair = (folder / "lists.cdp.h5", folder / "lists.cdp.h5", folder)
    poses = [pose_text(0, (x, 0.5, 0.25)) for x in xs]
    lists = asked(program, "overlap", *pair, poses)
    contacts = asked(program, "contacts", *pair, poses, "--tolerance", 1, "--most", 4)
    told = {"overlap": {}, "contacts": {}}
    for event in events:
        told[event["effect"]][event["frame"]] = event
    for frame, (found, near) in enumerate(zip(lists, contacts)):
        event = told["overlap"].get(frame, {})
        must(event.get("triangle_pairs", 0) == found["count"], f"{frame}: {event} {found}")
        event = told["contacts"].get(frame, {})
        must(event.get("contacts", 0) == near["count"], f"{frame}: {event} {near}")
        if near["count"]:
            deepest = near["contacts"][0]
            # The query moves B alone, so that coordinates are rounded otherwise.
            must(all(math.isclose(event[key], deepest[key], rel_tol=1e-9)
                     for key in ("lower", "upper")), f"{frame}: {event} {near}")
    kinds = {event["event"] for event in events}
    must(kinds == {"begins", "stays", "ends"} and summary["grown_steps"] == 0, f"{kinds} {summary}")


def the_clusters(program, folder):
    """Contacts that are joined are as many as those of a single query, and fewer than without."""
    meshes = [ROOT / f"samples/meshes/{name}.obj" for name in ("bracket", "bolt")]
    files = [folder / f"{mesh.stem}.cdp.h5" for mesh in meshes]
    for mesh, file in zip(meshes, files):
        bake(program, mesh, "-o", file, "--effects", "contacts")
    at, listed = (23, 15, -19.5), []
    objects = [{"name": "bracket", "model": str(meshes[0]), "layer": "a"},
               {"name": "bolt", "model": str(meshes[1]), "layer": "b",
                "pose": {"translation": at}}]
    for given in ({}, {"cluster_deg": 30, "manifold": True}):
        contacts = {"tolerance": 2, "most": 64, **given}
        scene = write_scene(folder / "clusters.json", layers=["a", "b"], objects=objects, pairs=[
            {"layers": ["a", "b"], "effects": ["contacts"], "contacts": contacts}])
        check_schema(SCENE_SCHEMA, json.loads(scene.read_text()), scene)
        (event,), _ = simulate(program, scene)
        options = ["--cluster-deg", 30, "--manifold"] if given else []
        found, = asked(program, "contacts", *files, folder, [pose_text(0, at)], "--tolerance", 2,
                       "--most", 64, *options)
        must(event["contacts"] == found["count"], f"{event} is not {found['count']}")
        listed.append(found["count"])
        planned = plan_of(program, scene)["pairs"][0]["contacts"]
        text = run(program, "simulate", scene, "--plan").stdout
        must(("manifold" in planned) == ("with manifolds, clusters of 0.52359877559" in text) ==
             bool(given), f"{planned} {text}")
        must(not given or math.isclose(planned["cluster_angle_rad"], math.pi / 6), f"{planned}")
    must(0 < listed[1] < listed[0], f"nothing was joined: {listed}")


def the_thousand(program, folder):
    """Neither threads nor the form of the output nor a cache change an event."""
    scene = SCENES / "thousand.json"
    one = simulate(program, scene, "-j", 1)
    must(one[1]["objects"] == 1000 and one[1]["frames"] == 32, f"{one[1]}")
    for effect in one[1]["effects"]:
        must(effect["begins"] > 100 and effect["ends"] > 10, f"little happens: {effect}")
    eight = simulate(program, scene, "-j", 8)
    must(one[0] == eight[0], "events depend on threads")
    must(without_times(one[1]) == without_times(eight[1]), f"{one[1]} {eight[1]}")

    whole = run(program, "simulate", scene, "--format", "json", "-o", folder / "run.json")
    must(whole.returncode == 0 and not whole.stdout, whole.stderr)
    document = json.loads((folder / "run.json").read_text())
    check_schema(OUTPUT_SCHEMA, {**document, "events": document["events"][:200]}, "--format json")
    must(document["events"] == one[0], "json and ndjson differ")

    for name in ("thousand.json", "crate.obj"):
        shutil.copy(SCENES / name, folder / name)
    cache = folder / "a cache/deep"
    first = simulate(program, folder / "thousand.json", "--cache", cache)
    baked, = cache.iterdir()
    changed_at = baked.stat().st_mtime_ns
    again = simulate(program, folder / "thousand.json", "--cache", cache)
    must(first[0] == one[0] == again[0], "the cache changes events")
    must(baked.stat().st_mtime_ns == changed_at, "the cache was not used")
    origin = plan_of(program, folder / "thousand.json", "--cache", cache)["models"][0]["origin"]
    must(origin == "cached", origin)
    larger = (folder / "crate.obj").read_text().replace("0.5", "0.75")
    (folder / "crate.obj").write_text(larger)
    other = simulate(program, folder / "thousand.json", "--cache", cache)
    must(other[0] != one[0] and len(list(cache.iterdir())) == 2, "another mesh has the old bake")
    # A file that is no bake of the mesh does not deceive.
    for file in cache.iterdir():
        file.write_bytes(baked.read_bytes())
    must(simulate(program, folder / "thousand.json", "--cache", cache)[0] == other[0],
         "a false file in the cache is believed")

    text = run(program, "simulate", scene, "--format", "text").stdout
    for words in ("not requested by any pair of layers: overlap, distance",
                  "layers never tested against each other: resting-resting (124750 pairs of "
                  "objects), resting-crossing",
                  "not read: 4 sections, ", f"state {one[1]['state_hash']}"):
        must(words in text, text)
    # The rows are read from the clock of the frame: nothing but its own reads is left out.
    must(0.95 <= one[1]["explained"] <= 1.001, f"the rows add up to {one[1]['explained']}")
    for effect in one[1]["effects"]:
        must(effect["state_bytes"] > 0 and effect["read_bytes"] > 0, f"{effect}")
    must(sum(layers["pairs"] for layers in one[1]["unpaired"]) == 312000, f"{one[1]['unpaired']}")


def many_pairs(program, folder):
    """Two heaps meet: then 40,000 pairs, for which the scene makes room. Nothing is lost or told
    twice, as a scene with room from the beginning shows."""
    shutil.copy(SCENES / "crate.obj", folder / "crate.obj")
    objects = [{"name": name, "model": "crate.obj", "layer": name, "pose": {"translation": [x, 0, 0]},
                "motion": {"velocity": [speed, 0, 0]},
                "instances": {"counts": [200, 1, 1], "spacing": [1 / 1024, 0, 0]}}
               for name, x, speed in (("a", 0, 0), ("b", 5, -1))]
    objects.append({"name": "early", "model": "crate.obj", "layer": "b",
                    "pose": {"translation": [0.5, 0, 0]}})
    members = {"layers": ["a", "b"], "pairs": [{"layers": ["a", "b"], "effects": ["collide"]}],
               "step_s": 0.5, "duration_s": 6, "objects": objects}
    grown = simulate(program, write_scene(folder / "grown.json", **members), "-j", 2)
    large = simulate(program, write_scene(folder / "large.json", **members,
                                          limits={"pairs": 200000}))
    must(grown[1]["grown_steps"] > 0 and large[1]["grown_steps"] == 0, f"{grown[1]} {large[1]}")
    must(len(grown[0]) == 40200 and grown[0] == large[0], f"{len(grown[0])} {len(large[0])}")
    for key in ("state_hash", "candidates", "kept", "effects"):
        one, other = (without_times(summary)[key] for _, summary in (grown, large))
        must(one == other, f"{key}: {grown[1]} {large[1]}")
    few = run(program, "simulate", write_scene(folder / "few.json", **members,
                                               limits={"pairs": 10000}))
    must(few.returncode == 5, few.stderr)
    must("needs room for " in few.stderr and "limits.pairs is 10000" in few.stderr, few.stderr)


L_SHAPE = ((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2))


def write_l_prism(path):
    """A closed solid of one component that is not convex."""
    points = [(x, y, z) for z in (0, 1) for x, y in L_SHAPE]
    faces = [(1, i + 1, i) for i in range(2, 6)] + [(7, i + 6, i + 7) for i in range(2, 6)]
    faces += [(i, i % 6 + 1, i % 6 + 7, i + 6) for i in range(1, 7)]
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in points) +
                    "".join(f"f {' '.join(map(str, face))}\n" for face in faces))


def the_rungs(program, folder):
    """Enclosing parts stand for solids where their errors allow it. Otherwise no hull is read."""
    write_l_prism(folder / "l.obj")
    bake(program, folder / "l.obj", "-o", folder / "l.cdp.h5", "--effects", "collide,distance",
         "--structures", "hull", "--parts", 1)
    motion = {"path": [{"time_s": 0, "pose": {"translation": [5, 0, 0]}},
                       {"time_s": 1, "pose": {"translation": [1.25, 1.25, 0]}}]}

    def scene_of(max_error, model="l.cdp.h5"):
        return write_scene(
            folder / "rungs.json", layers=["a"], step_s=0.25, duration_s=1.25,
            pairs=[{"layers": ["a", "a"], "effects": ["collide", "distance"], "body": "solid",
                    "max_distance": 1.5, "max_error": max_error}],
            objects=[{"name": "x", "model": model, "layer": "a"},
                     {"name": "y", "model": model, "layer": "a", "motion": motion}])

    def planned(max_error, model="l.cdp.h5"):
        scene = scene_of(max_error, model)
        check_schema(SCENE_SCHEMA, json.loads(scene.read_text()), scene)
        plan = plan_of(program, scene)
        read = {section["name"] for section in plan["models"][0]["read"]}
        return plan["pairs"][0], "hull_blocks" in read, plan["models"][0]["serves"]

    pair, hulls, serves = planned(100)
    error = pair["rung"]["error"]
    must(pair["rung"] == {"name": "parts", "error": error, "parts": [1, 1]} and hulls, f"{pair}")
    # By hand: of the hull, (1.5, 1.5) is the farthest from the walls of the notch, by a half.
    must(1 - 1e-9 <= error < 1.1 and "hull" in serves, f"{pair}")
    text = run(program, "simulate", scene_of(100), "--plan").stdout
    must("; max_error 100: by enclosing parts, at most 1 and 1, error at most " in text, text)
    must(planned(error)[0]["rung"]["name"] == "parts", "an error that just suffices")
    for pair, hulls, serves in (planned(0.999 * error), planned(100, "l.obj")):
        must(pair["rung"] == {"name": "walk", "error": pair["max_error"]}, f"{pair}")
        must(not hulls and "hull" not in serves, f"{serves}")
    must("rung" not in planned(0)[0], "a rung of exact answers")
    # By hand: at the end, each solid is in the other's notch, and parts touch. The solids do not.
    events, _ = simulate(program, scene_of(100))
    hit, = (event for event in events if event["effect"] == "collide")
    must(hit["event"] == "begins", f"{hit}")
    near = next(event for event in events if event["effect"] == "distance")
    must(near["upper"] - near["lower"] <= error + 1e-9, f"{near}")
    exact, _ = simulate(program, scene_of(0))
    must(all(event["effect"] == "distance" for event in exact) and exact, f"{exact}")
    scene = scene_of(1)
    scene.write_text(scene.read_text().replace('"max_error": 1', '"max_error": -1'))
    done = run(program, "simulate", scene, "--plan")
    must(done.returncode != 0 and "/pairs/0/max_error: found -1; expected a number, 0 or more." in
         done.stderr, done.stderr)


def unused_models(program, folder):
    """A model that no pair of layers asks for is not opened: this one could not be."""
    (folder / "secret.obj").write_text("no mesh\n")
    scene = write_scene(folder / "unused.json", layers=["a", "b"],
                        pairs=[{"layers": ["a", "a"], "effects": ["collide"]},
                               {"layers": ["a", "b"], "effects": []}],
                        objects=[{"name": "x", "model": "crate.obj", "layer": "a"},
                                 {"name": "y", "model": "crate.obj", "layer": "a"},
                                 {"name": "z", "model": "secret.obj", "layer": "b"}])
    origins = [model["origin"] for model in plan_of(program, scene)["models"]]
    must(origins == ["in memory", "unused"], f"{origins}")
    events, summary = simulate(program, scene, "--frames", 2)
    must(len(events) == 1 and summary["objects"] == 2 and summary["kept"] == 1, f"{summary}")


def all_refusals(program, folder, crate):
    """Of the plan and of baked files: one try tells all. No mesh is baked for it."""
    (folder / "broken.obj").write_text("no mesh\n")
    shutil.copy(folder / crate["model"], folder / "damaged.cdp.h5")
    with open(folder / "damaged.cdp.h5", "r+b") as damaged:
        damaged.truncate(600)
    models = [crate["model"], "broken.obj", "damaged.cdp.h5"]
    scene = write_scene(
        folder / "all.json", layers=["a", "b"],
        objects=[dict(crate, name=model, model=model) for model in models],
        pairs=[{"layers": ["a", "a"], "effects": ["distance"]},
               {"layers": ["a", "b"], "effects": ["collide"], "tolerance": 3}])
    words = ["Pair 1 of layers, 'a' and 'b': tolerance has no meaning without within",
             "crate.cdp.h5: its layer 'a' needs distance, but the file has no source_triangle",
             "damaged.cdp.h5: "]
    done = run(program, "simulate", scene, "--plan", "--format", "json", "--cache", folder / "none")
    must(done.returncode == 3, f"{done.returncode}: {done.stderr}")
    told = json.loads(done.stdout)
    check_schema(OUTPUT_SCHEMA, told, "all refusals")
    must(told["exit"] == 3 and len(told["refusals"]) == len(words), f"{told}")
    for word, sentence, line in zip(words, told["refusals"], done.stderr.splitlines()):
        must(word in sentence and sentence in line, f"'{word}' is not in {sentence}, {line}")
    must(not (folder / "none").exists(), "something was baked for a plan that does not exist")
    # With a plan, meshes are baked: then what is wrong with them is told too.
    scene.write_text(scene.read_text().replace(', "tolerance": 3', ""))
    told = run(program, "simulate", scene).stderr
    must(told.count("\n") == 3 and words[1] in told and words[2] in told and "broken.obj" in told,
         told)


def refusals(program, folder):
    """All reasons against a plan at once, and exit 2."""
    bake(program, folder / "crate.obj", "-o", folder / "crate.cdp.h5", "--effects", "collide")
    crate = {"name": "x", "model": "crate.cdp.h5", "layer": "a"}
    all_refusals(program, folder, crate)
    scene = write_scene(folder / "unbuilt.json", layers=["a", "b"], objects=[crate],
                        pairs=[{"layers": ["a", "b"], "effects": ["inside", "response"]},
                               {"layers": ["b", "a"], "effects": ["collide"], "tolerance": 3}])
    words = ["Pair 0 of layers, 'a' and 'b': response needs bodies",
             "Pair 0 of layers, 'a' and 'b': inside is not supported",
             "line 1: /pairs/1: Pair 1 of layers, 'b' and 'a': layers 'b' and 'a' are also those of "
             "pair 0",
             "Pair 1 of layers, 'b' and 'a': tolerance has no meaning without within",
             "crate.cdp.h5: its layer 'a' needs contacts"]
    done = run(program, "simulate", scene, "--plan", "--format", "json")
    must(done.returncode == 2, f"{done.returncode}: {done.stderr}")
    refused = json.loads(done.stdout)
    check_schema(OUTPUT_SCHEMA, refused, "refusals")
    must(len(refused["refusals"]) == len(words) == len(done.stderr.splitlines()), done.stderr)
    for sentence in words:
        must(sentence in done.stderr, f"'{sentence}' is not in {done.stderr}")
    # The same at --frames, and of a file that was not baked for it.
    scene = write_scene(folder / "not_baked.json", layers=["a"], objects=[crate],
                        pairs=[{"layers": ["a", "a"], "effects": ["within", "distance"]}])
    done = run(program, "simulate", scene)
    must(done.returncode == 2 and not done.stdout, done.stderr)
    must(len(done.stderr.splitlines()) == 1, done.stderr)
    for words in ("crate.cdp.h5: its layer 'a' needs distance and within, but the file has no "
                  "source_triangle.", "Bake it again with --effects collide,distance,within."):
        must(words in done.stderr, done.stderr)
    must(plan_of(program, write_scene(
        folder / "baked.json", layers=["a"], objects=[crate],
        pairs=[{"layers": ["a", "a"], "effects": ["collide"]}]))["models"][0]["origin"] == "baked",
         "a baked file is not told from a mesh")


def mistakes(program, folder):
    (folder / "bad.json").write_text('{"cdprep_scene": 1,\n"layers": ["a"], "pairs": [],\n'
                                     '"objects": [{"name": "x", "model": "none.obj", '
                                     '"layer": "b"}],\n"colour": 3}\n')
    (folder / "no.json").write_text('{"cdprep_scene": 1,\n"layers" ["a"]}\n')
    robots = {"arm.urdf": ("URDF", '<?xml version="1.0"?>\n<robot name="arm"/>\n'),
              "arm.sdf": ("SDF", '<sdf version="1.9"/>\n'), "arm.xml": ("MJCF", "<mujoco/>\n")}
    for name, (_, text) in robots.items():
        (folder / name).write_text(text)
    (folder / "broken.obj").write_text("v 1 2 3\nf 1 2 3\n")
    pairs = [{"layers": ["a", "a"], "effects": ["collide"]}]
    (folder / "short.obj").write_text("v 1 2\n")
    write_scene(folder / "broken.json", layers=["a"], pairs=pairs,
                objects=[{"name": "x", "model": "broken.obj", "layer": "a"},
                         {"name": "y", "model": "short.obj", "layer": "a"}])
    write_scene(folder / "long.json", layers=["a"], pairs=pairs, step_s=1e-3, duration_s=1e10,
                objects=[{"name": "x", "model": "crate.obj", "layer": "a"}])
    # The model of these cannot be baked: that they are too long is told before.
    for name, step, duration in (("longer", 1e-3, 1e300), ("endless", 1e-320, 1)):
        write_scene(folder / f"{name}.json", layers=["a"], pairs=pairs, step_s=step,
                    duration_s=duration, objects=[{"name": "x", "model": "broken.obj", "layer": "a"}])
    write_scene(folder / "fly.json", layers=["a"], pairs=pairs,
                objects=[{"name": "x", "model": "crate.obj", "layer": "a", "motion": "fly"}])
    write_scene(folder / "schema.json", **{"$schema": 3}, layers=["a"], pairs=pairs, objects=[])
    bake(program, folder / "crate.obj", "-o", folder / "inches.cdp.h5", "--unit", "in")
    write_scene(folder / "unit.json", layers=["a"], pairs=pairs, metres_per_unit=1,
                objects=[{"name": "x", "model": "inches.cdp.h5", "layer": "a"}])
    write_scene(folder / "far.json", layers=["a"], pairs=pairs, step_s=1,
                objects=[{"name": "x", "model": "crate.obj", "layer": "a",
                          "motion": {"velocity": [1e302, 0, 0]}}])
    good = SCENES / "crates.json"
    cases = [
        ([], 2, ["scene is required"]),
        ([folder / "missing.json"], 3, ["missing.json"]),
        ([folder / "no.json"], 3, ["no.json: line 2: this is not JSON"]),
        *(([folder / name], 3, [f"{name}: this is {form}, which joins bodies"])
          for name, (form, _) in robots.items()),
        ([folder / "bad.json"], 3, ["bad.json: line 4: /colour: unknown key 'colour'",
                                    "line 3: /objects/0/model: there is no file",
                                    "line 3: /objects/0/layer: 'b' is not a layer"]),
        ([folder / "broken.json"], 3, ["broken.obj", "short.obj"]),
        ([folder / "long.json"], 2, ["duration_s / step_s is 1e+13 frames; at most 1000000000"]),
        ([folder / "longer.json"], 2, ["duration_s / step_s is 1e+303 frames; at most 1000000000"]),
        ([folder / "endless.json"], 2, ["duration_s / step_s is too many frames; at most"]),
        ([folder / "fly.json"], 3, ['found "fly"; expected "fixed", "body", or an object with path']),
        ([good, "--frames", 1000000001], 2, ["--frames", "1000000001", "from 1 to 1000000000"]),
        ([folder / "schema.json"], 3, ["schema.json: line 1: /$schema: found 3; expected"]),
        ([folder / "unit.json"], 2, ["inches.cdp.h5 is in in, but the unit of the scene is m"]),
        ([folder / "far.json", "--frames", 2], 2, ["object 'x'"]),
        ([good, "--frames", 0], 2, ["--frames"]),
        ([good, "--frames", 3, "--plan"], 2, ["--frames", "--plan"]),
        ([good, "--plan", "--format", "ndjson"], 2, ["--format ndjson"]),
        ([good, "--plan", "--html", folder / "x.html"], 2, ["--plan and --html cannot be given"]),
        ([good, "--plan", "--svg", folder / "x.svg"], 2, ["--plan and --svg cannot be given"]),
        ([good, "--html", good], 2, ["crates.json is an input or another output"]),
        ([good, "--html", folder / "x", "--svg", folder / "a/../x"], 2, ["is an input or another"]),
        ([good, "--until", -1], 2, ["--until"]),
        ([good, "--until", 1, "--frames", 3], 2, ["--until", "--frames"]),
        ([good, "--until", 1, "--plan"], 2, ["--until", "--plan"]),
        ([good, "--until", 1e300], 2, ["--until / step_s is 8e+300 frames; at most 1000000000"]),
        ([good, "--html", folder / "no/such/x"], 4, ["no/such"]),
        ([good, "--format", "xml"], 2, ["text, json or ndjson"]),
        ([good, "-o", folder / "no/such/folder/x"], 4, ["no/such/folder/x"]),
        ([good, "--cache", folder / "bad.json"], 4, ["bad.json"]),
    ]
    for arguments, code, words in cases:
        done = run(program, "simulate", *arguments)
        must(done.returncode == code, f"{arguments} exited {done.returncode}: {done.stderr}")
        must(all(line.startswith("cdprep simulate: ") for line in done.stderr.splitlines()),
             done.stderr)
        for word in words:
            must(word in done.stderr, f"{arguments}: '{word}' is not in {done.stderr}")


def the_effects(program, folder):
    """The schema of scene files names the effects that the program reads."""
    words = SCENE_SCHEMA["$defs"]["pair"]["properties"]["effects"]["items"]["enum"]
    scene = write_scene(folder / "effects.json", layers=["a"], objects=[],
                        pairs=[{"layers": ["a", "a"], "effects": ["none"]}])
    told = run(program, "simulate", scene).stderr
    must(f"Choose from {', '.join(words[:-1])} or {words[-1]}." in told, told)


def the_help(program):
    """It states the defaults of bodies, as the schema of scene files does."""
    dynamics = SCENE_SCHEMA["$defs"]["dynamics"]["properties"]
    substeps, iterations = (dynamics[key]["default"] for key in ("substeps", "iterations"))
    told = " ".join(run(program, "simulate", "--help").stdout.split())
    must(f"A frame then has {substeps} substeps, and the solver {iterations} iterations in each. "
         "`dynamics` of the scene changes these numbers." in told, told)


def an_interrupt(program):
    running = subprocess.Popen([program, "simulate", SCENES / "thousand.json", "--frames",
                                "100000000"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               text=True)
    time.sleep(1)
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=20)
    must(running.returncode == 130, f"interrupted, it exited {running.returncode}: {told}")
    must("stopped" in told, told)


def main():
    program = sys.argv[1]
    scenes = sorted(SCENES.glob("*.json"))
    must(len(scenes) >= 3, f"only {len(scenes)} sample scenes")
    for scene in scenes:
        check_schema(SCENE_SCHEMA, json.loads(scene.read_text()), scene)
        plan_of(program, scene)
        _, summary = simulate(program, scene, "--frames", 2)
        must(summary["frames"] == 2, f"{scene}: {summary}")
    the_plans(program)
    for check in (the_crates, the_assembly, the_lists, the_clusters, the_thousand):
        with tempfile.TemporaryDirectory() as scratch:
            check(program, pathlib.Path(scratch))
    with tempfile.TemporaryDirectory() as scratch:
        for check in (many_pairs, unused_models, the_rungs, refusals, mistakes, the_effects):
            check(program, pathlib.Path(scratch))
    the_help(program)
    an_interrupt(program)


if __name__ == "__main__":
    main()
