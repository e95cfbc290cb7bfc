"""Effects on a whole picture as features of a plain scene, on a stand-in for VTK's picture."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.engine.effects.depth_of_field import Focus
from pvfiblets.engine.effects.picture import Attachment, PictureEffects
from pvfiblets.engine.effects.projection import Projection
from pvfiblets.engine.effects.tone import Tone
from pvfiblets.engine.gbuffer import EMPTY

if TYPE_CHECKING:
    import moderngl

    from ...cameras import Camera

APERTURE, MAX_BLUR = 0.06, 16.0
"""Of the height that is seen at the distance in focus, and pixels: the defaults of ``plotter.picture``."""

DEEPEST = 4294967295.0  # of depth keys


def lens_of(camera: Camera) -> Projection:
    """Return what effects must know of a camera."""
    return Projection(camera.size, camera.camera_to_clip)


@dataclass(frozen=True)
class PictureEffect:
    """The effect on a whole picture: tones, and whether it is in focus in the scene's middle only."""

    name: str
    tone: Tone = field(default_factory=Tone)
    focused: bool = False


PICTURE_EFFECTS = (
    PictureEffect("depth of field", focused=True),
    PictureEffect("film tones", Tone(operator="aces")),
    PictureEffect("brightness and contrast", Tone(brightness=0.1, contrast=1.2)),
    PictureEffect("gamma", Tone(gamma=1.8)),
    PictureEffect("depth of field and film tones", Tone(operator="aces"), focused=True),
)


class WholePicture:
    """Pictures with colours and depths, one for each camera, and what changes them.

    Depths are the scene's; colours are synthetic of the streamlines' numbers, on white. Both lie in textures of one
    sample a pixel. They are made when a camera is used first, from the G-buffer: later times are of the
    effect alone.
    """

    def __init__(self, ctx: moderngl.Context, effect: PictureEffect) -> None:
        self._ctx, self._effect = ctx, effect
        self._effects = PictureEffects(ctx)
        self._taken: dict[Camera, list[Any]] = {}
        self._shown: Any = None

    def draw(self, buffer: Any, camera: Camera) -> None:
        """Change the picture of a camera; it is kept as it was, and shown beside."""
        if camera not in self._taken:
            self._taken[camera] = self._take(buffer)
        colours, depths = (Attachment(texture.glo, 0) for texture in self._taken[camera])
        viewport = 0, 0, *camera.size
        focus, lens = None, lens_of(camera)
        if self._effect.focused:
            distance = float(np.linalg.norm(camera.eye - camera.centre))
            focus = Focus(distance, APERTURE * camera.size[1] / lens.pixels_per_mm(distance), MAX_BLUR)
        self._effects.copy(colours, depths if self._effect.focused else None, viewport)
        if self._shown is None:
            self._shown = self._ctx.texture(camera.size, 4)
        self._effects.draw(Attachment(self._shown.glo, 0), viewport, tone=self._effect.tone, focus=focus, lens=lens)

    def _take(self, buffer: Any) -> list[Any]:
        keys = np.frombuffer(buffer.depth.read(), "<u4")
        ids = np.frombuffer(buffer.ids.read(), "<u4")[::2]
        there = keys != EMPTY
        words = np.where(there, ids * np.uint32(2654435761), np.uint32(0xFFFFFFFF)) | np.uint32(0xFF000000)
        depths = np.where(there, keys / DEEPEST, 1.0).astype("<f4")
        return [
            self._ctx.texture(buffer.size, 4, words.astype("<u4").tobytes()),
            self._ctx.texture(buffer.size, 1, depths.tobytes(), dtype="f4"),
        ]

    def pixels(self) -> Any:
        """Return the last picture, (height, width, 4) uint8, row 0 at the bottom."""
        return np.frombuffer(self._shown.read(), np.uint8).reshape(*self._shown.size[::-1], 4)

    def explain(self) -> dict[str, list[dict[str, Any]]]:
        """Return ``buffers``: name and bytes of what the effect keeps; the picture itself is VTK's."""
        return {"buffers": [{"name": "picture", "bytes": self._effects.nbytes}]}

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._effects.release()
        for textures in self._taken.values():
            for texture in textures:
                texture.release()
        self._taken.clear()
        if self._shown is not None:
            self._shown.release()
            self._shown = None
