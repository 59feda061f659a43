#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Halves and doubles named constants of decomposition, one at a time, and writes a CSV row for
each: how many pieces or parts, how large an error and how much time a few requests then take.

Builds a copy of the sources in FOLDER in which each constant of tools/decompose/enclose and
tools/decompose/surface reads a factor from the environment, so that one build answers for all.
A constant that sizes an array or is an argument of a template keeps its value and is listed as
`fixed`. Whole numbers are rounded, and stay 1 or more.

  count:   pieces and parts of all requests together, and of the request that changed most, in per
           cent. Constants of drop_points.cpp have requests of their own, to `export`: the points
           it writes.
  error:   the proved outer error beside that with the written value, as ratios: the geometric
           mean over all requests, and the request that changed most. Errors below a ten
           thousandth of the diagonal count as that.
  seconds: of the processor, as a ratio: the median of --rounds runs of all requests, beside the
           last run with the written values; there is one every tenth constant.
  same:    whether all reports are equal, apart from their times.

Usage: vary_constants.py CDPREP FOLDER [--again] [--models FOLDER_OF_MODELS] [--rounds N]
                         [--only NAME,...] [--into TABLE]
--again asks the program that an earlier run built in FOLDER.
--only measures these constants, such as drop_points.kPads; otherwise all.
--into puts the rows into a table of an earlier run. Without --only, it measures the constants that
the table lacks, or has with another value. Rows of constants that are gone leave the table.
CDPREP closes the horse, and bakes what is exported. FOLDER_OF_MODELS holds horse.ply, and need not
be there.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
NEEDED = ("cli", "command_line", "decompose", "export", "hull", "import", "mesh", "text", "write")
ROOMS = ("tools/decompose/enclose", "tools/decompose/surface")
TYPE = r"double|float|std::size_t|std::u?int\d+_t|unsigned|int"
NAMED = re.compile(rf"^(\s*)((?:inline |static )*)constexpr ({TYPE}) (k\w+) = ([^;]+);", re.M)
# Defaults of options that bound what a caller sets.
OPTIONS = {"hull_error.h": ["most_cells"], "solid_cells.h": ["most_cells"]}
COLUMNS = "constant,value,factor,count,count_most_percent,error_mean,error_most,seconds,same"
VARIED = """#pragma once
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <type_traits>
namespace cdprep {
template <class T> T varied(const char* name, T value) {
    const char* const wanted = std::getenv("CDPREP_VARIED");
    const char* const factor = std::getenv("CDPREP_FACTOR");
    if (!wanted || !factor || std::strcmp(wanted, name) != 0) return value;
    const double now = static_cast<double>(value) * std::atof(factor);
    if constexpr (std::is_floating_point_v<T>) return static_cast<T>(now);
    return static_cast<T>(std::max(1.0, std::round(now)));
}
}
"""
ORIGINAL = {}  # texts by path


def rewrite(source, fixed):
    """Lets the constants of a copy read their factor. Returns {name: value} of those that do."""
    found = {}
    for room in ROOMS:
        for path in sorted((source / room).iterdir()):
            if path.suffix not in (".h", ".cpp"):
                continue
            text = ORIGINAL.setdefault(path, path.read_text())

            def replace(match):
                space, how, kind, name, value = match.groups()
                key = f"{path.stem}.{name}"
                if re.search("numeric_limits|sizeof|, k", value):
                    return match[0]
                found[key] = " ".join(value.split())
                if key in fixed:
                    return match[0]
                if space and "static" in how and "inline" not in how:
                    how = "inline " + how
                return (f"{space}{how}const {kind} {name} = "
                        f'cdprep::varied<{kind}>("{key}", {value});')

            text = NAMED.sub(replace, text)
            for field in OPTIONS.get(path.name, []):
                def option(match):
                    key = f"{path.stem}.{field}"
                    found[key] = match[2]
                    return match[1] + f'cdprep::varied<{match[3]}>("{key}", {match[2]});'
                text, count = re.subn(rf"(({TYPE}) {field} = )([\d.']+);",
                                      lambda m: option([m[0], m[1], m[3], m[2]]), text)
                assert count == 1, (path, field)
            if "cdprep::varied" in text:
                include = '#include "decompose/varied.h"\n'
                text = (text.replace("#pragma once\n", "#pragma once\n" + include, 1)
                        if path.suffix == ".h" else include + text)
            path.write_text(text)
    return found


def build(folder):
    """Builds the copy. Returns its program, the constants, and those that are fixed."""
    source, out = folder / "source", folder / "build"
    shutil.rmtree(source, ignore_errors=True)
    for name in subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, text=True,
                               capture_output=True).stdout.split("\n"):
        if name and not name.startswith(("docs/", "samples/meshes/")) and (ROOT / name).exists():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, source / name)
    for path in (source / "tools").iterdir():  # features that decompose does without
        if path.is_dir() and path.name not in (*NEEDED, "page"):
            shutil.rmtree(path)
    main = source / "tools/cli/main.cpp"
    main.write_text(re.sub(r"    add_(?!decompose|export)\w+\(root, exit\);\n", "",
                           main.read_text()))
    (source / "tools/decompose/varied.h").write_text(VARIED)
    fixed = set()
    while True:
        found = rewrite(source, fixed)
        subprocess.run(["cmake", "-S", source, "-B", out, "-G", "Ninja",
                        "-DCMAKE_BUILD_TYPE=Release", "-DCDPREP_TESTS=OFF",
                        "-DCDPREP_SAMPLES=OFF", "-DCMAKE_UNITY_BUILD=ON"], check=True,
                       stdout=subprocess.DEVNULL)
        done = subprocess.run(["ninja", "-k", "0", "-C", out, "cdprep_program",
                               "cdprep-import-child"], text=True, capture_output=True)
        if done.returncode == 0:
            return out / "bin/cdprep", found, fixed
        named = set(re.findall(r"‘[^’]*?\b(k[A-Z]\w+)’ is not usable in a constant", done.stdout))
        named |= set(re.findall(r"the value of ‘[^’]*?\b(k[A-Z]\w+)’", done.stdout))
        more = {key for key in found if key.split(".")[1] in named} - fixed
        if not more:
            sys.exit(done.stdout[-4000:])
        fixed |= more


def built(folder):
    """The same as build(), of an earlier run."""
    found, program = {}, folder / "build/bin/cdprep"
    for room in ROOMS:
        for path in sorted((folder / "source" / room).iterdir()):
            found.update(re.findall(r'varied<.*?>\("(\S+)", ([^;]+)\);', path.read_text()))
    code = program.read_bytes()
    return program, found, {key for key in found if key.encode() + b"\0" not in code}


def exports(cdprep, folder, models):
    """The same as requests(), for drop_points.cpp."""
    kettle, meshes = folder / "kettle.obj", ROOT / "samples/meshes"
    subprocess.run([sys.executable, ROOT / "tests/engines/make_kettle.py", kettle], check=True)
    sources = [(meshes / "bolt.obj", "mm", "--max-error", "0.5"),
               (meshes / "bracket.obj", "mm", "--max-error", "0.5"),
               (kettle, "m", "--parts", "32")]
    if models and models.exists():
        sources.append((models / "horse.ply", "m", "--parts", "16"))
    asked = []
    for source, unit, *limits in sources:
        baked = folder / f"{source.stem}.cdp.h5"
        subprocess.run([cdprep, "bake", source, "-o", baked, "--unit", unit, "--structures", "hull",
                        *limits], check=False, stdout=subprocess.DEVNULL)
        asked.append((f"{source.stem} exported", ["export", baked, "--for", "godot", "--no-visual",
                                                  "-o", folder / f"{source.stem}.glb"]))
    return asked


def requests(cdprep, folder, models):
    """What is asked of what: [(name, arguments)]."""
    meshes = ROOT / "samples/meshes"
    asked = [("bolt parts", [meshes / "bolt.obj", "--parts", "4", "--work", "5000000"]),
             ("bracket parts", [meshes / "bracket.obj", "--parts", "6"]),
             ("bracket error", [meshes / "bracket.obj", "--max-error", "0.4", "--work",
                                "10000000"]),
             ("bracket exact", [meshes / "bracket.obj", "--exact"])]
    if models and models.exists():
        closed = folder / "horse.off"
        subprocess.run([cdprep, "repair", models / "horse.ply", "-o", closed, "--preset",
                        "closed"], check=False, stdout=subprocess.DEVNULL)
        asked += [("horse parts", [closed, "--parts", "16", "--max-vertices", "64"]),
                  ("horse sheet", [models / "horse.ply", "--parts", "12", "--to-surface"]),
                  ("horse little work", [closed, "--parts", "16", "--work", "6000000"]),
                  ("horse tolerance", [closed, "--tolerance", "0.0005"])]
    return [(name, ["decompose", *arguments]) for name, arguments in asked]


def ask(program, asked, key="", factor=1.0):
    """Reports and seconds of all requests with one constant changed."""
    env = {**os.environ, "CDPREP_VARIED": key, "CDPREP_FACTOR": repr(factor)}
    reports, before = [], resource.getrusage(resource.RUSAGE_CHILDREN)
    for _, arguments in asked:
        try:
            done = subprocess.run([program, *arguments, "--format", "json"], env=env, text=True,
                                  capture_output=True, timeout=300)
            reports.append(json.loads(done.stdout))
            reports[-1].pop("seconds", None)
            if "stored_points" in reports[-1]:  # of an export
                reports[-1].update(count=reports[-1]["points"],
                                   diagonal=math.hypot(*reports[-1]["size"]))
                continue
            for key_of_count in ("pieces", "parts"):
                if key_of_count in reports[-1]:
                    reports[-1]["count"] = reports[-1][key_of_count]
        except (subprocess.TimeoutExpired, json.JSONDecodeError):
            reports.append(None)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return reports, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def compare(base, now):
    """Counts and errors of reports beside those of others: a list of CSV fields."""
    pairs = [(a, b) for a, b in zip(base, now) if a and b and "count" in a and "count" in b]
    count = sum(b["count"] for _, b in pairs)
    worst = max(pairs, key=lambda p: abs(p[1]["count"] / p[0]["count"] - 1))
    least = [1e-4 * a.get("diagonal", 0) for a, _ in pairs]  # below, all errors count as equal
    errors = [max(b["outer_error"], low) / max(a["outer_error"], low)
              for (a, b), low in zip(pairs, least) if low]
    mean = math.exp(sum(map(math.log, errors)) / len(errors)) if errors else 1
    most = max(errors, key=lambda r: abs(math.log(r)), default=1)
    return [str(count), f"{100 * (worst[1]['count'] / worst[0]['count'] - 1):+.0f}",
            f"{mean:.3f}", f"{most:.3f}"]


def measure(program, asked, base, beside, key, value, rounds):
    """The rows of a constant, beside the reports and the time with its written value."""
    rows = []
    for factor in (0.5, 2.0):
        ratios = []
        for _ in range(rounds):
            now, seconds = ask(program, asked, key, factor)
            ratios.append(seconds / beside)
        rows.append([key, value, str(factor), *compare(base, now),
                     f"{statistics.median(ratios):.2f}", "yes" if now == base else "no"])
    return rows


def read_table(path):
    """The comments of a table, and its rows by constant."""
    lines = path.read_text().splitlines()
    rows = {}
    for row in csv.reader(line for line in lines if not line.startswith(("#", "constant,"))):
        rows.setdefault(row[0], []).append(row)
    return [line for line in lines if line.startswith("#")], rows


def line_of(row):
    return f'{row[0]},"{row[1]}",{",".join(row[2:])}'


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("cdprep", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--models", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--into", type=pathlib.Path)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    folder, cdprep = options.folder.resolve(), options.cdprep.resolve()
    comments, table = read_table(options.into) if options.into else ([], {})
    program, found, fixed = (built if options.again else build)(folder)
    wanted = set(filter(None, options.only.split(",")))
    if wanted - set(found):
        sys.exit("no such constant: " + ", ".join(sorted(wanted - set(found))))
    wanted = wanted or {key for key, value in found.items()
                        if key not in table or table[key][0][1] != value}
    rows, heads = {}, []
    for group, prepare in ((False, requests), (True, exports)):
        keys = sorted(key for key in wanted if key.startswith("drop_points.") == group)
        if not set(keys) - fixed:
            rows.update((key, [[key, found[key], "fixed"] + 6 * [""]]) for key in keys)
            continue
        asked = prepare(cdprep, folder, options.models)
        base = ask(program, asked)[0]
        failed = [name for (name, _), report in zip(asked, base) if "count" not in (report or ())]
        if failed:
            sys.exit("failed: " + ", ".join(failed))
        heads += ["# requests: " + "; ".join(name for name, _ in asked),
                  f"# with the written values: {sum(r['count'] for r in base)} "
                  + ("points" if group else "pieces and parts")]
        for number, key in enumerate(keys):
            if number % 10 == 0:
                beside = ask(program, asked)[1]
            rows[key] = ([[key, found[key], "fixed"] + 6 * [""]] if key in fixed else
                         measure(program, asked, base, beside, key, found[key], options.rounds))
            print(*map(line_of, rows[key]), sep="\n", file=sys.stderr, flush=True)
    if table and rows:
        heads = [*comments, "# later, " + ", ".join(sorted(rows)) + ":", *heads]
    table = {key: rows.get(key, table.get(key)) for key in found if key in rows or key in table}
    lines = [*(heads or comments), COLUMNS,
             *(line_of(row) for key in sorted(table) for row in table[key])]
    if options.into:
        options.into.write_text("\n".join(lines) + "\n")
    else:
        print("\n".join(lines))


main()
