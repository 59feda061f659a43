#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep simulate X.gltf: triggers of KHR_physics_rigid_bodies have the events known by hand. A
scene file of the same objects has the same events. Forms, threads, the cache and recordings change
nothing. What is ignored is listed. Mistakes have their exit codes.

Usage: gltf_scenes.py CDPREP
"""
import base64
import json
import math
import pathlib
import sys
import tempfile

from clash import cube, write_gltf
from schemas import check_schema, schema_of
from shared_models import must, run

SCHEMA = schema_of("simulate/simulate")
EXTENSION = "KHR_physics_rigid_bodies"


def simulate(program, scene, *arguments, code=0):
    done = run(program, "simulate", scene, *arguments)
    must(done.returncode == code, f"{scene} {arguments} exited {done.returncode}: {done.stderr}")
    return done


def lines_of(done):
    """The events, and the summary without times."""
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    for line in lines:
        check_schema(SCHEMA, line, line)
    return lines[:-1], lines[-1]["summary"]


def told(done):
    """Frame, effect and kind of each event, and its objects."""
    return [(line["frame"], line["event"], line["a"], line["b"]) for line in lines_of(done)[0]
            if line["effect"] != "response"]


# --- A scene in both forms -----------------------------------------------------------------


def part(name, mesh, translation, physics, **more):
    return {"name": name, "mesh": mesh, "translation": translation,
            "extensions": {EXTENSION: physics}, **more}


def surface(kind, mesh, filter=None):
    members = {"geometry": {"mesh": mesh}}
    return {kind: members if filter is None else {**members, "collisionFilter": filter}}


def moving(velocity=(0, 0, 0), turn=(0, 0, 0)):
    return {"motion": {"isKinematic": True, "linearVelocity": velocity, "angularVelocity": turn}}


# A cube flies through a gate that is larger than it, and past one that its filter refuses. A post
# beside a third gate turns into it. A fourth gate flies over a ground that stands still.
MESHES = [cube(0.5), cube(2), cube(0.25)]
NODES = [
    part("flyer", 0, [-3, 0, 0], {**moving((4, 0, 0)), **surface("collider", 0, 0)}),
    part("gate", 1, [0, 0, 0], surface("trigger", 1, 1)),
    part("closed", 1, [0, 0, 0], surface("trigger", 1, 2)),
    part("post", 0, [0, 20, 0], {**moving(turn=(0, 0, math.pi / 2)), **surface("collider", 0, 0)}),
    part("corner", 2, [0.86, 20, 0], surface("trigger", 2, 1)),
    part("ground", 1, [0, -20, 0], surface("collider", 1)),
    part("scout", 2, [-4, -20, 0], {**moving((4, 0, 0)), **surface("trigger", 2)}),
    {"name": "picture", "mesh": 0},
]
PHYSICS = {EXTENSION: {"collisionFilters": [
    {"collisionSystems": ["cubes"]},
    {"collisionSystems": ["gates"], "collideWithSystems": ["cubes", "others"]},
    {"collisionSystems": ["gates"], "notCollideWithSystems": ["cubes"]}]}}


def write_scene(path, nodes=NODES, **members):
    return write_gltf(path, MESHES, nodes, extensions=PHYSICS, extensionsUsed=[EXTENSION],
                      extensionsRequired=[EXTENSION], **members)


def write_scene_file(folder):
    """The same objects in a scene file, by hand."""
    for number, (points, triangles) in enumerate(MESHES):
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in points)
        text += "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)
        (folder / f"mesh{number}.obj").write_text(text)
    layers = {"flyer": "cubes", "post": "cubes", "gate": "gates", "corner": "gates",
              "closed": "closed", "ground": "ground", "scout": "scouts"}
    objects = []
    for node in NODES:
        if node["name"] not in layers:
            continue
        entry = {"name": node["name"], "model": f"mesh{node['mesh']}.obj",
                 "layer": layers[node["name"]], "pose": {"translation": node["translation"]}}
        motion = node["extensions"][EXTENSION].get("motion")
        if motion:
            entry["motion"] = {"velocity": motion["linearVelocity"],
                               "turn_rad_per_s": motion["angularVelocity"]}
        objects.append(entry)
    pairs = [("cubes", "gates"), ("cubes", "scouts"), ("ground", "scouts"), ("ground", "closed")]
    path = folder / "same.json"
    path.write_text(json.dumps({
        "cdprep_scene": 1, "metres_per_unit": 1, "step_s": 1 / 60, "duration_s": 1,
        "layers": sorted(set(layers.values())), "objects": objects,
        "pairs": [{"layers": pair, "effects": ["collide"], "body": "solid"} for pair in pairs]}))
    return path


# --- Checks --------------------------------------------------------------------------------


def the_triggers(program, folder):
    """By hand: the flyer touches the gate from x = -2.5 to 2.5, also while it is all inside. The
    scout touches the ground from x = -2.25 to 2.25. An edge of the corner gate is at 0.659 from the
    axis of the post, at 22.3 degrees. It is in the post from 40.7 - 22.3 = 18.4 degrees on, and so
    by symmetry up to 71.6; then again after a quarter turn."""
    scene = write_scene(folder / "scene.gltf")
    done = simulate(program, scene, "--frames", 120)
    _, summary = lines_of(done)
    pairs = {}
    for frame, event, a, b in told(done):
        pairs.setdefault(frozenset((a, b)), []).append((event, frame))
    must(pairs.pop(frozenset(("flyer", "gate"))) == [("begins", 8), ("ends", 83)], done.stdout)
    must(pairs.pop(frozenset(("scout", "ground"))) == [("begins", 27), ("ends", 94)], done.stdout)
    must(pairs.pop(frozenset(("post", "corner"))) ==
         [("begins", 13), ("ends", 48), ("begins", 73), ("ends", 108)], done.stdout)
    must(not pairs, f"{pairs}")
    must(summary["frames"] == 120, f"{summary}")
    must(lines_of(simulate(program, scene))[1]["frames"] == 60, "a run is not 1 s")
    # The oracle: a scene file of the same objects, read by another reader.
    as_set = lambda done: {(frame, event, frozenset((a, b))) for frame, event, a, b in told(done)}
    same = simulate(program, write_scene_file(folder), "--frames", 120)
    must(as_set(same) == as_set(done), f"{as_set(same) ^ as_set(done)}")


def the_plan(program, folder):
    scene = write_scene(folder / "scene.gltf")
    plan = json.loads(simulate(program, scene, "--plan", "--format", "json").stdout)
    check_schema(SCHEMA, plan, "--plan")
    must([(layer["name"], layer["objects"]) for layer in plan["layers"]] ==
         [("colliders of cubes", 2), ("triggers of gates", 2), ("triggers of gates#2", 1),
          ("colliders", 1), ("triggers", 1)], f"{plan['layers']}")
    must([pair["layers"] for pair in plan["pairs"]] ==
         [["colliders of cubes", "triggers of gates"], ["colliders of cubes", "triggers"],
          ["triggers of gates#2", "colliders"], ["colliders", "triggers"]], f"{plan['pairs']}")
    must(all(pair["effects"] == ["collide"] for pair in plan["pairs"]), f"{plan['pairs']}")
    must(len(plan["models"]) == 3, f"{plan['models']}")


def the_forms(program, folder):
    """.gltf, .glb, threads and the cache give the same events."""
    one = told(simulate(program, write_scene(folder / "scene.gltf"), "-j", 1))
    must(one, "there are no events")
    binary = write_scene(folder / "scene.glb")
    for arguments in ((binary,), (binary, "-j", 4), (folder / "scene.gltf", "-j", 4),
                      (binary, "--cache", folder / "cache"), (binary, "--cache", folder / "cache")):
        must(told(simulate(program, *arguments)) == one, f"{arguments} gives other events")
    must(len(list((folder / "cache").glob("*.h5"))) == 3, "the cache has not the 3 models")


def the_recordings(program, folder):
    for name in ("scene.gltf", "scene.glb"):
        scene = write_scene(folder / name)
        first, second = folder / "first.ndjson", folder / "second.ndjson"
        done = simulate(program, scene, "--frames", 30, "--record", first, "-j", 1)
        again = simulate(program, first, "--record", second, "-j", 2)
        must(first.read_bytes() == second.read_bytes(), f"{name} replays to other bytes")
        must(told(done) == told(again), f"{name}: other events")
        moved = [dict(node) for node in NODES]
        moved[1]["translation"] = [0, 0, 1]
        write_scene(scene, moved)
        wrong = simulate(program, first, code=3)
        must(f"{name}: the file has changed since it was recorded." in wrong.stderr, wrong.stderr)
        scene.unlink()
        wrong = simulate(program, first, code=3)
        must(name in wrong.stderr, wrong.stderr)


def the_list(program, folder):
    """What is ignored, and what is assumed."""
    plain = simulate(program, write_scene(folder / "scene.gltf"), "--plan").stderr.splitlines()
    start = f"cdprep simulate: {folder / 'scene.gltf'}: "
    must(plain == [
        start + "ignored: a node with triangles but without a collider or trigger (/nodes/7).",
        start + "assumed: a kinematic node without a centre of mass turns about its origin.",
        start + "assumed: a collider or trigger without collision systems is in no system that a "
                "filter lists.",
        start + "assumed: a step is 1/60 s, and a run takes 1 s without --frames or "
                "--until."], f"{plain}")
    joint = part("joined", 0, [9, 9, 9], {**surface("collider", 0), "joint": {"connectedNode": 0}})
    hull = part("hull", 0, [9, 9, -9], {
        "trigger": {"geometry": {"node": 9, "convexHull": True}}})
    more = simulate(program, write_scene(
        folder / "scene.gltf", NODES + [joint, hull],
        animations=[{"channels": [{"target": {"node": 0, "path": "translation"}}]}]), "--plan")
    at = "/extensions/KHR_physics_rigid_bodies/"
    for words in (f"a joint (/nodes/8{at}joint).",
                  f"a convex hull as geometry; the mesh is used (/nodes/9{at}trigger/geometry/node).",
                  "an animation of a node (/animations/0/channels/0)."):
        must(start + "ignored: " + words in more.stderr, more.stderr)


def mistakes(program, folder):
    scene = folder / "wrong.gltf"
    at = "/nodes/0/extensions/KHR_physics_rigid_bodies/collider/"
    for physics, words in (
            (surface("collider", 7), at + "geometry/mesh: found 7, but the last of the meshes is "
                                          "number 2."),
            (surface("collider", 0, 9), at + "collisionFilter: found 9, but the last of the "
                                             "collision filters is number 2."),
            ({"collider": {}}, "the key 'geometry' is missing.")):
        write_scene(scene, [part("wrong", 0, [0, 0, 0], physics)])
        done = simulate(program, scene, "--plan", code=3)
        must(words in done.stderr and str(scene) in done.stderr, done.stderr)
    write_scene(scene, [{"mesh": 0}])
    done = simulate(program, scene, code=3)
    must("there is nothing to compute" in done.stderr, done.stderr)
    for text in ("", "{", "glTF", "[]", '{"asset": {"version": "2.0"}}'):
        scene.write_text(text)
        done = simulate(program, scene, code=3)
        must(str(scene) in done.stderr, done.stderr)
    whole = write_scene(folder / "whole.glb").read_bytes()
    for length in (4, 11, 12, 20, 40, len(whole) // 2):
        (folder / "cut.glb").write_bytes(whole[:length])
        simulate(program, folder / "cut.glb", code=3)


def the_buffers(program, folder):
    """A file that the scene refers to is no output."""
    scene = write_scene(folder / "scene.gltf")
    document = json.loads(scene.read_text())
    data = base64.b64decode(document["buffers"][0]["uri"].split(",", 1)[1])
    document["buffers"][0]["uri"] = "meshes.bin"
    (folder / "meshes.bin").write_bytes(data)
    scene.write_text(json.dumps(document))
    for option in ("--record", "--html", "--svg", "-o"):
        wrong = simulate(program, scene, option, folder / "meshes.bin", code=2)
        must("meshes.bin" in wrong.stderr, wrong.stderr)
    must((folder / "meshes.bin").read_bytes() == data, "a buffer was overwritten")


def the_bodies(program, folder):
    """By hand: the bottom of the box falls 0.25 m to the gate's top in 0.2258 s, so at frame 14. It
    comes to rest on the floor, whose top is at 0."""
    nodes = [part("box", 0, [0, 2, 0], {"motion": {"mass": 2}, **surface("collider", 0)}),
             part("floor", 1, [0, -2, 0], surface("collider", 1)),
             part("gate", 2, [0, 1, 0], surface("trigger", 2))]
    scene = write_scene(folder / "fall.gltf", nodes)
    first, second = folder / "first.ndjson", folder / "second.ndjson"
    done = simulate(program, scene, "--frames", 240, "--record", first)
    must(told(done) == [(14, "begins", "box", "gate")], done.stdout)
    must("gravity is 9.81 m/s^2 along -y" in done.stderr, done.stderr)
    poses = [pose for line in first.read_text().splitlines()
             for pose in json.loads(line).get("poses", []) if pose[0] == 0]
    must(abs(poses[-1][11] - 0.5) < 0.005, f"the box is not on the floor: {poses[-1]}")
    simulate(program, first, "--record", second)
    must(first.read_bytes() == second.read_bytes(), "a replay has other bytes")


def a_long_fall(program, folder):
    """A box falls 3 m, at 7.7 m/s. By the rule, most_speed is 2 sqrt(2 g h), and h is 8 m: from the
    box's top, at 4, to the floor's lowest point, at -4. So nothing is too fast."""
    nodes = [part("box", 0, [0, 3.5, 0], {"motion": {"mass": 2}, **surface("collider", 0)}),
             part("floor", 1, [0, -2, 0], surface("collider", 1))]
    done = simulate(program, write_scene(folder / "fall.gltf", nodes), "--frames", 240)
    _, summary = lines_of(done)
    must(summary["response"]["too_fast"] == 0, f"{summary}")
    must("faster" not in done.stderr, done.stderr)
    start = "assumed: dynamics.most_speed is "
    told_speed = done.stderr.split(start)[1].split(":")[0]
    must(abs(float(told_speed) - 2 * math.sqrt(2 * 9.81 * 8)) < 1e-3, done.stderr)


def main():
    program = sys.argv[1]
    for check in (the_triggers, the_bodies, a_long_fall, the_plan, the_forms, the_recordings, the_list,
                  the_buffers, mistakes):
        with tempfile.TemporaryDirectory() as scratch:
            check(program, pathlib.Path(scratch))


if __name__ == "__main__":
    main()
