"""Colour bars: one for each layer whose colours stand for values, so that they say what the picture shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pvfiblets.web.document import Layer

__all__ = ["Bars", "bar_arguments", "bars_of", "contrast", "has_labels"]

MOST_BARS = 6
LABELLED_RATIO = 0.35
"""How much of its width a bar takes beside names."""
_WIDTH, _FIRST, _STEP, _NAMES = 0.06, 0.88, 0.14, 0.12
_LOW, _HEIGHT = 0.07, 0.3
"""Below the middle of the height, where the letters at the sides stand, titles over the bars included."""


class Bars:
    """The colour bars of a plotter.

    Parameters
    ----------
    plotter : pyvista.Plotter
    """

    def __init__(self, plotter: Any) -> None:
        self._plotter = plotter
        self._shown: list[tuple[Any, ...]] = []

    def show(self, drawn: Sequence[tuple[Layer, Any]], background: str) -> None:
        """Bring the bars in step with layers and their actors, in the order of the layers."""
        found = bars_of(drawn)
        wanted = [(title, actor, _looks(layer, actor), background) for title, layer, actor in found]
        if wanted == self._shown:
            return
        for title, *_ in self._shown:
            if title in self._plotter.scalar_bars:
                self._plotter.remove_scalar_bar(title, render=False)
        self._shown = wanted
        for place, (title, _, actor) in enumerate(found):
            arguments = bar_arguments(place, actor, background)
            bar = self._plotter.add_scalar_bar(title, mapper=actor.mapper, render=False, **arguments)
            if has_labels(actor):
                bar.SetBarRatio(LABELLED_RATIO)
                bar.SetTextPositionToPrecedeScalarBar()
                # VTK centres names from the second picture on only.
                bar.GetAnnotationTextProperty().SetVerticalJustificationToCentered()


def bars_of(drawn: Sequence[tuple[Layer, Any]]) -> list[tuple[str, Layer, Any]]:
    """Return title, layer and actor of each bar; titles are all different."""
    found: list[tuple[str, Layer, Any]] = []
    for layer, actor in drawn:
        wanted = layer.settings.get("show_bar", False) and layer.visible
        title = _title(layer, actor) if wanted else None
        if title is None or len(found) == MOST_BARS:
            continue
        taken = {other for other, _, _ in found}
        if title in taken:
            title = f"{title}, {layer.name}"
        while title in taken:
            title += " "
        found.append((title, layer, actor))
    return found


def bar_arguments(place: int, actor: Any, background: str) -> dict[str, Any]:
    """Return arguments of ``plotter.add_scalar_bar`` for an actor's bar: the first at the right, others to the left."""
    found = {
        "color": contrast(background),
        "vertical": True,
        "width": _WIDTH,
        "height": _HEIGHT,
        "position_x": round(_FIRST - _STEP * place, 4),
        "position_y": _LOW,
    }
    if has_labels(actor):
        return {**found, "position_x": round(_FIRST - _STEP * place - _NAMES, 4), "n_labels": 0}
    return {**found, "title_font_size": 13, "label_font_size": 13}


def has_labels(actor: Any) -> bool:
    """Whether an actor's bar names its numbers; it is narrow then, with the names at its right."""
    return bool(getattr(actor, "shows_labels", False))


def contrast(background: str) -> str:
    """Return black or white, whichever stands out."""
    parts = [int(background[k : k + 2], 16) for k in (1, 3, 5)]
    return "black" if sum(parts) > 382 else "white"


def _title(layer: Layer, actor: Any) -> str | None:
    if layer.kind == "mesh":
        scalars = layer.settings["scalars"]
        mapped = scalars is not None and actor.mapper.scalar_visibility and actor.mapper.color_mode != "direct"
        return scalars if mapped else None
    title: str | None = actor.scalars_title
    return title


def _looks(layer: Layer, actor: Any) -> tuple[Any, ...]:
    """What a bar copies from its actor and does not follow by itself: of meshes all, of others the kind of labels."""
    own = tuple(layer.settings[name] for name in ("cmap", "log_scale") if name in layer.settings)
    return (*own, tuple(layer.settings["clim"] or ()), has_labels(actor))
