"""A page in Chromium, and how its picture differs from another one; fixtures are in conftest.py."""

import base64
import threading
import time
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import numpy as np

from tests.web.browsing import PATIENCE


class Page:
    """A page that was opened from a file."""

    def __init__(self, browser, path, *, size=(200, 160), before="", **options):
        self.context = browser.new_context(viewport={"width": size[0], "height": size[1]}, **options)
        self.page = self.context.new_page()
        if before:
            self.page.add_init_script(before)  # runs before what the page has
        self.page.set_default_timeout(PATIENCE)
        self.errors, self.requests = [], []
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", lambda said: self.errors.append(said.text) if said.type == "error" else None)
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.goto(str(path) if "://" in str(path) else path.as_uri())
        self.page.wait_for_selector("body:not([data-state=loading])")

    @property
    def message(self):
        return self.page.locator("#message").inner_text() if self.page.locator("#message").is_visible() else ""

    def settled(self):
        self.page.evaluate("pvfiblets.settled()")
        return self

    def picture(self):
        """Return the finished picture, ``(height, width, 3)``."""
        self.settled()
        width, height, data = self.page.evaluate(
            """() => {
                const bytes = pvfiblets.pixels();
                let text = '';
                for (let i = 0; i < bytes.length; i += 32768)
                    text += String.fromCharCode(...bytes.subarray(i, i + 32768));
                return [pvfiblets.width, pvfiblets.height, btoa(text)];
            }"""
        )
        return np.frombuffer(base64.b64decode(data), np.uint8).reshape(height, width, 4)[..., :3].astype(np.int16)


class Silent(SimpleHTTPRequestHandler):
    """Python's own server, which knows no ranges and tells nobody."""

    def log_message(self, *_):
        pass


@contextmanager
def serving(folder, handler=Silent):
    """Serve a folder's files meanwhile, and give the address."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(handler, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        server.server_close()
        thread.join(PATIENCE / 1000)


def until(page, expression):
    """Wait until something is so in a page or frame; its policy forbids the browser to try by itself."""
    end = time.monotonic() + PATIENCE / 1000
    while not page.evaluate(expression):
        assert time.monotonic() < end, expression
        page.wait_for_timeout(20)


def differing(page, picture):
    """Return the share of pixels that differ by more than 8 levels, and that of pixels that are not background."""
    picture = np.asarray(picture)[..., :3].astype(np.int16)
    assert page.shape == picture.shape
    drawn = (np.abs(picture - picture[0, 0]).max(axis=2) > 8) | (np.abs(page - picture[0, 0]).max(axis=2) > 8)
    wrong = np.abs(page - picture).max(axis=2) > 8
    return wrong.sum() / max(drawn.sum(), 1), drawn.mean()
