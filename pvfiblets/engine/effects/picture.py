"""Effects on a finished picture of any renderer: depth of field, and tones.

`PictureEffects` copies colours and depths of a viewport, and draws them changed to where they were. What the copy is
made of are textures of a framebuffer that is not the engine's, known by their OpenGL names.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ..gl.delayed_read import DelayedRead
from .depth_of_field import STEPS, TILE, Focus, disc_areas
from .picture_passes import Attachment, PicturePasses, bytes_of
from .projection import Projection
from .tone import Tone

__all__ = ["FAINTEST", "Attachment", "PictureEffects", "SeenThrough"]

FAINTEST = 0.02  # opacity below which things that one sees something through are not what one looks at

_LARGEST = float(np.finfo(np.float32).max)


@dataclass(frozen=True, eq=False)
class SeenThrough:
    """A G-buffer of something that hides nothing, but lies in focus or out of it."""

    depth: moderngl.Texture  # where it begins, as keys
    # colour and opacity, if they differ by pixel; opacities below `FAINTEST` do not count
    lights: moderngl.Texture | None = None
    positions: moderngl.Texture | None = None  # with `values`: place and value by pixel; others do not count
    values: tuple[float, float] = (-math.inf, math.inf)  # least and greatest value that counts


class PictureEffects(PicturePasses):
    """Effects on pictures in one context."""

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx, {"steps": float(STEPS), "tile": TILE})
        self._areas: tuple[float, moderngl.Texture] | None = None
        self._corner = 0, 0
        self._reads: DelayedRead | None = None

    def copy(
        self,
        colour: Attachment,
        depth: Attachment | None,
        viewport: tuple[int, int, int, int],
        *,
        size: tuple[int, int] | None = None,
        corner: tuple[int, int] = (0, 0),
    ) -> None:
        """Take a picture over."""
        x, y, width, height = viewport
        size = size or (width, height)
        targets = {"colours": (4, "f4" if colour.floats else "f1")} | ({"depths": (1, "f4")} if depth else {})
        names = tuple(targets)
        for name, (components, dtype) in targets.items():
            self._texture(name, size, components, dtype)
        if depth is None:
            self._forget_depths()
        features = colour.features() + (["PICTURE_DEPTH"] if depth else [])
        outside = {"drawn": self._outside(colour, 4)} | ({"depths": self._outside(depth, 1)} if depth else {})
        uniforms = {"samples": colour.samples, "origin": (x, y), "corner": corner}
        with self._plain_state():
            target = self._framebuffer(names)
            target.viewport = (*corner, width, height)
            self._pass("copy", target, outside, uniforms, features)
        self._corner = corner

    @property
    def copied(self) -> tuple[moderngl.Texture, moderngl.Texture]:
        """Colours and depths of the copy."""
        return self._textures["colours"], self._textures["depths"]

    def take_in(self, things: Iterable[SeenThrough]) -> None:
        """Give the copy the depths of see-through things, where these are nearer."""
        with self._plain_state():
            target = self._framebuffer(("depths",))
            self._ctx.enable_only(moderngl.BLEND)
            self._ctx.blend_equation = moderngl.MIN, moderngl.MIN
            for thing in things:
                textures: dict[str, Any] = {"found": thing.depth}
                uniforms: dict[str, Any] = {"corner": self._corner, "faintest": FAINTEST}
                features = []
                if thing.lights is not None:
                    textures["lights"] = thing.lights
                    features.append("SEEN_LIGHT")
                if thing.positions is not None:
                    textures["positions"] = thing.positions
                    uniforms["values"] = tuple(min(max(value, -_LARGEST), _LARGEST) for value in thing.values)
                    features.append("SEEN_PEAK")
                target.viewport = (*self._corner, *thing.depth.size)
                self._pass("seen_through", target, textures, uniforms, features)
            self._ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
            self._ctx.enable_only(moderngl.NOTHING)

    def depths(self, rectangle: tuple[int, int, int, int]) -> npt.NDArray[np.float32]:
        """Read window depths of the copy."""
        target = self._framebuffer(("colours", "depths"))
        x, y, width, height = _within(rectangle, target.size)
        if width <= 0 or height <= 0:
            return np.ones((0, 0), np.float32)
        data = target.read((x, y, width, height), components=1, attachment=1, dtype="f4", alignment=1)
        return np.frombuffer(data, np.float32).reshape(height, width)

    def depths_later(
        self, rectangle: tuple[int, int, int, int], tag: Any
    ) -> tuple[Any, npt.NDArray[np.float32]] | None:
        """Request window depths of the copy, and return depths of an earlier picture, without waiting for the GPU."""
        if self._reads is None:
            self._reads = DelayedRead(self._ctx, self._gl)
        target = self._framebuffer(("colours", "depths"))
        area = _within(rectangle, target.size)
        if min(area[2:]) > 0:
            with self._gl.framebuffers_kept():
                self._reads.start(target, area, 1, tag, attachment=1)
        came = self._reads.arrived()
        return None if came is None else (came[0], came[1][..., 0])

    def draw(
        self,
        target: Attachment,
        viewport: tuple[int, int, int, int],
        *,
        tone: Tone,
        focus: Focus | None = None,
        lens: Projection | None = None,
    ) -> None:
        """Draw the copy, changed."""
        x, y = viewport[:2]
        shift = {"shift": (self._corner[0] - x, self._corner[1] - y)}
        with self._plain_state():
            if focus is not None and lens is not None:
                textures = self._blurred(focus, lens)
                name, features = "gather", ["PICTURE_TONE", *tone.features] if tone.changes else []
            else:
                textures = {"colours": self._textures["colours"]}
                name, features = "tone", list(tone.features)
            with self._onto(target, viewport) as framebuffer:
                self._pass(name, framebuffer, textures, shift | tone.uniforms(), features)

    def _blurred(self, focus: Focus, lens: Projection) -> dict[str, moderngl.Texture]:
        """Compute how far the light of each pixel of the copy spreads; return the last pass's input."""
        size = self._textures["colours"].size
        blurs = self._texture("blurs", size, 4, "f4")
        tiled = -(-size[0] // TILE), -(-size[1] // TILE)
        tiles, reaches = (self._texture(name, tiled, 1, "f4") for name in ("tiles", "reaches"))
        lights = self._texture("lights", tiled, 4, "f4")
        colours = self._textures["colours"]
        around = {"around": int(focus.max_blur + 0.5) // TILE + 1}
        sources = {"depths": self._textures["depths"], "areas": self._disc_areas(focus.max_blur)}
        self._pass("blur", self._framebuffer(("blurs",)), sources, focus.uniforms(lens))
        self._pass("tiles", self._framebuffer(("tiles", "lights")), {"colours": colours, "blurs": blurs}, {})
        self._pass("reach", self._framebuffer(("reaches",)), {"tiles": tiles, "lights": lights}, around)
        return {"colours": colours, "blurs": blurs, "reaches": reaches}

    def _forget_depths(self) -> None:
        """Give back what only depth of field needs."""
        for name in set(self._textures) - {"colours"}:
            self._drop(name)
        if self._areas is not None:
            self._areas[1].release()
            self._areas = None

    def _disc_areas(self, widest: float) -> moderngl.Texture:
        if self._areas is None or self._areas[0] != widest:
            if self._areas is not None:
                self._areas[1].release()
            table = disc_areas(widest)
            texture = self._ctx.texture((len(table), 1), 1, table.tobytes(), dtype="f4")
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
            self._areas = widest, texture
        return self._areas[1]

    @property
    def nbytes(self) -> int:
        """Bytes of textures and buffers on the GPU."""
        areas = None if self._areas is None else self._areas[1]
        own = 0 if areas is None else areas.width * areas.height * bytes_of(areas)
        return super().nbytes + own + (0 if self._reads is None else self._reads.nbytes)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._forget_depths()
        if self._reads is not None:
            self._reads.release()
            self._reads = None
        super().release()


def _within(rectangle: tuple[int, int, int, int], size: tuple[int, int]) -> tuple[int, int, int, int]:
    """Return the part of a rectangle (x, y, width, height) that lies in a picture."""
    (x, y), (right, top) = (
        tuple(min(max(at, 0), side) for at, side in zip(corner, size, strict=True))
        for corner in (rectangle[:2], (rectangle[0] + rectangle[2], rectangle[1] + rectangle[3]))
    )
    return x, y, right - x, top - y
