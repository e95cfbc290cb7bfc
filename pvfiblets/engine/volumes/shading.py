"""`Shading`: the lamps of a scene on light through a volume, and what it reflects of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .uniform_blocks import MOST_LAMPS

if TYPE_CHECKING:
    import moderngl

    from ...volumes.volume import RaycastVolume

__all__ = ["WEAKEST", "Lamp", "Shading"]

WEAKEST = 0.02
"""Part of the range of colours by which values must change from voxel to voxel to have a normal of full weight."""


@dataclass(frozen=True)
class Lamp:
    """A lamp, in the scene's own coordinates.

    Attributes
    ----------
    place : tuple of 3 floats
        mm; of a directional one the direction towards it.
    positional : bool
    colour, highlight : tuple of 3 floats
        RGB of what it adds to colours and to reflections of itself, times its intensity.
    way : tuple of 3 floats
        In which it shines.
    cone : float
        Half the angle of its cone, degrees; 90 or more for none.
    exponent : float
        Power of the cosine by which it fades within its cone.
    fading : tuple of 3 floats
        Constant, linear and quadratic, by distance.
    """

    place: tuple[float, float, float]
    positional: bool = False
    colour: tuple[float, float, float] = (1.0, 1.0, 1.0)
    highlight: tuple[float, float, float] = (1.0, 1.0, 1.0)
    way: tuple[float, float, float] = (0.0, 0.0, -1.0)
    cone: float = 180.0
    exponent: float = 0.0
    fading: tuple[float, float, float] = (1.0, 0.0, 0.0)


@dataclass(frozen=True)
class Shading:
    """How light through a volume is shaded.

    Parameters
    ----------
    lamps : tuple of Lamp
        The first `MOST_LAMPS` count.
    eye : tuple of 4 floats
        Its place, mm, with 1; of a parallel view the direction towards it, with 0.
    matrix : tuple of 16 floats
        From the data's coordinates to the scene's, row by row.
    ambient, diffuse, specular, power : float
        As of VTK's properties.

    Notes
    -----
    Source: Levoy, "Display of surfaces from volume data" (1988), which Lesar 2015 (section I) builds on.
    """

    lamps: tuple[Lamp, ...]
    eye: tuple[float, ...]
    matrix: tuple[float, ...] = tuple(np.eye(4).ravel().tolist())
    ambient: float = 0.0
    diffuse: float = 1.0
    specular: float = 0.0
    power: float = 1.0

    def set_uniforms(self, program: moderngl.Program, volume: RaycastVolume, clim: tuple[float, float]) -> None:
        """Tell a program, of light through one volume."""
        place = np.array(self.matrix, np.float64).reshape(4, 4) @ volume.affine
        linear, eye = place[:3, :3], np.array(self.eye, np.float64)
        # From the eye, or where there is none from the volume: float32 has its digits there.
        origin = eye[:3] if eye[3] else place[:3, 3]
        spacing = float(np.linalg.norm(linear, axis=0).mean())
        lamps = self.lamps[:MOST_LAMPS]
        rows: dict[str, list[list[float]]] = {
            "lamp_places": [
                [*(np.array(lamp.place) - origin), 1.0] if lamp.positional else [*_unit(lamp.place), 0.0]
                for lamp in lamps
            ],
            "lamp_cones": [
                [*_unit(lamp.way), math.cos(math.radians(lamp.cone)) if lamp.positional and lamp.cone < 90.0 else -2.0]
                for lamp in lamps
            ],
            "lamp_fading": [[*lamp.fading, lamp.exponent] for lamp in lamps],
            "lamp_colours": [list(lamp.colour) for lamp in lamps],
            "lamp_highlights": [list(lamp.highlight) for lamp in lamps],
        }
        values: dict[str, Any] = {
            "seen_from_voxels": linear.T.ravel(),
            "normal_from_voxels": np.linalg.inv(linear).ravel(),  # transposed twice: column by column
            "seen_start": place[:3, 3] - origin,
            "towards_eye": [0.0] * 4 if eye[3] else [*_unit(eye[:3]), 1.0],
            "reflection": [self.ambient, self.diffuse, self.specular, self.power],
            "weakest": [WEAKEST * (clim[1] - clim[0]) / spacing],
        }
        for name, table in rows.items():
            padded = np.zeros((MOST_LAMPS, 3 if name in ("lamp_colours", "lamp_highlights") else 4))
            padded[: len(table)] = np.array(table).reshape(len(table), padded.shape[1])
            values[name] = padded
        for name, numbers in values.items():
            if name in program:
                uniform: Any = program[name]
                uniform.write(np.ascontiguousarray(numbers, "<f4").tobytes())
        if "lamp_count" in program:
            program["lamp_count"] = len(lamps)


def _unit(way: Any) -> list[float]:
    vector = np.array(way, np.float64)
    length = float(np.linalg.norm(vector))
    return (vector / (length or 1.0)).tolist()
