"""`FibletDrawable`: what draws a set of fiblets, whole or in parts, and many samples of a pixel at once."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING

from ..drawable import Drawable
from .style import FibletStyle

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..view import View
    from .sample_layers import Rectangle, SampledLines, SampleLayers


def has_layers(view: View, style: FibletStyle) -> bool:
    """Return True for lines without a surface, cut by planes at most, which can be drawn as layers of samples."""
    return style.radius is None and style.relief is None and view.region is None


class FibletDrawable(Drawable[FibletStyle]):
    """Draws a set of fiblets."""

    STYLE = FibletStyle

    @abstractmethod
    def layers_samples(self, view: View, style: FibletStyle) -> bool:
        """Say whether :meth:`sample_layers` can draw a picture now."""

    @abstractmethod
    def sampled(self, view: View, style: FibletStyle, rectangle: Rectangle) -> Iterable[SampledLines]:
        """Return what :meth:`sample_layers` draws of this set, part by part; nothing lies outside of the rectangle."""

    def sample_layers(self) -> SampleLayers:
        """Return what draws sixteen samples of every pixel, of this set and of others of the same picture and context.

        The picture of :meth:`render` stays as it is. :meth:`drop_samples` gives it back, or :meth:`release`.
        """
        from .sample_layers import SampleLayers

        self._check_alive()
        return self._keep(SampleLayers(self._ctx, self._gl, self._programs), "samples")

    def drop_samples(self, samples: SampleLayers) -> None:
        """Give back what :meth:`sample_layers` returned; twice is harmless."""
        self._drop(samples)
