"""What can be set of fiblets: properties of the actor, arguments of ``add_fiblets``, rows of the page."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from pvfiblets.plotting import shared_settings as shared
from pvfiblets.plotting.fiblets.looks import check_look
from pvfiblets.plotting.setting_places import COLOURS, LATER, MAPPER, OPTIONS, OWN, Effect, Switch
from pvfiblets.plotting.settings import Row, Setting, Settings, number, truth

STYLES = ("surface", "halo", "ink", "density")
"""What :attr:`FibletSettings.style` may be."""

TONES = ("log", "sqrt", "linear")
"""What :attr:`FibletSettings.density_tone` may be."""

ALL = "all"
"""Of :attr:`FibletSettings.transparency`."""


def _radii(data: Any) -> tuple[float, float]:
    size = shared.bounds_size(data)
    return 1e-5 * size, 0.1 * size


def _clim_span(actor: Any) -> tuple[float, float]:
    scalars = actor.active_scalars
    return scalars.range if scalars is not None and scalars.mapped else actor.clim


THINNEST, WIDEST = 1e-3, 64.0
"""Pixels of lines; a property of VTK's may ask for less and for more."""


def _line_width(name: str, width: Any) -> float:
    pixels = number(name, width, None, WIDEST, "pixels above 0 and")
    if pixels <= 0.0:
        raise ValueError(f"{name} is {width!r}; give pixels above 0 and up to {WIDEST:g}")
    return pixels


def _tube_radius(name: str, radius: Any) -> float | None:
    return None if radius is None else number(name, radius, None, None, "a number of millimetres above 0")


class FibletSettings(Settings):
    """Settings of :class:`~pvfiblets.plotting.fiblets.actor.FibletActor`, in the order of the page."""

    look: Setting[str | None] = Setting(
        None,
        "Name of settings that give a finished picture together; ``None`` where they are no look.\n\n"
        "``'plain'``: thin lines in gentle light. ``'illuminated'``: lines that shine and lie in each\n"
        "other's shade. ``'tubes'``: round tubes. ``'glass'``: lines through which one sees all others.\n"
        "``'density'``: light that adds up where lines lie on each other. ``'ink'``: a drawing in black or\n"
        "white, whose gaps show what lies behind. ``'studio'``: thick tubes in soft shade, which fade with\n"
        "the distance.\n\n"
        "Setting it sets line width, style, tubes, opacity, light and shading, no colours; widths follow\n"
        "the distance between lines. Change any of these afterwards.",
        argument='Settings that give a finished picture together: ``"plain"``, ``"illuminated"``, ``"tubes"``, '
        '``"glass"``, ``"density"``, ``"ink"`` or ``"studio"``. Other arguments go before it.',
        kind="str | None",
        header='{"plain", "illuminated", "tubes", "glass", "density", "ink", "studio"}, optional',
        where=LATER,
        check=check_look,
    )
    color = shared.color("One colour for all. ``scalars`` go before it.")
    rgb: Setting[bool | None] = Setting(
        None,
        "Whether scalars of 3 or 4 columns are colours.\n\n"
        "``True``: they are, uint8 from 0 to 255 or floats from 0 to 1. ``False``: their magnitude is mapped.\n"
        "``None``: colours where they can be such. Those of other widths are mapped by magnitude.",
        argument="Whether scalars of 3 or 4 columns are colours (True) or vectors, whose magnitude is mapped (False); "
        "by default colours where they are uint8, or floats from 0 to 1.",
        kind="bool | None",
        where=OWN,
    )
    cmap = shared.CMAP
    clim = shared.CLIM.but(row=replace(shared.CLIM_ROW, span=_clim_span))
    n_colors = shared.N_COLORS
    log_scale = shared.LOG_SCALE
    nan_color = shared.NAN_COLOR
    below_color = shared.BELOW_COLOR
    above_color = shared.ABOVE_COLOR
    annotations = shared.ANNOTATIONS
    flip_scalars = shared.FLIP_SCALARS
    categories: Setting[bool] = Setting(
        False,
        "Whether there are as many colours as different values, instead of ``n_colors``.",
        kind="bool",
        where=COLOURS,
        check=truth,
    )
    opacity: Setting[float] = Setting(
        None,
        "From 0, not to be seen, to 1. Anything else that is set is taken by ``opacity_by``.",
        argument="Of all streamlines, from 0, not to be seen, to 1; the theme's by default. Or what "
        '``actor.opacity_by`` takes: ``"linear"``, ``"sigmoid"`` and the like, opacities along the colour map; '
        "numbers from 0 to 1, or the name of an array with them, one per streamline or per point.",
        kind=shared.OPACITIES,
        header="float, str or array_like, optional",
        where=OWN,
        check=shared.number_or_more,
        row=Row("Opacity", "From 0, not to be seen, to 1.", type="number", default=1.0, limits=(0.0, 1.0)),
    )
    opacity_by: Setting[Any] = Setting(
        None,
        "Opacities beside ``opacity``, which they are times.\n\n"
        "``None`` for none; as in :meth:`pyvista.Plotter.add_mesh` the name of a transfer function\n"
        "(``'linear'``, ``'geom'``, ``'sigmoid'``, with ``_r`` reversed) along the colour map, from its first\n"
        "colour to the last, or numbers from 0 to 1 for that; or numbers from 0 to 1, one per streamline\n"
        "or one per point, or the name of an array of such. Opacities of points and another number that\n"
        "colours points do not go together.",
        argument=False,
        where=LATER,
        row=Row("Fades by", "Opacity along the colour map.", type="choice", optional=True,
                choices=[(None, "nothing"), ("linear", "value"), ("linear_r", "value, reversed"),
                         ("geom", "value, steep"), ("sigmoid", "value, a step")],
                matters=shared.by_numbers),
    )  # fmt: skip
    transparency: Setting[str | int | None] = Setting(
        ALL,
        "What an ``opacity`` below 1 shows behind the nearest line.\n\n"
        "``\"all\"``: all lines, in no order that one could see: the nearest as it is, the others in\n"
        "four slices by how far behind it they are, mixed within a slice. Costs one drawing of all\n"
        "streamlines in view, and 64 bytes of GPU memory a pixel. ``\"layers\"``: the four nearest, each\n"
        "with its own colour, light and depth, blended in order. A number from 2 to 64: as many. What\n"
        "lies behind the last does not show; a layer costs a drawing, and 44 bytes a pixel. ``None``:\n"
        "the nearest alone, through which one sees the rest of the scene. Opaque actors pay for none.",
        kind="str | int | None",
        header='{"all", "layers", None} or int, default: "all"',
        where=LATER,
        row=Row("Seen through", "What shows behind the nearest line, with opacity below 1.", type="choice",
                choices=[("all", "all lines"), ("layers", "the next lines"), (None, "what is behind all lines")],
                matters=lambda s: s["opacity"] < 1.0),
    )  # fmt: skip
    line_width: Setting[float] = Setting(
        None,
        "Width in pixels.",
        kind="float | None",
        where=OWN,
        check=_line_width,
        row=Row("Line width", "Pixels.", "Lines", "number", 1.0, limits=(0.25, 64.0),
                matters=lambda s: s["tube_radius"] is None),
    )  # fmt: skip
    style: Setting[str] = Setting(
        STYLES[0],
        "``'surface'``, lines in their colours, ``'halo'``, black lines in white halos, ``'ink'``, black on a\n"
        "light background and white on a dark one, in halos of the background's colour, or ``'density'``, all\n"
        "lines that lie on each other.\n\n"
        "``'halo'`` and ``'ink'`` are drawings in ink (Everts et al. 2009), ``'halo'`` best on white:\n"
        "all lines are of one colour and without light, and have default halos. Colours and\n"
        "``lighting`` stay as they are and come back with ``'surface'``, which takes halos away.\n\n"
        "``'density'`` adds up light: a pixel has the mean colour of all streamlines in it, the\n"
        "brighter the more there are (``density_tone``), over what is behind them. The second number of\n"
        "``clim`` is how many have full brightness; without, as many as the fullest pixel of the\n"
        "picture holds. Lines are a pixel wide, without light. With ``scalars=\"density\"`` a colour map and a\n"
        "scalar bar tell streamlines per pixel.",
        argument="``\"density\"`` adds up light where streamlines lie on each other, ``\"halo\"`` draws black lines in "
        "white halos, ``\"ink\"`` such as suit the background.",
        choices=STYLES,
        where=LATER,
        row=Row("Style", "Ink: lines in one colour, in halos that show depth.", "Lines",
                choices=[("surface", "coloured lines"), ("halo", "ink and halos"), ("ink", "ink on any ground"),
                         ("density", "density")]),
    )  # fmt: skip
    density_tone: Setting[str] = Setting(
        TONES[0],
        "How brightness grows with the number n of streamlines in a pixel, in ``style='density'``.\n\n"
        "Where m have full brightness: ``'log'``, log(1 + n) / log(1 + m); ``'sqrt'``, the root of n / m;\n"
        "``'linear'``, n / m. Colours of ``scalars=\"density\"`` spread by ``log_scale`` instead.",
        argument=False,
        choices=TONES,
        where=LATER,
        row=Row("Tone", "How brightness grows with the number of lines in a pixel.", "Lines",
                choices=[("log", "logarithm"), ("sqrt", "square root"), ("linear", "proportional")],
                matters=lambda s: s["style"] == "density" and s["scalars"] != "density"),
    )  # fmt: skip
    tube_radius: Setting[float | None] = Setting(
        None,
        "Radius (mm) of tubes in place of lines of ``line_width`` pixels; ``None``, the default, for lines.\n\n"
        "Tubes are exact bodies: each pixel shows the point of the surface that it sees, they cut into\n"
        "each other and into meshes, and ends are round. Those thinner than a pixel are a pixel wide.",
        argument=False,
        where=LATER,
        check=_tube_radius,
        row=Row("Tube radius", "mm; empty: lines.", "Lines", "number", optional=True, limits=_radii),
    )
    tube_shading: Setting[bool] = Setting(
        False,
        "Whether light falls on lines wider than a pixel as on round tubes.\n\n"
        "Only the light changes: their depth stays that of flat lines. ``illuminated`` goes before it.\n"
        "Nothing to be seen without ``lighting``. The same as ``prop.render_lines_as_tubes``, which\n"
        "the theme may set.",
        argument=False,
        where=LATER,
        check=truth,
        row=Row("Round lines", "Light lines wider than a pixel as round tubes.", "Lines",
                matters=lambda s: s["line_width"] > 1.0 and s["tube_radius"] is None),
    )  # fmt: skip
    lighting = shared.lighting(
        "Shade the lines by the scene's lights; the theme's by default. Light leaves at least 0.6 of every colour, "
        "and all of those that numbers stand for: they match their scalar bar.",
        None,
    )
    illuminated: Setting[bool] = Setting(
        False,
        "Whether each light is reflected as by a thin cylinder, whichever side it comes from.\n\n"
        "Light and shade are as strong as these lights make them (Zöckler et al. 1996; Mallo et al.\n"
        "2005). Off, they are gentle, and leave colours that numbers stand for as they are. Nothing\n"
        "to be seen without ``lighting``.",
        argument=False,
        where=Switch("pvfiblets.mappers.shading:Illuminated"),
        row=Row("Cylinders", "Reflect lights as thin cylinders do, from whichever side.", "Shading",
                matters=lambda s: s["lighting"]),
    )  # fmt: skip
    ambient_occlusion = shared.AMBIENT_OCCLUSION
    depth_cue = shared.DEPTH_CUE
    halos: Setting[dict[str, Any] | bool] = Setting(
        False,
        "Gaps that lines cut into what is behind them, the wider the farther it is behind.\n\n"
        "Depth-dependent halos of Everts et al. 2009.\n\n"
        "``width`` (mm): from a line's edge to its halo's, at most 24 pixels; ``None``, the default,\n"
        "is half the distance between lines, but from 1.25 to 5 pixels. ``depth`` (mm): by how much\n"
        "the halo's edge lies behind its line; lines side by side whose depths differ by less do not\n"
        "cut each other. ``None``, the default, is 8 times the width. ``color`` (``'white'``):\n"
        "``'background'`` for the renderer's.",
        argument=False,
        where=Effect("pvfiblets.mappers.shading:Halos"),
        row=Row("Halos", "Gaps around lines, the wider the farther behind things are.", "Shading",
                matters=lambda s: s["style"] == STYLES[0]),
    )  # fmt: skip
    detail: Setting[float] = Setting(
        0.0,
        "Pixels by which drawn lines may be off, so that less is drawn of what is far away.\n\n"
        "0, the default, draws every point: what is shown is exact. 0.5 draws fiblets whose points all\n"
        "lie within half a pixel of a straight line as one segment; seen from far, a frame then takes 5\n"
        "to 30 % less time, and a pixel in fifty shows another streamline.",
        argument=False,
        where=MAPPER,
        check=lambda name, value: number(name, value, 0.0, 64.0),
        row=Row("Detail", "Pixels by which lines may be off where that saves time; 0: exact.", "Drawing", "number",
                limits=(0.0, 4.0)),
    )  # fmt: skip
    pipeline: Setting[str] = Setting(
        "auto",
        'How fiblets become pixels; ``"auto"`` takes the fastest that the plotter\'s OpenGL has, and '
        "``plotter.fiblets.pipelines()`` lists all.",
        kind="str",
        where=OPTIONS,
    )
    culling: Setting[str | None] = Setting(
        "auto",
        'How fiblets behind others are found out. ``"two-phase"`` changes no pixel; ``"auto"`` is that where '
        'frames are measured to take less time by it, and none elsewhere; ``"coverage"`` may lose '
        "some for a frame after the camera jumped; ``None`` draws all that the camera may see.",
        kind="str | None",
        choices=("auto", "two-phase", "coverage", None),
        where=OPTIONS,
        row=Row("Culling", "How hidden lines are left out; the picture is the same but for coverage, the paper's.",
                "Drawing", choices=[("auto", "auto"), ("two-phase", "two-phase"), ("coverage", "coverage"),
                                    (None, "none")]),
    )  # fmt: skip
    fit: Setting[str | None] = Setting(
        None,
        "Where the fiblets need more GPU memory than there is: ``None`` refuses, ``\"sample\"`` draws a share "
        "of the streamlines, ``\"stream\"`` all of them, part by part: while the camera moves a share, and what is "
        "there.",
        kind="str | None",
        choices=(None, "sample", "stream"),
        where=OPTIONS,
        row=Row("Too large", "What to do where GPU memory does not suffice for all.", "Drawing",
                choices=[(None, "say so"), ("sample", "draw a share"), ("stream", "draw part by part")]),
    )  # fmt: skip
    cluster: Setting[Any] = Setting(
        None,
        "A ``distributed.Client``, or the address of a scheduler, whose workers draw the fiblets, each a part of them, "
        "by their own graphics cards; ``None`` draws here. A set that is mapped from a ``.fiblets`` file is read by "
        "each worker under that name.",
        kind="Any",
        where=OPTIONS,
    )
