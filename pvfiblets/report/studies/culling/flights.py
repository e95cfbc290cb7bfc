"""A camera that flies from picture to picture, as when a user turns the scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    import moderngl

Read = TypeVar("Read")


class Flight:
    """A camera that flies through views, and back the next time: every picture is one step from the one before.

    ``renderer.render(view, style)`` draws, and returns the picture to read; the first view is where the camera starts.
    """

    def __init__(self, ctx: moderngl.Context, renderer: Any, path: Sequence[Any], style: Any) -> None:
        self._ctx, self._renderer, self._style = ctx, renderer, style
        self._path = list(path)

    def __len__(self) -> int:
        """Pictures on the way."""
        return len(self._path) - 1

    def pictures(self, read: Callable[[Any], Read]) -> list[Read]:
        """Fly forth from the beginning, and return each picture on the way, as a function reads it."""
        self._renderer.render(self._path[0], self._style)
        return [read(self._renderer.render(view, self._style)) for view in self._path[1:]]

    def __call__(self) -> None:
        """Fly back, or forth again, after :meth:`pictures`."""
        self._path.reverse()
        for view in self._path[1:]:
            self._renderer.render(view, self._style)
            self._ctx.finish()
