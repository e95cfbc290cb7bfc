"""Pictures for browsers: drawn when something changed, coarse while the camera moves, full at rest.

Nothing is drawn and nothing is sent while nothing changes. While the pointer drags, frames are coded at a low quality,
and the next is drawn only when the last one has left for the browser; as soon as the pointer rests, the same pixels
are coded once more at full quality, without drawing again.
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
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvfiblets.web.wire import MOST_PIXELS

logger = logging.getLogger("pvfiblets.web")

REST = 0.25  # seconds without an event after which the camera is at rest
FASTEST = 1.0 / 60.0  # seconds from frame to frame, at least
UNSENT = 4  # messages that may wait for the network before drawing waits for them


class PictureStream:
    """The view of a plotter as a sequence of pictures; an area of trame-rca.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Off screen, with an interactor.
    name : str
        The area's name.
    codec : {'jpeg', 'png', 'webp'}
        How pictures travel. PNG has no quality: it is the same at rest and in motion.
    moving, still : int
        Quality while the camera moves and at rest, from 1 to 100.
    pending : callable
        The number of messages that the network has not taken yet.
    failed : callable
        Told of an error while drawing.
    drawn : callable
        Called after each frame.
    """

    def __init__(
        self,
        plotter: Any,
        name: str,
        *,
        codec: str = "jpeg",
        moving: int = 50,
        still: int = 92,
        pending: Callable[[], int] = lambda: 0,
        failed: Callable[[Exception], None] = lambda _: None,
        drawn: Callable[[], None] = lambda: None,
    ) -> None:
        from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

        self.area_name = name
        self.codec = codec
        self.moving_quality = moving
        self.still_quality = still
        self.frames = 0  # drawn
        self.sent = 0  # pictures
        self.sent_bytes = 0
        self.times: deque[float] = deque(maxlen=30)  # seconds that each of the last frames took to draw
        self._plotter = plotter
        self._pending = pending
        self._failed = failed
        self._after = drawn
        self._streamer: Any = None
        self._wanted = asyncio.Event()
        self._moved = 0.0
        self._size = (300, 300)
        self._pressed: set[str] = set()
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="pictures")
        self._task: asyncio.Task[None] | None = None
        self._grab = vtkWindowToImageFilter()
        self._grab.SetInput(plotter.render_window)
        self._grab.ReadFrontBufferOff()
        self._grab.ShouldRerenderOff()
        self._grab.SetInputBufferTypeToRGB()
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
        if wanted != self._size:
            self._size = wanted
            self._plotter.iren.interactor.UpdateSize(*wanted)
        self.request()  # always: a page that was reloaded has no picture yet

    def on_interaction(self, _origin: str, event: dict[str, Any]) -> None:
        """Let VTK's interactor have an event of the pointer."""
        kind = str(event["type"])
        if kind.endswith("Press"):
            self._pressed.add(kind)
        elif kind.endswith("Release"):
            if kind.replace("Release", "Press") not in self._pressed:
                return
            self._pressed.discard(kind.replace("Release", "Press"))
        if kind in ("StartInteractionEvent", "EndInteractionEvent", "InteractionEvent"):
            return
        from vtkmodules.vtkWebCore import vtkRemoteInteractionAdapter

        vtkRemoteInteractionAdapter.ProcessEvent(self._plotter.iren.interactor, json.dumps(self._scaled(event)))
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
        across, down = self._size[0] / width, self._size[1] / height
        scaled = event | {"w": self._size[0], "h": self._size[1]}
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

    def warm(self) -> None:
        """Draw before anybody looks, if nothing is drawn yet: by then programs are compiled and data are on the GPU."""
        if not self.frames:
            try:
                self._draw()
            except Exception as error:  # noqa: BLE001 - as when somebody looks
                self._failed(error)

    @property
    def size(self) -> tuple[int, int]:
        """The picture's width and height in pixels."""
        return self._size

    @property
    def moving(self) -> bool:
        """Whether the camera moved just now."""
        return time.monotonic() - self._moved < REST

    def picture(self) -> bytes:
        """Return the view as PNG, drawn now."""
        return encode(self._draw(), "png", 100)

    @property
    def milliseconds(self) -> float | None:
        """The median time that a frame took to draw lately."""
        return float(np.median(self.times)) * 1000.0 if self.times else None

    async def close(self) -> None:
        """Stop."""
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
            moving = self.moving
            try:
                pixels = self._draw()
                self._after()
            except Exception as error:
                logger.exception("drawing failed")
                self._failed(error)
                continue
            coarse = moving and self.codec != "png"
            await self._send(pixels, self.moving_quality if coarse else self.still_quality)
            await self._drained()
            if coarse and await self._rests():
                await self._send(pixels, self.still_quality)
            await asyncio.sleep(max(0.0, FASTEST - (time.monotonic() - started)))

    async def _rests(self) -> bool:
        """Wait until the camera is at rest; ``False`` as soon as another frame is wanted."""
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(self._wanted.wait(), max(0.0, self._moved + REST - time.monotonic()))
        return not self._wanted.is_set()

    async def _drained(self) -> None:
        while self._pending() > UNSENT:
            await asyncio.sleep(0.005)

    def _draw(self) -> NDArray[np.uint8]:
        from vtkmodules.util.numpy_support import vtk_to_numpy

        started = time.perf_counter()
        self._plotter.render()
        self._grab.Modified()
        self._grab.Update()
        image = self._grab.GetOutput()
        width, height, _ = image.GetDimensions()
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)
        self.frames += 1
        self.times.append(time.perf_counter() - started)
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
        self.sent_bytes += len(content)


def encode(pixels: NDArray[np.uint8], codec: str, quality: int) -> bytes:
    """Return a picture's bytes.

    Parameters
    ----------
    pixels : ndarray of uint8, shape (height, width, 3)
        The first row is the top.
    codec : {'jpeg', 'png', 'webp'}
        The format.
    quality : int
        From 1 to 100; PNG is lossless whatever it says.
    """
    from PIL import Image

    file = BytesIO()
    settings: dict[str, Any] = {"quality": quality}
    if codec == "png":
        settings = {"compress_level": 1}
    elif codec == "jpeg" and quality >= 90:
        settings["subsampling"] = 0  # thin coloured lines lose their colour by it
    elif codec == "webp":
        settings["method"] = 1
    Image.fromarray(pixels).save(file, codec, **settings)
    return file.getvalue()
