#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Opens pages in headless Chromium and looks at them: a mark is where its finding is, as
the page projects it and as this file does, nowhere else, and nothing asks a network."""
import math
import pathlib
import subprocess
import sys
import tempfile

from browser import Browser, Picture, find_chromium
from shared_models import SKIPPED, must

SAMPLE_PAGE = sys.argv[2]
WIDTH, HEIGHT = 1280, 800
FIELD_OF_VIEW = math.radians(40)  # of the height, as view.js has it
HOLE = [((3, -1, 1), (5, -1, 1)), ((3, 1, 1), (5, 1, 1)), ((3, -1, 1), (3, 1, 1)),
        ((5, -1, 1), (5, 1, 1))]  # the boundary edges of sample_page's cube, in its order
EYE, TARGET = (1.5, 2.5, 8.0), (4.25, -0.25, 0.5)


def page(folder, name, exponent=0):
    path = folder / f"{name}_{exponent}.html"
    subprocess.run([SAMPLE_PAGE, name, str(exponent), path], check=True)
    return path.as_uri()


def camera(exponent=0):
    return "camera=" + ",".join(repr(math.ldexp(value, exponent)) for value in EYE + TARGET)


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def projected(point, box):
    """Pixels of the window, by the pinhole camera of the address and Y up."""
    forward = unit(minus(TARGET, EYE))
    right = unit(cross(forward, (0, 1, 0)))
    up = cross(right, forward)
    seen = minus(point, EYE)
    scale = box["height"] / 2 / math.tan(FIELD_OF_VIEW / 2) / dot(seen, forward)
    return (box["x"] + box["width"] / 2 + dot(seen, right) * scale,
            box["y"] + box["height"] / 2 - dot(seen, up) * scale)


def distance_to_segment(point, ends):
    a, b = ends
    run, away = minus(b, a), minus(point, a)
    along = min(1, max(0, dot(away, run) / max(1e-12, dot(run, run))))
    return math.dist(away, [along * x for x in run])


def colour(browser, name):
    text = browser.value(f"getComputedStyle(document.documentElement).getPropertyValue('{name}')")
    digits = text.strip().lstrip("#")
    return tuple(int(digits[i:i + 2], 16) for i in (0, 2, 4))


def view_box(browser):
    return browser.value("(() => { const r = document.querySelector('#view canvas')"
                         ".getBoundingClientRect(); return {x: r.x, y: r.y, width: r.width, "
                         "height: r.height}; })()")


def text_of(browser, identity):
    return browser.value(f"document.getElementById('{identity}').textContent")


def clean(browser):
    """Nothing was asked of a network, thrown, or complained about."""
    must(all(url.startswith(("file:", "data:", "about:")) for url in browser.requests),
         f"the page asked for {browser.requests}")
    must(not browser.complaints, f"the console says {browser.complaints}")


def coloured(browser, name):
    """Pixels of the picture in the very colour of a rule, without label and tools."""
    browser.value("for (const id of ['label', 'tools']) "
                  "document.getElementById(id).style.visibility = 'hidden'")
    picture = Picture(browser.screenshot())
    box = view_box(browser)
    found = picture.find(colour(browser, name), (box["x"], box["y"], box["x"] + box["width"],
                                                 box["y"] + box["height"]))
    return picture, found


def check_marks(browser, folder, exponent):
    """The third boundary edge is drawn along its projection, and nowhere else."""
    browser.open(page(folder, "cube", exponent) + "#CDP0301/3&" + camera(exponent))
    box = view_box(browser)
    middle = projected((3, 0, 1), box)
    label = browser.value("({x: +document.getElementById('label').dataset.x, "
                          "y: +document.getElementById('label').dataset.y})")
    must(math.dist(middle, (label["x"] + box["x"], label["y"] + box["y"])) < 0.5,
         f"2^{exponent}: the page projects to {label}, this test to {middle}")
    picture, found = coloured(browser, "--rule-orange")
    edges = [[projected(end, box) for end in edge] for edge in HOLE]
    must(len(found) > 3 * math.dist(*edges[2]), f"2^{exponent}: {len(found)} pixels of the mark")
    worst = max(distance_to_segment(pixel, edges[2]) for pixel in found)
    must(worst < 9, f"2^{exponent}: a pixel of the mark is {worst} pixels from the edge")
    for k in range(1, 20):
        x, y = (a + (b - a) * k / 20 for a, b in zip(*edges[2]))
        must(picture.pixel(int(x), int(y)) == colour(browser, "--rule-orange"),
             f"2^{exponent}: no mark at {x}, {y} on the edge")
    clean(browser)
    return len(found)


def check_all_marks(browser, folder):
    """Without a choice all four edges are drawn, and the note's triangle only when asked for."""
    browser.open(page(folder, "cube") + "#" + camera())
    box = view_box(browser)
    edges = [[projected(end, box) for end in edge] for edge in HOLE]
    _, found = coloured(browser, "--rule-orange")
    for index, edge in enumerate(edges):
        near = [pixel for pixel in found if distance_to_segment(pixel, edge) < 6]
        must(len(near) > 2 * math.dist(*edge), f"edge {index}: {len(near)} pixels")
    must(all(min(distance_to_segment(pixel, edge) for edge in edges) < 6 for pixel in found),
         "marks of boundary edges lie elsewhere too")
    _, pins = coloured(browser, "--rule-indigo")
    corner = projected((3, -1, -1), box)
    must(pins and max(math.dist(pixel, corner) for pixel in pins) < 7,
         f"the vertex with several fans is at {corner}, marked at {pins[:1]}")
    _, hidden = coloured(browser, "--rule-olive")
    must(not hidden, "a note is marked before it is asked for")
    browser.value("toggle_marks('CDP0203')")
    browser.settle()
    _, shown = coloured(browser, "--rule-olive")
    must(len(shown) > 500, f"the sliver has {len(shown)} pixels")
    clean(browser)


def check_names(browser, folder):
    """Names that would end a script or begin an element are text."""
    browser.open(page(folder, "cube") + "#CDP0301/1")
    name = 'open </script><b>cube</b> & "more"\ufffd.obj'
    must(text_of(browser, "mesh-name") == name, text_of(browser, "mesh-name"))
    must("root/<!--<script>alert(1)</script>" in text_of(browser, "detail"), "node path")
    must(browser.value("document.title") == name.replace("\ufffd", "\ufffd") + " - cdprep validate",
         browser.value("document.title"))
    must(browser.value("document.querySelectorAll('header b').length") == 1, "markup in a name")
    must("Permission is hereby granted" in text_of(browser, "license"), "no licence of three.js")
    clean(browser)


def check_going(browser, folder):
    """Rows, keys, clicks in the picture and the address all go to a place."""
    browser.open(page(folder, "cube") + "#" + camera())
    box = view_box(browser)
    browser.click(*projected((5, 0, 1), box))
    browser.settle()
    must(browser.value("location.hash") == "#CDP0301/4", browser.value("location.hash"))
    browser.press("n", "n")
    browser.settle()
    must(browser.value("location.hash") == "#CDP0301/1", browser.value("location.hash"))
    label = browser.value("+document.getElementById('label').dataset.x")
    must(abs(label - box["width"] / 2) < 1, "the camera did not fly to the place")
    browser.value("document.getElementById('list').focus()")
    for key in ("End", "ArrowRight", "ArrowDown", "Enter"):
        browser.press(key)
    browser.settle()
    must(browser.value("location.hash") == "#CDP0304/1", browser.value("location.hash"))
    browser.value("location.hash = '#CDP0302/1'")
    browser.wait("document.getElementById('label-text').textContent.includes('CDP0302/1')")
    browser.value("document.getElementById('link').click()")
    must("camera=" in browser.value("location.hash"), "no camera in the address")
    clean(browser)


def check_many(browser, folder):
    """A thousand places a rule make few elements, and true counts."""
    browser.open(page(folder, "many") + "#CDP0501/900")
    rows = browser.value("document.querySelectorAll('.row').length")
    must(10 < rows < 80, f"{rows} rows are made")
    must(browser.value("list.rows.length") == 2 + 1000 + 1, "rows of a finding with 1000 places")
    must("900" in browser.value("document.querySelector('.row[aria-selected=true]').textContent"),
         "the chosen row is not in sight")
    must("14,400" in text_of(browser, "list") + text_of(browser, "severities"), "true count")
    browser.value("(() => { for (let i = 0; i < 20; ++i) step_place(1); })()")
    browser.settle()
    must(browser.value("location.hash") == "#CDP0501/920", browser.value("location.hash"))
    rows = browser.value("document.querySelectorAll('.row').length")
    must(10 < rows < 80, f"{rows} rows are made after 20 steps")
    browser.value("document.getElementById('words').value = 'sliver';"
                  "document.getElementById('words').oninput()")
    must(browser.value("list.rows.filter((row) => !row.place).length") == 1, "filter by name")
    browser.open(page(folder, "partial"))
    must("of 28,800 triangles" in text_of(browser, "partial")
         and browser.value("!document.getElementById('partial').hidden"), "says it is partial")
    clean(browser)


def check_several(browser, folder):
    """A selector, a file that could not be read, and addresses into the second mesh."""
    url = page(folder, "several")
    browser.open(url)
    must(browser.value("document.querySelectorAll('#mesh-choice option').length") == 3, "options")
    browser.value("document.getElementById('later').click()")
    browser.value("document.getElementById('later').click()")
    must("line 3 has 2 coordinates" in text_of(browser, "nothing-text"), "the error's sentence")
    must(browser.value("location.hash") == "#mesh=3", browser.value("location.hash"))
    for address in ("#mesh=2&CDP0301/3", "#CDP0301/3"):
        browser.open(url + address)
        must(browser.value("document.getElementById('mesh-choice').value") == "1", address)
        must("CDP0301 / 3" in text_of(browser, "detail"), address)
    clean(browser)


def luminance(rgb):
    parts = [value / 255 for value in rgb]
    parts = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return dot(parts, (0.2126, 0.7152, 0.0722))


def contrast(a, b):
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


def check_colours(browser, folder):
    """WCAG 2.1: text 4.5 on its ground; marks 3 on the scene and on their casing."""
    for theme in ("light", "dark"):
        browser.media(prefers_color_scheme=theme)
        browser.open(page(folder, "cube"))
        for ink in ("--ink", "--muted", "--error", "--warning", "--note", "--accent"):
            for ground in ("--paper", "--panel"):
                found = contrast(colour(browser, ink), colour(browser, ground))
                must(found >= 4.5, f"{theme}: {ink} on {ground} has contrast {found:.2f}")
        hues = browser.value("[...new Set(Object.values(page.rules).map((rule) => rule.hue))]")
        must(len(hues) > 8, f"hues {hues}")
        for hue in hues:
            for ground in ("--scene", "--casing", "--panel"):
                found = contrast(colour(browser, "--rule-" + hue), colour(browser, ground))
                must(found >= 3, f"{theme}: {hue} on {ground} has contrast {found:.2f}")
        must(Picture(browser.screenshot()).pixel(20, 100) == colour(browser, "--scene"), theme)
    browser.media(prefers_color_scheme="light")
    clean(browser)


def check_paper(browser, folder):
    """Printed, the findings and the verdict stand below the picture."""
    browser.open(page(folder, "cube"))
    printed = browser.ask("Page.printToPDF")["data"]
    must(len(printed) > 20000, f"{len(printed)} characters of PDF")
    paper = text_of(browser, "paper")
    must("CDP0301 Edge has one triangle: 4" in paper and "triangle 9" in paper, paper)
    must(browser.value("document.getElementById('paper-picture').naturalWidth") > 100, "picture")
    clean(browser)


def check_without_webgl(folder):
    """Without WebGL the list stands, with a sentence in the picture's place."""
    with Browser(WIDTH, HEIGHT, "--disable-3d-apis") as browser:
        browser.open(page(folder, "cube") + "#CDP0301/3")
        must("no WebGL" in text_of(browser, "nothing-text")
             and browser.value("!document.getElementById('nothing').hidden"), "the sentence")
        must("triangle 6" in text_of(browser, "list"), "the list")
        must("CDP0301 / 3" in text_of(browser, "detail"), "the place")
        clean(browser)


def main():
    if not find_chromium():
        print("skipped: there is no Chromium (cmake/packages tests installs it on Debian)")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with Browser(WIDTH, HEIGHT) as browser:
            for exponent in (0, 1000, -1000):
                print(f"2^{exponent}: {check_marks(browser, folder, exponent)} pixels of the mark")
            check_all_marks(browser, folder)
            check_names(browser, folder)
            check_going(browser, folder)
            check_many(browser, folder)
            check_several(browser, folder)
            check_colours(browser, folder)
            check_paper(browser, folder)
        check_without_webgl(folder)
    print("every mark is where its finding is")


main()
