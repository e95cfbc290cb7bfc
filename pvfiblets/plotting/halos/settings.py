"""What can be set of lines and points with halos: properties of actors, arguments of ``add_halo_...``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pvfiblets.plotting import shared_settings as shared
from pvfiblets.plotting.setting_places import OPTIONS, OWN, Place
from pvfiblets.plotting.settings import Argument, Setting, Settings, truth

if TYPE_CHECKING:
    from pvfiblets.plotting.halos.style import Threshold

WIDTH_CUE = 0.5
"""Share by which the farthest lines are thinner, by default."""


class _Looks(Place):
    """A field of the actor's `LookSettings`, which check it; read as it is drawn."""

    def read(self, actor: Any, setting: Setting[Any]) -> Any:
        return getattr(actor.look, setting.field)

    def write(self, actor: Any, setting: Setting[Any], value: Any) -> None:
        actor._change(**{setting.field: value})  # noqa: SLF001 - of the class that it is part of

    def kept(self, actor: Any, one: Argument) -> Any:
        return getattr(actor._looks, one.field)  # noqa: SLF001


class _Tapering(Place):
    """One of the two numbers of ``tapering``."""

    def __init__(self, index: int) -> None:
        self._index = index

    def read(self, actor: Any, setting: Setting[Any]) -> Any:  # noqa: ARG002 - as of all places
        return actor.tapering[self._index]

    def write(self, actor: Any, setting: Setting[Any], value: Any) -> None:  # noqa: ARG002 - as of all places
        both = list(actor.tapering)
        both[self._index] = value
        actor.tapering = tuple(both)


LOOKS = _Looks()


class HaloSettings(Settings):
    """Settings of lines and points alike."""

    max_displacement: Setting[float] = Setting(
        None,
        "By how many mm the edge of a halo lies behind its line or point; ``None`` sets what suits the data.\n\n"
        "Lines that cross with less between them have narrower halos, those side by side none.",
        kind="float | None",
        where=LOOKS,
    )
    displacement: Setting[Any] = Setting(
        "linear",
        "How far back a halo lies between its line and its edge, as shares of ``max_displacement``.\n\n"
        '``"linear"``, ``"square"``, ``"square root"``; 2 to 64 numbers in 0..1 at equally spaced places\n'
        "from the axis to the edge; or a function of an array of places in 0..1.",
        kind="Displacement",
        header='{"linear", "square", "square root"}, table or function, default: "linear"',
        where=LOOKS,
        read=lambda actor: actor._looks.displacement,  # noqa: SLF001
    )
    width_cue: Setting[float] = Setting(
        WIDTH_CUE,
        "By which share the farthest in the data are thinner than the nearest, 0 to 1; halos keep their width.",
        kind="float",
        where=LOOKS,
    )
    threshold: Setting[Threshold] = Setting(
        None,
        "The least number of ``filter_by`` that shows, or the least and the greatest, ``None`` for no end.\n\n"
        "Changing it costs a redraw, and nothing is copied to the GPU.",
        kind="Threshold",
        header="float or (float, float), optional",
        where=LOOKS,
        read=lambda actor: actor._looks.threshold,  # noqa: SLF001
    )
    color: Setting[Any] = Setting(
        None,
        "One colour for all; black, or white with ``light_on_dark``, where none was given.\n\n"
        "Setting it puts scalars out of use; ``None`` sets that default.",
        argument="One colour for all, black by default. ``scalars`` go before it.",
        kind=shared.COLOR_LIKE,
        header="color-like, optional",
        where=OWN,
    )
    halo_color: Setting[Any] = Setting(
        None,
        "Colour of the halos: white, or black with ``light_on_dark``, where none was given.\n\n"
        '``"background"``: that of the renderer, be it a gradient from below to above. ``None`` sets\n'
        "the default.",
        kind=shared.COLOR_LIKE,
        header='color-like or "background", optional',
        where=OWN,
    )
    light_on_dark: Setting[bool] = Setting(
        False,
        "White in black halos instead of black in white ones; colours that were given stay.\n\n"
        'The background is the plotter\'s: ``plotter.set_background("black")``.',
        kind="bool",
        where=OWN,
        check=truth,
    )
    cmap = shared.CMAP
    clim = shared.CLIM
    n_colors = shared.N_COLORS
    log_scale = shared.LOG_SCALE
    nan_color = shared.NAN_COLOR
    below_color = shared.BELOW_COLOR
    above_color = shared.ABOVE_COLOR
    annotations = shared.ANNOTATIONS
    flip_scalars = shared.FLIP_SCALARS
    opacity = shared.opacity("Of all and its halos; what lies behind the nearest does not show through.")
    opacity_by = shared.opacity_by()
    lighting = shared.lighting("Shade by the scene's lights.", False)
    smooth: Setting[bool] = Setting(
        True,
        "Whether lines and points turn into their halos gradually, over a pixel.",
        kind="bool",
        where=LOOKS,
    )
    min_width: Setting[float] = Setting(
        1.0,
        "Pixels of the window that a line or point takes at least; 0 leaves it as it is.",
        kind="float",
        where=LOOKS,
    )
    culling: Setting[str | None] = Setting(
        "two-phase",
        "How those behind others are found out, where there are many; the picture is the same.",
        kind="str | None",
        choices=("two-phase", None),
        where=OPTIONS,
    )


class HaloLineSettings(HaloSettings):
    """Settings of :class:`~pvfiblets.plotting.halos.actors.HaloLineActor`."""

    line_width: Setting[float] = Setting(
        None,
        "Width (mm) of the lines; ``None`` sets what suits the data.",
        kind="float | None",
        where=LOOKS,
    )
    strip_width: Setting[float] = Setting(
        None,
        "Width (mm) of a line with the halos on both its sides; ``None`` sets what suits ``line_width``.",
        kind="float | None",
        where=LOOKS,
    )
    tapering: Setting[Any] = Setting(
        True,
        "How ends of lines narrow: over so many vertices, which go so far along the mask, up to 0.5.\n\n"
        "The mask is as wide as the strip from 0.2 on. ``True`` sets the paper's (2, 0.2), ``False``\n"
        "(0, 0.2): square ends.",
        kind="bool | tuple[int, float]",
        header="bool or (int, float), default: True",
        where=LOOKS,
        read=lambda actor: (actor.look.n_tapered, actor.look.t_tapered),
    )
    n_tapered: Setting[int] = Setting(
        2, "Vertices over which ends of lines narrow; 0 leaves them square.", argument=False, where=_Tapering(0)
    )
    t_tapered: Setting[float] = Setting(
        0.2, "How far along the mask those vertices go.", argument=False, where=_Tapering(1)
    )
    filter_taper: Setting[float] = Setting(
        None,
        "Length (mm) over which lines narrow where the filter ends them; ``None`` sets two mean segments.",
        kind="float | None",
        where=LOOKS,
    )


class HaloPointSettings(HaloSettings):
    """Settings of :class:`~pvfiblets.plotting.halos.actors.HaloPointActor`."""

    point_size: Setting[float] = Setting(
        None,
        "Diameter of the points, mm; ``None`` sets what suits the data.",
        kind="float | None",
        where=LOOKS,
        field="line_width",
    )
    halo_size: Setting[float] = Setting(
        None,
        "Diameter of a point with its halo, mm; ``None`` sets what suits ``point_size``.",
        kind="float | None",
        where=LOOKS,
        field="strip_width",
    )
