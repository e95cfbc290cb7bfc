"""A server in a process of its own, and pages of it in Chromium, for tests.

The fixtures are in conftest.py: ``served`` starts servers, ``visit`` opens pages and fails a test whose page wrote an
error to its console.
"""

import base64
import contextlib
import io
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from pvfiblets.web.state import WRITABLE

FLAGS = (
    "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-quic", "--no-first-run",
)  # fmt: skip
PATIENCE = int(os.environ.get("PVFIBLETS_PATIENCE", "120000"))  # ms: machines that run tests are busy
QUIET = 150  # ms of a page's own clock: what it holds back, for 100 ms, has been sent by then
FINE = 90  # the least quality of pictures at rest
QUALITY = re.compile(rb"\xa7quality([\x00-\x7f]|\xcc.)", re.DOTALL)  # of a picture, an integer of msgpack
# What the page has sent is taken, and what is drawn is drawn, when this comes back: the server does one after another.
SESSION = "window.trame.trigger('save_session')"
LOAD = "(text) => fetch('/session', {method: 'POST', body: text}).then((answer) => answer.status)"
ANSWER = f"""() => Promise.race([
    {SESSION}, new Promise((done) => setTimeout(done, 20000)),
])"""
HELD_BACK = f"() => new Promise((done) => setTimeout(done, {QUIET}))"
STANDS = """async (patience) => {
    const end = performance.now() + patience;
    const runs = (one) => one.playState === 'running' && one.effect.getComputedTiming().endTime < Infinity;
    for (let still = 0; still < 3; ++still) {  // what changes now begins to move a frame or two later
        await new Promise(requestAnimationFrame);
        const moving = document.getAnimations().filter(runs);
        if (!moving.length) continue;
        if (performance.now() > end) throw new Error('a page that moves for ever');
        const late = new Promise((done) => setTimeout(done, patience));
        await Promise.race([late, Promise.allSettled(moving.map((one) => one.finished))]);
        still = -1;
    }
}"""

# Of Firefox's web sockets Playwright hears nothing: the page tells what comes, of its text and bytes the beginning.
LISTENING = """
new MutationObserver(() => {
  const told = document.querySelector("[data-toast]");
  if (told) window.toldLast = told.innerText;
}).observe(document, {subtree: true, childList: true, characterData: true});
"""
"""What the page tells goes after some seconds, which a slow machine may need to look."""

HEARING = """
window.WebSocket = class extends WebSocket {
    constructor(...given) {
        super(...given);
        this.addEventListener('message', async ({data}) => {
            const text = typeof data === 'string';
            const bytes = text ? [] : new Uint8Array(data instanceof Blob ? await data.arrayBuffer() : data);
            const begins = btoa(String.fromCharCode(...bytes.slice(0, 1000)));
            window.pvfibletsHeard(begins, text ? data.length : bytes.length);
        });
    }
};
"""


def chromium() -> str | None:
    """Return where Chromium is, if it is."""
    names = ("chromium", "chromium-browser", "google-chrome")
    given = os.environ.get("CHROMIUM")
    return given or next((found for name in names if (found := shutil.which(name))), None)


@contextlib.contextmanager
def launched(flags=FLAGS):
    """Give Chromium, or skip where there is none. While it runs, ``asyncio.run()`` cannot: it is for one module."""
    playwright = pytest.importorskip("playwright.sync_api")
    path = chromium()
    if path is None:
        pytest.skip("there is no Chromium on this machine: scripts/browser.sh installs it")
    with playwright.sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=path, args=list(flags))
        yield found
        found.close()


class Served:
    """``pvfiblets serve`` with some arguments, on a port of its own."""

    def __init__(self, *arguments, root):
        self.root = Path(root)
        self.log = self.root.parent / f"serve-{time.monotonic_ns()}.log"
        command = [
            sys.executable, "-m", "pvfiblets", "serve",
            *map(str, arguments),
            "--port",
            "0",
            "--root",
            str(root),
            "--token-file",
            str(self.log.with_suffix(".token")),
        ]  # fmt: skip
        with self.log.open("w") as log:
            self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True)
        line = self.process.stdout.readline()
        found = re.search(r"http://\S+", line)
        assert found, self.log.read_text()
        self.base = found.group().rstrip("/")
        self.url = f"{self.base}/?token={self.log.with_suffix('.token').read_text().strip()}"

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(30)
        finally:
            self.process.kill()
            self.process.stdout.close()


class Visit:
    """One page in a browser of its own: cookies are not shared with others."""

    def __init__(self, browser, served, *, width=1280, height=720, **options):
        self.served = served
        self.context = browser.new_context(
            viewport={"width": width, "height": height}, accept_downloads=True, **options
        )
        self.page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.errors = []
        self.requests = []
        self.received = []
        self.page.add_init_script(LISTENING)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", self._said)
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.pictures = 0
        self.quality = 0  # of the last one
        if browser.browser_type.name == "firefox":
            self.page.expose_function("pvfibletsHeard", lambda begins, size: self.take(base64.b64decode(begins), size))
            self.page.add_init_script(HEARING)
        else:
            self.page.on("websocket", lambda socket: socket.on("framereceived", self.take))

    def take(self, data, size=None):
        """Take note of a message from the server, or of how it begins and its size."""
        self.received.append(len(data) if size is None else size)
        if isinstance(data, bytes) and b"image/" in data[:1000] and (found := QUALITY.search(data[:1000])):
            self.pictures += 1
            self.quality = found[1][-1]

    def _said(self, said):
        # An event that is on its way when a page is left is lost, of which its client complains.
        if said.type == "error" and "trame.rca.event unsuccessful: connection not open" not in said.text:
            self.errors.append(said.text)

    def open(self):
        """Open the page and wait for the first picture with something in it."""
        self.page.goto(self.served.url)
        return self.ready()

    def ready(self, *, tools=True):
        picture = self.page.locator("#pv-view img[src^=blob]")

        def comes():
            assert "(exit code" not in self.served.log.read_text(), self.served.log.read_text()
            return picture.count()

        self.wait(comes, "the first picture")
        self.wait(lambda: self.layers() and self.picture().std() > 1.0, "a picture with something in it")
        return self.unfold() if tools else self

    def unfold(self):
        """Open the tools where there is room: small screens begin with their icons."""
        if self.page.viewport_size["width"] >= 1100 and not self.state("shared"):
            self.page.evaluate("window.trame.state.set('right_open', true)")
            self.stands()
        return self

    def wait(self, until, what):
        """Wait until a function says so."""
        end = time.monotonic() + PATIENCE / 1000.0
        pause = 10  # ms: most of what is waited for comes soon
        while not (found := until()):
            assert time.monotonic() < end, f"waited in vain for {what}; the server said:\n{self.served.log.read_text()}"
            self.page.wait_for_timeout(pause)
            pause = min(2 * pause, 100)
        return found

    def picture(self):
        """Return what the view shows, ``(height, width, 3)``, as the browser has it, without what lies over it."""
        from PIL import Image

        data = self.page.evaluate(
            """() => {
                const image = document.querySelector('#pv-view img');
                const canvas = document.createElement('canvas');
                canvas.width = image.naturalWidth || 1; canvas.height = image.naturalHeight || 1;
                if (image.naturalWidth) canvas.getContext('2d').drawImage(image, 0, 0);
                return canvas.toDataURL('image/png').split(',')[1];
            }"""
        )
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB")).astype(np.int16)

    def rests(self):
        """Wait until a fine picture is the last, and none comes while the server answers; return it."""
        count, end = -1, time.monotonic() + PATIENCE / 1000.0
        while self.pictures != count or self.quality < FINE:
            assert time.monotonic() < end, f"no rest; the server said:\n{self.served.log.read_text()}"
            count = self.pictures
            self.page.evaluate(ANSWER)  # by then all that was done is known there
            for _ in range(2):
                self.page.evaluate(HELD_BACK)
                self.page.evaluate(ANSWER)  # by then it is drawn; then, by then it is coded and sent
        return self.picture()

    def stands(self):
        """Wait until what the page was told is shown, and nothing of it slides, grows or fades."""
        self.page.evaluate(ANSWER)
        self.page.evaluate(STANDS, PATIENCE)

    def changed(self, before, what="another picture", least=0.05):
        """Wait until the picture differs from one before, and is at rest."""

        def differs():
            now = self.picture()
            return now.shape != before.shape or np.abs(now - before).mean() > least

        self.wait(differs, what)
        return self.rests()

    def state(self, name):
        return self.page.evaluate(f"window.trame.state.get('{name}')")

    def remember(self):
        """Keep the session as it is now, for :meth:`begin_again`."""
        self.begun = self.page.evaluate(SESSION)
        self.panels = {name: self.state(name) for name in WRITABLE}  # what is open, typed and chosen
        return self

    def begin_again(self):
        """Have the session as it was remembered, without another process for it; what can be undone stays."""
        self.page.evaluate("document.activeElement?.blur()")
        self.page.evaluate("(panels) => window.trame.state.update(panels)", self.panels)
        self.page.evaluate(LOAD, self.begun)
        self.wait(lambda: self.page.evaluate(SESSION) == self.begun, "the session as it was")
        self.rests()
        return self

    def layers(self):
        return self.page.locator("[data-layer]").count()

    def drag(self, start=(0.4, 0.5), end=(0.65, 0.6), *, steps=12):
        """Drag over the view, from and to shares of it."""
        self.trace((start, end), steps=steps)

    def trace(self, places, *, steps=4):
        """Draw a line over the view through places, shares of it."""
        box = self.page.locator("#pv-view").bounding_box()
        at = [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in places]
        self.page.wait_for_function(  # nothing that fades or slides away lies over what is drawn on
            """([x, y]) => {
                const over = document.querySelector('#pv-over');
                return !over || over.contains(document.elementFromPoint(x, y));
            }""",
            arg=list(at[0]),
        )
        self.page.mouse.move(*at[0])
        self.page.mouse.down()
        for place in at[1:]:
            self.page.mouse.move(*place, steps=steps)
        self.page.mouse.up()

    def choose(self, name, title):
        """Choose from the list of a property."""
        self.page.click(f"[data-property={name}] .v-select .v-field")
        self.page.click(f".v-overlay--active .v-list-item:has-text('{title}')")

    def tab(self, name):
        self.page.click(f"[data-tab={name}]")
        self.page.wait_for_selector(f"#tab-{name}")

    def press(self, key):
        self.page.keyboard.press(key)

    def told(self, text):
        """Wait until the page tells exactly this."""
        self.wait(lambda: self.toast() == text, text)

    def toast(self):
        """Return what the page told last, be it gone again."""
        return self.page.evaluate("window.toldLast || ''")

    def close(self):
        try:
            self.context.request.post(f"{self.served.base}/end", headers={"Origin": self.served.base})
        finally:
            self.context.close()
