#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Studies two sample meshes through the program: what every format holds, what is asserted,
what is refused in which words, and that the page tells of a rung when one points at it.

Usage: accuracy.py CDPREP FAULTY
FAULTY is the program with cells of octrees that never meet.
"""
import csv
import json
import math
import pathlib
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

from browser import Browser, find_chromium
from schemas import report_of
from shared_models import bake, must, run

PROGRAM, FAULTY = sys.argv[1:3]
ROOT = pathlib.Path(__file__).resolve().parents[2]
MESHES = ROOT / "samples" / "meshes"
BOLT, BRACKET = MESHES / "bolt.obj", MESHES / "bracket.obj"
LADDERS = ["geometry", "distance", "predicates", "storage", "coherence"]
STRATA = ["deep", "shallow", "touching", "near", "far"]


def accuracy(*arguments, code=0):
    done = run(PROGRAM, "accuracy", *arguments)
    must(done.returncode == code, f"accuracy {arguments} exited {done.returncode}: {done.stderr}")
    return done


def wrong_flags(study, rung, rigid_only=False):
    """False hits and misses, counted anew from the answers by pose."""
    asked = [(pose, answer) for pose, answer in zip(study["poses"], rung["answers"])
             if pose["rigid"] or not rigid_only]
    misses = sum(pose["hit"] and answer == "no" for pose, answer in asked)
    false_hits = sum(not pose["hit"] and answer != "no" for pose, answer in asked)
    return misses, false_hits


def check_pairs(where, rung):
    """Sums by pose, and shares of the sums, within their bands."""
    pairs = rung["pairs"]
    wanted, found, both = (sum(pose[i] for pose in rung["pairs_by_pose"]) for i in range(3))
    must([wanted, found, both] == [pairs["wanted"], pairs["found"], pairs["both"]],
         f"{where}: {pairs}")
    for name, part, whole in [("recall", both, wanted), ("precision", both, found)]:
        band = pairs[name]
        must(math.isclose(band["value"], part / whole if whole else 1), f"{where}: {band}")
        must(band["low"] <= band["value"] <= band["high"], f"{where}: {band}")


def check_rung(study, ladder, rung):
    where = f"{ladder['name']}, {rung['name']}"
    times = rung["time"]
    must(0 < times["median_s"] <= times["p95_s"] <= times["p999_s"], f"{where}: {times}")
    must(len(rung["seconds"]) == times["cases"], f"{where}: {len(rung['seconds'])} times")
    median = sorted(rung["seconds"])[(times["cases"] + 1) // 2 - 1]
    must(math.isclose(median, times["median_s"], rel_tol=1e-9), f"{where}: median {median}")
    if "pairs" in rung:
        check_pairs(where, rung)
    if "answers" not in rung:
        return
    rigid = rung["rigid"]
    must(wrong_flags(study, rung, True) == (rigid["misses"]["count"], rigid["false_hits"]["count"]),
         f"{where}: {rigid}")
    must(rigid["misses"]["of"] + rigid["false_hits"]["of"] == study["rigid"]
         == len(study["poses"]) - rigid["undecided"], f"{where}: {rigid}")
    must(len(rung["answers"]) == len(study["poses"]), f"{where}: answers")
    misses, false_hits = wrong_flags(study, rung)
    strata = rung["strata"].values()
    must(misses == sum(s["misses"]["count"] for s in strata), f"{where}: misses")
    must(false_hits == sum(s["false_hits"]["count"] for s in strata), f"{where}: false hits")
    if rung["promise"] in ("no misses", "exact", "yes and no are right"):
        must(misses == 0, f"{where} missed {misses}")
    if rung["promise"] == "exact":
        must(false_hits == 0, f"{where}: {false_hits} false hits")


def check_json(folder):
    """Every number of the tables can be derived again, and promises hold."""
    output, table = folder / "study.json", folder / "study.csv"
    accuracy(BOLT, BRACKET, "--quick", "--format", "json", "-o", output, "--save", table, "--save",
             folder / "study.html")
    study = report_of("accuracy", output.read_text())
    must(study["exit"] == 0 and study["broken"] == [], f"broken: {study['broken']}")
    must([ladder["name"] for ladder in study["ladders"]] == LADDERS, "ladders")
    must({pose["stratum"] for pose in study["poses"]} == set(STRATA), "strata")
    must(study["machine"]["kernels"] and study["machine"]["compiler"], "machine")
    must(study["self_check"]["low"] <= study["self_check"]["ratio"] <= study["self_check"]["high"],
         f"self-check {study['self_check']}")
    must(study["self_check"]["holds"]
         == (study["self_check"]["low"] <= 1 <= study["self_check"]["high"]), "self-check")
    for ladder in study["ladders"]:
        for rung in ladder["rungs"]:
            check_rung(study, ladder, rung)
            is_told = "touched_bytes" in rung or any("hull" in left for left in ladder["left_out"])
            must(is_told, f"{rung['name']}: bytes that it reads")
    for rung in study["ladders"][1]["rungs"]:
        holds = rung["distance"]["interval_holds"]
        must(holds["count"] == holds["of"] > 0, f"distance, {rung['name']}: {holds}")
    check_table(study, list(csv.DictReader(table.read_text().splitlines())))
    return study


def check_table(study, rows):
    """The CSV has the figures of the JSON."""
    rungs = [rung for ladder in study["ladders"] for rung in ladder["rungs"]]
    must([row["rung"] for row in rows] == [rung["name"] for rung in rungs], "rungs of the CSV")
    for row, rung in zip(rows, rungs):
        figures = {"median_s": rung["time"]["median_s"], "cases": rung["time"]["cases"]}
        figures |= {name: rung[name] for name in ("bytes", "build_s", "outer", "inner", "error")
                    if isinstance(rung.get(name), (int, float))}
        if "answers" in rung:
            for name in ("misses", "false_hits"):
                counts = {s: stratum[name]["count"] for s, stratum in rung["strata"].items()}
                figures |= {f"{s}_{name}": count for s, count in counts.items()}
                figures[name] = sum(counts.values())
        for name, value in figures.items():
            must(math.isclose(float(row[name] or 0), value, rel_tol=1e-8, abs_tol=1e-300),
                 f"{rung['name']}, {name}: {row[name]} in the CSV, {value} in the JSON")


def check_poses(study, folder):
    """`query` gives the answers that the study says are true."""
    poses = folder / "poses.txt"
    poses.write_text("\n".join(" ".join(map(repr, pose["pose"])) for pose in study["poses"]))
    bake(PROGRAM, BOLT, BRACKET, "--output-dir", folder)
    baked = [folder / "bolt.cdp.h5", folder / "bracket.cdp.h5"]
    done = run(PROGRAM, "query", "collide", *baked, "--poses", poses, "--format", "ndjson")
    hits = [json.loads(line)["hit"] for line in done.stdout.splitlines()]
    must(hits == [pose["hit"] for pose in study["poses"]], "query collide answers otherwise")
    must(30 <= 100 * sum(hits) / len(hits) <= 70, f"{sum(hits)} of {len(hits)} poses hit")
    return baked


def check_baked(study, baked):
    """Baked files are the same models: the same poses."""
    done = accuracy(*baked, "--quick", "--ladder", "distance", "--format", "json")
    again = report_of("accuracy", done.stdout)
    must([pose["pose"] for pose in again["poses"]] == [pose["pose"] for pose in study["poses"]],
         "baked files give other poses")
    must([ladder["name"] for ladder in again["ladders"]] == ["distance"], "--ladder")


def check_other_formats(folder):
    short = ["--quick", "--ladder", "predicates,storage"]
    text = accuracy(BOLT, BRACKET, *short).stdout
    must("what the next digit costs" in text and "24-bit grid" in text, text)
    rows = accuracy(BOLT, BRACKET, *short, "--format", "csv").stdout.splitlines()
    table = list(csv.DictReader(rows))
    must(all(row["model_a"] == str(BOLT) and row["seed"] == "1" for row in table), "facts of the CSV")
    must({row["ladder"] for row in table} == {"predicates", "storage"}, "ladders of the CSV")
    must(all(float(row["median_s"]) > 0 and None not in row for row in table), "cells of the CSV")
    svg, again = folder / "charts.svg", folder / "again.csv"
    rows = accuracy(BOLT, BRACKET, *short, "--format", "csv", "--save", svg, "--save", again).stdout
    must(again.read_text() == rows, "what is saved is not what is printed")
    root = xml.etree.ElementTree.parse(svg).getroot()
    must(root.tag == "{http://www.w3.org/2000/svg}svg", root.tag)
    must(len(root.findall(".//{*}circle")) >= 11, "marks of the charts")
    page = folder / "short.html"
    accuracy(BOLT, BRACKET, *short, "--format", "html", "-o", page, "--save", folder / "again.html")
    must(page.read_text() == (folder / "again.html").read_text(), "the page that is saved")
    must(page.read_text().lower().startswith("<!doctype html>"), "no page")


def check_page(folder):
    """Pointing at a mark tells of its rung; nothing asks a network."""
    if not find_chromium():
        print("skipped: the page in a browser: there is no Chromium")
        return
    with Browser(1200, 900) as browser:
        browser.open((folder / "study.html").as_uri())
        must(browser.value("document.querySelectorAll('svg').length") >= 6, "charts")
        must(browser.value("document.getElementById('tip').hidden"), "a card before it is asked")
        browser.value("document.querySelector('#geometry svg .point').scrollIntoView("
                      "{block: 'center'})")
        at = browser.value("(() => { const r = document.querySelector('#geometry svg .point')"
                           ".getBoundingClientRect(); return {x: r.x + r.width / 2, "
                           "y: r.y + r.height / 2}; })()")
        browser.ask("Input.dispatchMouseEvent", type="mouseMoved", x=at["x"], y=at["y"])
        browser.wait("!document.getElementById('tip').hidden")
        card = browser.value("document.getElementById('tip').textContent")
        must("geometry: sphere" in card and "no misses" in card and "worst" in card, card)
        must(browser.value("document.querySelectorAll('tbody tr.lit').length") == 1, "lit row")
        browser.value("document.querySelector('#coherence .block').focus()")
        must("coherence: collide, cold" in browser.value("document.getElementById('tip').textContent"),
             "the Tab key does not reach a bar")
        overlaps = browser.value("document.documentElement.scrollWidth <= innerWidth")
        must(overlaps, "the page is wider than the window")
        must(all(url.startswith(("file:", "data:", "about:")) for url in browser.requests),
             f"the page asked for {browser.requests}")
        must(not browser.complaints, f"the console says {browser.complaints}")


def check_broken_promise(folder):
    """A program whose octrees miss what they enclose says so in every format, and exits with 6."""
    output = folder / "broken.json"
    short = ["accuracy", BOLT, BRACKET, "--quick", "--ladder", "geometry"]
    done = run(FAULTY, *short, "--format", "json", "-o", output)
    must(done.returncode == 6, f"exit {done.returncode}: {done.stderr}")
    must("a promise is broken: geometry, octree 3: " in done.stderr, done.stderr)
    study = report_of("accuracy", output.read_text())
    must(study["exit"] == 6 and len(study["broken"]) == 2, study["broken"])
    must(all("misses" in sentence for sentence in study["broken"]), study["broken"])
    done = run(FAULTY, *short)
    must(done.returncode == 6 and "BROKEN PROMISE: geometry, octree 3" in done.stdout, done.stdout)


def check_refusals(folder):
    """Invalid arguments: 2; unreadable: 3; not written: 4; each in a sentence."""
    empty = folder / "empty.obj"
    empty.write_text("v 0 0 0\n")
    for arguments, code, words in [
            ([BOLT, empty, "--quick"], 3, "has no triangle"),
            ([BOLT, empty, "--quick", "--allow-empty"], 2, "second model has no triangles"),
            ([BOLT, folder / "missing.obj"], 3, "missing.obj"),
            ([BOLT, BRACKET, "--quick", "--ladder", "stairs"], 2, "stairs"),
            ([BOLT, BRACKET, "--quick", "--save", BOLT], 2, "the extension must be .txt"),
            ([BOLT, BRACKET, "--quick", "-o", BOLT], 2, "is an input or another output"),
            ([folder / "bolt.cdp.h5", BRACKET, "--normalize"], 2, "is a baked file"),
            ([BOLT, BRACKET, "--progress", "loud"], 2, "'loud' is not auto, bar, plain or none"),
            ([BOLT, BRACKET, "--quick", "--ladder", "predicates", "-o", folder / "no" / "x"], 4,
             "x")]:
        done = accuracy(*arguments, code=code)
        must(words in done.stderr, f"{arguments}: {done.stderr}")
        must(done.stdout == "", f"{arguments} printed {done.stdout[:80]}")
    done = accuracy(BOLT, empty, "--allow-empty", "--format", "json", code=2)
    failed = report_of("accuracy", done.stdout)
    must(failed["exit"] == 2 and "no triangles" in failed["error"], failed)


def check_interrupt(folder):
    """A person who stops it gets 130, and no file."""
    output = folder / "stopped.json"
    process = subprocess.Popen([PROGRAM, "accuracy", BOLT, BRACKET, "-o", output, "--progress",
                                "plain"], stderr=subprocess.PIPE, text=True)
    said = [process.stderr.readline() for _ in range(4)]
    process.send_signal(signal.SIGINT)
    said += process.stderr.readlines()
    must(process.wait() == 130, f"exit {process.returncode}")
    must(not output.exists(), "a file of a stopped study")
    must(any("poses" in line for line in said), f"progress: {said}")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study = check_json(folder)
        baked = check_poses(study, folder)
        check_baked(study, baked)
        check_other_formats(folder)
        check_page(folder)
        check_broken_promise(folder)
        check_refusals(folder)
        check_interrupt(folder)
    print(f"{len(study['poses'])} poses, {sum(len(l['rungs']) for l in study['ladders'])} rungs")


main()
