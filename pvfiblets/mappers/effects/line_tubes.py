"""Lines with bodies: wide lines shaded as if they were round, tubes, and the light that falls on tubes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.mappers.effects.shader_effects import Draw, MapperEffect, ShaderEffect

if TYPE_CHECKING:
    import moderngl


def thickness_of(effects: Iterable[MapperEffect]) -> float:
    """Return the radius (mm) of the tubes that effects want; 0 for lines."""
    return max((effect.style.get("radius") or 0.0 for effect in effects), default=0.0)


def thickened(bounds: Sequence[float], radius: float) -> Sequence[float]:
    """Return bounds (xmin, xmax, ymin, ...) moved outwards."""
    return [bound + side * radius for bound, side in zip(bounds, (-1, 1) * 3, strict=True)]


def normals_to_view(directions: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the ``(3, 3)`` cofactors, largest 1, of how directions turn: so a stretched surface keeps its normals."""
    a, b, c = directions.T
    turned = np.array([np.cross(b, c), np.cross(c, a), np.cross(a, b)]).T
    if np.linalg.det(directions) < 0.0:
        turned = -turned
    scaled: npt.NDArray[np.float64] = turned / (np.abs(turned).max() or 1.0)
    return scaled


class _Blank:
    """A texel that says of every pixel that it lies in the middle of its line."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._texture: Any = None

    @property
    def texture(self) -> Any:
        """The texel, made when it is first needed."""
        if self._texture is None:
            self._texture = self._ctx.texture((1, 1), 1, np.zeros(1, np.float16).tobytes(), dtype="f2", alignment=1)
            self._texture.filter = self._ctx.NEAREST, self._ctx.NEAREST
        return self._texture

    def explain(self) -> dict[str, list[dict[str, Any]]]:
        """Return ``passes`` (none) and ``buffers``, name and bytes."""
        held = [] if self._texture is None else [{"name": "fibletAcrossMap (blank)", "bytes": 2}]
        return {"passes": [], "buffers": held}

    def release(self) -> None:
        """Give it back; twice is harmless."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None


@dataclass(frozen=True)
class TubeShading(ShaderEffect):
    """A `pvfiblets.mappers.effects.shader_effects.MapperEffect` that lights wide lines like round tubes.

    Only the light changes: depths stay flat. Lines one pixel wide look as they
    did, and tubes have their own normals. It costs two bytes for each pixel.
    """

    features = frozenset({"tube_shading"})

    @property
    def style(self) -> Mapping[str, Any]:
        """Requests to the engine."""
        return {"across": True}

    def make(self, ctx: moderngl.Context) -> _Blank:
        """Make a substitute for the engine's texture where there are no wide lines."""
        return _Blank(ctx)

    def prepare(self, kept: _Blank, draw: Draw) -> Mapping[str, Any]:
        """Return the engine's texture."""
        flat = draw.style.relief == "across" and draw.buffer.across is not None
        return {"fibletAcrossMap": draw.buffer.across if flat else kept.texture}


@dataclass(frozen=True)
class SurfaceNormals(ShaderEffect):
    """A mapper effect that lights surfaces by the normals in ``GBuffer.across``."""

    features = frozenset({"tube_normal"})

    def prepare(self, kept: None, draw: Draw) -> Mapping[str, Any]:  # noqa: ARG002
        """Return the engine's texture."""
        return {"fibletNormalMap": draw.buffer.across}

    def set_uniforms(self, kept: None, program: Any, draw: Draw) -> None:  # noqa: ARG002
        """Set how normals turn with the actor."""
        turned = normals_to_view(draw.frame.directions_to_view)
        program.SetUniformMatrix3x3("fibletNormalToView", turned.T.ravel().tolist())


@dataclass(frozen=True)
class Tubes(SurfaceNormals):
    """A mapper effect that draws streamlines as tubes: bodies with round ends.

    Each pixel shows the point at which its ray meets the tube, to float32's last digits: tubes cut into each other and
    into VTK's meshes, and lights, ambient occlusion and selection take them for surfaces. Those thinner than a pixel
    are drawn a pixel wide. ``line_width`` is not looked at. It costs four bytes for each pixel.
    """

    radius: float  # data mm; a user matrix that scales the actor scales its tubes

    def __post_init__(self) -> None:
        if not (math.isfinite(self.radius) and self.radius > 0.0):
            raise ValueError(f"the radius of tubes is {self.radius}; give a finite number of millimetres above 0")

    @property
    def style(self) -> Mapping[str, Any]:
        """Requests to the engine."""
        return {"radius": float(self.radius), "across": True}
