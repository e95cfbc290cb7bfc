"""Colours of numbers: PyVista's look-up table and the mapper's colouring, always in step.

One :class:`pyvista.LookupTable` per actor serves both the picture and the scalar bar, so the two
cannot disagree: the mapper is handed this table's own bytes and range.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkStringArray, vtkVariant, vtkVariantArray

from pvfiblets.mappers.colouring import Colouring
from pvfiblets.plotting.actors.source_changes import is_dataset

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.plotting.colours.scalars import Scalars

MOST_COLOURS = 65536  # entries of a look-up table

MOST_WORDS = 64  # names of categories beside a scalar bar: of more, the bar shows the colours alone


def label_colours(count: int) -> list[Any]:
    """Return so many colours that are easily told apart, over again after twenty."""
    import matplotlib as mpl

    chosen: Any = mpl.colormaps["tab10" if count <= 10 else "tab20"]
    colours = chosen.colors
    return [mpl.colors.to_hex(colours[i % len(colours)]) for i in range(count)]


@dataclass
class ColourSettings:
    """A user's settings of an actor's colours; ``None`` means PyVista's theme or the data."""

    color: Any = None  # one colour for all, when no scalars are chosen
    cmap: Any = None  # as for `pyvista.Plotter.add_mesh`
    # values of the first and the last colour; one number `x` means `(-x, x)`. Categories ignore it, and `log_scale`.
    clim: Any = None
    n_colors: int = 256  # entries of the look-up table
    log_scale: bool = False  # spread the colours over the logarithm of the values
    nan_color: Any = None  # for NaN, and for values outside `clim`
    below_color: Any = None
    above_color: Any = None
    flip_scalars: bool = False  # reverse the colour map
    categories: bool = False  # as many colours as there are different values, instead of `n_colors`
    annotations: dict[float, str] | None = None  # what the scalar bar writes beside values


def active_scalars(source: Any, color: Any, rgb: bool | None, *, points: bool = False) -> str | None:
    """Return what colours a data set of VTK's that came without ``scalars``, by the rules of PyVista's `add_mesh`."""
    if (color is not None and not rgb) or not is_dataset(source):
        return None
    mesh = pv.wrap(source)
    found: str | None = mesh.point_data.active_scalars_name if points else mesh.active_scalars_name
    return found


def as_limits(clim: Any) -> tuple[float, float]:
    """Return the two numbers that ``clim`` stands for."""
    if isinstance(clim, (int, float, np.number)):
        return as_limits((-clim, clim))
    pair = isinstance(clim, (Sequence, np.ndarray)) and not isinstance(clim, str) and len(clim) == 2
    if not pair or not all(isinstance(end, (int, float, np.number)) for end in clim):
        raise ValueError(f"clim is {clim!r}; give one number or two, (low, high)")
    low, high = float(clim[0]), float(clim[1])
    if not (np.isfinite(low) and np.isfinite(high) and low <= high):
        raise ValueError(f"clim is ({low:g}, {high:g}); give two finite numbers, the low one first")
    return low, high


def as_count(count: Any) -> int:
    """Return the number of colours that ``n_colors`` stands for."""
    if not isinstance(count, (int, float, np.number)) or not 1 <= count <= MOST_COLOURS or int(count) != count:
        raise ValueError(f"n_colors is {count!r}; give a whole number above zero, up to {MOST_COLOURS}")
    return int(count)


def limits(settings: ColourSettings, scalars: Scalars) -> tuple[float, float]:
    """Return the values of the first and the last colour."""
    if settings.clim is None or scalars.categories is not None:
        # A table of the user's own has a range, which `add_mesh` takes, too.
        own = isinstance(settings.cmap, pv.LookupTable)
        low, high = settings.cmap.scalar_range if own else scalars.colour_range
        return _above_zero(low, high, scalars) if _is_log(settings, scalars) else (float(low), float(high))
    low, high = as_limits(settings.clim)
    if settings.log_scale and low <= 0.0:
        raise ValueError(f"clim begins at {low:g}; a logarithmic scale needs values above zero")
    return low, high


def _is_log(settings: ColourSettings, scalars: Scalars) -> bool:
    return bool(settings.log_scale) and scalars.categories is None


def shared_limits(clim: Any, settings: ColourSettings, scalars: Scalars | None) -> tuple[float, float]:
    """Return the limits to take on from a scalar bar that several actors share: a logarithmic scale begins above 0."""
    low, high = as_limits(clim)
    return _above_zero(low, high, scalars) if settings.log_scale and scalars is not None else (low, high)


def _above_zero(low: float, high: float, scalars: Scalars) -> tuple[float, float]:
    if low <= 0.0:
        low = min(scalars.positive, high) if high > 0.0 else 1e-6
    return float(low), float(max(high, low))


def update_table(
    table: pv.LookupTable,
    settings: ColourSettings,
    scalars: Scalars,
    theme: Any,
    fiblets: FibletSet | None = None,
) -> None:
    """Bring ``table`` in step with the settings; the object stays, so scalar bars follow."""
    # `fiblets` are needed where there are categories, to count them.
    count = as_count(settings.n_colors)
    low, high = limits(settings, scalars)
    labels = scalars.categories is not None
    usual = label_colours(len(scalars.categories)) if scalars.categories else theme.cmap
    if scalars.category_colours is not None:
        usual = [pv.Color(colour).hex_rgb for colour in scalars.category_colours]
    cmap = usual if settings.cmap is None else settings.cmap
    if isinstance(cmap, (list, tuple)) and not cmap:
        raise ValueError("cmap is an empty list; give at least one colour, or the name of a colour map")
    own = isinstance(cmap, pv.LookupTable)
    if own:
        table.DeepCopy(cmap)
    else:
        if (settings.categories or labels) and fiblets is not None:
            count = scalars.distinct(fiblets)
        table._opacity_parm = (None, False, "quadratic")  # noqa: SLF001 - PyVista would apply the opacity of before
        table.apply_cmap(cmap, count, flip=settings.flip_scalars)
    # The order matters: VTK refuses a logarithmic scale while the range touches zero.
    table.log_scale = False
    table.scalar_range = (low, high)
    table.log_scale = _is_log(settings, scalars)
    few = len(scalars.categories or ()) <= MOST_WORDS
    words = _first(settings.annotations, scalars.categories if few else None)
    if words is not None or not own:
        _annotate(table, words or {})
    table.nan_color = _first(settings.nan_color, cmap.nan_color if own else None, theme.nan_color)
    table.below_range_color = _first(settings.below_color, cmap.below_range_color if own else None)
    table.above_range_color = _first(settings.above_color, cmap.above_range_color if own else None)


def _annotate(table: pv.LookupTable, words: Mapping[float, str]) -> None:
    """Set all words at once: VTK orders them anew for each that is set alone, 5,000 of them for two minutes."""
    values, texts = vtkVariantArray(), vtkStringArray()
    for value, text in words.items():
        values.InsertNextValue(vtkVariant(float(value)))
        texts.InsertNextValue(str(text))
    values.Squeeze()  # PyVista reads as many as there is room for
    table.SetAnnotations(values, texts)


def _first(*found: Any) -> Any:
    """Return the first that is not ``None``."""
    return next((one for one in found if one is not None), None)


def make_colouring(
    settings: ColourSettings, scalars: Scalars | None, table: pv.LookupTable, default_color: Any
) -> Colouring:
    """Return what the mapper needs to colour the same way as ``table`` does."""
    if scalars is None:
        color = default_color if settings.color is None else settings.color
        return Colouring(mode="solid", color=None if color is None else pv.Color(color).float_rgb)
    if scalars.kind == "point_rgba":
        return Colouring(mode="point_rgba", source=scalars.name, has_alpha=scalars.has_alpha)
    if scalars.kind == "point_packed":
        return Colouring(mode="point_packed", source=scalars.name, has_alpha=scalars.has_alpha)
    if not scalars.mapped:
        return Colouring(mode=scalars.kind, values=scalars.values)
    return Colouring(
        mode=scalars.kind,
        values=scalars.values,
        source=_source(scalars),
        lut=np.asarray(table.values, dtype=np.uint8),
        clim=tuple(table.scalar_range),
        log_scale=_is_log(settings, scalars),
        nan_color=pv.Color(table.nan_color).float_rgba,
        below_color=_rgba(table.below_range_color),
        above_color=_rgba(table.above_range_color),
    )


def _source(scalars: Scalars) -> Any:
    """Return what the engine takes a value at every point from, if it does."""
    if scalars.values is not None or scalars.kind == "pixel_count":
        return None
    return scalars.name if scalars.volume is None else scalars.volume


def _rgba(color: Any) -> tuple[float, ...] | None:
    """Return a colour's four parts from 0 to 1, or ``None`` for no colour."""
    return None if color is None else pv.Color(color).float_rgba
