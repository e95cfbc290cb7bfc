"""The way from pixels to millimetres and back: what effects must know of a camera."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

# 1 - window depth = f stands in the third place: NDC depth is 2 * depth - 1 = 1 - 2 * f.
_FROM_COMPLEMENT = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -2.0, 1.0], [0.0, 0.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Projection:
    """A picture's size and projection."""

    size: tuple[int, int]  # width and height in pixels
    # `(4, 4)` float64: view coordinates (mm, the viewer at the origin, looking along -z) to clip coordinates
    projection: npt.NDArray[np.float64]
    pixel_to_view: npt.NDArray[np.float64] = field(init=False, repr=False)
    """``(4, 4)``: (x, y in [-1, 1], 1 - window depth, 1) to view coordinates, homogeneous, largest entry 1."""

    def __post_init__(self) -> None:
        matrix = np.array(self.projection, np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or np.linalg.matrix_rank(matrix) < 4:
            raise ValueError(f"projection must be a finite (4, 4) matrix with an inverse, got {matrix.tolist()}")
        inverse = np.linalg.inv(matrix) @ _FROM_COMPLEMENT
        object.__setattr__(self, "projection", matrix)
        object.__setattr__(self, "pixel_to_view", inverse / np.abs(inverse).max())

    @property
    def scale(self) -> tuple[float, float, float]:
        """(k, w0, w1): a mm at a distance (mm) from the viewer's plane is ``k / (w0 + w1 * distance)`` pixels."""
        # Measured up the picture, at its middle.
        k = 0.5 * self.size[1] * float(np.linalg.norm(self.projection[1, :3]))
        return k, float(self.projection[3, 3]), -float(self.projection[3, 2])

    def pixels_per_mm(self, distance: float) -> float:
        """Return how many pixels a mm takes at a distance (mm); infinite at the viewer's plane and behind."""
        k, w0, w1 = self.scale
        w = w0 + w1 * distance
        return k / w if w > 0.0 else np.inf

    @property
    def key(self) -> tuple[object, ...]:
        """The same for equal lenses."""
        return self.size, self.projection.tobytes()

    def uniforms(self) -> dict[str, object]:
        """Return what ``shaders/effects/view_position.glsl`` asks for, beside the keys."""
        # Column by column, as OpenGL has matrices.
        return {"pixel_to_view": tuple(self.pixel_to_view.T.ravel().tolist()), "lens": self.scale}
