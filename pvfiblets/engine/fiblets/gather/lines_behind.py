"""`LinesBehind`: what a renderer of fiblets draws of the lines behind the nearest, layers and sums."""

from __future__ import annotations

import abc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import moderngl

from ...view import View
from ..fiblet_drawable import FibletDrawable
from ..style import FibletStyle
from .depth_peeling import Layers
from .layered_buffer import LayeredBuffer

if TYPE_CHECKING:
    from ...culling import Occlusion
    from ...drawable import Drawable
    from ...gbuffer import GBuffer
    from ..data.uniform_blocks import SharedBlocks
    from ..pipelines import DrawRequest, Pipeline
    from .gatherer import Gatherer
    from .gathering import Gathered, SliceDistances
    from .paint import Paint


class LinesBehind(FibletDrawable):
    """Layers and sums of lines behind the nearest. Textures and programs are made when first needed."""

    _shared: SharedBlocks

    def __init__(self, ctx: moderngl.Context, constants: Any, lender: Drawable[Any] | None = None) -> None:
        super().__init__(ctx, constants, lender)
        self._features_behind: frozenset[str] = frozenset()
        self._layers: Layers | None = None
        self._gatherer: Gatherer | None = None

    @abc.abstractmethod
    def _request(self, view: View, style: FibletStyle, target: GBuffer) -> DrawRequest:
        """Update and bind everything that a view and a style need, and return the draw request."""

    @abc.abstractmethod
    def _make_pipeline(self) -> Pipeline:
        """Make one with a record of fiblets of its own."""

    @abc.abstractmethod
    def _make_stage(self) -> tuple[Pipeline, Occlusion | None]:
        """Make what draws one layer."""

    def render_layers(self, view: View, style: FibletStyle | None = None, count: int = 4) -> LayeredBuffer:
        """Draw ``count`` layers, the nearest lines included; a repeated call with this view and style costs nothing."""
        style = style or FibletStyle()
        nearest = self.render(view, style)
        if self._layers is None:
            self._layers = self._keep(Layers(self._ctx, self._gl, self._programs, self._make_stage), "layers")
        with self._noting():
            return self._layers.render(nearest, count, view, style, lambda: self._request(view, style, nearest))

    def drop_layers(self) -> None:
        """Give back what :meth:`render_layers` keeps; twice is harmless."""
        self._drop_one(self._layers)
        self._layers = None

    def gather(
        self,
        view: View,
        style: FibletStyle | None = None,
        paint: Paint | None = None,
        *,
        sliced: bool = False,
        outside: Callable[[], moderngl.Texture | None] | None = None,
        state: Any = None,
    ) -> Gathered:
        """Add up what all lines show in each pixel; nothing is done that has been done for this picture."""
        # Without `paint`, lines are counted. `sliced` leaves the nearest line out, and parts the others by how far
        # behind it they are. `outside` returns depth keys of other things in the scene, r32ui of the view's size: lines
        # behind those are left out. `state` is another object where that depth may be another.
        from .gathering import SLICES
        from .paint import Paint

        style = style or FibletStyle()
        nearest = self.render(view, style)
        gatherer = self._with_gatherer()
        with self._noting():
            return gatherer.render(
                nearest,
                paint or Paint(),
                SLICES if sliced else 1,
                self.slice_distances(view),
                lambda: self._request(view, style, nearest),
                outside,
                state,
            )

    def slice_distances(self, view: View) -> SliceDistances:
        """Return how slices of a view's depth lie, the same for all parts of a set."""
        from .gathering import SliceDistances

        origin, scale, top = self._shared.place
        return SliceDistances.from_box(view, origin, origin + top * scale)

    def gathers_words(self, view: View, style: FibletStyle, nearest: GBuffer) -> bool:
        """Return whether this picture's sums are words, not floats."""
        return self._with_gatherer().gathers_words(self._request(view, style, nearest))

    def gather_into(
        self,
        held: Gathered,
        view: View,
        style: FibletStyle,
        paint: Paint,
        nearest: GBuffer,
        hides: moderngl.Texture | None,
    ) -> None:
        """Add all lines of this part to the sums of its set, ``held``."""
        # `nearest` is the picture of all parts: where there are slices, a line of this part that is as near is left
        # out.
        picture = self.render(view, style) if held.slices > 1 else nearest
        gatherer = self._with_gatherer()
        with self._noting():
            gatherer.add_to(held, paint, nearest, picture, self._request(view, style, picture), hides)

    def _with_gatherer(self) -> Gatherer:
        from .gatherer import Gatherer

        if self._gatherer is None:
            maker = Gatherer(self._ctx, self._gl, self._programs, self._make_pipeline)
            self._gatherer = self._keep(maker, "gathered")
        return self._gatherer

    def most_lines(self, *, wait: bool = True) -> float:
        """Return the greatest weight of a pixel in what :meth:`gather` made last: lines, where it was not sliced."""
        # Without `wait`, it may be that of some pictures earlier.
        if self._gatherer is None:
            return 0.0
        with self._noting():
            return self._gatherer.greatest(wait=wait)

    def drop_gathered(self) -> None:
        """Give back what :meth:`gather` keeps; twice is harmless."""
        self._drop_one(self._gatherer)
        self._gatherer = None

    @contextmanager
    def _noting(self) -> Iterator[None]:
        """Report the features of pictures drawn in this scope as the main picture's."""
        with self._programs.noting() as features:
            yield
        self._features_behind |= features

    def _drop_one(self, kept: Any) -> None:
        if kept is not None:
            self._drop(kept)
        self._features_behind = frozenset()

    def explain(self, *, counts: bool = True) -> dict[str, Any]:
        """Return what :meth:`.Drawable.explain` does, and ``fiblets`` as the census counts them; None: not known."""
        return super().explain(counts=counts) | {"features": sorted(self._features | self._features_behind)}

    def release(self) -> None:
        """Give back everything on the GPU; twice is harmless."""
        super().release()
        self._layers = self._gatherer = None
        self._features_behind = frozenset()
