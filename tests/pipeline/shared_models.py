# SPDX-License-Identifier: MIT
"""The test models, where a checkout has them, and the program under test."""
import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77  # ctest: SKIP_RETURN_CODE
# How many times as long a program takes that has sanitizers, where memory and threads are looked
# at: CDPREP_SLOWDOWN=10. Whether answers about large models are right is seen without them.
SLOWDOWN = float(os.environ.get("CDPREP_SLOWDOWN", "1"))
IS_SLOW = SLOWDOWN > 1 and os.environ.get("CDPREP_ALL_POSES") != "yes"


def place_of_shared_folder():
    beside = pathlib.Path(__file__).resolve().parents[2].parent / "shared"
    return pathlib.Path(os.environ.get("CDPREP_SHARED", beside))


def shared_folder_if_there():
    """The folder of test models, or None."""
    folder = place_of_shared_folder()
    return folder if (folder / "models").is_dir() else None


def shared_folder():
    """The folder of test models, or exits as skipped with the reason."""
    folder = shared_folder_if_there()
    if folder is None:
        print(f"skipped: no test models in {place_of_shared_folder()} (set CDPREP_SHARED)")
        sys.exit(SKIPPED)
    return folder


def shared_models_if_there(*names):
    """Those of the test models, or none where a checkout has none."""
    folder = place_of_shared_folder() / "models"
    for name in names:
        if not (folder / name).is_file():
            print(f"skipped: the part about {name}, which is not in {folder} (set CDPREP_SHARED)")
    return [folder / name for name in names if (folder / name).is_file()]


def hard_files(models):
    """The 30 hard models."""
    return sorted(path for path in (models / "hard").iterdir()
                  if path.is_file() and path.suffix not in {".md", ".bin"})


def small(files):
    """Those that take little time: no larger than a million bytes."""
    return [path for path in files if path.stat().st_size <= 1_000_000]


def checker(models, folder):
    """check_mesh.py with its self-intersection counter built beside it, in a folder."""
    for name in ("check_mesh.py", "selfx.cpp"):
        shutil.copy(models / name, folder / name)
    subprocess.run(["g++", "-O2", "-o", folder / "selfx", folder / "selfx.cpp", "-lquadmath"],
                   check=True)
    spec = importlib.util.spec_from_file_location("check_mesh", folder / "check_mesh.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


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
