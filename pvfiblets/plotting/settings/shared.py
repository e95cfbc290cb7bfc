"""Settings that several drawables share; each drawable's settings class lists its own."""

from __future__ import annotations

from difflib import get_close_matches
from numbers import Real
from typing import Any

from pvfiblets.plotting.colours.colours import as_count, as_limits
from pvfiblets.plotting.settings.places import COLOURS, LATER, OWN, PROPERTY, Effect
from pvfiblets.plotting.settings.settings import Argument, Row, Setting, Settings, number, truth

CMAPS = (
    "viridis", "plasma", "inferno", "magma", "cividis", "turbo", "gray", "bone", "hot", "afmhot", "copper", "pink",
    "coolwarm", "RdBu", "RdYlBu", "Spectral", "PuOr", "bwr", "seismic", "twilight", "hsv", "rainbow", "jet", "Blues",
    "Greens", "Reds", "YlOrRd", "YlGnBu", "tab10", "tab20", "Set1", "Set2", "Paired",
)  # fmt: skip
"""Colour maps that a page offers; each also reversed, with ``_r``."""

MAP_NAMES = (*CMAPS, *(f"{name}_r" for name in CMAPS))
COLOR_LIKE = "ColorLike | None"
COLORMAP = "ColormapOptions | pv.LookupTable | None"
LIMITS = "float | Sequence[float] | None"
OPACITIES = "float | str | Sequence[float] | np.ndarray | None"  # types that are PyVista's own, for annotations

MAPS = [(name, name.replace("_", " ")) for name in MAP_NAMES]


def bounds_size(data: Any) -> float:
    """Return the diagonal of some data's bounds, mm; 1 where they have none."""
    b = data.bounds
    found = float(sum((b[k + 1] - b[k]) ** 2 for k in (0, 2, 4)) ** 0.5)
    return found if 0.0 < found < float("inf") else 1.0


def by_numbers(settings: Any) -> bool:
    """Return True if the settings colour by numbers."""
    return settings["scalars"] not in (None, "orientation", "ends", "random")


def colour_map(name: str, value: Any) -> Any:
    """Return a colour map; raise ValueError for an unknown name, even if no numbers colour yet."""
    if isinstance(value, str):
        from pyvista.plotting.colors import get_cmap_safe

        try:
            get_cmap_safe(value)
        except ValueError as error:
            near = ", ".join(repr(one) for one in get_close_matches(value, MAP_NAMES)) or "'viridis' or 'coolwarm'"
            raise ValueError(
                f"{name} is {value!r}, which is no colour map; give a name that matplotlib knows, such as {near}, a "
                "list of colours, or a LookupTable"
            ) from error
    return value


def _limits(_name: str, value: Any) -> Any:
    """Return a range as it is given, whether numbers colour now or later."""
    if value is not None:
        as_limits(value)
    return value


def _colour(name: str, value: Any) -> Any:
    """Return a colour as it is given, if it is one."""
    if value is not None:
        from pyvista import Color

        try:
            Color(value)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{name} is {value!r}; give a name, a hex string, or three or four numbers") from error
    return value


def _annotations(name: str, value: Any) -> Any:
    """Return the labels of a scalar bar by their values."""
    if value is None:
        return None
    good = isinstance(value, dict) and all(isinstance(at, Real) and isinstance(word, str) for at, word in value.items())
    if not good:
        raise ValueError(f"{name} is {value!r}; give a dict from numbers to words, such as {{50.0: 'half'}}")
    return {float(at): word for at, word in value.items()}


def color(doc: str) -> Setting[Any]:
    """Return the setting of a drawable's single colour."""
    return Setting(
        None,
        "One colour for all; setting it switches scalars off.",
        argument=doc,
        kind=COLOR_LIKE,
        header="color-like, optional",
        where=OWN,
        row=Row("Colour", "Colour of the whole layer.", type="colour", default="#ffffff",
                matters=lambda settings: settings["scalars"] is None),
    )  # fmt: skip


CMAP: Setting[Any] = Setting(
    None,
    "Colour map, as for :meth:`pyvista.Plotter.add_mesh`.",
    argument="Colour map; the theme's by default. A :class:`pyvista.LookupTable` brings its range and its colours "
             "of values outside.",
    kind=COLORMAP,
    header="str, list, colormap or LookupTable, optional",
    where=COLOURS,
    check=colour_map,
    read=lambda actor: actor._theme.cmap if actor._settings.cmap is None else actor._settings.cmap,  # noqa: SLF001
    row=Row("Map", "Colours from the low to the high end of the range.", type="choice",
            choices=[(None, "default"), *MAPS], matters=by_numbers),
)  # fmt: skip

CLIM_ROW = Row(
    "Range", "Values of the first and the last colour; empty: the range of the data.", type="range", optional=True,
    read=lambda actor: list(actor.clim), matters=by_numbers, scale=True,
)  # fmt: skip

CLIM: Setting[tuple[float, float]] = Setting(
    None,
    "Values of the first and the last colour; ``None`` sets the range of the data.\n\n"
    "It stays when the scalars change. Categories, such as groups, have no range.",
    argument="Values of the first and the last colour; the range of the data by default.",
    kind=LIMITS,
    header="float or (float, float), optional",
    where=COLOURS,
    check=_limits,
    read=lambda actor: tuple(actor.lookup_table.scalar_range),
    row=CLIM_ROW,
)

N_COLORS: Setting[int] = Setting(
    256, "Entries of the look-up table.", argument="Number of colours in the map.", kind="int", where=COLOURS,
    check=lambda _name, value: as_count(value),
)  # fmt: skip

LOG_SCALE: Setting[bool] = Setting(
    False,
    "Whether the colours spread over the logarithm of the values.",
    argument="Spread the colours over the logarithm of the values. Between points the value is interpolated (VTK "
             "interpolates its logarithm), so colour, scalar bar, pick and filter agree.",
    kind="bool",
    where=COLOURS,
    check=truth,
    row=Row("Logarithmic", "Spread the colours over the logarithm of the values.", matters=by_numbers, scale=True),
)

NAN_COLOR: Setting[Any] = Setting(
    None,
    "Colour of NaN.",
    kind=COLOR_LIKE,
    header="color-like, optional",
    where=COLOURS,
    check=_colour,
    read=lambda actor: actor.lookup_table.nan_color,
    row=Row("Without a value", "Colour of missing values.", type="colour", optional=True,
            read=lambda actor: actor.nan_color.hex_rgb, matters=by_numbers),
)  # fmt: skip

BELOW_COLOR: Setting[Any] = Setting(
    None,
    "Colour of values below ``clim``; ``None`` uses the first of the map.",
    kind=COLOR_LIKE,
    header="color-like, optional",
    where=COLOURS,
    check=_colour,
)

ABOVE_COLOR: Setting[Any] = Setting(
    None,
    "Colour of values above ``clim``; ``None`` uses the last of the map.",
    kind=COLOR_LIKE,
    header="color-like, optional",
    where=COLOURS,
    check=_colour,
)

ANNOTATIONS: Setting[dict[float, str] | None] = Setting(
    None,
    "Texts beside values of the scalar bar; ``None`` uses the names of labels, if any.",
    kind="dict[float, str] | None",
    header="dict of float to str, optional",
    where=COLOURS,
    check=_annotations,
)

FLIP_SCALARS = Argument(False, "Reverse the colour map.", kind="bool", where=COLOURS)


def opacity(of: str) -> Setting[float]:
    """Return the opacity setting of a drawable; ``of`` begins its argument's description."""
    return Setting(
        None,
        "From 0, invisible, to 1. Other values are passed to ``opacity_by``.",
        argument=f"{of} The theme's by default. Or what ``actor.opacity_by`` takes: "
        '``"linear"``, ``"sigmoid"`` and the like, opacities along the colour map; numbers from 0 to 1 for that, or '
        "one per line.",
        kind=OPACITIES,
        header="float, str or array_like, optional",
        where=OWN,
        check=number_or_more,
        row=Row("Opacity", "From 0, invisible, to 1.", type="number", default=1.0, limits=(0.0, 1.0)),
    )


def opacity_by() -> Setting[Any]:
    """Return the setting of tubes' or halos' opacities by numbers."""
    return Setting(
        None,
        "Opacities by numbers, multiplied by ``opacity``.\n\n"
        "``None`` for none; the name of a transfer function (``'linear'``, ``'geom'``, ``'sigmoid'``, with\n"
        "``_r`` reversed) along the colour map, or numbers from 0 to 1 for that, the lowest first; or\n"
        "numbers from 0 to 1, one per line, or the name of an array of them.",
        argument=False,
        where=LATER,
    )


def number_or_more(name: str, value: Any) -> Any:
    """Return a number from 0 to 1 as a float; other values are checked when they are set."""
    if value is None or isinstance(value, (str, list, tuple)) or getattr(value, "ndim", 0) > 0:
        return value
    return number(name, value, 0.0, 1.0)


def lighting(what: str, default: bool | None) -> Setting[bool]:
    """Return a drawable's setting of light."""
    kind = "bool" if default is False else "bool | None"
    return Setting(
        default,
        "Whether the scene's lights shade the drawable.",
        argument=what,
        kind=kind,
        where=PROPERTY,
        check=truth,
        row=Row("Light", "Shade by the scene's lights.", "Shading", "bool", True),
    )


AMBIENT_OCCLUSION: Setting[dict[str, Any] | bool] = Setting(
    False,
    "Darkness where other geometry occludes a line or tube.\n\n"
    "``radius`` (mm): largest distance of occluding geometry. ``None``, the default: 16 times the\n"
    "distance between lines, at least 8 pixels, at most a 20th of the data's diagonal; for tubes a\n"
    "20th of it. ``samples`` (16): pixels read around each pixel. ``strength`` (1.0): 0 to 1.",
    argument=False,
    where=Effect("pvfiblets.mappers.effects.shading:AmbientOcclusion"),
    row=Row("Ambient occlusion", "Darken occluded places.", "Shading"),
)

DEPTH_CUE: Setting[dict[str, Any] | bool] = Setting(
    False,
    "Fading with the distance from the viewer.\n\n"
    "``strength`` (0.7): share of the colour at the far end. ``color``: ``None``, the default, is\n"
    "the background's. ``range``: distances (mm) at which fading begins and ends; ``None``, the\n"
    "default, uses the nearest and the farthest part of the data's bounds.",
    argument=False,
    where=Effect("pvfiblets.mappers.effects.shading:DepthCue"),
    row=Row("Depth cue", "Fade distant parts.", "Shading"),
)


class Common(Settings):
    """Arguments of every ``add_...``: how an actor is added to the plotter."""

    name = Argument(None, "Replaces the actor of the same name.", kind="str | None")
    label = Argument(None, "For :meth:`pyvista.Plotter.add_legend`.", kind="str | None")
    show_scalar_bar = Argument(
        None, "The theme's by default; colours without a colour map never have one.", kind="bool | None"
    )
    scalar_bar_args = Argument(
        None, "For :meth:`pyvista.Plotter.add_scalar_bar`.", kind="dict[str, Any] | None", header="dict, optional"
    )
    pickable = Argument(True, "Whether pickers find the actor.", kind="bool")
    user_matrix = Argument(
        None, "From data to world coordinates.", kind="TransformLike | None", header="transform-like, optional"
    )
    reset_camera = Argument(None, "As for :meth:`pyvista.Plotter.add_mesh`.", kind="bool | None")
    render = Argument(True, "Render at once if the window is open.", kind="bool")
