"""How an actor that is not opaque shows what lies behind its nearest lines."""

from __future__ import annotations

from typing import Any

from pvfiblets.mappers.depth_peeling import Layers

_NAME = "layers"
_LAYERS = 4


class Transparency:
    """The part of :class:`~pvfiblets.plotting.fiblets.actor.FibletActor` that lets lines be looked through."""

    _mapper: Any

    @property
    def transparency(self) -> str | int | None:
        """How many layers of lines an ``opacity`` below 1 shows, one through the other.

        ``None``: the nearest alone, through which one sees the rest of the scene. ``"layers"``:
        four, each with its own colour, light and depth, blended in order. A number from 2 to 64:
        as many. What lies behind the last does not show. A layer costs a drawing of all
        streamlines in view, and 44 bytes of GPU memory a pixel; opaque actors pay for none.
        """
        extra = self._mapper.extras.get(_NAME)
        if extra is None:
            return None
        return "layers" if extra.count == _LAYERS else extra.count

    @transparency.setter
    def transparency(self, transparency: str | int | None) -> None:
        if transparency is None:
            self._mapper.set_extra(_NAME, None)
            return
        layers = _LAYERS if transparency == "layers" else transparency
        try:
            extra = Layers(layers)  # type: ignore[arg-type]  # what is no number is refused by it
        except (TypeError, ValueError) as error:
            raise ValueError(
                f"transparency is {transparency!r}; give None, 'layers', or a number of layers from 2 to 64"
            ) from error
        self._mapper.set_extra(_NAME, extra)
