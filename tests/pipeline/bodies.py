#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep simulate: bodies fall, push each other and come to rest; threads, recordings and dropped
effects change nothing of it; what cannot be computed is refused, all at once.

Usage: bodies.py CDPREP
"""
import json
import math
import pathlib
import shutil
import struct
import sys
import tempfile

from shared_models import IS_SLOW, bake, must, run
from simulate import (OUTPUT_SCHEMA, SCENES, check_schema, plan_of, simulate, untimed,
                      write_scene)

INSIDE = 1.8  # of the tray in pile.json


def bodies_of(summary):
    return untimed(summary["response"])


def frames_of(recording):
    """The poses of each frame by object, as a recording has them."""
    poses, frames = {}, []
    for line in recording.read_text().splitlines()[1:-1]:
        for number, *pose in json.loads(line)["poses"]:
            poses[number] = pose
        frames.append(dict(poses))
    return frames


def the_pile(program, folder):
    """The jacks stay in the tray and come to rest; 1 and 2 threads and a replay give the same."""
    first, second, third = (folder / f"{name}.ndjson" for name in ("first", "second", "third"))
    count = 60 if IS_SLOW else 300  # the first of them are enough to compare threads
    pile = (SCENES / "pile.json", "--frames", count)
    events, one = simulate(program, *pile, "-j", 1, "--record", first)
    again, two = simulate(program, *pile, "-j", 2, "--record", second)
    must(first.read_bytes() == second.read_bytes() and events == again, "threads change the pile")
    must(bodies_of(one) == bodies_of(two), f"{one['response']} {two['response']}")
    replayed, three = simulate(program, first, "--record", third)
    told = [event for event in events if event["effect"] != "response"]
    must(first.read_bytes() == third.read_bytes() and told == replayed, "the replay differs")
    must("response" not in three and three["response_is_replayed"], "a replay computes bodies")
    response = one["response"]
    must(response["bodies"] == 20 and response["driven"] == 0, f"{response}")
    must(response["asked_by"] == ["bodies-trays", "bodies-bodies"], f"{response}")
    must(response["incomplete"] == 0 and response["too_fast"] == 0, f"{response}")
    frames = frames_of(first)
    must(len(frames) == one["frames"] == count, f"{one['frames']}")
    if not IS_SLOW:
        the_pile_rests(events, response, frames)


def the_pile_rests(events, response, frames):
    asleep = {}
    for event in (event for event in events if "body" in event):
        asleep[event["body"]] = event["event"]
    must(list(asleep.values()) == ["sleeps"] * 20, f"not all were told to sleep: {asleep}")
    must(response["awake"] == 0 and response["deepest"] <= 0.008, f"{response}")
    for number in range(1, 21):
        x, y, z = frames[-1][number][-3:]
        must(max(abs(x), abs(y)) < INSIDE / 2 and 0 < z < 1, f"object {number} is at {x, y, z}")
        moved = math.dist(frames[-1][number][-3:], frames[-31][number][-3:])
        must(moved < 0.01, f"object {number} still moves: {moved} in half a second")


def ball_scene(folder, name, effects, **members):
    """Two crates fall, 1 and 3 metres, upon a floor."""
    body = {"body": {"mass": 2}}
    return write_scene(
        folder / name, metres_per_unit=1, step_s=1 / 60, duration_s=1, gravity=[0, 0, -8],
        layers=["floors", "crates"], pairs=[{"layers": ["floors", "crates"], "effects": effects}],
        **members,
        objects=[{"name": "floor", "model": str(SCENES / "ground.obj"), "layer": "floors",
                  "pose": {"translation": [0, 0, -0.5]}},
                 {"name": "low", "model": str(SCENES / "crate.obj"), "layer": "crates",
                  "pose": {"translation": [-2, 0, 1.5]}, "motion": body},
                 {"name": "high", "model": str(SCENES / "crate.obj"), "layer": "crates",
                  "pose": {"translation": [2, 0, 3.5]}, "motion": body}])


def check_pushes(events, summary):
    """Each begin of a pair is followed by its end before the next begin. Both rest at last."""
    pushes = {}
    for event in events:
        if event["effect"] == "response" and "a" in event:
            pushes.setdefault((event["a"], event["b"]), []).append(event)
    must(set(pushes) == {("floor", "low"), ("floor", "high")}, f"{pushes}")
    for pair in pushes.values():
        kinds = [event["event"] for event in pair]
        must(kinds == (["begins", "ends"] * len(kinds))[:len(kinds)], f"{pair}")
        must(kinds[-1] == "begins", f"it does not rest: {pair}")
    must(pushes["floor", "low"][0]["frame"] in (30, 31), f"{pushes}")
    told = [event["event"] for pair in pushes.values() for event in pair]
    counted = summary["response"]
    must((told.count("begins"), told.count("ends")) == (counted["begins"], counted["ends"]),
         f"{told} {counted}")


def falls(program, folder):
    """By hand: a crate falls 1 metre in sqrt(2 / 8) seconds. Other effects do not change that."""
    scene = ball_scene(folder, "fall.json", ["response", "collide"])
    recording = folder / "fall.ndjson"
    events, summary = simulate(program, scene, "--record", recording)
    check_pushes(events, summary)
    frames = frames_of(recording)
    for frame in range(30):
        height = 1.5 - 4 * (frame / 60) ** 2
        must(abs(frames[frame][1][-1] - height) < 1e-4, f"frame {frame}: {frames[frame][1]}")
    must(abs(frames[-1][1][-1] - 0.5) < 1e-3, f"it does not rest: {frames[-1][1]}")
    alone = ball_scene(folder, "alone.json", ["response"])
    _, less = simulate(program, alone)
    must(bodies_of(less) == bodies_of(summary), "an effect changes the motion")
    must(less["effects"] == [] and "collide" in less["not_computed"], f"{less}")
    _, still = simulate(program, scene, "--drop", "response")
    must("response" in still["not_computed"] and still["moved"] == 3, f"{still}")


def warnings(program, folder):
    """Standard error tells what was less exact, in every format. Contacts follow 2 m/s here."""
    fast = ball_scene(folder, "fast.json", ["response"])
    for path in SCENES.glob("*.obj"):
        shutil.copy(path, folder)
    pile = json.loads((SCENES / "pile.json").read_text())
    pile["dynamics"]["most_contacts"] = 1
    many = folder / "many.json"
    many.write_text(json.dumps(pile))
    for scene, words in ((fast, "too fast for the search for contacts"), (many, "cut short")):
        for form in ("text",) if IS_SLOW else ("text", "json", "ndjson"):
            done = run(program, "simulate", scene, "--format", form, "-o", folder / "report",
                       "--frames", 45)
            must(done.returncode == 0 and words in done.stderr and "Raise dynamics.most_" in
                 done.stderr and done.stderr.count("\n") == 1, f"{form}: {done.stderr}")


def costs(program, folder):
    """Both effects are measured. What does not fit is refused before anything is computed."""
    scene = ball_scene(folder, "cost.json", ["response", "collide"])
    _, summary = simulate(program, scene, "--cost", "-j", 1)
    must({row["without"] for row in summary["costs"]} == {"response", "collide"}, f"{summary}")
    many = run(program, "simulate", scene, "--cost", "--frames", 900000000)
    must(many.returncode == 5 and "bytes of poses; at most" in many.stderr, many.stderr)


def the_plan(program, folder):
    plan = plan_of(program, SCENES / "pile.json")
    response = plan["response"]
    must((response["bodies"], response["driven"], response["fixed"]) == (20, 0, 1), f"{response}")
    must(response["substeps"] == 4 and response["iterations"] == 50, f"{response}")
    must(response["gravity"] == [0, 0, -9.81], f"{response}")
    must(plan["pairs"][0]["effects"] == ["contacts", "response"], f"{plan['pairs']}")
    must("response" not in plan["not_computed"], f"{plan['not_computed']}")
    jack = next(model for model in plan["models"] if model["path"].endswith("jack.obj"))
    must("mass_properties" in [section["name"] for section in jack["read"]], f"{jack['read']}")


def refusals(program, folder):
    """Each sentence names what to change; all come at once, and nothing is computed."""
    bake(program, SCENES / "crate.obj", "-o", folder / "crate.cdp.h5", "--effects", "contacts")
    shutil.copy(SCENES / "sheet.obj", folder)
    scene = write_scene(
        folder / "refused.json", layers=["a", "b"], gravity=[0, 0, -1],
        dynamics={"tolerance": 1e-6},
        pairs=[{"layers": ["a", "a"], "effects": ["response"]},
               {"layers": ["b", "b"], "effects": ["collide"]}],
        objects=[{"name": "baked", "model": "crate.cdp.h5", "layer": "a", "motion": "body"},
                 {"name": "open", "model": "sheet.obj", "layer": "a", "motion": "body"}])
    done = run(program, "simulate", scene, "--plan", "--format", "json")
    must(done.returncode == 2, f"exit {done.returncode}: {done.stderr}")
    told = json.loads(done.stdout)
    check_schema(OUTPUT_SCHEMA, told, scene)
    parts = ["crate.cdp.h5: its layer 'a' needs response, but the file has no mass_properties. "
             "Bake it again with --effects contacts,response.",
             "The contact tolerance is 1e-06",
             "object 'open': response needs mass, and the mesh is unbalanced"]
    must(len(told["refusals"]) == len(parts), f"{told['refusals']}")
    for part, sentence in zip(parts, told["refusals"]):
        must(part in sentence, sentence)
    what_to_bake(program, folder)
    box = {"name": "box", "model": str(SCENES / "crate.obj"), "layer": "a", "motion": "body"}
    for part, code, members, material in (
            ("/dynamics/most_contacts: found 300; expected a whole number from 1 to 256", 3,
             {"dynamics": {"most_contacts": 300}}, {}),
            ("/dynamics/iterations: found 2000000; expected a whole number from 1 to 1000000", 3,
             {"dynamics": {"iterations": 2000000}}, {}),
            ("/motion/body/mass: found 1e-31; expected a number from 1e-30 to 1e+30", 3, {},
             {"mass": 1e-31}),
            ("object 'box': the friction is 1e+07", 2, {}, {"friction": 1e7})):
        scene = write_scene(folder / "numbers.json", layers=["a"], gravity=[0, 0, -1], **members,
                            pairs=[{"layers": ["a", "a"], "effects": ["response"]}],
                            objects=[dict(box, motion={"body": {"mass": 1e-31}})
                                     if "mass" in material else dict(box, material=material)])
        done = run(program, "simulate", scene, "--plan")
        must(done.returncode == code and part in done.stderr, f"{part}: {done.stderr}")
    alone = write_scene(folder / "alone.json", layers=["a"], gravity=[0, 0, -1], pairs=[],
                        objects=[{"name": "x", "model": "sheet.obj", "layer": "a",
                                  "motion": "body"}])
    done = run(program, "simulate", alone)
    must(done.returncode == 2 and "no pair of this layer requests response" in done.stderr,
         done.stderr)
    plan = run(program, "simulate", SCENES / "pile.json", "--plan").stdout
    must("; contacts within 0.05555; layers 'bodies' and 'trays', 'bodies' and 'bodies'\n" in plan,
         plan)


def what_to_bake(program, folder):
    """One sentence for each file says how to bake it again; after that it is served."""
    scene = ball_scene(folder, "bake.json", ["response", "collide", "contacts"])
    text = scene.read_text()
    for name, effects in (("ground", ["--effects", "ray"]), ("crate", [])):
        bake(program, SCENES / f"{name}.obj", "-o", folder / f"{name}.cdp.h5", *effects)
        text = text.replace(str(SCENES / f"{name}.obj"), f"{name}.cdp.h5")
    scene.write_text(text)
    done = run(program, "simulate", scene)
    told = done.stderr.splitlines()
    must(done.returncode == 2 and len(told) == 2, done.stderr)
    for name, needs, words in (("ground", "collide and contacts", "layer 'floors'"),
                               ("crate", "contacts", "layer 'crates'")):
        found = [line for line in told if f"{name}.cdp.h5: its {words} needs {needs}, but" in line]
        must(len(found) == 1, f"{name}: {told}")
        line = found[0]
        must("piece_adjacency" in line, line)
        option = line.split("Bake it again with ")[1].rstrip(".").split()
        bake(program, SCENES / f"{name}.obj", "-o", folder / f"{name}.cdp.h5", *option)
        for ask in ("ray", "collide"):
            done = run(program, "info", folder / f"{name}.cdp.h5")
            must(ask in done.stdout, f"{ask} is lost: {done.stdout}")
    simulate(program, scene, "--frames", 2)
    # By itself, the effect is enough.
    bake(program, SCENES / "crate.obj", "-o", folder / "crate.cdp.h5", "--effects", "response")
    alone = ball_scene(folder, "alone.json", ["response"])
    alone.write_text(alone.read_text().replace(str(SCENES / "crate.obj"), "crate.cdp.h5"))
    simulate(program, alone, "--frames", 2)


def the_dominoes(program, _):
    """They fall one after the other, and the last one into the trigger."""
    done = run(program, "simulate", SCENES / "dominoes.gltf", "--until", 2)
    must(done.returncode == 0, done.stderr)
    events = [json.loads(line) for line in done.stdout.splitlines()[:-1]]
    first = {}
    for event in events:
        first.setdefault(frozenset((event["a"], event["b"])), event["frame"])
    hits = [first.get(frozenset((a, b))) for a, b in
            zip(["ball"] + [f"domino {i}" for i in range(7)], [f"domino {i}" for i in range(8)])]
    must(None not in hits and hits == sorted(set(hits)), f"the dominoes are hit in frames {hits}")
    must(first.get(frozenset(("domino 7", "end")), 0) > hits[-1], f"{hits}, the trigger: {first}")


def generated(program):
    """The kept meshes and scenes are those that the scripts write."""
    for script, count in (("make_pile.py", 3), ("make_bolt.py", 3), ("make_probe.py", 3),
                          ("make_dominoes.py", 1)):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            done = run(sys.executable, SCENES / script, folder)
            must(done.returncode == 0, done.stderr)
            written_files = list(folder.iterdir())
            must(len(written_files) == count, f"{script} wrote {written_files}")
            for written in written_files:
                must(written.read_text() == (SCENES / written.name).read_text(), f"{written.name}")


def piles_of_models(folder):
    """OBJ, PLY as text and PLY as bytes of one cube give the same meshes."""
    text = (SCENES / "crate.obj").read_text().splitlines()
    points = [line.split()[1:] for line in text if line.startswith("v ")]
    faces = [[int(word.split("/")[0]) - 1 for word in line.split()[1:]]
             for line in text if line.startswith("f ")]
    shutil.copy(SCENES / "crate.obj", folder)
    for name, kind in (("text", "ascii"), ("bytes", "binary_little_endian")):
        header = (f"ply\nformat {kind} 1.0\ncomment {name}\nelement vertex {len(points)}\n"
                  "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                  f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        if kind == "ascii":
            body = "".join(" ".join(p) + " 7\n" for p in points)
            body += "".join(" ".join(map(str, [len(f), *f])) + "\n" for f in faces)
            body = body.encode()
        else:
            body = b"".join(struct.pack("<3fB", *map(float, p), 7) for p in points)
            body += b"".join(struct.pack(f"<B{len(f)}i", len(f), *f) for f in faces)
        (folder / f"{name}.ply").write_bytes(header.encode() + body)
    written = folder / "written"
    done = run(sys.executable, SCENES / "make_pile.py", written, 3,
               *(folder / name for name in ("crate.obj", "text.ply", "bytes.ply")))
    must(done.returncode == 0, done.stderr)
    meshes = [[line for line in (written / f"{name}.obj").read_text().splitlines() if line[0] != "#"]
              for name in ("crate", "text", "bytes")]
    must(meshes[0] == meshes[1] == meshes[2] and len(meshes[0]) == len(points) + len(faces),
         f"{meshes}")
    (folder / "big.ply").write_text("ply\nformat binary_big_endian 1.0\nend_header\n")
    done = run(sys.executable, SCENES / "make_pile.py", written, 3, folder / "big.ply")
    must(done.returncode == 1 and "found the PLY format" in done.stderr, done.stderr)


def the_bolt(program, folder):
    """The bolt never touches the plate. It comes within 0.3 mm when it enters the hole."""
    events, summary = simulate(program, SCENES / "bolt.json")
    must(not any(event["effect"] == "overlap" for event in events), f"{events}")
    distances = [event for event in events if event["effect"] == "distance"]
    must(len(distances) == 1 and distances[0]["lower"] > 0, f"{distances}")
    within = [event["frame"] for event in events if event["effect"] == "within"]
    must(within and 20 < within[0] <= 36, f"{within}")
    must(summary["frames"] == 80, f"{summary['frames']}")


def main():
    program = sys.argv[1]
    generated(program)
    with tempfile.TemporaryDirectory() as scratch:
        piles_of_models(pathlib.Path(scratch))
    for check in (the_pile, falls, warnings, costs, the_plan, refusals, the_bolt, the_dominoes):
        with tempfile.TemporaryDirectory() as scratch:
            check(program, pathlib.Path(scratch))


if __name__ == "__main__":
    main()
