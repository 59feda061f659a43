#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/hero.png: the sample bolt in the sample bracket, on the page of validate --html.

Needs Chromium. Usage: docs/draw_hero.py CDPREP
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/pipeline"))
from browser import Browser  # noqa: E402  after the path is set

SHIFT = (26, 15, -19.5)  # of the bolt; samples/quickstart asks at the same pose
CAMERA = "camera=-30,-62,62,20,15,12"


def append(out, name, first, shift):
    """Adds a sample mesh as an object of its own; returns its number of vertices."""
    vertices = 0
    out.write(f"o {name}\n")
    for line in (ROOT / f"samples/meshes/{name}.obj").read_text().splitlines():
        words = line.split()
        if words and words[0] == "v":
            out.write("v %g %g %g\n" % tuple(float(x) + s for x, s in zip(words[1:], shift)))
            vertices += 1
        elif words and words[0] == "f":
            out.write("f " + " ".join(str(int(word) + first) for word in words[1:]) + "\n")
    return vertices


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        with open(folder / "bolt in bracket.obj", "w") as out:
            vertices = append(out, "bracket", 0, (0, 0, 0))
            append(out, "bolt", vertices, SHIFT)
        subprocess.run([program, "validate", "bolt in bracket.obj", "--html", "page.html", "-q"],
                       cwd=folder, check=False)
        with Browser(1280, 760) as browser:
            browser.open(f"file://{folder}/page.html")
            browser.value("document.getElementById('up').click()")  # Z is up
            browser.value(f"location.hash = '#{CAMERA}'")
            browser.settle()
            (ROOT / "docs/hero.png").write_bytes(browser.screenshot())


if __name__ == "__main__":
    main()
