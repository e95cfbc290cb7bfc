"""Effects on a whole picture that is drawn already, whoever drew it: depth of field, and tones.

`PictureEffects` copies colours and depths of a viewport, and draws them changed to where they were. What the copy is
made of are textures of a framebuffer that is not the engine's, known by their OpenGL names.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ..bindings import FIRST_UNIT
from ..errors import EngineError
from ..moderngl_extras import GLExtras
from ..shaders import Programs
from .depth_of_field import STEPS, TILE, Focus, disc_areas
from .projection import Projection
from .tone import Tone

__all__ = ["Attachment", "PictureEffects"]

_BYTES = {"f1": 1, "f4": 4, "u4": 4}


@dataclass(frozen=True)
class Attachment:
    """A texture of somebody else's framebuffer.

    Attributes
    ----------
    name : int
        OpenGL's.
    samples : int
        Per pixel; 0 for a plain texture.
    floats : bool
        Whether its colours are floats, not bytes.
    """

    name: int
    samples: int
    floats: bool = False


class PictureEffects:
    """What changes pictures in one context.

    Parameters
    ----------
    ctx : moderngl.Context
        Current, as for every method. Nothing is made on it until a picture is changed.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._gl = GLExtras(ctx)
        self._programs = Programs(ctx, {"steps": float(STEPS), "tile": TILE})
        self._textures: dict[str, moderngl.Texture] = {}
        self._framebuffers: dict[tuple[str, ...], moderngl.Framebuffer] = {}
        self._areas: tuple[float, moderngl.Texture] | None = None
        self._corner = 0, 0

    def copy(
        self,
        colour: Attachment,
        depth: Attachment | None,
        viewport: tuple[int, int, int, int],
        *,
        size: tuple[int, int] | None = None,
        corner: tuple[int, int] = (0, 0),
    ) -> None:
        """Take a picture over.

        Parameters
        ----------
        colour : Attachment
        depth : Attachment or None
            None where nobody asks for depths.
        viewport : tuple of 4 ints
            x, y, width, height of the part of the attachments that counts.
        size : tuple of 2 ints, optional
            Of the copy, where that shall be larger: several pictures side by side.
        corner : tuple of 2 ints
            Pixel of the copy at which this picture's lower left one comes.
        """
        x, y, width, height = viewport
        size = size or (width, height)
        targets = {"colours": (4, "f4" if colour.floats else "f1")} | ({"depths": (1, "f4")} if depth else {})
        names = tuple(targets)
        for name, (components, dtype) in targets.items():
            self._texture(name, size, components, dtype)
        if depth is None:
            self._forget_depths()
        features = (["PICTURE_SAMPLES"] if colour.samples else []) + (["PICTURE_DEPTH"] if depth else [])
        outside = {"drawn": self._outside(colour, 4)} | ({"depths": self._outside(depth, 1)} if depth else {})
        uniforms = {"samples": colour.samples, "origin": (x, y), "corner": corner}
        with self._plain_state():
            target = self._framebuffer(names)
            target.viewport = (*corner, width, height)
            self._pass("copy", target, outside, uniforms, features)
        self._corner = corner

    def depths(self, rectangle: tuple[int, int, int, int]) -> npt.NDArray[np.float32]:
        """Read window depths of the copy.

        Parameters
        ----------
        rectangle : tuple of 4 ints
            x, y, width, height in pixels of the copy; what lies beyond its edges is left out.

        Returns
        -------
        numpy.ndarray
            (rows, columns) float32, the lowest row first; 1 where nothing was drawn.
        """
        target = self._framebuffer(("colours", "depths"))
        x, y = (min(max(at, 0), side) for at, side in zip(rectangle, target.size, strict=False))
        right, top = (
            min(max(at + span, 0), side)
            for at, span, side in zip(rectangle[:2], rectangle[2:], target.size, strict=True)
        )
        if right <= x or top <= y:
            return np.ones((0, 0), np.float32)
        data = target.read((x, y, right - x, top - y), components=1, attachment=1, dtype="f4", alignment=1)
        return np.frombuffer(data, np.float32).reshape(top - y, right - x)

    def draw(
        self,
        target: Attachment,
        viewport: tuple[int, int, int, int],
        *,
        tone: Tone,
        focus: Focus | None = None,
        lens: Projection | None = None,
    ) -> None:
        """Draw the copy, changed.

        Parameters
        ----------
        target : Attachment
            Its colours; all samples of a pixel get the same.
        viewport : tuple of 4 ints
            x, y, width, height of the part of the target that is drawn.
        tone : Tone
            Comes after the focus.
        focus : Focus, optional
            Of a picture that was copied with its depths.
        lens : Projection, optional
            With the focus: of the viewport.
        """
        x, y, width, height = viewport
        outside = self._outside(target, 4, (x + width, y + height))
        shift = {"shift": (self._corner[0] - x, self._corner[1] - y)}
        with self._plain_state():
            if focus is not None and lens is not None:
                textures = self._blurred(focus, lens)
                name, features = "gather", ["PICTURE_TONE", *tone.features] if tone.changes else []
            else:
                textures = {"colours": self._textures["colours"]}
                name, features = "tone", list(tone.features)
            framebuffer = self._ctx.framebuffer([outside])
            try:
                framebuffer.viewport = viewport
                self._pass(name, framebuffer, textures, shift | tone.uniforms(), features)
            finally:
                framebuffer.release()

    def _blurred(self, focus: Focus, lens: Projection) -> dict[str, moderngl.Texture]:
        """Say of each pixel of the copy how far its light spreads; returns what the last pass reads."""
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

    # Textures, programs, state

    def _plain_state(self) -> Any:
        """Return what keeps the framebuffers that are bound; what is drawn meanwhile is neither mixed nor tested."""
        self._ctx.scissor = None
        self._ctx.enable_only(moderngl.NOTHING)
        return self._gl.framebuffers_kept()

    def _outside(self, attachment: Attachment, components: int, size: tuple[int, int] = (1, 1)) -> moderngl.Texture:
        """Return somebody else's texture as one of moderngl's, which never deletes it."""
        dtype = "f4" if attachment.floats else "f1"
        return self._ctx.external_texture(attachment.name, size, components, attachment.samples, dtype)

    def _texture(self, name: str, size: tuple[int, int], components: int, dtype: str) -> moderngl.Texture:
        """Return a texture, made anew for another size or kind."""
        old = self._textures.get(name)
        if old is not None and (old.size, old.dtype) == (size, dtype):
            return old
        if old is not None:
            self._drop(name)
        try:
            texture = self._ctx.texture(size, components, dtype=dtype)
        except moderngl.Error as error:
            raise EngineError(f"no memory for an effect on a picture of {size[0]} x {size[1]} pixels") from error
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self._textures[name] = texture
        return texture

    def _forget_depths(self) -> None:
        """Give back what only depth of field needs."""
        for name in set(self._textures) - {"colours"}:
            self._drop(name)
        if self._areas is not None:
            self._areas[1].release()
            self._areas = None

    def _drop(self, name: str) -> None:
        for names in [names for names in self._framebuffers if name in names]:
            self._framebuffers.pop(names).release()
        self._textures.pop(name).release()

    def _framebuffer(self, names: tuple[str, ...]) -> moderngl.Framebuffer:
        """Return what draws into textures."""
        if names not in self._framebuffers:
            with self._gl.framebuffers_kept():
                self._framebuffers[names] = self._ctx.framebuffer([self._textures[name] for name in names])
        return self._framebuffers[names]

    def _disc_areas(self, widest: float) -> moderngl.Texture:
        if self._areas is None or self._areas[0] != widest:
            if self._areas is not None:
                self._areas[1].release()
            table = disc_areas(widest)
            texture = self._ctx.texture((len(table), 1), 1, table.tobytes(), dtype="f4")
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
            self._areas = widest, texture
        return self._areas[1]

    def _pass(
        self,
        name: str,
        target: moderngl.Framebuffer,
        textures: Mapping[str, Any],
        uniforms: Mapping[str, Any],
        features: Iterable[str] = (),
    ) -> None:
        """Run a fragment stage of ``shaders/effects/picture`` on every pixel of a target's viewport."""
        program, array = self._programs.screen(f"effects/picture/{name}.frag", features)
        for unit, (sampler, texture) in enumerate(textures.items(), start=FIRST_UNIT):
            if sampler in program:
                texture.use(unit)
                program[sampler] = unit
        for uniform, value in uniforms.items():
            if uniform in program:
                program[uniform] = value
        target.use()
        array.render(moderngl.TRIANGLES, vertices=3)

    @property
    def nbytes(self) -> int:
        """Bytes of textures on the GPU."""
        kept = [*self._textures.values(), *([self._areas[1]] if self._areas else [])]
        return sum(t.width * t.height * t.components * _BYTES[t.dtype] for t in kept)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._forget_depths()
        for name in list(self._textures):
            self._drop(name)
        self._programs.release()
