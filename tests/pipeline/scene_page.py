#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Opens pages of `cdprep simulate --html` in headless Chromium and plays them: what begins there
begins in the frame that the events of the run name, and nothing asks a network.

Usage: scene_page.py CDPREP
"""
import json
import pathlib
import re
import sys
import tempfile

from browser import Browser, Picture, find_chromium
from changing_models import read_mesh, sheared
from shared_models import SKIPPED, must, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "samples/scenes"
WIDTH, HEIGHT = 1280, 800


def simulate(program, scene, folder, *arguments):
    """The page of a run, its events, and what stderr says."""
    page = folder / (pathlib.Path(scene).stem + ".html")
    done = run(program, "simulate", scene, "--html", page, "--progress", "none", *arguments)
    must(done.returncode == 0, f"{scene}: {done.stderr}")
    return page, [json.loads(line) for line in done.stdout.splitlines()][:-1], done.stderr


def clean(browser):
    """Nothing was asked of a network, thrown, or complained about."""
    must(all(url.startswith(("file:", "data:", "about:")) for url in browser.requests),
         f"the page asked for {browser.requests}")
    must(not browser.complaints, f"the console says {browser.complaints}")


def text_of(browser, identity):
    return browser.value(f"document.getElementById('{identity}').textContent")


def go(browser, frame):
    browser.value(f"go_to_frame({frame})")
    browser.settle()


def colour(browser, name):
    text = browser.value(f"getComputedStyle(document.documentElement).getPropertyValue('{name}')")
    digits = text.strip().lstrip("#")
    return tuple(int(digits[i:i + 2], 16) for i in (0, 2, 4))


def tint_of(browser, name):
    """The colour of an object, as the picture has it: red, green, blue in 0 to 255."""
    return browser.value("(() => { const i = run.objects.findIndex((o) => o[0] === '" + name + "');"
                         "for (const one of state.view.instances) {"
                         "  const at = one.objects.indexOf(i);"
                         "  if (at >= 0) return [0, 1, 2].map((k) => "
                         "Math.round(one.tint.array[at * 3 + k] * 255));"
                         "} })()")


def check_events(browser, page, events):
    """Each event is in the list and its mark in the lane of its effect; from its frame on, and not
    before, the two objects are listed as a pair for which the effect holds."""
    browser.open(page.as_uri())
    must(browser.value("run.event_count") >= len(events), "events are missing")
    listed = browser.value("Array.from({length: run.event_count}, (_, i) => { "
                           "const e = run.event(i); return [e.frame, run.effects[e.effect].name, "
                           "e.kind, run.object_name(e.a), run.object_name(e.b)]; })")
    told = [[e["frame"], e["effect"], e["event"], e["a"], e["b"]] for e in events]
    must(all(event in listed for event in told), f"{told} is not in {listed}")
    for event in events:
        holds = []
        for frame in (event["frame"] - 1, event["frame"]):
            if frame < 0:
                holds.append(event["event"] == "ends")
                continue
            go(browser, frame)
            pairs = text_of(browser, "pairs")
            row = re.search(re.escape(f"{event['a']} \u2013 {event['b']}: ")
                            + "((?:collide|within|overlap|distance|contacts|haptic|, )*)", pairs)
            holds.append(row is not None and event["effect"] in row[1])
        begins = event["event"] == "begins"
        must(holds == [not begins, begins], f"{event}: holds {holds}")
    for effect in {event["effect"] for event in events}:
        for kind in ("begins", "ends"):
            marks = browser.value(f"+document.querySelector('#lane-{effect} .{kind}')"
                                  ".dataset.count")
            frames = {e[0] for e in listed if e[1:3] == [effect, kind]}
            must(marks == len(frames), f"{effect}: {marks} marks of {kind}, frames {frames}")
    clean(browser)


def check_pushes(browser, program, folder):
    """Bodies that begin and end to push each other are listed in the frames that the run tells."""
    scene = json.loads((SCENES / "pile.json").read_text())
    scene["objects"] = scene["objects"][:9]
    for pair in scene["pairs"]:
        pair["effects"], pair["events"] = ["response"], ["begins", "ends"]
        pair.pop("contacts")
    for one in scene["objects"]:
        one["model"] = str(SCENES / one["model"])
    (folder / "few.json").write_text(json.dumps(scene))
    page, events, _ = simulate(program, folder / "few.json", folder, "--frames", 60)
    told = [[e["frame"], e["event"], e["a"], e["b"]] for e in events
            if e["event"] in ("begins", "ends")]
    must({e[1] for e in told} == {"begins", "ends"} and len(told) > 9, f"pushes: {told}")
    browser.open(page.as_uri())
    listed = browser.value("Array.from({length: run.event_count}, (_, i) => { "
                           "const e = run.event(i); return [e.frame, e.kind, "
                           "run.object_name(e.a), run.object_name(e.b)]; })")
    must(listed == told, f"listed {listed}, told {told}")
    effects = browser.value("Array.from({length: run.event_count}, (_, i) => "
                            "run.effects[run.event(i).effect].name)")
    must(set(effects) == {"response"}, f"effects {effects}")
    stages = browser.value("run.spans.stages")
    must(stages[0] == "response", f"stages {stages}")
    for kind in ("begins", "ends"):
        marks = browser.value(f"+document.querySelector('#lane-response .{kind}').dataset.count")
        frames = {e[0] for e in told if e[1] == kind}
        must(marks == len(frames), f"{marks} marks of {kind}, frames {frames}")
    clean(browser)


def check_tints(browser, page, events):
    """Objects that collide take the colour of the effect, at the frame of the event."""
    browser.open(page.as_uri())
    begins = next(e for e in events if e["effect"] == "collide" and e["event"] == "begins")
    effect = colour(browser, "--effect-collide")

    def away(name):
        return sum(abs(x - y) for x, y in zip(tint_of(browser, name), effect))
    go(browser, begins["frame"] - 1)
    before = [away(begins[key]) for key in "ab"]
    go(browser, begins["frame"])
    now = [away(begins[key]) for key in "ab"]
    must(all(y < x / 2 for x, y in zip(before, now)), f"{begins}: {before} {now}")
    clean(browser)


def check_playback(browser, page):
    """Play moves the time and the bar, pause holds it; keys, drags and clicks go to a frame."""
    browser.open(page.as_uri())
    must(text_of(browser, "clock").startswith("frame 0 of 0 to 31, 0 s"), text_of(browser, "clock"))
    before = Picture(browser.screenshot()).rows
    browser.press(" ", " ")
    browser.wait("run.frame >= 3 && run.frame < 31")
    must(text_of(browser, "play") == "Pause", "the button")
    browser.press(" ", " ")
    browser.settle()
    frame = browser.value("run.frame")
    must(browser.value("+document.getElementById('bar').value") == frame, "the bar")
    browser.value("new Promise((go) => setTimeout(go, 400))")
    must(browser.value("run.frame") == frame, "it plays on")
    after = Picture(browser.screenshot()).rows
    must((before != after).any(axis=2).sum() > 500, "the picture does not change")
    must(browser.value("location.hash") == f"#frame={frame}", browser.value("location.hash"))

    # At the end it begins again, or stops.
    go(browser, 30)
    browser.value("document.getElementById('speed').value = '4'; "
                  "document.getElementById('speed').onchange()")
    browser.press(" ", " ")
    browser.wait("run.frame < 20")
    browser.press(" ", " ")
    browser.press("l", "l")
    go(browser, 30)
    browser.press(" ", " ")
    browser.wait("run.frame === 31 && !state.playing")

    browser.value("document.getElementById('bar').focus()")
    for key, expected in (("Home", 0), ("ArrowRight", 1), ("PageUp", 11), ("ArrowLeft", 10),
                          ("End", 31)):
        browser.press(key)
        must(browser.value("run.frame") == expected, f"{key}: {browser.value('run.frame')}")
    must("frame 31" in browser.value("document.getElementById('bar')"
                                     ".getAttribute('aria-valuetext')"), "the words of the bar")
    box = browser.value("(() => { const r = document.querySelector('#lane-collide svg')"
                        ".getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()")
    browser.click(box[0] + 8 + (box[2] - 16) * 12 / 31, box[1] + box[3] / 2)
    browser.settle()
    must(browser.value("run.frame") == 12, "a click on a lane")
    must("frame 12" in text_of(browser, "hint") and "1 pair" in text_of(browser, "hint"),
         text_of(browser, "hint"))
    browser.press("n", "n")
    must(browser.value("run.frame") == 16, "the next event")
    browser.press("p", "p")
    browser.press("p", "p")
    must(browser.value("run.frame") == 0, "the previous event")
    browser.value("document.querySelector('#bar').value = 20; document.querySelector('#bar')"
                  ".oninput()")
    must(browser.value("run.frame") == 20, "a drag of the bar")
    clean(browser)


def check_panels(browser, page, events):
    """Rows of events and objects lead to frames and objects; the plan says what is not computed."""
    browser.open(page.as_uri())
    browser.value("document.getElementById('tab-events').click()")
    rows = browser.value("document.querySelectorAll('#events .row').length")
    must(rows == browser.value("run.event_count"), f"{rows} rows of events")
    browser.value("document.getElementById('events').focus()")
    for key in ("End", "Enter"):
        browser.press(key)
    must(browser.value("run.frame") == events[-1]["frame"], "a row of the events")
    browser.value("document.getElementById('event-words').value = 'within';"
                  "document.getElementById('event-words').oninput()")
    must("2 of 6" in text_of(browser, "event-count"), text_of(browser, "event-count"))
    browser.value("document.getElementById('tab-objects').click()")
    browser.press("/", "/")
    browser.value("document.getElementById('object-words').value = 'tumbling';"
                  "document.getElementById('object-words').oninput()")
    browser.value("document.querySelector('#objects .row').click()")
    browser.wait("document.getElementById('view').getAttribute('aria-busy') === 'false'")
    browser.settle()
    must("tumbling" in text_of(browser, "label-text"), text_of(browser, "label-text"))
    # A click on the middle of the picture then meets that object.
    browser.value("choose(null, false)")
    box = browser.value("(() => { const r = document.querySelector('#view canvas')"
                        ".getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()")
    browser.click(box[0] + box[2] / 2, box[1] + box[3] / 2)
    must(browser.value("run.objects[state.chosen][0]") == "tumbling", "a click in the picture")
    must(text_of(browser, "not-computed").startswith(
        "Not requested by any pair of layers: overlap, distance, contacts, continuous, self, "
        "haptic, response."),
         text_of(browser, "not-computed"))
    browser.value("document.getElementById('tab-plan').click()")
    plan = text_of(browser, "panel-plan")
    must("crates \u2013 triggers" in plan and "tolerance 0.25" in plan, plan)
    unused = browser.value("[...document.querySelectorAll('.sections .unused')]"
                           ".map((one) => one.textContent)")
    must("findings" in unused and "bvh_nodes" not in unused, f"{unused}")
    browser.value("document.getElementById('tab-cost').click()")
    must(browser.value("document.querySelectorAll('#chart .stage').length") >= 2, "the chart")
    clean(browser)


def check_lit(browser, program, folder):
    """Triangles that overlap are filled where they are, contacts are arrows, distances lines."""
    meshes = ROOT / "samples/meshes"
    path = {"path": [{"time_s": 0, "pose": {"translation": [23, 15, 40]}},
                     {"time_s": 1, "pose": {"translation": [23, 15, 8],
                                            "quaternion": [1, 0, 0, 1]}},
                     {"time_s": 2, "pose": {"translation": [21, 14, -20]}}]}
    scene = folder / "lit.json"
    scene.write_text(json.dumps({
        "cdprep_scene": 1, "step_s": 0.125, "duration_s": 2.125, "layers": ["a", "b"],
        "pairs": [{"layers": ["a", "b"], "effects": ["overlap", "distance", "contacts"],
                   "max_distance": 20, "contacts": {"tolerance": 1, "most": 8}}],
        "objects": [{"name": "bracket", "model": str(meshes / "bracket.obj"), "layer": "a"},
                    {"name": "bolt", "model": str(meshes / "bolt.obj"), "layer": "b",
                     "motion": path}]}))
    page, events, _ = simulate(program, scene, folder)
    browser.open(page.as_uri())
    first = {e["effect"]: e for e in reversed(events) if e["event"] == "begins"}
    for effect, name in (("overlap", "lit_triangles()"), ("contacts", "arrows().segments"),
                         ("distance", "distance_lines().segments")):
        begin = first[effect]["frame"]
        counts = []
        for frame in (max(begin - 1, 0), begin):
            go(browser, frame)
            counts.append(browser.value(f"state.view.{name}.length"))
        must(counts[1] > 0 and (begin == 0 or counts[0] == 0), f"{effect} in {begin}: {counts}")
    begin = first["overlap"]
    go(browser, begin["frame"])
    drawn = browser.value("run.now.lit.reduce((sum, one) => sum + one[1].length, 0)")
    must(0 < drawn <= 2 * begin["triangle_pairs"], f"{drawn} triangles, {begin}")
    # There the bolt's head is in the plate, from above.
    go(browser, 13)
    picture = Picture(browser.screenshot())
    found = picture.find(colour(browser, "--effect-overlap"), (0, 40, 800, 560))
    must(len(found) > 50, f"{len(found)} pixels of triangles that touch")
    clean(browser)


def pixel_at(browser, picture, point):
    """The colour of the picture where a point of the world is drawn."""
    x, y = browser.value(
        "(() => { const p = new THREE.Vector3(" + ",".join(map(str, point)) + ");"
        "p.sub(new THREE.Vector3(...run.centre)).multiplyScalar(2 ** -run.exponent);"
        "state.view.camera.updateMatrixWorld(); p.project(state.view.camera);"
        "const box = state.view.canvas.getBoundingClientRect();"
        "return [box.left + (p.x + 1) / 2 * box.width, box.top + (1 - p.y) / 2 * box.height]; })()")
    return tuple(picture.pixel(round(x), round(y)))[:3]


def check_shapes(browser, program, folder):
    """The sheet of cut.json: each frame has its positions, and after the tear there is a gap."""
    page, _, told = simulate(program, SCENES / "cut.json", folder)
    must("at rest" not in told, told)
    browser.open(page.as_uri())
    points, faces = read_mesh(SCENES / "sheet.obj")
    for frame in (0, 4, 11):
        go(browser, frame)
        drawn = browser.value("[...run.shapes.get(0).positions].map((x) => x * 2 ** run.exponent)")
        expected = [x for point in sheared(points, 0.125 * frame) for x in point]
        must(len(drawn) == len(expected) and
             max(abs(x - y) for x, y in zip(drawn, expected)) < 1e-6, f"frame {frame}: {drawn}")
    triangles = "state.view.shaped.get(0).mesh.geometry.index.count / 3"
    must(browser.value(triangles) == len(faces), f"{browser.value(triangles)} triangles at rest")
    # The middle of the gap at a quarter of the sheet, by hand: sheared by 0.25 at 2.5 s.
    ground = colour(browser, "--scene")
    gap = (0.1, -1.2, 0)
    go(browser, 4)
    must(pixel_at(browser, Picture(browser.screenshot()), (0.4, -1.2, 0)) != ground, "no sheet")
    go(browser, 20)
    must(pixel_at(browser, Picture(browser.screenshot()), gap) == ground, "there is no gap")
    changes = json.loads(run(program, "simulate", SCENES / "cut.json").stdout.splitlines()[-1])
    changes = changes["summary"]["changes"]
    must(browser.value(triangles) == len(faces) - changes["torn"] + changes["appended"],
         f"{browser.value(triangles)} triangles after the tear; {changes}")
    # Time runs backwards as well.
    go(browser, 3)
    must(browser.value(triangles) == len(faces), "the sheet stays torn")
    clean(browser)


def check_many(browser, program, folder):
    """A thousand objects play: a frame takes the script little time, on a busy machine too."""
    page, events, told = simulate(program, SCENES / "thousand.json", folder)
    must(not told, told)
    browser.open(page.as_uri())
    must(browser.value("run.event_count") == len(events), "events")
    must(browser.value("document.querySelectorAll('.row').length") < 80, "too many rows are made")
    # The script's own time. What follows is the graphics card's, of which there is none here.
    taken = browser.value("Array.from({length: 31}, (_, i) => { const begin = performance.now();"
                          "go_to((i * 7) % run.shown.length); state.view.draw();"
                          "return performance.now() - begin; }).sort((x, y) => x - y)[15]")
    print(f"a thousand objects: {taken:.1f} ms of script a frame")
    must(taken < 200, f"{taken} ms")
    clean(browser)


def check_left_out(browser, program, folder):
    """A long run is shown in part; page and stderr say so."""
    page, events, told = simulate(program, SCENES / "crates.json", folder, "--frames", 5000)
    must("The page shows every 4th of 5000 frames" in told, told)
    browser.open(page.as_uri())
    must("every 4th of 5000 frames" in text_of(browser, "partial"), text_of(browser, "partial"))
    must(page.stat().st_size < 6e6, f"{page.stat().st_size} bytes")
    must(browser.value("run.shown[run.shown.length - 1].frame") == 4999, "the last frame")
    must(browser.value("run.spans.frames.reduce((x, y) => x + y, 0)") == 5000, "frames in lanes")
    must(browser.value("run.event_count") >= len(events), "events")
    go(browser, 13)
    must(browser.value("run.frame") == 12, "the nearest shown frame")
    clean(browser)


def check_costs(browser, program, folder):
    """The tab Cost has the numbers of the summary, and nothing where --cost did not run."""
    report = folder / "costs.json"
    page, _, _ = simulate(program, SCENES / "crates.json", folder, "--frames", 5, "--cost",
                          "--format", "json", "-o", report)
    costs = json.loads(report.read_text())["summary"]["costs"]
    browser.open(page.as_uri())
    browser.value("document.getElementById('tab-cost').click()")
    rows = browser.value("[...document.querySelectorAll('#effect-costs tbody tr')]"
                         ".map((row) => [...row.children].map((cell) => cell.textContent))")
    must([row[0] for row in rows] == [cost["without"] for cost in costs] and rows, f"{rows} {costs}")
    for row, cost in zip(rows, costs):
        for text, value in zip(row[1:], (cost["change_of_time"], cost["spread_of_time"])):
            must(abs(float(text.rstrip(" %")) - 100 * value) < 0.06, f"{row} is not {cost}")
    clean(browser)
    simulate(program, SCENES / "crates.json", folder, "--frames", 2)
    browser.open(page.as_uri())
    must(browser.value("document.querySelectorAll('#effect-costs').length") == 0, "no costs")


def check_up(browser, program, folder):
    """In glTF, y is up; in a scene file without gravity, z."""
    for scene, words in (("dominoes.gltf", "Y is up"), ("crates.json", "Z is up")):
        page, _, _ = simulate(program, SCENES / scene, folder, "--frames", 2)
        browser.open(page.as_uri())
        must(text_of(browser, "up") == words, f"{scene}: {text_of(browser, 'up')}")
        must(browser.value("state.view.camera.up.y") == int(words[0] == "Y"), f"{scene}: the camera")
    clean(browser)


def luminance(rgb):
    parts = [value / 255 for value in rgb]
    parts = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(x * y for x, y in zip(parts, (0.2126, 0.7152, 0.0722)))


def check_colours(browser, page):
    """WCAG 2.1: effects have contrast 3 on each ground, text has 4.5."""
    for theme in ("light", "dark"):
        browser.media(prefers_color_scheme=theme)
        browser.open(page.as_uri())
        for inks, grounds, least in (
                (("--ink", "--muted", "--accent"), ("--paper", "--panel"), 4.5),
                ([f"--effect-{name}" for name in ("collide", "overlap", "within", "distance",
                                                  "contacts", "continuous", "self", "haptic")],
                 ("--scene", "--paper", "--panel", "--casing"), 3)):
            for ink in inks:
                for ground in grounds:
                    low, high = sorted(luminance(colour(browser, name)) for name in (ink, ground))
                    found = (high + 0.05) / (low + 0.05)
                    must(found >= least, f"{theme}: {ink} on {ground} has contrast {found:.2f}")
        must(Picture(browser.screenshot()).pixel(20, 100) == colour(browser, "--scene"), theme)
    browser.media(prefers_color_scheme="light")
    clean(browser)


def check_layout(page):
    """Nothing overlaps and nothing is cut off, in wide and in narrow windows."""
    for width, height in ((1280, 800), (1000, 700), (600, 900)):
        with Browser(width, height) as browser:
            browser.open(page.as_uri())
            cut = browser.value("document.documentElement.scrollWidth > innerWidth + 1")
            must(not cut, f"{width}: the page is wider than the window")
            meet = browser.value(
                "(() => { const boxes = [...document.querySelectorAll('#controls > *, .lane')]"
                ".map((e) => e.getBoundingClientRect());"
                "return boxes.some((a, i) => boxes.slice(i + 1).some((b) => a.left < b.right - 1 "
                "&& b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1)); })()")
            must(not meet, f"{width}: controls overlap")


def check_without_webgl(page):
    """Without WebGL the lanes, the events and the plan stand, with a sentence in place of the
    picture."""
    with Browser(WIDTH, HEIGHT, "--disable-3d-apis") as browser:
        browser.open(page.as_uri() + "#frame=12")
        must("no WebGL" in text_of(browser, "nothing-text")
             and browser.value("!document.getElementById('nothing').hidden"), "the sentence")
        must("gate \u2013 sliding: collide" in text_of(browser, "panel-frame"), "the pairs")
        must(browser.value("document.querySelectorAll('.lane').length") == 3, "the lanes")
        clean(browser)


def main():
    if not find_chromium():
        print("skipped: there is no Chromium (cmake/packages tests installs it on Debian)")
        sys.exit(SKIPPED)
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        page, events, told = simulate(program, SCENES / "crates.json", folder)
        must(not told, told)
        with Browser(WIDTH, HEIGHT) as browser:
            check_events(browser, page, events)
            probe, sensed, told = simulate(program, SCENES / "probe.json", folder)
            must(not told and len(sensed) > 20, f"the probe: {told} {len(sensed)}")
            check_events(browser, probe, sensed)
            check_tints(browser, page, events)
            check_pushes(browser, program, folder)
            check_playback(browser, page)
            check_panels(browser, page, events)
            check_lit(browser, program, folder)
            check_shapes(browser, program, folder)
            check_colours(browser, page)
            check_many(browser, program, folder)
        check_layout(page)
        check_without_webgl(page)
        with Browser(WIDTH, HEIGHT) as browser:
            check_left_out(browser, program, folder)
            check_costs(browser, program, folder)
            check_up(browser, program, folder)
    print("what begins in the run begins on its page")


main()
