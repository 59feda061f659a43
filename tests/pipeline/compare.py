#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep compare: every cell of every table has a value or a reason, in each format; poses follow
from the seed; peers are set beside us, and a program that is none is one sentence; what is asked
wrongly has its exit code and writes nothing.

Usage: compare.py CDPREP MESHES [PEERS]
MESHES holds bracket.obj and bolt.obj. PEERS is the program that asks other libraries.
"""
import csv
import json
import pathlib
import re
import signal
import stat
import subprocess
import sys
import tempfile
import time

UNITS = {"", "count", "s", "MiB", "share"}
VERDICTS = {"holds", "fails", "not asked"}


def run(program, *arguments):
    return subprocess.run([program, "compare", *map(str, arguments)], capture_output=True, text=True)


def check_json(report, models):
    assert report["exit"] == 0, report["exit"]
    assert [m["name"] for m in report["models"]] == models, report["models"]
    machine, settings = report["machine"], report["settings"]
    for key in ("processor", "system", "compiler", "build", "kernels"):
        assert machine[key], (key, machine)
    assert settings["rounds"] >= 1 and settings["threads"] >= 1, settings
    cells = 0
    for table in report["tables"]:
        keys = [column["key"] for column in table["columns"]]
        assert len(set(keys)) == len(keys), keys
        assert all(column["unit"] in UNITS for column in table["columns"]), table["columns"]
        for row in table["rows"]:
            assert list(row["cells"]) == keys, (table["table"], row["label"])
            for key, cell in row["cells"].items():
                filled = "value" in cell or bool(cell.get("text"))
                assert filled != bool(cell.get("reason")), (table["table"], row["label"], key, cell)
                cells += 1
    assert cells > 0
    assert all(c["verdict"] in VERDICTS and c["claim"] for c in report["checks"])
    return cells


def check_all_formats(program, meshes):
    models = [meshes / "bracket.obj", meshes / "bolt.obj"]
    done = run(program, *models, "--quick", "--format", "json")
    assert done.returncode == 0, done.stderr
    assert done.stderr == "", done.stderr
    report = json.loads(done.stdout)
    cells = check_json(report, ["bracket", "bolt"])
    names = [table["table"] for table in report["tables"]]
    assert names == ["1", "2", "2.bracket", "2.bolt", "3", "3.details", "4", "4.bracket-bolt",
                     "talk", "talk.search"], names
    ticks = [[c.get("text", "") for c in row["cells"].values()] for row in report["tables"][0]["rows"]]
    assert ticks[0] == ["X"] * 7, ticks
    # Exact strategies agree, which is a promise; so does every tick of the paper's.
    promises = [c for c in report["checks"] if "exact answers" in c["claim"] or
                "Table 1" in c["claim"]]
    assert len(promises) == 2 and all(c["verdict"] == "holds" for c in promises), promises
    poses = report["pairs"][0]["poses"]
    assert len(poses) == 15 and all(len(p["a_from_b"]) == 12 for p in poses), len(poses)
    assert {p["stratum"] for p in poses} == {"deep", "shallow", "touching", "near", "far"}

    text = run(program, *models, "--quick").stdout
    for word in ("Table 1.", "Table 2.", "Table 3.", "Table 4.", "Table talk.", "Errata", "Seed 1"):
        assert word in text, word

    lines = run(program, *models, "--quick", "--format", "csv").stdout.splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert len(rows) == cells, (len(rows), cells)
    assert all(bool(r["value"] or r["text"]) != bool(r["reason"]) for r in rows)

    page = run(program, *models, "--quick", "--format", "html").stdout
    assert page.startswith("<!DOCTYPE html>") and page.endswith("</html>\n")
    assert "http://" not in page and "https://" not in page and "<script" not in page
    assert page.count("<section") == len(names) + 2, page.count("<section")
    assert page.count("<table>") == len(names) and "<svg" in page


def check_choices(program, meshes, folder):
    model = meshes / "bolt.obj"
    output = folder / "out.json"
    done = run(program, model, "--quick", "--tables", "1,4", "--format", "json", "-o", output)
    assert done.returncode == 0 and done.stdout == "", done
    report = json.loads(output.read_text())
    assert [t["table"] for t in report["tables"]] == ["1", "4", "4.bolt-bolt"]
    # The same seed draws the same poses, another seed others.
    poses = [p["a_from_b"] for p in report["pairs"][0]["poses"]]
    for seed, same in ((1, True), (2, False)):
        again = json.loads(run(program, model, "--quick", "--tables", "talk", "--seed", seed,
                               "--format", "json").stdout)
        assert ([p["a_from_b"] for p in again["pairs"][0]["poses"]] == poses) == same, seed
    # Two files of one name are told apart.
    (folder / "other").mkdir()
    (folder / "other/bolt.obj").write_text(model.read_text())
    twice = json.loads(run(program, model, folder / "other/bolt.obj", "--quick", "--tables", "2",
                           "--format", "json").stdout)
    assert [m["name"] for m in twice["models"]] == ["bolt", "bolt (2)"], twice["models"]
    # None of the paper's pairs is among them.
    none = json.loads(run(program, model, "--quick", "--tables", "4", "--pairs", "paper",
                          "--format", "json").stdout)
    assert none["pairs"] == [], none["pairs"]


def check_paper(program, folder):
    """A mesh with the published counts of Horse has its figures beside it, and is not called it."""
    vertices, triangles = 3582, 7172
    rows = [f"v {i % 60} {i // 60} {i * i % 7}" for i in range(vertices)]
    rows += [f"f {1 + i % 3500} {2 + i % 3500} {61 + i % 3500}" for i in range(triangles)]
    path = folder / "mine.obj"
    path.write_text("\n".join(rows) + "\n")
    report = json.loads(run(program, path, "--quick", "--tables", "2,3", "--format", "json").stdout)
    assert "not known" in report["models"][0]["likeness"], report["models"]
    table = {t["table"]: t for t in report["tables"]}
    cells = table["2"]["rows"][0]["cells"]
    assert table["2"]["rows"][0]["label"] == "mine"
    assert cells["tetra_tree_s"]["published"] == {"value": 0.427}, cells["tetra_tree_s"]
    assert abs(table["3"]["rows"][0]["cells"]["pqp_mib"]["value"] - 2.8726) < 5e-5


def program_that(folder, name, body):
    path = folder / name
    path.write_text("#!/bin/sh\n" + body)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def check_peers(program, meshes, folder, peers):
    asked = [meshes / "bolt.obj", "--quick", "--tables", "4", "--format", "json", "--peers"]
    for name, body, word in (("none", None, "cannot be started"),
                             ("crashes", "kill -SEGV $$\n", "signal 11"),
                             ("fails", "exit 3\n", "ended with 3"),
                             ("babbles", "echo hello\n", "not the JSON"),
                             ("lacks", """echo '{"peers": [{"name": "X", "note": "", "build_s": 0,
 "collide": {"seconds": [1], "answers": [1]}, "reasons": {}}], "absent": []}'""", "1 answers")):
        path = folder / name
        if body is not None:
            path = program_that(folder, name, body)
        done = run(program, *asked, path)
        assert done.returncode == 3, (name, done)
        assert word in done.stderr and done.stderr.count("\n") == 1, (name, done.stderr)
        assert word in json.loads(done.stdout)["error"], (name, done.stdout)
    if not peers:
        return
    done = run(program, *asked, peers)
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    check_json(report, ["bolt"])
    labels = [row["label"] for row in report["tables"][1]["rows"]]
    assert labels[10] == "exact BVH", labels
    assert any("PQP was not asked" in line for line in report["peers"]), report["peers"]
    for label in labels[11:]:
        assert any(line.startswith(label) for line in report["peers"]), (label, report["peers"])


def check_refusals(program, meshes, folder):
    model = meshes / "bolt.obj"
    bad = folder / "bad.obj"
    bad.write_text("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    empty = folder / "empty.obj"
    empty.write_text("v 0 0 0\n")
    copy = folder / "copy.obj"
    copy.write_text(model.read_text())
    for code, arguments in ((2, ["--quick"]), (2, [model, "--tables", "5"]),
                            (2, [model, "--format", "svg"]), (2, [model, "--poses", "0"]),
                            (2, [model, "--pairs", "some"]),
                            (2, [copy, "--quick", "-o", copy]), (3, [folder / "absent.obj"]),
                            (3, [bad]), (3, [empty]), (3, [model, bad, "--quick"]),
                            (4, [model, "--quick", "-o", folder / "no/such/folder.txt"])):
        done = run(program, *arguments)
        assert done.returncode == code, (code, arguments, done)
        assert done.stdout == "" and done.stderr, (arguments, done)
    assert copy.read_text() == model.read_text()


def check_interrupt(program, meshes, folder):
    """Stopped in the middle: 130, and nothing is left behind."""
    inside = folder / "stopped"
    inside.mkdir()
    started = subprocess.Popen([program, "compare", str(meshes / "bracket.obj"), "--rounds", "1000",
                                "--poses", "200", "-o", str(inside / "out.txt")],
                               stderr=subprocess.PIPE, text=True)
    time.sleep(1)
    started.send_signal(signal.SIGINT)
    _, said = started.communicate(timeout=120)
    assert started.returncode == 130, (started.returncode, said)
    assert re.search("stopped", said), said
    assert list(inside.iterdir()) == [], list(inside.iterdir())


def main():
    program, meshes = sys.argv[1], pathlib.Path(sys.argv[2])
    peers = sys.argv[3] if len(sys.argv) > 3 else ""
    check_all_formats(program, meshes)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        check_choices(program, meshes, folder)
        check_paper(program, folder)
        check_peers(program, meshes, folder, peers)
        check_refusals(program, meshes, folder)
        check_interrupt(program, meshes, folder)


if __name__ == "__main__":
    main()
