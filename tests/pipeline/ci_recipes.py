#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What README.md tells people to put into CI does what it says: its workflow and its
pre-commit hook are taken out of the text and run in a scratch repository.

Usage: ci_recipes.py CDPREP
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap

from shared_models import must
from validate import CORNERS, CUBE, ROOT, write_obj


def recipes():
    """The shell lines of the baseline, of the workflow, and the hook."""
    section = (ROOT / "README.md").read_text().split("## Meshes in CI\n")[1].split("\n## ")[0]
    blocks = re.findall(r"```(\w+)\n(.*?)```", section, re.DOTALL)
    must([kind for kind, _ in blocks] == ["sh", "yaml", "sh"], f"README has {blocks}")
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


def main():
    program = sys.argv[1]
    baseline, workflow, hook = recipes()
    with tempfile.TemporaryDirectory() as scratch:
        repository = Repository(pathlib.Path(scratch), program)
        assets = repository.folder / "assets"
        write_obj(assets / "good.obj", CORNERS, CUBE)
        write_obj(assets / "old.obj", CORNERS, CUBE[1:])
        repository.sh(baseline, 0)

        repository.sh(workflow, 0)
        must(results(repository.folder) == [], "known findings are listed")
        write_obj(assets / "new.obj", CORNERS, CUBE[2:])
        repository.sh(workflow, 1)
        must(set(results(repository.folder)) == {"assets/new.obj"}, "what is listed as new")
        write_obj(assets / "new.obj", CORNERS, CUBE)
        repository.sh(workflow, 0)

        # The hook sees what is committed, and nothing else.
        path = repository.folder / ".git/hooks/pre-commit"
        path.parent.mkdir(exist_ok=True)
        path.write_text(hook)
        path.chmod(0o755)
        repository.sh("git commit -qm text", 0)
        repository.sh("git add assets mesh-baseline.json && git commit -qm known", 0)
        write_obj(assets / "new\u00e9 one.obj", CORNERS, CUBE[2:])
        write_obj(assets / "good.obj", CORNERS, [*CUBE[2:], *CUBE[:2]])
        repository.sh("git add assets/good.obj && git commit -qm good", 0)
        refused = repository.sh("git add assets && git commit -qm bad", 1)
        must("new\u00e9 one.obj: FAILED" in refused.stdout + refused.stderr, f"{refused}")
        (assets / "new\u00e9 one.obj").write_text("v 0 0 0\nf 1 2 3\n")
        repository.sh("git add assets && git commit -qm worse", 1)
        must(repository.sh("git log --oneline | wc -l", 0).stdout.strip() == "3", "commits")
    print("the recipes of README.md hold")


main()
