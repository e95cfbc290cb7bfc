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

WEAKEST = 0.02
"""Part of the range of colours by which values must change from voxel to voxel to have a normal of full weight."""


@dataclass(frozen=True)
class Lamp:
    """A lamp, in the scene's own coordinates."""

    place: tuple[float, float, float]  # mm; of a directional one the direction towards it
    positional: bool = False
    # RGB of its light on surfaces, and in their reflections, times its intensity
    colour: tuple[float, float, float] = (1.0, 1.0, 1.0)
    highlight: tuple[float, float, float] = (1.0, 1.0, 1.0)
    way: tuple[float, float, float] = (0.0, 0.0, -1.0)  # in which it shines
    cone: float = 180.0  # half the angle of its cone, degrees; 90 or more for none
    exponent: float = 0.0  # power of the cosine; light fades by it within the cone
    fading: tuple[float, float, float] = (1.0, 0.0, 0.0)  # constant, linear and quadratic, by distance


@dataclass(frozen=True)
class Shading:
    """How light through a volume is shaded.

    Source: Levoy, "Display of surfaces from volume data" (1988), which Lesar 2015 (section I) builds on.
    """

    lamps: tuple[Lamp, ...]  # the first `MOST_LAMPS` count
    eye: tuple[float, ...]  # its place, mm, with 1; of a parallel view the direction towards it, with 0
    # from the data's coordinates to the scene's, row by row
    matrix: tuple[float, ...] = tuple(np.eye(4).ravel().tolist())
    ambient: float = 0.0  # as of VTK's properties
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
