#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Man pages, completion and docs/COMMANDS.md are those of the program's options.

Usage: manuals.py CDPREP
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from shared_models import must

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(*command, **options):
    return subprocess.run(command, text=True, capture_output=True, **options)


def commands_of(program, path=()):
    """All commands by their words, as --help lists them."""
    text = run(program, *path, "--help").stdout
    listed = re.search(r"^Commands:\n((?:  .*\n| +.*\n)+)", text, re.M)
    yield path, text
    for name in re.findall(r"^  (\w+)", listed[1] if listed else "", re.M):
        yield from commands_of(program, (*path, name))


def help_is_complete(program, folder):
    """Each command has its usage, at most 80 columns, its options in its man page and an example."""
    commands = list(commands_of(program))
    must(len(commands) > 15, f"only {len(commands)} commands")
    for path, text in commands:
        name = " ".join(("cdprep", *path))
        must(text.startswith(f"Usage: {name}"), f"{name}: {text[:80]}")
        must(max(map(len, text.splitlines())) <= 110, f"{name}: a line of --help is too long")
        page = (folder / "man" / (name.replace(" ", "-") + ".1")).read_text()
        page = page.replace("\\-", "-")
        for option in re.findall(r"^ +(?:-\w, )?(--[\w-]+)", text, re.M):
            must(option in page, f"{name}: {option} is not in the man page")
        if path and path[-1] != "query":
            must("Examples:" in text, f"{name} has no example")


def readme_is_tested():
    """The C++ of README.md is that of a unit test, but for comments and what it returns."""
    readme = (ROOT / "README.md").read_text()
    shown = re.search(r"```cpp\n#include <cdprep/cdprep.hpp>\n(.*?)```", readme, re.S).group(1)
    test = (ROOT / "tests/unit/lib/whole/doc_examples_test.cpp").read_text()
    tested = re.search(r" readme\(\) \{\n(.*?) *return ReadmeAnswer", test, re.S).group(1)
    shown = re.sub(r"//.*", "", shown).replace("return 1;", "return std::nullopt;")
    must(shown.split() == tested.split(), f"README.md has\n{shown}\nbut the test has\n{tested}")


def man_pages_render(folder):
    for page in (folder / "man").iterdir():
        done = run("groff", "-man", "-Tutf8", "-ww", "-z", page)
        must(done.returncode == 0 and not done.stderr, f"{page.name}: {done.stderr}")


def completed(folder, *words):
    """What bash offers for the last of some words."""
    script = (f"source {folder}/completion/cdprep.bash; COMP_WORDS=({' '.join(words)}); "
              f"COMP_CWORD={len(words) - 1}; _cdprep; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
    done = run("bash", "-c", script, cwd=folder)
    must(done.returncode == 0, done.stderr)
    return done.stdout.split()


def bash_completes(folder):
    must("bake" in completed(folder, "cdprep", "''"), "bash offers no command")
    must(completed(folder, "cdprep", "val") == ["validate"], "bash does not complete 'val'")
    must("--effects" in completed(folder, "cdprep", "bake", "--e"), "bash offers no option")
    must(completed(folder, "cdprep", "validate", "--format", "sa") == ["sarif"],
         "bash offers no value")
    must("overlap" in completed(folder, "cdprep", "query", "o"), "bash offers no query")
    must("octree" in completed(folder, "cdprep", "query", "overlap", "--structure", "''"),
         "bash offers no structure")
    must(completed(folder, "cdprep", "bake", "--effects", "ov") == ["overlap"],
         "bash does not complete the first word of a list")
    must(completed(folder, "cdprep", "bake", "--effects", "ray,collide,ov")
         == ["ray,collide,overlap"], "bash does not complete the last word of a list")


def other_shells_read_theirs(folder):
    for shell, name in (("zsh", "_cdprep"), ("fish", "cdprep.fish")):
        if not shutil.which(shell):
            print(f"skipped: {shell} is not installed")
            continue
        done = run(shell, "-n", folder / "completion" / name)
        must(done.returncode == 0 and not done.stderr, f"{shell}: {done.stderr}")


def fish_completes(folder):
    if not shutil.which("fish"):
        return
    for line, words in (("cdprep bake --effects ray,ov", ["ray,overlap"]),
                        ("cdprep query overlap --structure tet", ["tetra-tree"])):
        done = run("fish", "-c", f"source {folder}/completion/cdprep.fish; complete -C '{line}'")
        offered = [each.split("\t")[0] for each in done.stdout.splitlines()]
        must(offered == words, f"fish offers {offered} for {line}")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        done = run(program, "--write-manuals", folder)
        must(done.returncode == 0 and not done.stdout + done.stderr, done.stderr)
        must((folder / "COMMANDS.md").read_text() == (ROOT / "docs/COMMANDS.md").read_text(),
             "docs/COMMANDS.md is old: run cdprep --write-manuals and copy COMMANDS.md")
        help_is_complete(program, folder)
        readme_is_tested()
        man_pages_render(folder)
        bash_completes(folder)
        other_shells_read_theirs(folder)
        fish_completes(folder)
        done = run(program, "--write-manuals", "/proc/none")
        must(done.returncode == 4 and done.stderr.count("\n") == 1, done.stderr)


if __name__ == "__main__":
    main()
