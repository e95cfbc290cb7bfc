"""Pictures for browsers: drawn when something changed, coarse while the camera moves, full at rest.

Nothing is drawn and nothing is sent while nothing changes. While the pointer drags, frames are coded at a low quality,
and the next is drawn only when the last one has left for the browser. Scenes that take long to draw are drawn with
fewer pixels meanwhile, which the browser enlarges, with fewer points of their lines, which may be off by such a pixel,
and large sets with fewer streamlines (:mod:`pvfiblets.web.view.pace`).

Once the pointer rests, the full-resolution frame is sent at full quality; if the last one had all its pixels, without
drawing again. Keys that move the cross-hair show panes of slices first, and the 3-D view in the next picture. It is
drawn in pieces, and aborted at an event (:mod:`pvfiblets.mappers.frames.incremental_frame`). If nothing happens then,
the accumulation samples of ``plotter.picture.antialias`` are drawn, one between any two events, and their mean is sent
when it is finished.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from pvfiblets.engine.pieces import PIECE
from pvfiblets.mappers.frames.incremental_frame import draw_in_pieces
from pvfiblets.mappers.frames.scene import reduce_detail
from pvfiblets.web.server.rpc_allowlist import MOST_PIXELS
from pvfiblets.web.view.encoding import encode
from pvfiblets.web.view.pace import LEVELS, Level, Pace
from pvfiblets.web.view.touch import Fingers

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkRenderer

logger = logging.getLogger("pvfiblets.web")

LARGEST_WINDOW = 4096  # pixels along each side of one drawing
REST = 0.25  # seconds without an event after which the camera is at rest
FASTEST = 1.0 / 60.0  # seconds from frame to frame, at least
UNSENT = 4  # messages that may wait for the network before drawing waits for them
PATIENCE = 10.0  # seconds that it does: of browsers that share a view, one may have gone to sleep
HEAVY = 0.5  # seconds of a frame beyond which samples wait for a pause of events
RESTS = 3.0  # so many frames long,
LONGEST_REST = 8.0  # but no longer than these seconds
HEARD = 0.002  # seconds between samples, in which events are heard
SO_FAR = 0.5  # seconds between partial frames of a set whose parts are fetched


class PictureStream:
    """The view of a plotter as a sequence of pictures; an area of trame-rca."""

    def __init__(
        self,
        plotter: pv.BasePlotter,  # off screen, with an interactor
        name: str,  # the area's name
        *,
        codec: str = "jpeg",  # how pictures travel. PNG has no quality: it is the same at rest and in motion.
        moving: int = 50,  # quality while the camera moves and at rest, from 1 to 100
        still: int = 92,
        pending: Callable[[], int] = lambda: 0,
        failed: Callable[[Exception], None] = lambda _: None,
        drawn: Callable[[], None] = lambda: None,
        elsewhere: Callable[[], bool] = lambda: False,
        left_out: Callable[[], Any] = lambda: None,
        pane_at: Callable[[float, float], Any] = lambda _x, _y: None,
        resized: Callable[[], object] = lambda: None,
        postpones: Callable[[bool], bool] = lambda _: False,
    ) -> None:
        from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

        self.area_name = name
        self.codec = codec
        self.moving_quality = moving
        self.still_quality = still
        self.frames = 0  # drawn
        self.sent = 0  # pictures
        self.times: deque[float] = deque(maxlen=30)  # seconds that each of the last frames took to draw
        self._plotter = plotter
        self._pending = pending  # the number of messages that the network has not taken yet
        self._failed = failed  # told of an error while drawing
        self._after = drawn
        self._resized = resized
        # asked before each frame: whether somebody else draws, so that no picture is needed
        self._elsewhere = elsewhere
        self.given_up = 0  # whole pictures that somebody acted before the end of
        self._drawn_ahead = 0.0  # seconds that pieces of the next frame have taken
        self._stale = False  # whether something has changed that was not drawn
        self._streamer: Any = None
        self._wanted = asyncio.Event()
        # then asked for the renderer that somebody else draws, while pictures are of all others; None for none
        self._left_out = left_out
        # then asked to postpone views that may change a picture later, if it may; returns whether there are any
        self._postpones = postpones
        self._moved = 0.0
        self._size = (300, 300)  # of the whole picture
        self._scale = 1.0  # its pixels for one of the page
        self._level = LEVELS[0]  # of the current frame
        self._pace = Pace()
        self._seen: dict[Level, tuple[Any, ...]] = {}  # from where each level saw the scene last
        self._sharp = (plotter.render_window.GetMultiSamples(), plotter.render_window.GetDPI())
        self._pressed: set[str] = set()
        self._fingers = Fingers(plotter, pane_at)
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="pictures")
        self._task: asyncio.Task[None] | None = None
        self._grab = vtkWindowToImageFilter()
        self._grab.SetInput(plotter.render_window)
        self._grab.ReadFrontBufferOff()
        self._grab.ShouldRerenderOff()
        self._grab.SetInputBufferTypeToRGB()
        plotter.picture.pace_by_hand()
        plotter.show(auto_close=False, interactive=False)  # until then plotter.render() does nothing
        plotter.iren.interactor.EnableRenderOff()  # frames are drawn here, not by every event

    # What trame-rca calls

    def set_streamer(self, streamer: Any) -> None:
        """Take the protocol that sends pictures."""
        self._streamer = streamer
        if streamer is not None and self._task is None:
            self._task = asyncio.get_running_loop().create_task(self._run())

    def update_size(self, _origin: str, size: dict[str, Any]) -> None:
        """Draw at a browser's size."""
        scale = float(size["p"])
        if (pixels := size["w"] * size["h"] * scale**2) > MOST_PIXELS:
            scale *= (MOST_PIXELS / pixels) ** 0.5
        wanted = max(int(size["w"] * scale), 16), max(int(size["h"] * scale), 16)
        if (wanted, scale) != (self._size, self._scale):
            self._size, self._scale = wanted, scale
            self._pace = Pace()  # what other sizes cost says nothing
            self._plotter.render_window.SetDPI(self._dpi)
            self._plotter.iren.interactor.UpdateSize(*self._pixels)
            self._resized()
        self.request()  # always: a page that was reloaded has no picture yet

    def on_interaction(self, _origin: str, event: dict[str, Any]) -> None:
        """Pass an event of the pointer to VTK's interactor."""
        kind = str(event["type"])
        if kind.endswith("Press"):
            self._pressed.add(kind)
        elif kind.endswith("Release"):
            if kind.replace("Release", "Press") not in self._pressed:
                return
            self._pressed.discard(kind.replace("Release", "Press"))
        if kind in ("StartInteractionEvent", "EndInteractionEvent", "InteractionEvent"):
            return
        scaled = self._scaled(event)
        if not self._fingers.take(scaled):
            from vtkmodules.vtkWebCore import vtkRemoteInteractionAdapter

            vtkRemoteInteractionAdapter.ProcessEvent(self._plotter.iren.interactor, json.dumps(scaled))
        self._moved = time.monotonic()
        self.request()

    def reset(self) -> None:
        """Send a picture again."""
        self.request()

    def video_codecs(self) -> list[Any]:
        """Return none: pictures are sent, not video."""
        return []

    def negotiate_video(self, _codecs: object) -> dict[str, str]:
        """Refuse video."""
        return {"error": "not-a-video-stream"}

    def _scaled(self, event: dict[str, Any]) -> dict[str, Any]:
        """Return an event in pixels of this picture: browsers that share it may have other sizes."""
        width, height = float(event.get("w") or 0), float(event.get("h") or 0)
        if not (width > 0 and height > 0):
            return event
        columns, rows = self._pixels
        across, down = columns / width, rows / height
        scaled = event | {"w": columns, "h": rows}
        for name, factor in (("x", across), ("y", down)):
            if name in event:
                scaled[name] = int(event[name] * factor)
        if "translation" in event:
            scaled["translation"] = [int(value * across) for value in event["translation"]]
        if "positions" in event:
            scaled["positions"] = {
                finger: place | {"x": int(place.get("x", 0) * across), "y": int(place.get("y", 0) * down)}
                for finger, place in event["positions"].items()
            }
        return scaled

    # What the application calls

    def request(self) -> None:
        """Draw and send soon: something has changed."""
        self._wanted.set()

    def hasten(self) -> None:
        """Draw and send soon, as coarsely as while the camera moves: the picture is not of what the page says."""
        self._moved = time.monotonic()
        self.request()

    def warm(self) -> None:
        """Draw before anybody looks, if nothing is drawn yet: by then programs are compiled and data are on the GPU."""
        if not self.frames:
            try:
                self._draw()
            except Exception as error:  # noqa: BLE001 - as when somebody looks
                self._failed(error)

    def settle(self) -> tuple[int, int]:
        """Draw the full-resolution frame, unless the last one was, and return its width and height."""
        if self._stale or self._level is not LEVELS[0]:
            self._draw()
        return self._size

    def leave(self) -> None:
        """Take note of a change that somebody else draws."""
        self._stale = True
        self._after()

    @property
    def moving(self) -> bool:
        """Whether the camera moved just now."""
        return time.monotonic() - self._moved < REST

    def picture(self) -> bytes:
        """Return the view as PNG, drawn now and finished."""
        self._draw()
        while self._plotter.picture.refine():
            pass
        return encode(self._read(), "png", 100)

    def picture_of(self, width: int, height: int, *, transparent: bool = False) -> NDArray[np.uint8]:
        """Return the view at any size, drawn now and finished."""
        # Lines and letters are as large beside the picture's height as on the page. What is larger than that is drawn
        # in pieces: enlarged windows have wider lines, more dots to an inch have not.
        pieces = max(-(-height // self._size[1]), -(-max(width, height) // LARGEST_WINDOW))
        size = -(-width // pieces), -(-height // pieces)
        window, interactor = self._plotter.render_window, self._plotter.iren.interactor
        self._draw()  # all pixels, whatever the camera did just now
        try:
            window.SetDPI(max(1, round(self._dpi * size[1] / self._size[1])))
            interactor.UpdateSize(*size)
            self._plotter.render()
            while self._plotter.picture.refine():
                pass
            taken = self._plotter.screenshot(None, scale=pieces, transparent_background=transparent)
        finally:
            window.SetDPI(self._dpi)
            interactor.UpdateSize(*self._pixels)
            self.request()
        found: NDArray[np.uint8] = np.ascontiguousarray(np.asarray(taken)[:height, :width])
        return found

    @property
    def milliseconds(self) -> float | None:
        """The median time that a frame took to draw lately."""
        return float(np.median(self.times)) * 1000.0 if self.times else None

    async def close(self) -> None:
        """Stop."""
        reduce_detail(self._plotter.render_window, 0.0)
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        self._pool.shutdown(wait=False)

    # Drawing

    async def _run(self) -> None:
        while True:
            await self._wanted.wait()
            self._wanted.clear()
            started = time.monotonic()
            try:
                if self._elsewhere():
                    self.leave()
                elif (renderer := self._left_out()) is not None:
                    await self._frame_without(renderer)
                else:
                    await self._frame()
            except Exception as error:  # the next is drawn all the same
                logger.exception("drawing failed")
                self._failed(error)
                continue
            await asyncio.sleep(max(0.0, FASTEST - (time.monotonic() - started)))

    async def _frame(self) -> None:
        """Draw and send a frame, and what follows it when the camera rests."""
        moving = self.moving
        if self._postpones(not moving and self._level is LEVELS[0]):  # coarse frames are quicker still
            await self._send(self._draw(), self.still_quality)
            self._stale = True
            self._after()
            await self._drained()
            if await self._wanted_within(HEARD) or not await self._pieces():  # so that it leaves before more is drawn
                return
        elif not moving and not await self._ahead():
            return  # the event requests its own frame
        pixels = self._draw(self._pace.choose() if moving else LEVELS[0])
        self._after()
        coarse = moving and self.codec != "png"
        await self._send(pixels, self.moving_quality if coarse else self.still_quality)
        await self._drained()
        whole = self._level is LEVELS[0]
        if moving and (coarse or not whole) and await self._rests():
            if whole:
                await self._send(pixels, self.still_quality)
            else:
                self.request()
        if not self._wanted.is_set() and whole:
            await self._refine()

    async def _ahead(self) -> bool:
        """Draw what takes longest of the whole picture in pieces; ``False`` as soon as somebody acts meanwhile."""
        # Then the picture that is shown stays, and the next one comes as soon as if nothing had been drawn.
        if self._level is not LEVELS[0]:
            self._resize(LEVELS[0])
        moved = self._moved
        if await self._pieces() or self._moved == moved:  # if others than the camera want a picture, it is this one
            return True
        self._drawn_ahead = 0.0
        self.given_up += 1
        return False

    async def _pieces(self, *, refining: bool = False) -> bool:
        """Draw of the next frame what can be drawn in pieces; ``False`` as soon as another one is wanted."""
        if self._pace.expected(LEVELS[0]) <= PIECE:
            return True
        self._drawn_ahead, began = 0.0, time.perf_counter()
        for _ in draw_in_pieces(self._plotter.render_window, refining=refining):
            self._drawn_ahead += time.perf_counter() - began
            if await self._wanted_within(HEARD):
                return False
            began = time.perf_counter()
        self._drawn_ahead += time.perf_counter() - began
        return True

    async def _refine(self) -> None:
        """Draw the samples of the picture at rest and send it, unless something happens meanwhile."""
        # While parts of a set are fetched, partial frames are sent now and then.
        # No event is handled while a sample is drawn: slow samples wait for a pause of events.
        picture = self._plotter.picture
        heavy = self.times[-1] if self.times and self.times[-1] > HEAVY and not picture.fetching else 0.0
        await self._wanted_within(max(REST, min(RESTS * heavy, LONGEST_REST)))
        await self._practise()
        before, fetching, sent = picture.samples, picture.fetching, time.monotonic()
        while await self._pieces(refining=True) and not self._wanted.is_set() and picture.refine():
            await self._wanted_within(max(HEARD, heavy))
            if picture.fetching and time.monotonic() - sent > SO_FAR:
                await self._send(self._read(), self.still_quality)
                sent = time.monotonic()
        self._drawn_ahead = 0.0
        if not self._wanted.is_set() and (picture.samples != before or fetching):
            await self._send(self._read(), self.still_quality)

    async def _practise(self) -> None:
        """Draw an invisible frame of a moving camera, to compile its programs in advance."""
        # Programs are compiled and a share of a large set is copied to the GPU before somebody drags, not meanwhile.
        if self._wanted.is_set() or not self._pace.untried:
            return
        self._show(self._pace.level)
        await asyncio.sleep(HEARD)
        if not self._wanted.is_set() and await self._ahead():
            self._show(LEVELS[0])

    async def _rests(self) -> bool:
        """Wait until the camera is at rest; ``False`` as soon as another frame is wanted."""
        return not await self._wanted_within(max(0.0, self._moved + REST - time.monotonic()))

    async def _wanted_within(self, seconds: float) -> bool:
        """Wait, so that events are heard, until another frame is wanted; ``False`` if none is after some seconds."""
        # Not `asyncio.wait_for`: Python 3.11's loses a cancelling when its awaitable has just finished.
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                await self._wanted.wait()
        return self._wanted.is_set()

    async def _drained(self) -> None:
        end = time.monotonic() + PATIENCE
        while self._pending() > UNSENT and time.monotonic() < end:
            await asyncio.sleep(0.005)

    @property
    def _pixels(self) -> tuple[int, int]:
        """Width and height of the current frame."""
        width, height = self._size
        return max(round(width * self._level.size), 16), max(round(height * self._level.size), 16)

    @property
    def _dpi(self) -> int:
        """Pixels per inch of the current frame."""
        return max(1, round(self._sharp[1] * self._scale * self._level.size))

    def _resize(self, level: Level) -> None:
        """Draw as coarsely from now on, and let the pointer be where it was."""
        interactor = self._plotter.iren.interactor
        before, last, place = self._pixels, interactor.GetLastEventPosition(), interactor.GetEventPosition()
        self._fingers.resize(level.size / self._level.size)
        self._level = level
        self.times.clear()
        # Letters and lines keep their size on the page. Enlarged pixels have no use for samples.
        self._plotter.render_window.SetDPI(self._dpi)
        self._plotter.render_window.SetMultiSamples(self._sharp[0] if level is LEVELS[0] else 0)
        reduce_detail(self._plotter.render_window, level.off, level.share)
        interactor.UpdateSize(*self._pixels)
        for at in (last, place):  # an event moves the place before to the last
            interactor.SetEventPosition(
                *(int(k * now / then) for k, now, then in zip(at, self._pixels, before, strict=True))
            )

    async def _frame_without(self, renderer: vtkRenderer) -> None:
        """Draw and send all other views; later picks need a new frame."""
        coarse = self.moving
        renderer.SetDraw(False)
        try:
            pixels = self._draw(self._pace.choose() if coarse else LEVELS[0])
        finally:
            renderer.SetDraw(True)
            self._stale = True
        self._after()
        await self._send(pixels, self.moving_quality if coarse else self.still_quality)
        await self._drained()
        if coarse and await self._rests():
            self.request()

    def _draw(self, level: Level = LEVELS[0]) -> NDArray[np.uint8]:
        pixels, seconds = self._show(level)
        self.frames += 1
        self.times.append(seconds)
        return pixels

    def _show(self, level: Level) -> tuple[NDArray[np.uint8], float]:
        """Draw, and return the picture and the seconds that it took."""
        if level is not self._level:
            self._resize(level)
        started = time.perf_counter()
        self._plotter.render()
        self._stale = False
        pixels = self._read()
        seconds = time.perf_counter() - started + self._drawn_ahead
        self._drawn_ahead = 0.0
        camera = self._plotter.camera
        seen = camera.position, camera.focal_point, camera.up, camera.parallel_scale
        self._pace.took(level, seconds, moved=self.moving or seen != self._seen.get(level))
        self._seen[level] = seen
        return pixels, seconds

    def _read(self) -> NDArray[np.uint8]:
        """Return the picture that has been drawn."""
        from vtkmodules.util.numpy_support import vtk_to_numpy

        self._grab.Modified()
        self._grab.Update()
        image = self._grab.GetOutput()
        width, height, _ = image.GetDimensions()
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)
        return np.ascontiguousarray(pixels[::-1, :, :3])

    async def _send(self, pixels: NDArray[np.uint8], quality: int) -> None:
        loop = asyncio.get_running_loop()
        content = await loop.run_in_executor(self._pool, encode, pixels, self.codec, quality)
        if self._streamer is None:
            return
        meta = {
            "type": f"image/{self.codec}", "codec": "", "w": pixels.shape[1], "h": pixels.shape[0],
            "st": int(time.time() * 1000), "key": "key", "quality": quality,
        }  # fmt: skip
        self._streamer.push_content(self.area_name, meta, content)
        self.sent += 1
