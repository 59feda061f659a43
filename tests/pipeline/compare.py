#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep compare: every cell of every table has a value or a reason, in each format, and the JSON is
as its schema says; poses follow from the seed, and are the same when they are saved and read again;
the page opens in a browser; peers are set beside us, and a file that is not a program is one
sentence; an invalid argument has its exit code and writes nothing.

Usage: compare.py CDPREP MESHES [PEERS]
MESHES holds bracket.obj and bolt.obj. PEERS is the program that asks other libraries.
"""
import csv
import pathlib
import re
import signal
import stat
import subprocess
import sys
import tempfile
import time

from browser import Browser, find_chromium
from schemas import report_of


def run(program, *arguments):
    return subprocess.run([program, "compare", *map(str, arguments)], capture_output=True, text=True)


def parsed(text):
    return report_of("compare", text)


def check_json(report, models):
    assert report["exit"] == 0, report["exit"]
    assert [m["name"] for m in report["models"]] == models, report["models"]
    cells = 0
    for table in report["tables"]:
        keys = [column["key"] for column in table["columns"]]
        assert len(set(keys)) == len(keys), keys
        for row in table["rows"]:
            assert list(row["cells"]) == keys, (table["table"], row["label"])
            for key, cell in row["cells"].items():
                filled = "value" in cell or bool(cell.get("text"))
                assert filled != bool(cell.get("reason")), (table["table"], row["label"], key, cell)
                cells += 1
    assert cells > 0
    return cells


def check_all_formats(program, meshes):
    models = [meshes / "bracket.obj", meshes / "bolt.obj"]
    done = run(program, *models, "--quick", "--format", "json")
    assert done.returncode == 0, done.stderr
    assert done.stderr == "", done.stderr
    report = parsed(done.stdout)
    cells = check_json(report, ["bracket", "bolt"])
    names = [table["table"] for table in report["tables"]]
    assert names == ["1", "2", "2.bracket", "2.bolt", "3", "3.details", "3.peers", "4", "4.peers",
                     "4.bracket-bolt", "talk", "talk.search"], names
    ticks = [[c.get("text", "") for c in row["cells"].values()] for row in report["tables"][0]["rows"]]
    assert ticks[0] == ["X"] * 7, ticks
    # Exact strategies agree, which is a promise; so does every tick of the paper's. No step of
    # pruning loses a pair.
    promises = [c for c in report["checks"] if c["promise"]]
    assert len(promises) == 3 and all(c["verdict"] == "holds" for c in promises), promises
    claims = [c["claim"] for c in report["checks"]]
    for word, count in (("Table 1", 1), ("Table 2", 2), ("exact answers", 1),
                        ("against itself", 1), ("at least as long as", 1), ("corners of", 1),
                        ("Every step of pruning", 1),
                        ("hashed octree reduces", 4)):
        assert sum(word in claim for claim in claims) == count, (word, count, claims)
    poses = report["pairs"][0]["poses"]
    assert len(poses) == 15 and all(len(p["a_from_b"]) == 12 for p in poses), len(poses)
    assert {p["stratum"] for p in poses} == {"deep", "shallow", "touching", "near", "far"}

    text = run(program, *models, "--quick").stdout
    for word in ("Table 1.", "Table 2.", "Table 3.", "Table 4.", "Table talk.", "Errata", "Seed 1"):
        assert word in text, word

    lines = run(program, *models, "--quick", "--format", "csv").stdout.splitlines()
    rows = list(csv.DictReader(lines))
    told = {"provenance", "claims"}
    assert told <= {r["table"] for r in rows}
    rows = [r for r in rows if r["table"] not in told]
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
    report = parsed(output.read_text())
    assert [t["table"] for t in report["tables"]] == ["1", "4", "4.peers", "4.bolt-bolt"]
    # The same seed draws the same poses, another seed others.
    poses = [p["a_from_b"] for p in report["pairs"][0]["poses"]]
    for seed, same in ((1, True), (2, False)):
        again = parsed(run(program, model, "--quick", "--tables", "talk", "--seed", seed,
                               "--format", "json").stdout)
        assert ([p["a_from_b"] for p in again["pairs"][0]["poses"]] == poses) == same, seed
    # Two files of one name are told apart.
    (folder / "other").mkdir()
    (folder / "other/bolt.obj").write_text(model.read_text())
    twice = parsed(run(program, model, folder / "other/bolt.obj", "--quick", "--tables", "2",
                           "--format", "json").stdout)
    assert [m["name"] for m in twice["models"]] == ["bolt", "bolt (2)"], twice["models"]
    # A look asks pairs that have each model; all of them when it is told to. The talk's algorithm
    # to the letter is not timed in a look.
    models = [model, meshes / "bracket.obj", folder / "other/bolt.obj"]
    names = ["bolt", "bracket", "bolt (2)"]
    for words, pairs, left_out in (([], 2, 1), (["--pairs", "all"], 3, 0)):
        look = parsed(run(program, *models, "--quick", "--tables", "4", "--format", "json",
                          *words).stdout)
        check_json(look, names)
        assert {pair[side] for pair in look["pairs"] for side in "ab"} == set(names), look["pairs"]
        assert len(look["pairs"]) == pairs, look["pairs"]
        assert look["settings"]["pairs_left_out"] == left_out, look["settings"]
        literal = [row for table in look["tables"] for row in table["rows"]
                   if row["label"].startswith("hashed octree, literal")]
        assert len(literal) == pairs, literal
        for cell in (cell for row in literal for cell in row["cells"].values()):
            assert "value" not in cell and cell["reason"], cell
    # None of the paper's pairs is among them.
    none = parsed(run(program, model, "--quick", "--tables", "4", "--pairs", "paper",
                          "--format", "json").stdout)
    assert none["pairs"] == [], none["pairs"]


def check_poses(program, meshes, folder):
    """Saved poses are read again to the last bit, and asked as if they were drawn."""
    models = [meshes / "bracket.obj", meshes / "bolt.obj"]
    drawn = parsed(run(program, *models, "--quick", "--tables", "4", "--seed", 7, "--save-poses",
                       folder / "poses", "--format", "json").stdout)["pairs"][0]
    path = folder / "poses" / "bracket-bolt.pose"
    lines = path.read_text().splitlines()
    assert "Seed 7." in lines[1] and "# deep" in lines, lines[:6]
    assert len([line for line in lines if not line.startswith("#")]) == 15, len(lines)
    # 17 digits are a double; the models by their hash.
    assert [float(x) for x in lines[5].split()] == drawn["poses"][0]["a_from_b"], lines[5]
    report = parsed(run(program, *models, "--quick", "--tables", "4", "--poses", folder / "poses",
                        "--format", "json").stdout)
    assert sum(model["read_hash"] in line for model in report["models"] for line in lines) == 2
    again = report["pairs"][0]
    assert again["poses"] == drawn["poses"] and again["hash"] == drawn["hash"], again
    assert again["source"] == str(path) and "seed" not in again, again["source"]
    text = run(program, *models, "--quick", "--tables", "4", "--poses", folder / "poses").stdout
    assert f"15 poses of {path}, hash {drawn['hash']}" in text, text[:2000]

    # Neither the poses that were read nor the report are replaced.
    before = path.read_bytes()
    kept = run(program, *models, "--quick", "--tables", "4", "--poses", folder / "poses",
               "--save-poses", folder / "poses")
    assert kept.returncode == 2 and "Choose another folder." in kept.stderr, kept
    kept = run(program, *models, "--quick", "--tables", "4", "-o", path, "--save-poses",
               folder / "poses")
    assert kept.returncode == 2 and "another output" in kept.stderr, kept
    assert "Table 4" in path.read_text(), path.read_text()[:200]
    path.write_bytes(before)

    # Others' files need not tell of strata: what touches is deep.
    path.write_text("\n".join(line for line in lines if not line.startswith("#")) + "\n")
    bare = parsed(run(program, *models, "--quick", "--tables", "talk", "--poses", folder / "poses",
                      "--format", "json").stdout)["pairs"][0]["poses"]
    assert {p["stratum"] for p in bare if p["hit"]} == {"deep"}, bare
    assert {p["stratum"] for p in bare if not p["hit"]} == {"touching", "near", "far"}, bare

    # A stratum without poses has no figures.
    path.write_text("1 0 0 0 1 0 0 0 1 900 0 0\n")
    apart = parsed(run(program, *models, "--quick", "--tables", "4", "--poses", folder / "poses",
                       "--format", "json").stdout)
    assert [pose["hit"] for pose in apart["pairs"][0]["poses"]] == [False], apart["pairs"]
    rows = {t["table"]: t for t in apart["tables"]}["4.bracket-bolt"]["rows"]
    assert all("value" not in row["cells"]["collide_deep"] for row in rows), rows
    for text, word in (("1 0 0 0 1 0 0 0 1 0 0\n", "11 numbers"), ("# deep\n", "no pose"),
                       ("2 0 0 0 1 0 0 0 1 0 0 0\n", "line 1"), (None, "bracket-bolt.pose")):
        path.unlink() if text is None else path.write_text(text)
        done = run(program, *models, "--quick", "--tables", "4", "--poses", folder / "poses")
        assert done.returncode == 3 and done.stdout == "", done
        assert word in done.stderr and done.stderr.count("\n") == 1, done.stderr


def check_page(program, meshes, folder):
    """The page fits its window, asks no network, and tells of a cell that one points at."""
    if not find_chromium():
        print("skipped: the page in a browser: there is no Chromium")
        return
    page = folder / "tables.html"
    assert run(program, meshes / "bracket.obj", meshes / "bolt.obj", "--quick", "--format", "html",
               "-o", page).returncode == 0
    with Browser(1200, 900) as browser:
        browser.open(page.as_uri())
        links = browser.value("[...document.querySelectorAll('nav a')].map(a => a.hash).join(' ')")
        for link in links.split():
            assert browser.value(f"document.querySelectorAll('{link}').length") == 1, link
        assert len(links.split()) == 14, links
        assert browser.value("document.querySelectorAll('svg circle.collide').length") > 9
        empty = "[...document.querySelectorAll('td')].filter(d => !d.textContent.trim()).length"
        assert browser.value(empty) == 0, "cells without anything"
        silent = "[...document.querySelectorAll('td.none')].filter(d => !d.title).length"
        assert browser.value(silent) == 0, "cells without a reason"
        assert "spread" in browser.value("document.querySelector('#table-4 td').title")
        for width in (1200, 480):
            browser.ask("Emulation.setDeviceMetricsOverride", width=width, height=900,
                        deviceScaleFactor=1, mobile=False)
            wide = browser.value("document.documentElement.scrollWidth")
            assert wide <= width, f"the page is {wide} wide in a window of {width}"
        assert all(url.startswith(("file:", "data:", "about:")) for url in browser.requests), \
            browser.requests
        assert not browser.complaints, browser.complaints


def check_paper(program, folder):
    """A mesh with the published counts of Horse has its figures beside it, and is not called it."""
    vertices, triangles = 3582, 7172
    rows = [f"v {i % 60} {i // 60} {i * i % 7}" for i in range(vertices)]
    rows += [f"f {1 + i % 3500} {2 + i % 3500} {61 + i % 3500}" for i in range(triangles)]
    path = folder / "mine.obj"
    path.write_text("\n".join(rows) + "\n")
    report = parsed(run(program, path, "--quick", "--tables", "2,3", "--format", "json").stdout)
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
                             ("fails", "exit 3\n", "ended with exit code 3"),
                             ("babbles", "echo hello\n", "not the expected JSON"),
                             ("lacks", """echo '{"peers": [{"key": "x", "name": "X", "note": "",
 "collide": {"seconds": [[1]], "answers": [1]}, "reasons": {}}], "absent": []}'""", "1 answers")):
        path = folder / name
        if body is not None:
            path = program_that(folder, name, body)
        done = run(program, *asked, path)
        assert done.returncode == 3, (name, done)
        assert word in done.stderr and done.stderr.count("\n") == 1, (name, done.stderr)
        assert word in parsed(done.stdout)["error"], (name, done.stdout)
    if not peers:
        return
    done = run(program, *asked, peers)
    assert done.returncode == 0, done.stderr
    report = parsed(done.stdout)
    check_json(report, ["bolt"])
    table = {t["table"]: t for t in report["tables"]}
    labels = [row["label"] for row in table["4.bolt-bolt"]["rows"]]
    assert labels[10] == "exact BVH", labels
    assert any("PQP was not measured" in line for line in report["peers"]), report["peers"]
    for label in labels[11:]:
        assert any(line.startswith(label) for line in report["peers"]), (label, report["peers"])
    check_peer_cells(table["4.peers"]["rows"][0]["cells"], 2, report["peers"])
    built = parsed(run(program, meshes / "bolt.obj", "--quick", "--tables", "3", "--format", "json",
                       "--peers", peers).stdout)
    cells = {t["table"]: t for t in built["tables"]}["3.peers"]["rows"][0]["cells"]
    check_peer_cells(cells, 0, built["peers"])
    if "value" in cells["qhull_vertices"]:  # 2 v - 4 facets by Euler
        vertices = cells["qhull_vertices"]["value"]
        assert vertices > 3 and cells["qhull_facets"]["value"] == 2 * vertices - 4, cells


def check_peer_cells(cells, ours, said):
    """A column is filled, or its library is said to be absent."""
    title = {"fcl": "FCL", "ode": "ODE", "bullet": "Bullet", "cgal": "CGAL", "embree": "Embree",
             "qhull": "qhull", "pqp": "PQP", "swift": "SWIFT++"}
    for key, cell in list(cells.items())[ours:]:
        words = title[key.split("_")[0]] + " was not measured"
        absent = any(line.startswith(words) for line in said)
        assert ("value" in cell) != absent, (key, cell, said)


def check_refusals(program, meshes, folder):
    model = meshes / "bolt.obj"
    bad = folder / "bad.obj"
    bad.write_text("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    empty = folder / "empty.obj"
    empty.write_text("v 0 0 0\n")
    copy = folder / "copy.obj"
    copy.write_text(model.read_text())
    for code, arguments in ((2, ["--quick"]), (2, [model, "--tables", "5"]),
                            (2, [model, "--format", "svg"]), (2, [model, "--per-stratum", "0"]),
                            (2, [model, "--pairs", "some"]),
                            (2, [model, "--poses", folder / "absent"]),
                            (2, [model, "--poses", folder, "--seed", "1"]),
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
                                "--per-stratum", "200", "--progress", "plain",
                                "-o", str(inside / "out.txt")],
                               stderr=subprocess.PIPE, text=True)
    # It has begun to measure, and has more to measure than it could in this time.
    begun = started.stderr.readline()
    assert begun and started.poll() is None, begun
    time.sleep(1)
    assert started.poll() is None, "over before it was stopped"
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
        check_poses(program, meshes, folder)
        check_page(program, meshes, folder)
        check_paper(program, folder)
        check_peers(program, meshes, folder, peers)
        check_refusals(program, meshes, folder)
        check_interrupt(program, meshes, folder)


if __name__ == "__main__":
    main()
