#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cdprep validate: every format says the same and is as its schema says, exit codes,
names of inputs, rules, baselines, and output that stays small on a million findings.

Usage: validate.py CDPREP
"""
import errno
import json
import os
import pathlib
import pty
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import jsonschema

from schemas import check_schema, report_of
from shared_models import IS_SLOW, must, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
SARIF_SCHEMA = json.loads((ROOT / "tests/data/sarif-2.1.0-part.schema.json").read_text())
JUNIT_SCHEMA = ROOT / "tests/data/junit.xsd"
FORMATS = ["text", "json", "ndjson", "sarif", "junit"]

CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
CUBE = [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]  # outward


def write_obj(path, corners, triangles):
    lines = ["v " + " ".join(map(str, corner)) for corner in corners]
    lines += ["f " + " ".join(str(vertex + 1) for vertex in t) for t in triangles]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n")
    return path


def shuffled(corners, triangles, seed):
    """The same mesh with other numbers."""
    order = list(range(len(corners)))
    random.Random(seed).shuffle(order)
    new = {old: number for number, old in enumerate(order)}
    triangles = [tuple(new[v] for v in (t[1], t[2], t[0])) for t in triangles]
    random.Random(seed + 1).shuffle(triangles)
    return [corners[old] for old in order], triangles


def check_sarif(log):
    """The schema, and what it cannot say: that references lead somewhere."""
    check_schema(SARIF_SCHEMA, log, "SARIF")
    official = os.environ.get("CDPREP_SARIF_SCHEMA")  # that of OASIS, where somebody has it
    if official:
        schema = json.loads(pathlib.Path(official).read_text())
        jsonschema.validators.validator_for(schema)(schema).validate(log)
    only = log["runs"][0]
    rules = only["tool"]["driver"]["rules"]
    must(len({rule["id"] for rule in rules}) == len(rules), "two SARIF rules have one id")
    places = []
    for result in only["results"]:
        must(rules[result["ruleIndex"]]["id"] == result["ruleId"], f"ruleIndex of {result}")
        places += result["locations"]
    invocation = only["invocations"][0]
    for notification in invocation["toolExecutionNotifications"]:
        places += notification["locations"]
    for place in places:
        location = place["physicalLocation"]["artifactLocation"]
        must(only["artifacts"][location["index"]]["location"]["uri"] == location["uri"],
             f"the artifact of {place}")
    for override in invocation["ruleConfigurationOverrides"]:
        must(rules[override["descriptor"]["index"]]["id"] == override["descriptor"]["id"],
             f"the rule of {override}")
    return only


def check_junit(text, scratch):
    """The schema, and that the sums are those of the cases."""
    path = scratch / "junit.xml"
    path.write_text(text)
    done = subprocess.run(["xmllint", "--noout", "--schema", JUNIT_SCHEMA, path],
                          capture_output=True, text=True)
    must(done.returncode == 0, f"JUnit: {done.stderr[:400]}")
    suites = xml.etree.ElementTree.fromstring(text)
    for suite in suites:
        cases = suite.findall("testcase")
        for name, element in (("failures", "failure"), ("errors", "error"),
                              ("skipped", "skipped")):
            found = sum(case.find(element) is not None for case in cases)
            must(int(suite.get(name)) == found, f"JUnit counts {name} wrongly: {suite.attrib}")
        must(int(suite.get("tests")) == len(cases), f"JUnit counts tests wrongly: {suite.attrib}")
    return suites


class Validate:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def __call__(self, *arguments, **options):
        return run(self.program, "validate", *arguments, cwd=self.folder, **options)

    def json(self, *arguments, code=None, **options):
        done = self(*arguments, "--format", "json", **options)
        report = report_of("validate", done.stdout)
        must(code is None or done.returncode == code,
             f"validate {arguments} exited {done.returncode} instead of {code}: {done.stderr}")
        must(report["exit"] == done.returncode, f"{arguments}: the JSON says {report['exit']}")
        return report


def counts_of(mesh):
    return {finding["rule"]: finding["count"] for finding in mesh["findings"]}


def write_inputs(folder):
    """By hand: a cube is clean; without a triangle it has 3 edges and 1 loop of boundary."""
    write_obj(folder / "good/cube.obj", CORNERS, CUBE)
    write_obj(folder / "bad/open.obj", CORNERS, CUBE[1:])
    write_obj(folder / "bad/deep/not finite.obj", [*CORNERS[:-1], (1, 1, "nan")], CUBE)
    write_obj(folder / "bad/range.obj", CORNERS, [*CUBE, (0, 1, 90)])
    (folder / "bad/broken.off").write_text("OFF\n8 6 0\n1 2 3\n")
    (folder / "bad/notes.txt").write_text("no mesh\n")


def test_formats(validate, scratch):
    report = validate.json("good", "bad", code=3)
    names = [mesh["input"] for mesh in report["meshes"]]
    must(names == ["good/cube.obj", "bad/broken.off", "bad/deep/not finite.obj", "bad/open.obj",
                   "bad/range.obj"], f"folders give {names}")
    clean, broken, not_finite, opened, out_of_range = report["meshes"]
    must([mesh["exit"] for mesh in report["meshes"]] == [0, 3, 1, 0, 1], "exit codes by file")
    must(clean["findings"] == [] and clean["verdict"]["volume"] == 1 and
         "simple-solid" in clean["verdict"]["promises"], f"a cube is not clean: {clean}")
    must("broken.off" in broken["error"], broken["error"])
    must(counts_of(opened) == {"CDP0301": 3, "CDP0302": 1} and
         opened["counts"]["boundary_edges"] == 3, f"an open cube has {counts_of(opened)}")
    must(counts_of(not_finite)["CDP0101"] == 1 and
         not_finite["findings"][0]["places"][0]["vertices"] == [7], "the NaN is not placed")
    must(not_finite["uri"] == "bad/deep/not%20finite.obj", not_finite["uri"])
    must(counts_of(out_of_range)["CDP0102"] == 1 and
         out_of_range["findings"][0]["places"][0]["triangles"] == [12], "the index is not placed")
    must(report["summary"] == {"meshes": 5, "failed": 2, "unreadable": 1, "errors": 2,
                               "warnings": report["summary"]["warnings"],
                               "notes": report["summary"]["notes"], "known": 0,
                               "interrupted": False}, report["summary"])

    done = validate("good", "bad", "--format", "ndjson")
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    must(lines == report["meshes"] and done.returncode == 3, "NDJSON differs from JSON")

    sarif = check_sarif(json.loads(validate("good", "bad", "--format", "sarif").stdout))
    must(len(sarif["artifacts"]) == 5, "SARIF names not every file")
    must([sarif["invocations"][0][key] for key in ("executionSuccessful", "exitCode")] ==
         [False, 3], "SARIF's invocation")
    must("broken.off" in sarif["invocations"][0]["toolExecutionNotifications"][0]["message"]
         ["text"], "SARIF hides the file that cannot be read")
    found = [(result["ruleId"], result["level"]) for result in sarif["results"]]
    must(found.count(("CDP0101", "error")) == 1 and ("CDP0301", "warning") in found, found)
    must({"fullyQualifiedName": "triangle 12", "kind": "triangle", "name": "triangle 12"} in
         next(result for result in sarif["results"] if result["ruleId"] == "CDP0102")
         ["locations"][0]["logicalLocations"], "SARIF does not name the triangle")

    suites = check_junit(validate("good", "bad", "--format", "junit").stdout, scratch)
    must([(int(suite.get("failures")), int(suite.get("errors"))) for suite in suites] ==
         [(0, 0), (0, 1), (1, 0), (0, 0), (1, 0)], "JUnit's failures")
    check_junit(validate("good", "bad", "--format", "junit", "--timings").stdout, scratch)

    text = validate("good", "bad").stdout
    must("good/cube.obj: passed" in text and "bad/range.obj: FAILED" in text and
         "error   CDP0102" in text and "triangle 12" in text and
         text.endswith("5 files: 2 failed, 1 unreadable; 2 errors, " +
                       f"{report['summary']['warnings']} warnings, "
                       f"{report['summary']['notes']} notes\n"), text)


def test_same_bytes(validate):
    """Whatever finishes first."""
    write_obj(validate.folder / "aslow.obj", *grid(150))
    for form in FORMATS:
        arguments = ["aslow.obj", "good", "bad", "--format", form]
        first = validate(*arguments, "-j", "1")
        for threads in ("2", "5"):
            again = validate(*arguments, "-j", threads)
            must(again.stdout == first.stdout and again.stderr == first.stderr,
                 f"{form} differs with {threads} threads")
        must(validate(*arguments, "-o", "out").stdout == "", "-o prints too")
        must((validate.folder / "out").read_text() == first.stdout, f"-o differs for {form}")


def grid(n):
    corners = [(x, y, 0) for y in range(n + 1) for x in range(n + 1)]
    triangles = []
    for y in range(n):
        for x in range(n):
            a = y * (n + 1) + x
            triangles += [(a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1)]
    return corners, triangles


def test_inputs(validate):
    def names(*arguments, **options):
        return [mesh["input"] for mesh in validate.json(*arguments, **options)["meshes"]]

    must(names("bad/*.obj") == ["bad/open.obj", "bad/range.obj"], "a pattern")
    must(names("**/*.obj") == ["aslow.obj", "bad/deep/not finite.obj", "bad/open.obj",
                               "bad/range.obj", "good/cube.obj"], "** goes down")
    must(names("bad/[!r]*.o??") == ["bad/broken.off", "bad/open.obj"], "? and [...]")
    must(names("good/cube.obj", "./good/../good/cube.obj", "good") == ["good/cube.obj"],
         "a file named three times")
    write_obj(validate.folder / "odd/a[1].obj", CORNERS, CUBE)
    must(names("odd/a[1].obj") == ["odd/a[1].obj"], "a file whose name is a pattern")
    (validate.folder / "odd/list").write_text("good/cube.obj\r\n\nodd/a[1].obj\nbad/deep\n")
    listed = ["good/cube.obj", "odd/a[1].obj", "bad/deep/not finite.obj"]
    must(names("--files-from", "odd/list") == listed, "a list")
    done = subprocess.run([validate.program, "validate", "--files-from", "-", "--format", "json"],
                          cwd=validate.folder, input="good/cube.obj\n", text=True,
                          capture_output=True)
    must([mesh["input"] for mesh in json.loads(done.stdout)["meshes"]] == listed[:1],
         "a list on standard input")
    line_break = write_obj(validate.folder / "odd/two\nlines\r/ \"'.obj", CORNERS, CUBE)
    done = subprocess.run([validate.program, "validate", "-0", "--files-from", "-", "--format",
                           "json"], cwd=validate.folder, text=True, capture_output=True,
                          input="odd/two\nlines\r/ \"'.obj\0\0good\0odd/a[1].obj\0")
    must([mesh["input"].rsplit("/")[-1] for mesh in json.loads(done.stdout)["meshes"]] ==
         [" \"'.obj", "cube.obj", "a[1].obj"] and done.returncode == 0, f"NUL: {done}")
    line_break.unlink()
    must(validate("good", "--null").returncode == 2, "--null without a list")
    (validate.folder / "odd/nothing").write_text("")
    must(names("--files-from", "odd/nothing", code=0) == [], "an empty list is no mistake")
    for wrong in ("odd/*.stl", "nowhere"):
        mesh = validate.json(wrong, "good", code=3)["meshes"]
        must([m["exit"] for m in mesh] == [3, 0] and wrong in mesh[0]["error"], f"{wrong}: {mesh}")
    (validate.folder / "empty").mkdir()
    must("no file with the extension of a mesh" in validate.json("empty", code=3)["meshes"][0]["error"], "an empty folder")
    os.symlink("..", validate.folder / "good/loop")
    must(names("good") == ["good/cube.obj"], "a link to a folder above")
    os.unlink(validate.folder / "good/loop")


def test_rules(validate):
    cases = [  # arguments, exit code
        (["bad/open.obj"], 0),
        (["bad/open.obj", "--fail-on", "warning"], 1),
        (["bad/open.obj", "--fail-on", "note"], 1),
        (["bad/open.obj", "--fail-on", "CDP0302"], 1),
        (["bad/open.obj", "--fail-on", "Boundary-Loop"], 1),
        (["bad/open.obj", "--fail-on", "CDP0303"], 0),
        (["bad/open.obj", "--fail-on", "CDP0303", "--fail-on", "warning"], 1),
        (["bad/range.obj", "--fail-on", "CDP0303"], 0),
        (["bad/open.obj", "--rule", "boundary-edge=error"], 1),
        (["bad/open.obj", "--rule", "CDP0301=note", "--rule", "CDP0302=note", "--fail-on",
          "warning"], 0),
        (["bad/open.obj", "--rule", "CDP0301=off", "--rule", "cdp0302=off", "--fail-on",
          "note"], 0),
        (["bad/range.obj", "--rule", "CDP0102=warn"], 0),
        (["bad/range.obj", "--rule", "CDP0102=warning", "--fail-on", "warning"], 1),
        (["good", "--fail-on", "note"], 0),
    ]
    for arguments, code in cases:
        for form in FORMATS:
            done = validate(*arguments, "--format", form)
            must(done.returncode == code, f"{arguments} --format {form}: {done.returncode} instead "
                                          f"of {code}: {done.stderr}")
    mesh, = validate.json("bad/open.obj", "--rule", "CDP0301=off", "--rule",
                          "CDP0302=error")["meshes"]
    must([(f["rule"], f["severity"]) for f in mesh["findings"]] == [("CDP0302", "error")] and
         mesh["counts"]["boundary_edges"] == 3, "a rule that is off changes counts")
    sarif = check_sarif(json.loads(validate("bad/open.obj", "--rule", "CDP0301=off", "--rule",
                                            "CDP0302=error", "--format", "sarif").stdout))
    must(sarif["invocations"][0]["ruleConfigurationOverrides"] and
         [result["level"] for result in sarif["results"]] == ["error"], "SARIF's overrides")
    mesh, = validate.json("good", "--no-crossings")["meshes"]
    must("crossings-examined" not in mesh["verdict"]["facts"], "crossings were examined")


def test_baseline(validate):
    """Numbers change, places do not."""
    folder = validate.folder / "base"
    corners, triangles = grid(12)
    triangles = [t for i, t in enumerate(triangles) if i not in (40, 41, 130, 131)]
    far = [tuple(9 + c for c in corner) for corner in CORNERS]  # a second, inverted component
    corners += far
    triangles += [tuple(v + len(corners) - 8 for v in (a, c, b)) for a, b, c in CUBE]
    corners += [(5.5, 5.5, 1), (5, 5, 0), (7, 7, 7)]  # the tip of a fin, an equal and a lone one
    middle = 5 * 13 + 5
    triangles += [(middle, middle + 1, len(corners) - 3), (middle + 14, middle + 1, middle)]
    corners += [(2.2, 9.3, -1), (2.8, 9.3, 1), (2.5, 9.7, 1), (11, 1, 3), (11, 2, 3)]
    last = len(corners) - 1
    triangles += [(last - 4, last - 3, last - 2), (last - 1, last, 2 * 13 + 10)]
    triangles[30] = triangles[30][::-1]
    write_obj(folder / "mesh.obj", corners, triangles)
    (folder / "broken.off").write_text("OFF\n8 6 0\n1 2 3\n")
    strict = ["--fail-on", "note"]
    old = validate("base", "--format", "json", "-o", "old.json")
    must(old.returncode == 3, f"a broken file: {old}")
    found = counts_of(validate.json("base/mesh.obj")["meshes"][0])
    must({"CDP0104", "CDP0105", "CDP0301", "CDP0302", "CDP0303", "CDP0304", "CDP0305", "CDP0401",
          "CDP0404", "CDP0501"} <= set(found), f"the zoo has {found}")

    for seed in range(3):
        write_obj(folder / "mesh.obj", *shuffled(corners, triangles, seed))
        report = validate.json("base", *strict, "--baseline", "old.json", code=0)
        known = sum(found.values())
        must([mesh.get("findings", []) for mesh in report["meshes"]] == [[], []] and
             report["summary"]["known"] == known + 1, f"renumbering: {report}")
        text = validate("base", "good", *strict, "--baseline", "old.json").stdout
        must(text == "3 files: 0 failed, 1 unreadable; 0 errors, 0 warnings, 0 notes, besides "
                     f"{known + 1} known\n", f"what is known is listed: {text}")

    # One triangle less: a hole of its own, with three edges, and nothing else is new.
    write_obj(folder / "mesh.obj", *shuffled(corners, triangles[:100] + triangles[101:], 7))
    report = validate.json("base/mesh.obj", *strict, "--baseline", "old.json", code=1)
    fresh = {f["rule"]: (f["new"], len(f["places"])) for f in report["meshes"][0]["findings"]}
    must(fresh["CDP0301"] == (3, 3) and fresh["CDP0302"][0] == 1, f"new: {fresh}")
    must(report["meshes"][0]["counts"]["boundary_edges"] == found["CDP0301"] + 3, "true counts")
    for form in ("sarif", "junit", "text", "ndjson"):
        done = validate("base/mesh.obj", *strict, "--baseline", "old.json", "--format", form)
        must(done.returncode == 1, f"{form} against a baseline: {done.returncode}")
        if form == "sarif":
            only = check_sarif(json.loads(done.stdout))
            must({result["baselineState"] for result in only["results"]} == {"new"}, "not new")
        if form == "text":
            must("3 new of " in done.stdout, done.stdout)
    must(validate("base/mesh.obj", "--baseline", "old.json").returncode == 0, "warnings fail")

    # An old report that was cut short: numbers are compared, and it says so.
    write_obj(folder / "mesh.obj", corners, triangles)
    validate("base", "--format", "json", "--max-issues", "2", "-o", "short.json")
    report = validate.json("base", *strict, "--baseline", "short.json", code=0)
    must(any("CDP0301 was compared by its count" in remark
             for remark in report["meshes"][1]["remarks"]), "no remark on the comparison")
    write_obj(folder / "mesh.obj", corners, triangles[:100] + triangles[101:])
    report = validate.json("base", *strict, "--baseline", "short.json", code=1)
    must({f["rule"]: f["new"] for f in report["meshes"][1]["findings"]}["CDP0301"] == 3,
         "new by number")

    # What cannot be a baseline.
    validate("base", "--format", "json", "--baseline", "old.json", "-o", "new.json")
    for name, text, words in (("new.json", None, "--baseline"), ("none.json", None, "none.json"),
                              ("text.json", "{", "byte"), ("other.json", "{}", "not a report"),
                              ("list.json", "[]", "not a report"),
                              ("old2.json", '{"report": "cdprep-validate", "version": 99}', "99"),
                              ("cut.json", '{"report": "cdprep-validate", "version": 1}',
                               "schema")):
        if text is not None:
            (validate.folder / name).write_text(text)
        done = validate("base", "--baseline", name)
        must(done.returncode == 3 and words in done.stderr and name in done.stderr and
             not done.stdout, f"{name} as baseline: {done}")


def test_bounds(validate, scratch):
    """Triangles, none of which shares a vertex: 350,000 of them have a million findings."""
    everything = os.environ.get("CDPREP_ALL_POSES") == "yes"
    count = 350_000 if everything else 20_000 if IS_SLOW else 100_000
    path = validate.folder / "soup.stl"
    random.seed(4)
    facet = struct.Struct("<12fH")
    with open(path, "wb") as file:
        file.write(b"soup".ljust(80) + struct.pack("<I", count))
        for i in range(count):
            x, y = float(i % 1000), float(i // 1000)
            file.write(facet.pack(0, 0, 1, x, y, 0, x + 0.5, y, 0, x, y + 0.5, 0, 0))
    for form, limit in zip(FORMATS, (20_000, 2_000_000, 2_000_000, 1_000_000, 200_000)):
        done = validate("soup.stl", "--format", form)
        must(done.returncode == 0 and len(done.stdout) < limit,
             f"{form} has {len(done.stdout)} characters, exit {done.returncode}: {done.stderr}")
        if form == "sarif":
            only = check_sarif(json.loads(done.stdout))
            edges = [r.get("occurrenceCount", 1) for r in only["results"]
                     if r["ruleId"] == "CDP0301"]
            must(sum(edges) == 3 * count and len(edges) == 101, f"SARIF counts {sum(edges)}")
        if form == "junit":
            check_junit(done.stdout, scratch)
    mesh, = validate.json("soup.stl", "--max-issues", "7")["meshes"]
    edges = next(f for f in mesh["findings"] if f["rule"] == "CDP0301")
    must(edges["count"] == 3 * count and len(edges["places"]) == 7, "places or count")
    must(len(mesh["components"]) == 7 and mesh["counts"]["components"] == count, "components")
    mesh, = validate.json("soup.stl", "--max-issues", "0")["meshes"]
    must(not any(f["places"] for f in mesh["findings"]), "0 places")
    os.unlink(path)


def test_ends(validate):
    # An old report stays when the new one cannot be written or is not finished.
    (validate.folder / "kept").write_text("old")
    done = validate("good", "-o", "no/where")
    must(done.returncode == 4 and "no/where" in done.stderr, f"an impossible output: {done}")
    with open("/dev/full", "w") as full:
        done = subprocess.run([validate.program, "validate", "bad"], cwd=validate.folder,
                              stdout=full, stderr=subprocess.PIPE, text=True)
    must(done.returncode == 4 and "standard output" in done.stderr, f"a full stdout: {done}")
    # What comes after the first mesh is not tried again, nor told of again.
    many = validate.folder / "many"
    many.mkdir()
    for number in range(40):
        shutil.copy(validate.folder / "bad/open.obj", many / f"{number}.obj")
    for form in ("text", "json", "ndjson", "sarif"):
        with open("/dev/full", "w") as full:
            done = subprocess.run([validate.program, "validate", many, "--format", form],
                                  stdout=full, stderr=subprocess.PIPE, text=True)
        must(done.returncode == 4 and len(done.stderr.splitlines()) == 1,
             f"a full stdout of {form}, more than one sentence: {done}")
    write_obj(validate.folder / "long.obj", *grid(500))
    going = subprocess.Popen([validate.program, "validate", "long.obj", "aslow.obj", "-j", "1",
                              "--progress", "plain", "-o", "kept"], cwd=validate.folder,
                             stderr=subprocess.PIPE, text=True)
    going.stderr.readline()  # it has begun
    going.terminate()
    going.communicate()
    must(going.returncode == 130 and (validate.folder / "kept").read_text() == "old",
         f"stopped: exit {going.returncode}")
    # Without the program that reads most formats, a file of those cannot be read.
    (validate.folder / "alone").mkdir()
    alone = shutil.copy(validate.program, validate.folder / "alone/cdprep")
    (validate.folder / "scene.gltf").write_text('{"asset": {"version": "2.0"}}')
    done = run(alone, "validate", "scene.gltf", "good", cwd=validate.folder)
    must(done.returncode == 3 and "cdprep-import-child" in done.stderr and
         "good/cube.obj: passed" in done.stdout, f"no import program: {done}")
    odd = os.fsencode(validate.folder) + b"/\xff\xfe odd\n&<\".obj"
    os.link(validate.folder / "bad/open.obj", odd)
    done = validate(os.fsdecode(odd), os.fsdecode(odd) + "\x1b[2J", "--format", "text",
                    errors="surrogateescape")
    for text in (done.stdout, done.stderr):
        must("odd\\n&<\".obj" in text and "\x1b" not in text and "odd\n" not in text,
             f"control characters: {text!r}")
    must(done.stderr.count("\n") == 1 and "obj\\x1b[2J: " in done.stderr, done.stderr)
    for form in FORMATS:
        done = subprocess.run([validate.program, "validate", odd, "--format", form],
                              capture_output=True, cwd=validate.folder)
        must(done.returncode == 0, f"a name that is not UTF-8: {done}")
        if form == "json":
            report_of("validate", done.stdout)
        if form == "sarif":
            check_sarif(json.loads(done.stdout))
        if form == "junit":
            check_junit(done.stdout.decode(), validate.folder)


def read_terminal(end):
    """All that was written to a terminal's other end, which is closed; a terminal hands it
    over in parts of its own choice and says EIO when there is no more."""
    text = b""
    try:
        while part := os.read(end, 4096):
            text += part
    except OSError as error:
        must(error.errno == errno.EIO, str(error))
    os.close(end)
    return text.decode()


def test_terminal(validate):
    """There, what cannot be read is told once; scripts find it in the report and on stderr."""
    ours, theirs = pty.openpty()
    done = subprocess.run([validate.program, "validate", "bad/broken.off", "--progress", "none"],
                          cwd=validate.folder, stdout=theirs, stderr=subprocess.PIPE, text=True)
    os.close(theirs)
    shown = read_terminal(ours)
    must(done.returncode == 3 and done.stderr == "" and shown.count("broken.off: ") == 2 and
         shown.startswith("bad/broken.off: UNREADABLE"), f"{shown}{done.stderr}")
    done = validate("bad/broken.off")
    must(done.stdout == shown.replace("\r\n", "\n") and
         done.stderr == "cdprep validate: " + done.stdout.splitlines()[1].strip() + "\n", f"{done}")


def test_html(validate):
    """The page's own tests look at it; here, that it has what was validated, and when."""
    text = validate("good", "bad").stdout
    done = validate("good", "bad", "--html", "page.html")
    page = (validate.folder / "page.html").read_text()
    must(done.returncode == 3 and done.stdout == text, "--html changes the report")
    must(page.lower().startswith("<!doctype html>") and "bad/open.obj" in page and
         "CDP0302" in page and "broken.off" in page, "the page lacks a mesh or a finding")


def test_explain(program):
    rules = json.loads(run(program, "explain", "--format", "json").stdout)["rules"]
    listed = run(program, "explain").stdout.splitlines()
    must(len(rules) == len(listed) > 20, "explain does not list all")
    for rule, line in zip(rules, listed):
        must(line.startswith(rule["rule"]) and rule["name"] in line, line)
        by_id, by_name = (run(program, "explain", word).stdout
                          for word in (rule["rule"].lower(), rule["name"]))
        must(by_id == by_name, f"{rule['rule']} and {rule['name']} differ")
        words = " ".join(by_id.split())
        for key in ("title", "meaning", "why", "remedy", "decided", "measure"):
            must(" ".join(rule[key].split()) in words, f"explain {rule['rule']} lacks its {key}")
    must(run(program, "explain", "CDP9999").returncode == 2, "a rule that is none")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as scratch, tempfile.TemporaryDirectory() as other:
        folder, other = pathlib.Path(scratch), pathlib.Path(other)
        validate = Validate(program, folder)
        write_inputs(folder)
        test_formats(validate, other)
        test_same_bytes(validate)
        test_inputs(validate)
        test_rules(validate)
        test_baseline(validate)
        test_bounds(validate, other)
        test_terminal(validate)
        test_html(validate)
        test_ends(validate)
        test_explain(program)
    print("reports are what their schemas say")


if __name__ == "__main__":
    main()
