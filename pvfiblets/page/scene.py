"""The scene of a page, as plain data; ``client/src/scene.ts`` is the same for the page's script."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

Made = TypeVar("Made")
Vector = tuple[float, float, float]
Bounds = tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class CameraPlace:
    """A camera, as VTK has it: world mm and degrees."""

    position: Vector
    focal_point: Vector
    up: Vector
    view_angle: float = 30.0
    parallel: bool = False
    parallel_scale: float = 1.0


@dataclass(frozen=True)
class Light:
    """A light."""

    colour: Vector  # RGB times intensity
    # direction to the light, in view coordinates of one that moves with the camera, or in world coordinates
    view: Vector | None = None
    world: Vector | None = None
    positional: bool = False  # whether `world` is a place instead

    def plain(self) -> dict[str, Any]:
        """Return it as JSON has it."""
        place = {"view": self.view} if self.world is None else {"world": self.world, "positional": self.positional}
        return {"colour": self.colour, **place}


@dataclass
class PageScene:
    """The scene of a page."""

    title: str  # of the page
    # at the bottom and at the top, RGB from 0 to 1
    background: tuple[Vector, Vector] = ((1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
    camera: CameraPlace | None = None  # none: an oblique view of everything, fitted to the reader's window
    lights: list[Light] = field(default_factory=list)  # A headlight where there is none
    # as `client/src/scene.ts` has them; `fiblet_layer` makes one
    layers: list[dict[str, Any]] = field(default_factory=list)
    bars: list[dict[str, Any]] = field(default_factory=list)
    blobs: list[bytes] = field(default_factory=list)  # what layers name by number
    bounds: Bounds = (np.inf, -np.inf, np.inf, -np.inf, np.inf, -np.inf)  # of everything, world mm
    letters: bool = False  # whether letters say where left, right, front, back, top and bottom are
    antialias: bool = True  # whether edges of lines are smooth
    # whether values of points are blobs of their own, and no part of the sets: other ones are then sent alone
    values_apart: bool = False

    def add_blob(self, data: bytes | npt.NDArray[Any]) -> int:
        """Keep some bytes and return their number."""
        self.blobs.append(data if isinstance(data, bytes) else np.ascontiguousarray(data).tobytes())
        return len(self.blobs) - 1

    def once(self, what: tuple[Any, ...], make: Callable[[], Made]) -> Made:  # noqa: ARG002 - used by subclasses
        """Return a result that takes long to make; scenes that are made again and again keep it."""
        return make()

    def add_layer(self, layer: dict[str, Any], bounds: Sequence[float]) -> None:
        """Show something that lies within bounds."""
        self.layers.append(layer)
        low, high = np.minimum(self.bounds[::2], bounds[::2]), np.maximum(self.bounds[1::2], bounds[1::2])
        x, y, z = zip(low.tolist(), high.tolist(), strict=True)
        self.bounds = (*x, *y, *z)

    def plain(self) -> dict[str, Any]:
        """Return all but the blobs as JSON has it."""
        if not self.layers or not np.isfinite(self.bounds).all():
            raise ValueError("a page needs streamlines or surfaces; add some first")
        return {
            "title": self.title,
            "background": self.background,
            **({} if self.camera is None else {"camera": self.camera.__dict__}),
            "bounds": self.bounds,
            "lights": [light.plain() for light in self.lights or [Light((1.0, 1.0, 1.0), view=(0.0, 0.0, 1.0))]],
            "layers": self.layers,
            "bars": self.bars,
            "letters": self.letters,
            "antialias": self.antialias,
        }


def fiblet_layer(
    scene: PageScene,
    fiblets: FibletSet,
    *,
    name: str = "streamlines",
    colours: dict[str, Any] | None = None,
    keep: tuple[str, ...] = (),
    line_width: float = 1.0,  # pixels of lines, or of the discs at their ends if only these are drawn
    ends: bool = False,
    light: str = "line",
    reflects: tuple[float, float, float, float] = (0.0, 1.0, 0.0, 1.0),
    sheen: Vector = (1.0, 1.0, 1.0),
    matrix: npt.NDArray[np.float64] | None = None,
    **more: Any,
) -> dict[str, Any]:
    """Show a set of fiblets."""
    from .fiblet_bytes import fiblet_bytes

    layer: dict[str, Any] = {
        "kind": "fiblets",
        "name": name,
        "visible": True,
        "data": scene.add_blob(scene.once(("bytes", fiblets, keep), lambda: fiblet_bytes(fiblets, keep))),
        "colours": colours or {"mode": "orientation"},
        "line_width": float(line_width),
        "ends": ends,
        "light": light,
        "reflects": reflects,
        "sheen": sheen,
        **more,
    }
    bounds = np.array(fiblets.bounds, float)
    if matrix is not None:
        layer["matrix"] = np.asarray(matrix, float).T.ravel().tolist()
        corners = np.array([[x, y, z, 1.0] for x in bounds[:2] for y in bounds[2:4] for z in bounds[4:]]) @ matrix.T
        bounds = np.column_stack([corners[:, :3].min(axis=0), corners[:, :3].max(axis=0)]).ravel()
    scene.add_layer(layer, _bounds(bounds))
    return layer


def encoded(table: npt.NDArray[np.uint8]) -> str:
    """Return a table of RGBA as JSON has it."""
    return base64.b64encode(np.ascontiguousarray(table, np.uint8).tobytes()).decode()


def _bounds(values: npt.NDArray[Any]) -> Bounds:
    a, b, c, d, e, f = (float(v) for v in values)
    return a, b, c, d, e, f
