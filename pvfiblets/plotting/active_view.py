"""The active view of a plotter, which its ``add_...`` methods and scalar bars work on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkRenderer


@contextmanager
def active_view(plotter: pv.BasePlotter, renderer: vtkRenderer) -> Iterator[None]:
    """Make one of a plotter's renderers the active one for a while."""
    renderers = plotter.renderers
    own, before = (
        np.atleast_1d(renderers.index_to_loc(index)).tolist()
        for index in (list(renderers).index(renderer), renderers.active_index)
    )
    renderers.set_active_renderer(*own)
    try:
        yield
    finally:
        renderers.set_active_renderer(*before)
