#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/pile.png: twenty jacks that fall into a tray, on the page of simulate --html.

Needs Chromium, and cdprep built with Bullet. Usage: docs/draw_pile.py CDPREP
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/pipeline"))
from browser import Browser  # noqa: E402  after the path is set

CAMERA = """(() => {
  const view = state.view;
  view.controls.target.set(0, 0, -0.25);
  view.camera.position.set(0.8, -1.75, 1.3);
  view.controls.update();
})()"""


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as scratch:
        page = pathlib.Path(scratch) / "page.html"
        subprocess.run([program, "simulate", ROOT / "samples/scenes/pile.json", "--html", page,
                        "-o", pathlib.Path(scratch) / "events.ndjson"], check=True)
        with Browser(1280, 760) as browser:
            browser.open(f"file://{page}")
            browser.value("go_to_frame(60)")
            browser.value(CAMERA)
            browser.settle()
            (ROOT / "docs/pile.png").write_bytes(browser.screenshot())


if __name__ == "__main__":
    main()
