# SPDX-License-Identifier: MIT
"""The test models, where a checkout has them, and the program under test."""
import json
import os
import pathlib
import subprocess
import sys

SKIPPED = 77  # ctest: SKIP_RETURN_CODE


def shared_folder():
    """The folder of test models, or exits as skipped with the reason."""
    beside = pathlib.Path(__file__).resolve().parents[2].parent / "shared"
    folder = pathlib.Path(os.environ.get("CDPREP_SHARED", beside))
    if not (folder / "models").is_dir():
        print(f"skipped: no test models in {folder} (set CDPREP_SHARED)")
        sys.exit(SKIPPED)
    return folder


def shared_models_if_there(*names):
    """Those of the test models, or none where a checkout has none."""
    beside = pathlib.Path(__file__).resolve().parents[2].parent / "shared"
    folder = pathlib.Path(os.environ.get("CDPREP_SHARED", beside)) / "models"
    return [folder / name for name in names if (folder / name).is_file()]


def run(program, *arguments, **options):
    """Runs cdprep; returns the finished process with text output."""
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, **options)


def must(condition, sentence):
    if not condition:
        print(f"FAILED: {sentence}")
        sys.exit(1)


def bake(program, *arguments, **options):
    """Bakes, which must succeed."""
    done = run(program, "bake", *arguments, **options)
    must(done.returncode == 0, f"bake {arguments} exited {done.returncode}: {done.stderr}")
    return done


def answers(program, *arguments):
    """The NDJSON lines of a query, which must succeed."""
    done = run(program, "query", *arguments, "--format", "ndjson")
    must(done.returncode == 0, f"query {arguments} exited {done.returncode}: {done.stderr}")
    return [json.loads(line) for line in done.stdout.splitlines()]
