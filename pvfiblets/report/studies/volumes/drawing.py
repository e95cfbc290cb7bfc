"""Drawing for the study of volumes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...cameras import Camera

if TYPE_CHECKING:
    import moderngl


def drawn(ctx: moderngl.Context, renderer: Any, camera: Camera, style: Any) -> Any:
    """Draw a picture, wait for it, and return its G-buffer."""
    from pvfiblets.engine import View

    buffer = renderer.render(View(camera.size, camera.model_view_projection), style)
    ctx.finish()
    return buffer


def drawing(ctx: moderngl.Context, renderer: Any, style: Any) -> Callable[[Camera], object]:
    """Return what draws a camera's picture in one style."""
    return lambda camera: drawn(ctx, renderer, camera, style)


def sample(mask: npt.NDArray[np.bool_], count: int) -> npt.NDArray[np.int64]:
    """Return rows and columns, ``(n, 2)``, of so many pixels of a mask at most."""
    return np.random.default_rng(0).permutation(np.argwhere(mask))[:count]
