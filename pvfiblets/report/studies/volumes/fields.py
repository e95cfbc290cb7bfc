"""Fields and transfer functions that are gentle, that jump, and that are zero but for one entry."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes import RaycastVolume

DENSE = 0.9  # opacity of a unit where tables are densest

Array = npt.NDArray[np.float64]


def tables() -> dict[str, Array]:
    """Return transfer functions of 256 entries, by name."""
    x, entry = np.linspace(0.0, 1.0, 256), np.arange(256)
    orange, blue = np.array([1.0, 0.6, 0.1]), np.array([0.1, 0.3, 1.0])
    turns = np.where((entry // 16 % 2)[:, None] == 0, orange, blue)
    found = {
        "ramp": (blue + x[:, None] * (orange - blue), DENSE * x),
        "edge": (orange, np.where(x > 0.37, DENSE, 0.0)),
        "peak": (orange, np.where(entry == 97, DENSE, 0.0)),
        "peaks": (turns, np.where(entry % 16 == 8, DENSE, 0.0)),
    }
    return {name: np.column_stack([np.broadcast_to(c, (256, 3)), alpha]) for name, (c, alpha) in found.items()}


def field(name: str, n: int) -> RaycastVolume:
    """Return a volume of values from 0 to 1: a slope, or a ball."""
    at = np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, n)] * 3, indexing="ij"), axis=-1)
    values = 0.5 + 0.5 * at @ [0.6, 0.3, 0.1] if name == "slope" else 1.0 - np.linalg.norm(at, axis=-1) / 1.2
    return RaycastVolume(np.clip(values, 0.0, 1.0).astype(np.float32), np.eye(4))
