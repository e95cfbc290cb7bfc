"""Who draws: the server, which sends pictures, or the browser, with the script of pages (`pvfiblets.page`).

A browser reports its abilities once (client/browser_renderer.js). Before every picture this module decides whether one
is needed: a browser that draws gets the changes of the scene and the camera instead, and reports where it has moved
the camera. Panes of slices beside the 3-D view are pictures of the server's, without that view. The
server's own plotter stays in step, so that picking, sessions, scripts and saved pictures know of it.
"""

from __future__ import annotations

import logging
import re
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets import page
from pvfiblets.web.actions import Actions
from pvfiblets.web.view.sent_scene import LARGEST, MOST, SentScene, SentScenes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from aiohttp import web

    from pvfiblets.web.app import Explorer

logger = logging.getLogger("pvfiblets.web")

SOFTWARE = re.compile(r"swiftshader|llvmpipe|softpipe|software|basic render", re.IGNORECASE)
"""Names of graphics cards that are none: programs that draw on the processor, slower than the server's may be."""

KEPT = 4  # scenes whose data can be fetched: requests under way when the scene changes still succeed

PACKED = 1  # how hard zlib tries on pixels: a third of a slice's bytes are left after 12 ms; a quarter, by 6, after 110


class BrowserDrawing(Actions):
    """Client-side rendering of an application: whether the browser renders, and its messages."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        options = app.options
        alone = not options.shared and options.cluster is None
        self._asked: str = options.draw if alone else "here"
        self._most = MOST if self._asked == "there" else LARGEST
        self._scenes = SentScenes(app.scene)
        self._sent: list[SentScene] = []
        self._able = False
        self._trouble = ""
        self._camera: dict[str, Any] | None = None
        self._turn = 0  # counts cameras that a browser has to take over
        self._mover = ""  # the page whose camera the last of these is; none: the server
        self._said = ""
        self.on = False
        self.rests = True  # the camera, as far as the browser has said
        app.page.there = {"asked": self._asked, "on": False}

    # What browsers say

    def report(self, webgl: Any, card: Any, trouble: Any = "") -> None:
        """Take note of what a browser can draw with."""
        name = str(card)[:200]
        self._able = webgl is True and (self._asked == "there" or not SOFTWARE.search(name))
        self._trouble = " ".join(str(trouble).split())[:300]
        if not self._able and not self._trouble and self._asked == "there":
            self._trouble = "this browser has no WebGL 2"
        self._camera = None  # a page that was reloaded knows of none
        self._app.stream.request()

    def moved(self, camera: Mapping[str, Any], origin: Any, rests: Any, turn: Any) -> None:
        """Put the camera where a browser has moved it, unless it was moved before by another that this one lacks."""
        app = self._app
        mover = str(origin)[:40]
        seen = turn == self._turn or mover == self._mover
        if not (self.on and seen and app.scene.cameras.camera() == self._camera):
            return
        app.scene.cameras.set_camera(camera)
        self._camera = app.scene.cameras.camera()
        if mover != self._mover:
            self._turn += 1
            self._mover = mover
        self.rests = rests is True
        app.stream.leave()
        if self.rests:
            app.files.keep_soon()
            self._send_camera()

    # What the stream of pictures asks

    def draws(self) -> bool:
        """Send changes to the browser, if it can draw them; return True if it draws everything."""
        if self._asked == "here" or not (self._able or self._trouble):
            return False
        why = self._trouble
        sent: SentScene | str = ""
        if self._able:
            try:
                sent = self._scenes.make(self._most)
            except Exception as error:  # the server draws it all the same
                logger.exception("a scene could not be made for a browser")
                sent = f"this scene ({error})"
            if isinstance(sent, str):
                why = sent and f"a browser cannot draw {sent}"
            elif sent.bytes > self._most:
                limit = f"{self._most / 1e6:,.0f} MB"
                why = f"the scene has {sent.bytes / 1e6:,.0f} MB, more than the {limit} that are sent"
                sent = ""
        if not isinstance(sent, SentScene):
            self._leave(why)
            return False
        self._tell(sent)
        return not self._app.scene.slicing.beside

    def drawn_view(self) -> Any:
        """Return the renderer that the browser draws in the server's place; None for none."""
        return self._app.scene.slicing.view_3d if self.on else None

    def _tell(self, sent: SentScene) -> None:
        app = self._app
        camera = app.scene.cameras.camera()
        with app.state:
            if not self.on or sent.content != self._sent[-1].content:
                self._sent = [*self._sent[1 - KEPT :], sent]
                app.page.there = {"asked": self._asked, "on": True, "scene": sent.content}
                app.page.drawing = ""
            if camera != self._camera:
                self._camera = camera
                self._turn += 1
                self._mover = ""
                self._send_camera()
        self.on, self.rests, self._said = True, True, ""

    def _send_camera(self) -> None:
        with self._app.state:
            self._app.page.there_camera = {"camera": self._camera, "from": self._mover, "turn": self._turn}

    def _leave(self, why: str) -> None:
        app, was = self._app, self.on
        said = f"The server draws: {why}." if why else ""
        with app.state:
            app.page.drawing = said
            if was:
                app.page.there = {"asked": self._asked, "on": False}
        self.on, self._sent, self._camera = False, [], None
        if said and said != self._said and (was or self._asked == "there"):
            app.say(said)
        self._said = said

    # What browsers fetch

    async def send_script(self, _: Any) -> web.FileResponse:
        """Respond to a browser that fetches the scene's data."""
        from aiohttp import web

        return web.FileResponse(Path(page.__file__).with_name("page.js"), headers={"Content-Type": "text/javascript"})

    async def send(self, request: web.Request) -> web.Response:
        """Answer a browser that fetches data."""
        from aiohttp import web

        name = request.match_info["name"]
        found = next((sent for sent in self._sent if name in sent.blobs), None)
        if found is None:
            raise web.HTTPNotFound
        body, headers = found.blobs[name], {}
        if name in found.pixels and "deflate" in request.headers.get("Accept-Encoding", ""):
            body, headers = zlib.compress(body, PACKED), {"Content-Encoding": "deflate"}
        return web.Response(body=body, content_type="application/octet-stream", headers=headers)
