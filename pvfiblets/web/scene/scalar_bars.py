"""Colour bars: one for each layer whose colours stand for values, so that they say what the picture shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.mappers.frames.scene import USUAL_DPI
from pvfiblets.plotting.colours.scalar_bar_labels import label_format, label_text
from pvfiblets.web.scene.scalar_bar_layout import MOST_LABELS, Place, Wanted, arrange
from pvfiblets.web.session.document import Layer

if TYPE_CHECKING:
    import pyvista as pv

MOST_BARS = 6


class Bars:
    """The colour bars of a plotter; they are placed anew whenever its window has another size."""

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = plotter
        self._shown: list[tuple[Any, ...]] = []
        self._wanted: list[Wanted] = []
        self._placed_for: tuple[Any, ...] = ()
        self.places: list[Place | None] = []
        self.close = observe(plotter.renderer, ("StartEvent",), weakly(self.arrange))
        """Stop following the window; twice is harmless."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the view that they lie over, pixels."""
        left, bottom, right, top = self._plotter.renderer.GetViewport()
        width, height = self._plotter.window_size
        return round(width * (right - left)), round(height * (top - bottom))

    @property
    def left_out(self) -> list[str]:
        """Titles of the bars that there is no room for."""
        return [one.title for one, place in zip(self._wanted, self.places, strict=True) if place is None]

    def show(self, drawn: Sequence[tuple[Layer, Any]], background: str) -> None:
        """Bring the bars in step with layers and their actors, in the order of the layers."""
        found = bars_of(drawn)
        wanted = [(title, actor, _looks(layer, actor), background) for title, layer, actor in found]
        if wanted != self._shown:
            for title, *_ in self._shown:
                if title in self._plotter.scalar_bars:
                    self._plotter.remove_scalar_bar(title, render=False)
            self._shown = wanted
            for title, _, actor in found:
                self._plotter.add_scalar_bar(
                    title, mapper=actor.mapper, render=False, n_labels=0 if _has_labels(actor) else MOST_LABELS,
                    color=contrast(background), vertical=True, position_x=0.5, position_y=0.1,
                )  # fmt: skip
            self._placed_for = ()
        self._wanted = [_wanted(title, actor) for title, _, actor in found]
        self.arrange()

    def arrange(self) -> None:
        """Place the bars for the present size of the window, if they are not."""
        window = self._plotter.render_window
        if window is None or not self._shown:
            self.places, self._placed_for = [], ()
            return
        if tuple(window.GetTileScale()) != (1, 1):
            return  # a picture in pieces: VTK enlarges positions set before the first
        size, dpi = self.size, window.GetDPI()
        now = (size, dpi, tuple(self._wanted))
        if now == self._placed_for:
            return
        self._placed_for = now
        family = self._plotter.theme.font.family
        self.places = arrange(
            self._wanted, size, dpi / USUAL_DPI, lambda text, font: _width_of(text, font, dpi, family)
        )
        for (title, actor, *_), place in zip(self._shown, self.places, strict=True):
            bar = self._plotter.scalar_bars[title]
            form = None if actor.mapper.lookup_table.GetScale() else label_format(*actor.mapper.scalar_range)
            if form is not None:
                bar.SetLabelFormat(form)
            bar.SetVisibility(place is not None)
            if place is not None:
                _put(bar, title, place, size)


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


def bar_arguments(place: Place, size: tuple[int, int], background: str) -> dict[str, Any]:
    """Return arguments of ``plotter.add_scalar_bar`` for a bar in a place of a picture."""
    return {
        "color": contrast(background),
        "vertical": True,
        **_shares(place, size),
        "n_labels": place.labels,
        "title_font_size": place.font,
        "label_font_size": place.label_font,
    }


def bar_calls(title: str, place: Place) -> dict[str, tuple[Any, ...]]:
    """Return the calls of a bar's methods that ``plotter.add_scalar_bar`` has no argument for: names, and arguments."""
    calls: dict[str, tuple[Any, ...]] = {
        "SetBarRatio": (round(place.ratio, 4),),
        "SetVerticalTitleSeparation": (place.gap,),
    }
    if not place.labels:
        calls["SetTextPositionToPrecedeScalarBar"] = ()
    if place.title != title:
        calls["SetTitle"] = (place.title,)
    return calls


def _put(bar: Any, title: str, place: Place, size: tuple[int, int]) -> None:
    """Make a bar what a script's arguments and calls make it."""
    shares = _shares(place, size)
    bar.SetTitle(title)
    bar.SetPosition(shares["position_x"], shares["position_y"])
    bar.SetWidth(shares["width"])
    bar.SetHeight(shares["height"])
    bar.SetUnconstrainedFontSize(True)
    bar.SetAnnotationTextScaling(False)
    bar.SetDrawTickLabels(place.labels > 0)
    if place.labels:
        bar.SetNumberOfLabels(place.labels)
    bar.GetTitleTextProperty().SetFontSize(place.font)
    for letters in (bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty()):
        letters.SetFontSize(place.label_font)
    for name, arguments in bar_calls(title, place).items():
        getattr(bar, name)(*arguments)
    # VTK centres names from the second picture on only.
    bar.GetAnnotationTextProperty().SetVerticalJustificationToCentered()


def _shares(place: Place, size: tuple[int, int]) -> Mapping[str, float]:
    """Return a place in shares of the picture's width and height."""
    width, height = size
    return {
        "width": round(place.width / width, 5),
        "height": round(place.height / height, 5),
        "position_x": round(place.left / width, 5),
        "position_y": round(place.bottom / height, 5),
    }


def _has_labels(actor: Any) -> bool:
    """Whether an actor's bar names its numbers; the names stand at its right."""
    return bool(getattr(actor, "shows_labels", False))


def contrast(background: str) -> str:
    """Return black or white, whichever stands out."""
    parts = [int(background[k : k + 2], 16) for k in (1, 3, 5)]
    return "black" if sum(parts) > 382 else "white"


def _wanted(title: str, actor: Any) -> Wanted:
    table = actor.mapper.lookup_table
    if _has_labels(actor):
        names = (table.GetAnnotation(k) for k in range(table.GetNumberOfAnnotatedValues()))
        return Wanted(title, tuple(str(name) for name in names), named=True)
    low, high = actor.mapper.scalar_range
    shares = [k / (count - 1) for count in range(2, MOST_LABELS + 1) for k in range(count)]
    values = [low + share * (high - low) for share in shares]
    if table.GetScale() and low > 0.0:  # logarithmic
        values = [low * (high / low) ** share for share in shares]
    form = None if table.GetScale() else label_format(low, high)
    return Wanted(title, tuple(sorted({label_text(value, form) for value in values})))


@lru_cache(4096)
def _width_of(text: str, font: int, dpi: int, family: str) -> float:
    """Return how wide VTK draws a text, in pixels."""
    import vtkmodules.vtkRenderingFreeType
    from pyvista.plotting.tools import parse_font_family
    from vtkmodules.vtkRenderingCore import vtkTextProperty, vtkTextRenderer

    del vtkmodules
    letters = vtkTextProperty()
    letters.SetFontFamily(parse_font_family(family))
    letters.SetFontSize(font)
    box = [0, 0, 0, 0]
    vtkTextRenderer.GetInstance().GetBoundingBox(letters, text, box, dpi)
    return float(box[1] - box[0] + 1)


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
    return (*own, tuple(layer.settings["clim"] or ()), _has_labels(actor))
