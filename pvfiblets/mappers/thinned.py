"""Some of a large set's streamlines, for frames of reduced detail (`pvfiblets.mappers.frames.scene.reduce_detail`).

Where lines hide each other, most of a set is decoded and tested in vain, and fewer pixels do not help. An even share of
the streamlines, always the same one, lies on the GPU beside the set from the first such frame on. What is filtered,
coloured and cut goes by the numbers of the whole set's streamlines.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pvfiblets.engine.errors import GPUMemoryError
from pvfiblets.mappers.frames.scene import wanted_share

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

LEAST_FIBLETS = 20_000  # smaller sets are never thinned: they are fast, and each of their lines may count


def thinned_engine(context: Any, slot: Any, fiblets: FibletSet, filtering: Any, make: Callable[..., Any]) -> Any:
    """Return the engine that draws the share of streamlines that the window requests."""
    if fiblets.n_fiblets < LEAST_FIBLETS or hasattr(slot.renderer, "patience"):
        return slot.renderer
    wanted = wanted_share(context.window) * slot.renderer.share
    share = max(wanted, min(LEAST_FIBLETS / fiblets.n_fiblets, slot.renderer.share))
    if share not in slot.thinned:
        try:
            # `alike`: shares the programs of the whole set, which are compiled already.
            slot.thinned[share] = make(context.ctx, fit="sample", most=share, alike=fiblets.n_fiblets)
        except GPUMemoryError:
            slot.thinned[share] = None
    engine = slot.thinned[share]
    if engine is None:
        return slot.renderer
    if engine.filtering is not filtering:
        engine.filtering = filtering
    return engine
