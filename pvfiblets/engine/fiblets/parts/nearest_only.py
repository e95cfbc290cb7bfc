"""`NearestOnly`: what renderers share that put pictures of parts together: they have no layers of lines."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

from ...errors import EngineError
from ..fiblet_drawable import FibletDrawable

if TYPE_CHECKING:
    import moderngl

    from ...gbuffer import GBuffer
    from ...view import View
    from ..data.filter_textures import Filter
    from ..style import FibletStyle

_NO_LAYERS = (
    "a set that is drawn part by part has no layers of lines, which need all of it at once; let lines be added up "
    "(transparency='all'), draw a share of it by fit='sample', or fewer streamlines"
)
_NO_SUMS = (
    "workers of a cluster draw the nearest lines only: what all lines add up to is not sent; leave opacity at 1 and "
    "the style at lines, or draw a share of the set here by fit='sample'"
)


class NearestOnly(FibletDrawable):
    """Draws a set of fiblets in parts."""

    hurried = False  # whether pictures show the available data at once
    # seconds after which a picture is given back as it is; None for complete pictures only
    patience: float | None = None
    _filter: Filter | None = None

    @property
    @abstractmethod
    def unfinished(self) -> bool:
        """Whether the last picture lacks parts that another one of the same view would show."""

    @property
    @abstractmethod
    def resident(self) -> bool:
        """Whether all parts of the last picture are there, so that another one of nearly the same view fetches none."""

    def render(
        self, view: View, style: FibletStyle | None = None, *, outside: moderngl.Texture | None = None
    ) -> GBuffer:
        """Draw, unless the last picture was of the same view and style and complete; see :meth:`.Drawable.render`."""
        found = super().render(view, style, outside=outside)
        if self.share < 1.0:
            self._made = None  # the next call goes on
        return found

    @property
    def filtering(self) -> Filter | None:
        """The filter; see :attr:`.FibletRenderer.filtering`."""
        self._check_alive()
        return self._filter

    @filtering.setter
    def filtering(self, wanted: Filter | None) -> None:
        self._check_alive()
        self._take_filter(wanted)
        self._filter, self._made = wanted, None

    @abstractmethod
    def _take_filter(self, wanted: Filter | None) -> None:
        """Check a filter and hand it on."""

    def render_layers(self, *_given: Any, **_named: Any) -> Any:
        """Raise: see the message."""
        raise EngineError(_NO_LAYERS)

    def gather(self, *_given: Any, **_named: Any) -> Any:
        """Raise: see the message."""
        raise EngineError(_NO_SUMS)

    def most_lines(self, *, wait: bool = True) -> float:  # noqa: ARG002
        """Return 0: nothing is added up."""
        return 0.0

    def drop_layers(self) -> None:
        """Do nothing: there are none."""

    def drop_gathered(self) -> None:
        """Do nothing: there are no sums."""
