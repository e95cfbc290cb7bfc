"""Settings of lines and points with halos: properties of actors, arguments of ``add_halo_...``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from pvfiblets.plotting.settings import shared
from pvfiblets.plotting.settings.places import OPTIONS, OWN, Place, Stored
from pvfiblets.plotting.settings.settings import Setting, Settings, truth

if TYPE_CHECKING:
    from collections.abc import Sequence

    Threshold: TypeAlias = float | Sequence[float | None] | None

WIDTH_CUE = 0.5  # default reduction of the width of the farthest lines


class _Looks(Place):
    """A field of the actor's `LookSettings`, which check it; reading returns the value in use."""

    def read(self, actor: Any, setting: Stored) -> Any:
        return getattr(actor.look, setting.field)

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        actor._change(**{setting.field: value})  # noqa: SLF001 - of the class that it is part of

    def value_for_copy(self, actor: Any, one: Stored) -> Any:
        return getattr(actor._looks, one.field)  # noqa: SLF001


class _Tapering(Place):
    """One of the two numbers of ``tapering``."""

    def __init__(self, index: int) -> None:
        self._index = index

    def read(self, actor: Any, setting: Stored) -> Any:  # noqa: ARG002 - as of all places
        return actor.tapering[self._index]

    def write(self, actor: Any, setting: Stored, value: Any) -> None:  # noqa: ARG002 - as of all places
        both = list(actor.tapering)
        both[self._index] = value
        actor.tapering = tuple(both)


LOOKS = _Looks()


class HaloSettings(Settings):
    """Settings of lines and points alike."""

    max_displacement: Setting[float] = Setting(
        None,
        "Depth (mm) of a halo's edge behind its line or point; ``None`` fits the data.\n\n"
        "Lines that cross at a smaller distance have narrower halos; lines side by side have none.",
        kind="float | None",
        where=LOOKS,
    )
    displacement: Setting[Any] = Setting(
        "linear",
        "Depth profile of a halo from its line to its edge, as shares of ``max_displacement``.\n\n"
        '``"linear"``, ``"square"``, ``"square root"``; 2 to 64 numbers in 0..1 at equally spaced places\n'
        "from the axis to the edge; or a function of an array of places in 0..1.",
        kind="Displacement",
        header='{"linear", "square", "square root"}, table or function, default: "linear"',
        where=LOOKS,
        read=lambda actor: actor._looks.displacement,  # noqa: SLF001
    )
    width_cue: Setting[float] = Setting(
        WIDTH_CUE,
        "Reduction of the width from the nearest to the farthest data, 0 to 1; halos keep their width.",
        kind="float",
        where=LOOKS,
    )
    threshold: Setting[Threshold] = Setting(
        None,
        "Least visible value of ``filter_by``, or least and greatest; ``None`` for no limit.\n\n"
        "A change costs a redraw and copies nothing to the GPU.",
        kind="Threshold",
        header="float or (float, float), optional",
        where=LOOKS,
        read=lambda actor: actor._looks.threshold,  # noqa: SLF001
    )
    color: Setting[Any] = Setting(
        None,
        "One colour for all; by default black on a light background and white on a dark one.\n\n"
        "Setting it turns scalars off. ``None`` sets the default, see ``light_on_dark``.",
        argument="One colour for all; by default black on a light background and white on a dark one. ``scalars`` "
        "override it.",
        kind=shared.COLOR_LIKE,
        header="color-like, optional",
        where=OWN,
    )
    halo_color: Setting[Any] = Setting(
        None,
        "Colour of the halos; by default the background's.\n\n"
        '``"background"``: the renderer\'s background, also if it is a gradient. ``None`` sets the\n'
        "default, see ``light_on_dark``.",
        kind=shared.COLOR_LIKE,
        header='color-like or "background", optional',
        where=OWN,
    )
    light_on_dark: Setting[bool | None] = Setting(
        None,
        "``True``: white with black halos. ``False``: black with white halos. Explicit colours stay.\n\n"
        "``None`` follows the background: black on a light one and white on a dark one, with halos of\n"
        "its colour.",
        kind="bool | None",
        where=OWN,
        check=lambda name, value: None if value is None else truth(name, value),
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
    opacity = shared.opacity("Of lines and halos together; only the nearest surface is visible.")
    opacity_by = shared.opacity_by()
    lighting = shared.lighting("Shade by the scene's lights.", False)
    smooth: Setting[bool] = Setting(
        True,
        "Whether the edge of a line or point blends into its halo over one pixel.",
        kind="bool",
        where=LOOKS,
    )
    min_width: Setting[float] = Setting(
        1.0,
        "Least width of a line or point in pixels of the window; 0 for no minimum.",
        kind="float",
        where=LOOKS,
    )
    culling: Setting[str | None] = Setting(
        "two-phase",
        "Occlusion culling of large sets; the image is the same.",
        kind="str | None",
        choices=("two-phase", None),
        where=OPTIONS,
    )


class HaloLineSettings(HaloSettings):
    """Settings of :class:`~pvfiblets.plotting.halos.actors.HaloLineActor`."""

    line_width: Setting[float] = Setting(
        None,
        "Width (mm) of the lines; ``None`` fits the data.",
        kind="float | None",
        where=LOOKS,
    )
    strip_width: Setting[float] = Setting(
        None,
        "Width (mm) of a line with the halos on both its sides; ``None`` fits ``line_width``.",
        kind="float | None",
        where=LOOKS,
    )
    tapering: Setting[Any] = Setting(
        True,
        "Tapering of ends: number of vertices, and their share of the mask, up to 0.5.\n\n"
        "The mask is as wide as the strip from 0.2 on. ``True`` sets the paper's (2, 0.2), ``False``\n"
        "(0, 0.2): square ends.",
        kind="bool | tuple[int, float]",
        header="bool or (int, float), default: True",
        where=LOOKS,
        read=lambda actor: (actor.look.n_tapered, actor.look.t_tapered),
    )
    n_tapered: Setting[int] = Setting(
        2, "Number of vertices of a tapered end; 0 for square ends.", argument=False, where=_Tapering(0)
    )
    t_tapered: Setting[float] = Setting(
        0.2, "Share of the mask at a tapered end.", argument=False, where=_Tapering(1)
    )
    filter_taper: Setting[float] = Setting(
        None,
        "Length (mm) of tapered ends at a filter's cut; ``None`` sets two mean segments.",
        kind="float | None",
        where=LOOKS,
    )


class HaloPointSettings(HaloSettings):
    """Settings of :class:`~pvfiblets.plotting.halos.actors.HaloPointActor`."""

    point_size: Setting[float] = Setting(
        None,
        "Diameter of the points, mm; ``None`` fits the data.",
        kind="float | None",
        where=LOOKS,
        field="line_width",
    )
    halo_size: Setting[float] = Setting(
        None,
        "Diameter of a point with its halo, mm; ``None`` fits ``point_size``.",
        kind="float | None",
        where=LOOKS,
        field="strip_width",
    )
