#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep simulate: recordings are as their schema says and replay to the same bytes; a recording that
was changed is refused; dropped effects and costs are told.

Usage: recordings.py CDPREP
"""
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from schemas import check_schema, schema_of
from shared_models import must, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "samples/scenes"
SCHEMA, OUTPUT_SCHEMA = schema_of("simulate/recording"), schema_of("simulate/simulate")


def simulate(program, *arguments, code=0):
    done = run(program, "simulate", *arguments)
    must(done.returncode == code, f"{arguments} exited {done.returncode}: {done.stderr}")
    return done


def summary_of(done):
    return json.loads(done.stdout.splitlines()[-1])["summary"]


def events_of(done):
    """All lines but the summary. A replay has no events of response."""
    return [line for line in done.stdout.splitlines()[:-1]
            if json.loads(line)["effect"] != "response"]


def replays(program, folder):
    """Of every sample scene, with 1 and 2 threads: the same bytes, events and state."""
    for scene in sorted(SCENES.glob("*.json")):
        first, second = folder / "first.ndjson", folder / "second.ndjson"
        told = simulate(program, scene, "--frames", 12, "--record", first, "-j", 1)
        again = simulate(program, first, "--record", second, "-j", 2)
        must(first.read_bytes() == second.read_bytes(), f"{scene} replays to other bytes")
        must(events_of(told) == events_of(again), f"{scene}: events")
        must(summary_of(told)["state_hash"] == summary_of(again)["state_hash"], f"{scene}: state")
        lines = [json.loads(line) for line in first.read_text().splitlines()]
        must(len(lines) == 14 and lines[-1] == {"frames": 12}, f"{scene}: {lines[-1]}")
        for line in lines:
            check_schema(SCHEMA, line, scene)


def moves_along(program, folder):
    """A recording finds its scene's models from wherever it is."""
    place = folder / "scenes"
    shutil.copytree(SCENES, place)
    simulate(program, place / "crates.json", "--frames", 3, "--record", folder / "kept.ndjson")
    moved = folder / "moved"
    moved.mkdir()
    shutil.move(place, moved / "scenes")
    shutil.move(folder / "kept.ndjson", moved / "kept.ndjson")
    simulate(program, moved / "kept.ndjson")
    for shorter in (("--frames", 2), ("--until", 0.2)):
        must(summary_of(simulate(program, moved / "kept.ndjson", *shorter))["frames"] == 2,
             f"{shorter} does not shorten a replay")
    alone = folder / "alone"
    alone.mkdir()
    shutil.copy(moved / "kept.ndjson", alone / "kept.ndjson")
    told = simulate(program, alone / "kept.ndjson", code=3).stderr
    must(f"{alone}/kept.ndjson: the recorded scene: " in told and "there is no file" in told and
         "paths of models are relative to the folder of the recording" in told, told)


def until(program, folder):
    """By hand: steps of 0.125 s, the first at 0."""
    for time_s, frames in ((0, 1), (0.124, 1), (0.125, 2), (1, 9), (3.99, 32)):
        done = simulate(program, SCENES / "crates.json", "--until", time_s)
        must(summary_of(done)["frames"] == frames, f"--until {time_s}: {summary_of(done)['frames']}")
    # 0.3 / 0.1 is below 3 in doubles; the frame at 0.3 s counts all the same.
    scene = folder / "third.json"
    scene.write_text((SCENES / "crates.json").read_text().replace("0.125", "0.1")
                     .replace("crate.obj", str(SCENES / "crate.obj"))
                     .replace("gate.obj", str(SCENES / "gate.obj"))
                     .replace("ground.obj", str(SCENES / "ground.obj")))
    must(summary_of(simulate(program, scene, "--until", 0.3))["frames"] == 4, "0.3 s of 0.1 s steps")


def changed_recordings(program, folder):
    good = folder / "good.ndjson"
    simulate(program, SCENES / "crates.json", "--frames", 4, "--record", good)
    lines = good.read_text().splitlines()
    first = json.loads(lines[0])
    moved = json.loads(lines[2])
    moved["poses"][0][12] += 1
    far = json.loads(lines[2])
    far["poses"][0][0] = 1000
    skewed = json.loads(lines[2])
    skewed["poses"][0][1] = 0.5
    no_import = {key: value for key, value in first.items() if key != "import"}
    other_import = dict(first, **{"import": {"metres_per_unit": "mm"}})
    no_text = {key: value for key, value in first.items() if key != "text"}
    other_model = dict(first, models=["0" * 16 if hash else "" for hash in first["models"]])
    cases = [
        ("no end", lines[:-1], "with the number of frames, is missing"),
        ("fewer", lines[:3] + lines[-1:], "line 4: expected frame 2"),
        ("swapped", lines[:2] + [lines[3], lines[2]] + lines[4:], "line 3: expected frame 1"),
        ("not json", lines[:2] + ["{"] + lines[3:], "line 3: the line is not a JSON object"),
        ("pose", lines[:2] + [json.dumps(moved)] + lines[3:], "line 3: frame 1 gives the state"),
        ("object", lines[:2] + [json.dumps(far)] + lines[3:], "number of an object, below"),
        ("rotation", lines[:2] + [json.dumps(skewed)] + lines[3:], "12 numbers of a rigid motion"),
        ("text", [json.dumps(no_text, separators=(",", ":"))] + lines[1:], "is missing or wrong"),
        ("import", [json.dumps(no_import, separators=(",", ":"))] + lines[1:], "import, models"),
        ("unit", [json.dumps(other_import, separators=(",", ":"))] + lines[1:], "import, models"),
        ("version", [lines[0].replace(":1,", ":2,", 1)] + lines[1:], "not a recording of version 1"),
        ("model", [json.dumps(other_model, separators=(",", ":"))] + lines[1:], "Record the scene"),
    ]
    for name, changed, words in cases:
        path = folder / f"{name}.ndjson"
        path.write_text("".join(line + "\n" for line in changed))
        done = simulate(program, path, code=3)
        must(words in done.stderr and path.name in done.stderr, f"{name}: {done.stderr}")


def imported_alike(program, folder):
    """A replay imports meshes as the run did, without being told. Other options are refused."""
    scene = SCENES / "assembly.json"
    recording, again = folder / "given.ndjson", folder / "again.ndjson"
    given = ("--unit", "mm", "--up-axis", "z")
    simulate(program, scene, "--record", recording, *given)
    must(json.loads(recording.read_text().splitlines()[0])["import"] ==
         {"metres_per_unit": 0.001, "up_axis": "z"}, "the options are not recorded")
    for options in ((), given):
        simulate(program, recording, "--record", again, *options)
        must(again.read_bytes() == recording.read_bytes(), f"{options}: another recording")
    plain = folder / "plain.ndjson"
    simulate(program, scene, "--record", plain)
    for path, options, words in (
            (recording, ("--unit", "cm"), "was recorded with --unit mm, but --unit cm is given"),
            (recording, ("--up-axis", "y"), "with --up-axis z, but --up-axis y is given"),
            (plain, ("--unit", "mm"), "was recorded without --unit, but --unit mm is given"),
            (plain, ("--allow-empty",), "without --allow-empty, but --allow-empty is given"),
            (plain, ("--unit", "mm", "--drop", "distance"), "was recorded without --unit")):
        wrong = simulate(program, path, *options, code=2)
        must(words in wrong.stderr and path.name in wrong.stderr, wrong.stderr)


def dropped_effects(program, folder):
    scene = SCENES / "assembly.json"
    whole = summary_of(simulate(program, scene))
    less = summary_of(simulate(program, scene, "--drop", "distance"))
    must("distance" in less["not_computed"] and "distance" not in whole["not_computed"], f"{less}")
    kept = {effect["name"]: effect["begins"] for effect in less["effects"]}
    for effect in whole["effects"]:
        must(effect["name"] == "distance" or kept[effect["name"]] == effect["begins"], f"{less}")
    text = simulate(program, scene, "--drop", "distance", "--format", "text").stdout
    asked, dropped = "not requested by any pair of layers: ", "left out by --drop: "
    must(dropped + "distance\n" in text and "contacts" in text.split(asked)[1].split("\n")[0], text)
    must("distance" not in text.split(asked)[1].split("\n")[0], text)
    must("not supported yet: inside\n" in text, text)
    page = folder / "page.html"
    simulate(program, scene, "--drop", "distance", "--html", page)
    must(len(re.findall(r'"is_dropped": ?true', page.read_text())) == 1, "the page does not tell")
    frames = summary_of(simulate(program, scene))["frames"]
    must(f"\nframes {frames} of {frames} complete; " in text, text)
    wrong = simulate(program, scene, "--drop", "contacts", code=2)
    must("--drop contacts: no pair of layers requests it." in wrong.stderr, wrong.stderr)
    recording = folder / "assembly.ndjson"
    simulate(program, scene, "--record", recording)
    simulate(program, recording, "--drop", "distance")


def costs(program, folder):
    scene = SCENES / "thousand.json"
    done = simulate(program, scene, "--frames", 20, "--cost", "-j", 1)
    summary = summary_of(done)
    check_schema(OUTPUT_SCHEMA, {"summary": summary}, "--cost")
    must([cost["without"] for cost in summary["costs"]] ==
         [effect["name"] for effect in summary["effects"]], f"{summary['costs']}")
    for effect in summary["effects"]:
        must(effect["asked_by"] and effect["frame_ms"] >= 0, f"{effect}")
    text = simulate(program, scene, "--frames", 5, "--cost", "--format", "text").stdout
    for words in ("time without it  requested by", " % (spread ", "boxes and broad phase"):
        must(words in text, text)
    recording = folder / "thousand.ndjson"
    simulate(program, scene, "--frames", 2, "--record", recording)
    wrong = simulate(program, recording, "--cost", code=2)
    must("--cost simulates the scene several times. Give the scene file" in wrong.stderr,
         wrong.stderr)


def names(program, folder):
    scene = folder / "crates.json"
    for path in SCENES.iterdir():
        if path.is_file():
            shutil.copy(path, folder)
    before = scene.read_bytes()
    for arguments in (["--record", scene], ["-o", scene], ["-o", folder / "x", "--record",
                                                           folder / "a/../x"]):
        wrong = simulate(program, scene, *arguments, code=2)
        must("is an input or another output" in wrong.stderr, wrong.stderr)
    must(scene.read_bytes() == before, "the scene was replaced")
    # What the scene reads is kept too, by whatever name.
    (folder / "link.html").symlink_to(folder / "crate.obj")
    for arguments in (["--html", folder / "link.html"], ["--svg", folder / "crate.obj"]):
        wrong = simulate(program, scene, *arguments, code=2)
        must("is an input or another output" in wrong.stderr, wrong.stderr)
    wrong = simulate(program, folder / "cloth.json", "-o", folder / "loop.pc2", code=2)
    must("loop.pc2 is an input" in wrong.stderr, wrong.stderr)


def an_interrupt(program, folder):
    """What was recorded before it can be replayed."""
    recording = folder / "interrupted.ndjson"
    running = subprocess.Popen([program, "simulate", SCENES / "crates.json", "--frames",
                                "100000000", "--record", recording], stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    time.sleep(1)
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=20)
    must(running.returncode == 130, f"interrupted, it exited {running.returncode}: {told}")
    frames = json.loads(recording.read_text().splitlines()[-1])["frames"]
    must(frames > 0, f"{frames} frames were recorded")
    replayed = summary_of(simulate(program, recording, "--frames", min(frames, 50)))
    must(replayed["frames"] == min(frames, 50), f"{replayed}")


def in_a_later_frame(process):
    """Waits until the progress bar tells that frames are complete. It is drawn in the next one."""
    told = ""
    while not re.search(r"\] [1-9]\d*/\d+ frame", told):
        letter = process.stderr.read(1)
        must(letter, f"it ended: {told}")
        told += letter


def slow_pile(folder):
    """A scene whose frames take 0.2 s or more, so a signal comes in the middle of one."""
    for path in SCENES.glob("*.obj"):
        shutil.copy(path, folder)
    scene = json.loads((SCENES / "pile.json").read_text())
    scene["dynamics"]["substeps"] = 1000000
    path = folder / "pile.json"
    path.write_text(json.dumps(scene))
    return path


def an_interrupt_in_a_frame(program, folder):
    scene = slow_pile(folder)
    for number in (signal.SIGINT, signal.SIGTERM):
        recording = folder / f"{number}.ndjson"
        running = subprocess.Popen([program, "simulate", scene, "--record", recording,
                                    "--progress", "bar"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        in_a_later_frame(running)
        running.send_signal(number)
        _, told = running.communicate(timeout=20)
        must(running.returncode == 130 and re.search(r"stopped (within|before) frame \d+ of \d+;", told),
             f"{running.returncode}: {told}")
        must(recording.exists(), f"signal {number} leaves no recording")
        lines = recording.read_text().splitlines()
        frames = json.loads(lines[-1])["frames"]
        must(frames == len(lines) - 2 > 0, f"{frames} frames in {len(lines)} lines")
        must(summary_of(simulate(program, recording))["frames"] == frames, f"{frames}")
        again = folder / "again.ndjson"
        simulate(program, recording, "--record", again)
        must(again.read_bytes() == recording.read_bytes(), "the replay differs")


def an_interrupt_of_costs(program, folder):
    """The frames are complete by then, and so are report and page: they lack the costs alone."""
    scene = slow_pile(folder)
    report, page = folder / "report.json", folder / "page.html"
    running = subprocess.Popen([program, "simulate", scene, "--frames", "2", "--cost", "--format",
                                "json", "-o", report, "--html", page, "--progress", "bar"],
                               stderr=subprocess.PIPE, text=True)
    told = ""
    while not re.search(r"\] 0/2 cost", told):
        letter = running.stderr.read(1)
        must(letter, f"it ended: {told}")
        told += letter
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=60)
    must(running.returncode == 130 and "stopped during the measurements of --cost" in told,
         f"{running.returncode}: {told}")
    summary = json.loads(report.read_text())["summary"]
    must(summary["frames"] == 2 and "costs" not in summary, f"{summary}")
    must(page.read_text().rstrip().endswith("</html>"), "the page is not complete")


def main():
    program = sys.argv[1]
    for check in (replays, moves_along, until, changed_recordings, imported_alike, dropped_effects,
                  costs, names, an_interrupt, an_interrupt_in_a_frame, an_interrupt_of_costs):
        with tempfile.TemporaryDirectory() as scratch:
            check(program, pathlib.Path(scratch))


if __name__ == "__main__":
    main()
