"""Settings of a layer of slices, each declared once."""

from __future__ import annotations

import math
from numbers import Integral, Real
from typing import Any

from pvfiblets.plotting.settings.places import Place, Stored
from pvfiblets.plotting.settings.settings import Argument, Row, Setting, Settings, truth
from pvfiblets.plotting.settings.shared import LIMITS, MAPS, Common, colour_map


class _Layer(Place):
    """A value of the layer's own; its slices are made anew with the next render."""

    def read(self, actor: Any, setting: Stored) -> Any:
        return actor._state[setting.field]  # noqa: SLF001 - of the class that it is part of

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        actor._write(setting.field, value)  # noqa: SLF001


LAYER = _Layer()


MEANING = "meaning"  # A row of the page that is no setting of layers: what the numbers of the image mean


def _of(*meanings: str) -> Any:
    """Return what says whether an image is of one of some kinds, as the page's other rows are."""
    return lambda settings: settings[MEANING] in meanings


def _reach(layer: Any) -> tuple[float, float]:
    """Return what a slider of the window should offer: nearly all values, and the window as it is."""
    low, high = layer.window
    if layer.kind != "scalars":
        return min(low, 0.0), max(high, 1.0)
    least, most = layer.image.percentiles(0.0, 100.0, layer.index)
    return min(least, low), max(most, high)


def _pair(name: str, value: Any, expected: str) -> tuple[float, float]:
    try:
        low, high = (float(part) for part in value)
    except (TypeError, ValueError):
        low = high = math.nan
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise ValueError(f"{name} is {value!r}; give {expected}")
    return low, high


def _window(name: str, value: Any) -> Any:
    """Return a window: two numbers, one for a window about 0, or None."""
    if value is None:
        return None
    if isinstance(value, Real) and not isinstance(value, bool):
        value = -abs(float(value)), abs(float(value))
    return _pair(name, value, "two finite numbers, the low one first, such as (0, 1)")


def _percentiles(name: str, value: Any) -> tuple[float, float]:
    expected = "two percentages from 0 to 100, the low one first, such as (1, 99)"
    low, high = _pair(name, value, expected)
    if low < 0.0 or high > 100.0:
        raise ValueError(f"{name} is {value!r}; give {expected}")
    return low, high


def _threshold(name: str, value: Any) -> float | None:
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, Real) or math.isnan(float(value)):
        raise ValueError(f"{name} is {value!r}; give a number, or None for no threshold")
    return float(value)


def _index(name: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise ValueError(f"{name} is {value!r}; give a whole number, which counts volumes from 0")
    return int(value)


class SliceSettings(Settings):
    """Settings of a layer of slices."""

    cmap: Setting[Any] = Setting(
        "gray",
        "Colour map, as for :meth:`pyvista.Plotter.add_mesh`.",
        kind="ColormapOptions | pv.LookupTable",
        header='str, list, colormap or LookupTable, default: "gray"',
        where=LAYER,
        check=colour_map,
        row=Row("Map", "Colours from the low to the high end of the window.", type="choice",
                choices=[("gray", "gray"), *(one for one in MAPS if one[0] != "gray")], matters=_of("scalars")),
    )
    clim: Setting[tuple[float, float]] = Setting(
        None,
        "Values of the first and the last colour, the window; ``None`` uses ``percentiles``.",
        argument="Values of the first and the last colour, the window; by default from ``percentiles``. For "
                 "direction-coded images, weights of black and of full colour.",
        kind=LIMITS,
        header="float or (float, float), optional",
        where=LAYER,
        check=_window,
        read=lambda layer: layer.window,
        row=Row("Window", "Values of the first and the last colour; empty: from the percentages.", type="range",
                optional=True, read=lambda layer: list(layer.window), span=_reach,
                matters=_of("scalars", "direction")),
    )
    percentiles: Setting[tuple[float, float]] = Setting(
        (1.0, 99.0),
        "Percentiles of the non-zero voxels at both ends of the window, without ``clim``.",
        kind="tuple[float, float]",
        header="(float, float), default: (1, 99)",
        where=LAYER,
        check=_percentiles,
        row=Row("Per cent", "Percentiles of the non-zero voxels at both ends of the window, if it has no numbers.",
                type="range", default=[1.0, 99.0], limits=(0.0, 100.0), resets=("clim",), matters=_of("scalars")),
    )
    log_scale: Setting[bool] = Setting(
        False, "Whether the colours spread over the logarithm of the values.", kind="bool", where=LAYER, check=truth,
        row=Row("Logarithmic", group="Drawing", matters=_of("scalars")),
    )  # fmt: skip
    below: Setting[float | None] = Setting(
        None, "Values below are hidden; ``None`` for none.", kind="float | None", where=LAYER, check=_threshold,
        row=Row("Hide below", "Values below are hidden; empty: none.", type="number", optional=True,
                matters=_of("scalars", "direction", "rgb")),
    )  # fmt: skip
    above: Setting[float | None] = Setting(
        None, "Values above are hidden; ``None`` for none.", kind="float | None", where=LAYER, check=_threshold,
        row=Row("Hide above", "Values above are hidden; empty: none.", type="number", optional=True,
                matters=_of("scalars", "direction", "rgb")),
    )  # fmt: skip
    outside: Setting[float | None] = Setting(
        None,
        "Values up to this one are transparent in the 3-D view where they reach the border of a slice, as around a "
        "head; ``None`` finds it from the edges of the image, ``-inf`` shows all. Panes show all.",
        kind="float | None",
        header="float, optional",
        where=LAYER,
        check=_threshold,
        read=lambda layer: layer.outside_level,
        row=Row("Clear outside", "Values up to this are transparent around the head in 3-D; empty: found from the "
                "image's edges.", group="Drawing", type="number", optional=True,
                read=lambda layer: layer.outside_level, matters=_of("scalars", "direction", "rgb")),
    )
    opacity: Setting[float] = Setting(
        1.0, "From 0, invisible, to 1.", kind="float", where=LAYER, low=0.0, high=1.0, row=Row("Opacity")
    )
    blend: Setting[str] = Setting(
        "over", "Blending with the layers below: over them, or added to them.", kind="str",
        choices=("over", "add"), where=LAYER, row=Row("Blend", group="Drawing"),
    )  # fmt: skip
    interpolation: Setting[str] = Setting(
        "linear", "Between voxels; labels are never interpolated.", kind="str",
        choices=("nearest", "linear", "cubic"), where=LAYER,
        row=Row("Between voxels", group="Drawing", matters=_of("scalars", "rgb", "direction")),
    )  # fmt: skip
    index: Setting[int] = Setting(
        0, "Number of the volume shown of an image with four axes, from 0; negative: from the end.", kind="int",
        where=LAYER, check=_index,
        row=Row("Volume", "Which volume of an image of several, from 0.", group="Drawing", type="number", whole=True,
                limits=lambda image: (0, image.n_volumes - 1), matters=_of("scalars", "labels")),
    )  # fmt: skip
    outline: Setting[bool] = Setting(
        False, "Whether labels are shown by their outlines alone.", kind="bool", where=LAYER, check=truth,
        row=Row("Outlines", matters=_of("labels")),
    )  # fmt: skip
    visible: Setting[bool] = Setting(True, "Whether the layer is shown.", kind="bool", where=LAYER, check=truth)


class SliceCommon(Settings):
    """Arguments that say how slices come into the plotter."""

    name = Argument(None, "Replaces the slices of the same name.", kind="str | None")
    pickable = Argument(True, "Whether pickers find the slices.", kind="bool")
    show_scalar_bar = Argument(
        False, "Show the colours of the first image's window; those without a colour map have none.", kind="bool"
    )
    scalar_bar_args = Common.DECLARED["scalar_bar_args"]
    user_matrix = Common.DECLARED["user_matrix"]
    reset_camera = Common.DECLARED["reset_camera"]
    render = Common.DECLARED["render"]
