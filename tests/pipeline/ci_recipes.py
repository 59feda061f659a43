#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The workflow and the pre-commit hook of docs/CI.md work: they are taken out of the text and
run in a scratch repository.

Usage: ci_recipes.py CDPREP
"""
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import textwrap

from shared_models import must
from validate import CORNERS, CUBE, ROOT, shuffled, write_obj


def recipes():
    """The shell lines of the baseline, of the workflow, and the hook."""
    section = (ROOT / "docs/CI.md").read_text()
    blocks = re.findall(r"```(\w+)\n(.*?)```", section, re.DOTALL)
    must([kind for kind, _ in blocks] == ["sh", "yaml", "sh"], f"docs/CI.md has {blocks}")
    steps = re.findall(r"^( *)run: \|\n((?:\1  .*\n)+)", blocks[1][1], re.MULTILINE)
    must(len(steps) == 1 and "cdprep validate" in steps[0][1], f"the workflow runs {steps}")
    return blocks[0][1], textwrap.dedent(steps[0][1]), blocks[2][1]


class Repository:
    def __init__(self, folder, program):
        self.folder = folder
        (folder / "bin").mkdir()
        (folder / "bin/cdprep").symlink_to(pathlib.Path(program).resolve())
        who = {f"GIT_{role}_{what}": "x@example.org" for role in ("AUTHOR", "COMMITTER")
               for what in ("NAME", "EMAIL")}
        self.environment = {**os.environ, **who, "HOME": str(folder),
                            "GIT_CONFIG_NOSYSTEM": "1",
                            "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
        self.sh("git init -q . && echo bin > .gitignore && git add .gitignore", 0)

    def sh(self, lines, code):
        """As a service runs a step: it stops at the first failure."""
        done = subprocess.run(["sh", "-e", "-c", lines], cwd=self.folder, env=self.environment,
                              capture_output=True, text=True)
        must(done.returncode == code, f"exit {done.returncode} instead of {code} from {lines!r}: "
                                      f"{done.stdout}{done.stderr}")
        return done


def results(folder):
    log = json.loads((folder / "meshes.sarif").read_text())
    return [result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
            for result in log["runs"][0]["results"]]


def test_hook(repository, hook):
    """It sees what is committed, and nothing else."""
    assets = repository.folder / "assets"
    path = repository.folder / ".git/hooks/pre-commit"
    path.parent.mkdir(exist_ok=True)
    path.write_text(hook)
    path.chmod(0o755)

    def refuse(words):
        refused = repository.sh("git commit -qm bad", 1)
        must(words in refused.stdout + refused.stderr, f"no {words!r} in {refused}")

    repository.sh("git commit -qm text", 0)
    must(not (repository.folder / "mesh-baseline.json").exists()
         or not repository.sh("git ls-files mesh-baseline.json", 0).stdout, "a baseline is there")
    write_obj(assets / "clean.obj", CORNERS, CUBE)
    repository.sh("git add assets/clean.obj && git commit -qm clean", 0)
    repository.sh("git add assets mesh-baseline.json && git commit -qm known", 0)
    for name in ("new\u00e9 one.obj", "T\u00fcr neu.OBJ", "\"two\" 'quotes'.Obj", "two\nlines.obj"):
        write_obj(assets / name, CORNERS, CUBE[2:])
        write_obj(assets / "good.obj", CORNERS, [*CUBE[2:], *CUBE[:2]])
        repository.sh("git add assets/good.obj && git commit --allow-empty -qm good", 0)
        repository.sh("git add assets", 0)
        refuse(".obj: FAILED" if name.endswith(".obj") else f"{name}: FAILED")
        # Mended where it is edited, but not where it is staged; then the other way round.
        write_obj(assets / name, CORNERS, CUBE)
        refuse(": FAILED")
        repository.sh("git add assets", 0)
        write_obj(assets / name, CORNERS, CUBE[2:])
        repository.sh("git commit -qm mended", 0)
        (assets / name).write_text("v 0 0 0\nf 1 2 3\n")
        repository.sh("git add assets", 0)
        refuse("")
        repository.sh("git reset -q --hard", 0)

    # A known mesh may stay as it is; a baseline counts as it is staged.
    write_obj(assets / "old.obj", *shuffled(CORNERS, CUBE[1:], 3))
    (repository.folder / "mesh-baseline.json").write_text("{}")
    repository.sh("git add assets && git commit -qm known", 0)
    repository.sh("git checkout -q mesh-baseline.json", 0)

    # What -a stages, and what is named, is in an index of its own.
    write_obj(assets / "good.obj", CORNERS, CUBE[3:])
    for commit in ("git commit -qam bad", "cd assets && git commit -qm bad good.obj"):
        refused = repository.sh(commit, 1)
        must("assets/good.obj: FAILED" in refused.stdout + refused.stderr, f"{refused}")
    repository.sh("git checkout -q assets", 0)

    # A glTF file is seen with its buffer, also one that no commit touches.
    positions = struct.pack("<24f", *(float(c) for corner in CORNERS for c in corner))
    indices = struct.pack("<36H", *(v for t in CUBE for v in t))
    (assets / "cube.bin").write_bytes(positions + indices)
    repository.sh("git add assets && git commit -qm buffer", 0)
    (assets / "cube.gltf").write_text(json.dumps(gltf_of(len(positions), len(indices))))
    repository.sh("git add assets && git commit -qm gltf", 0)
    must(repository.sh("git status --porcelain", 0).stdout == "?? meshes.sarif\n",
         "the hook left something")


def gltf_of(position_bytes, index_bytes):
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "buffers": [{"uri": "cube.bin", "byteLength": position_bytes + index_bytes}],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": position_bytes},
                {"buffer": 0, "byteOffset": position_bytes, "byteLength": index_bytes}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
                 "min": [0, 0, 0], "max": [1, 1, 1]},
                {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]}


def main():
    program = sys.argv[1]
    baseline, workflow, hook = recipes()
    with tempfile.TemporaryDirectory() as scratch:
        repository = Repository(pathlib.Path(scratch), program)
        assets = repository.folder / "assets"
        write_obj(assets / "good.obj", CORNERS, CUBE)
        write_obj(assets / "old.obj", CORNERS, CUBE[1:])
        repository.sh(baseline, 0)
        known = (repository.folder / "mesh-baseline.json").read_bytes()
        write_obj(assets / "range.obj", CORNERS, [(0, 1, 90)])
        repository.sh(baseline, 0)  # errors and unreadable files can be known too
        repository.sh(workflow, 0)
        (assets / "range.obj").write_text("f x\n")
        repository.sh(workflow, 3)
        repository.sh(baseline, 0)
        repository.sh(workflow, 0)
        (assets / "range.obj").unlink()
        repository.sh(baseline, 0)
        must((repository.folder / "mesh-baseline.json").read_bytes() == known, "other bytes")
        repository.sh(baseline.replace("mesh-", "no/where/"), 4)

        repository.sh(workflow, 0)
        must(results(repository.folder) == [], "known findings are listed")
        write_obj(assets / "new.obj", CORNERS, CUBE[2:])
        repository.sh(workflow, 1)
        must(set(results(repository.folder)) == {"assets/new.obj"}, "what is listed as new")
        write_obj(assets / "new.obj", CORNERS, CUBE)
        repository.sh(workflow, 0)

        test_hook(repository, hook)
    print("the recipes of docs/CI.md hold")


main()
