# SPDX-License-Identifier: MIT
"""A headless Chromium without a GPU, driven over its debugging pipe."""
import base64
import contextlib
import json
import os
import select
import shutil
import struct
import subprocess
import tempfile
import time
import zlib

import numpy

FLAGS = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--hide-scrollbars", "--no-first-run", "--disable-extensions", "--mute-audio",
         "--disable-background-networking", "--host-resolver-rules=MAP * ~NOTFOUND",
         "--force-device-scale-factor=1", "--remote-debugging-pipe"]


def find_chromium():
    """The program, or None."""
    return shutil.which("chromium") or shutil.which("chromium-browser")


class Browser:
    """One window. Everything it asks of a network, says or throws is kept."""

    def __init__(self, width, height, *flags):
        self.width, self.height = width, height
        self.profile = tempfile.TemporaryDirectory(prefix="cdprep_chromium_",
                                                   ignore_cleanup_errors=True)
        to_child, self.to = os.pipe()
        self.back, from_child = os.pipe()

        def become_three_and_four():
            # Copies above both first: either may already be 3 or 4.
            low, high = os.dup(to_child), os.dup(from_child)
            while low < 5:
                low = os.dup(low)
            while high < 5:
                high = os.dup(high)
            os.dup2(low, 3)
            os.dup2(high, 4)

        self.process = subprocess.Popen(
            [find_chromium(), *FLAGS, f"--user-data-dir={self.profile.name}",
             f"--window-size={width},{height}", *flags, "about:blank"],
            preexec_fn=become_three_and_four, close_fds=False, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        os.close(to_child)
        os.close(from_child)
        self.buffer, self.number, self.session = b"", 0, None
        self.requests, self.complaints = [], []
        target = self.ask("Target.createTarget", url="about:blank")
        attached = self.ask("Target.attachToTarget", targetId=target["targetId"], flatten=True)
        self.session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(domain + ".enable")
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height,
                 deviceScaleFactor=1, mobile=False)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.to)
        os.close(self.back)
        with contextlib.suppress(ProcessLookupError):
            self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.profile.cleanup()

    def ask(self, method, **parameters):
        """Sends a command and returns its answer; events met on the way are kept."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        wanted = self.number
        while True:
            answer = self.receive()
            if answer.get("id") == wanted:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def receive(self, seconds=120):
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.back], [], [], seconds)
            got = os.read(self.back, 1 << 20) if ready else b""
            if not got:
                raise RuntimeError("Chromium does not answer")
            self.buffer += got
        text, self.buffer = self.buffer.split(b"\0", 1)
        message = json.loads(text)
        self.keep(message.get("method"), message.get("params", {}))
        return message

    def keep(self, event, about):
        if event == "Network.requestWillBeSent":
            self.requests.append(about["request"]["url"])
        elif event == "Runtime.exceptionThrown":
            self.complaints.append(about["exceptionDetails"].get("exception", {})
                                   .get("description", about["exceptionDetails"]["text"]))
        elif event == "Runtime.consoleAPICalled" and about["type"] in ("error", "warning"):
            self.complaints.append(str([part.get("value") for part in about["args"]]))
        elif event == "Log.entryAdded" and about["entry"]["level"] in ("error", "warning"):
            # The driver says that reading pixels back is slow: that is the screenshot.
            if "GPU stall due to ReadPixels" not in about["entry"]["text"]:
                self.complaints.append(about["entry"]["text"])

    def value(self, expression):
        """The value of a script expression in the page."""
        result = self.ask("Runtime.evaluate", expression=expression, returnByValue=True,
                          awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait(self, expression, seconds=60):
        """Until the expression is true."""
        end = time.monotonic() + seconds
        while not self.value(expression):
            if time.monotonic() > end:
                raise RuntimeError(f"not within {seconds} s: {expression}")
            time.sleep(0.03)

    def open(self, url):
        self.ask("Page.navigate", url="about:blank")
        self.requests.clear()
        self.ask("Page.navigate", url=url)
        self.settle()

    def settle(self):
        """Until the page stands still."""
        self.wait("document.readyState === 'complete' && location.href !== 'about:blank' && "
                  "(!document.getElementById('view') || "
                  "document.body.classList.contains('no-webgl') || "
                  "document.getElementById('view').getAttribute('aria-busy') === 'false')")
        self.value("new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go)))")

    def media(self, **features):
        self.ask("Emulation.setEmulatedMedia",
                 features=[{"name": name.replace("_", "-"), "value": value}
                           for name, value in features.items()])

    def press(self, key, text=""):
        self.ask("Input.dispatchKeyEvent", type="keyDown", key=key, text=text)
        self.ask("Input.dispatchKeyEvent", type="keyUp", key=key)

    def click(self, x, y):
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left",
                     clickCount=1)

    def screenshot(self):
        """The window as bytes of a PNG, whose filters are quick."""
        return base64.b64decode(self.ask("Page.captureScreenshot", format="png",
                                         optimizeForSpeed=True)["data"])


class Picture:
    """The pixels of a PNG of 8 bits a channel, not interlaced."""

    def __init__(self, png):
        at, packed = 8, b""
        while at < len(png):
            length, kind = struct.unpack(">I4s", png[at:at + 8])
            if kind == b"IHDR":
                self.width, self.height, depth, colour = struct.unpack(">IIBB", png[at + 8:at + 18])
                self.channels = {2: 3, 6: 4}[colour]
                assert depth == 8
            elif kind == b"IDAT":
                packed += png[at + 8:at + 8 + length]
            at += 12 + length
        self.rows = self.unfilter(zlib.decompress(packed))

    def unfilter(self, raw):
        """Rows of pixels. Sums of bytes keep their last 8 bits, as PNG has it."""
        lines = numpy.frombuffer(raw, numpy.uint8).reshape(self.height, -1)
        rows = numpy.zeros((self.height + 1, self.width, self.channels), numpy.uint8)
        for y, line in enumerate(lines):
            kind, row, above = line[0], line[1:].reshape(self.width, -1), rows[y]
            if kind == 1:
                row = numpy.cumsum(row, axis=0, dtype=numpy.uint8)
            elif kind == 2:
                row = row + above
            elif kind > 2:
                row = self.predicted(kind, row, above)
            rows[y + 1] = row
        return rows[1:]

    def predicted(self, kind, row, above):
        """A row each byte of which depends on the one before it."""
        step, row, above = self.channels, row.flatten().tolist(), above.flatten().tolist()
        for i, up in enumerate(above):
            left, corner = (row[i - step], above[i - step]) if i >= step else (0, 0)
            row[i] = (row[i] + guess(kind, left, up, corner)) & 255
        return numpy.array(row, numpy.uint8).reshape(self.width, -1)

    def pixel(self, x, y):
        return tuple(self.rows[y, x, :3].tolist())

    def find(self, colour, box):
        """The pixels of that very colour within box (x0, y0, x1, y1)."""
        x0, y0, x1, y1 = (max(0, int(edge)) for edge in box)
        is_it = (self.rows[y0:y1, x0:x1, :3] == colour).all(axis=2)
        return [(x0 + x, y0 + y) for y, x in numpy.argwhere(is_it).tolist()]


def guess(kind, left, up, corner):
    """The predictor of a PNG filter: of the mean, or of Paeth."""
    if kind == 3:
        return (left + up) // 2
    estimate = left + up - corner
    return min((left, up, corner), key=lambda value: abs(estimate - value))
