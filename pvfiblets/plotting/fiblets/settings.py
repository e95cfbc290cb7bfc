"""Settings of fiblets: properties of the actor, arguments of ``add_fiblets``, rows of the page."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from pvfiblets.engine.fiblets.style import LARGEST_DISC
from pvfiblets.plotting.fiblets.looks import check_look
from pvfiblets.plotting.settings import shared
from pvfiblets.plotting.settings.places import COLOURS, LATER, MAPPER, OPTIONS, OWN, PROPERTY, Effect, Switch
from pvfiblets.plotting.settings.settings import Row, Setting, Settings, number, truth

STYLES = ("surface", "halo", "ink", "density", "ends")  # values of `FibletSettings.style`

TONES = ("log", "sqrt", "linear")  # values of `FibletSettings.density_tone`

ALL = "all"  # default of `FibletSettings.transparency`


def _radii(data: Any) -> tuple[float, float]:
    size = shared.bounds_size(data)
    return 1e-5 * size, 0.1 * size


def _clim_span(actor: Any) -> tuple[float, float]:
    scalars = actor.active_scalars
    return scalars.range if scalars is not None and scalars.mapped else actor.clim


THINNEST, WIDEST = 1e-3, 64.0  # limits of line widths, pixels; a VTK property may exceed them


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
        "Preset of widths, light and shading; ``None`` if the settings are no preset.\n\n"
        "``'plain'``: thin lines in gentle light. ``'illuminated'``: shining lines that shade each other.\n"
        "``'tubes'``: round tubes. ``'glass'``: translucent lines. ``'density'``: light that adds up where\n"
        "lines overlap. ``'ink'``: a drawing in black or white, with gaps between near and far lines.\n"
        "``'studio'``: thick tubes in soft shade that fade with the distance.\n\n"
        "Setting it sets line width, style, tubes, opacity, light and shading, but no colours; widths\n"
        "follow the distance between lines. Each can be changed afterwards.",
        argument='Preset of widths, light and shading: ``"plain"``, ``"illuminated"``, ``"tubes"``, '
        '``"glass"``, ``"density"``, ``"ink"`` or ``"studio"``. Other arguments override it.',
        kind="str | None",
        header='{"plain", "illuminated", "tubes", "glass", "density", "ink", "studio"}, optional',
        where=LATER,
        check=check_look,
    )
    color = shared.color("One colour for all. ``scalars`` go before it.")
    rgb: Setting[bool | None] = Setting(
        None,
        "Whether scalars of 3 or 4 columns are colours.\n\n"
        "``True``: colours, uint8 from 0 to 255 or floats from 0 to 1. ``False``: their magnitude is mapped.\n"
        "``None``: colours if the values allow it. Other numbers of columns are mapped by magnitude.",
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
        "Whether each different value has its own colour, instead of ``n_colors`` colours.",
        kind="bool",
        where=COLOURS,
        check=truth,
    )
    opacity: Setting[float] = Setting(
        None,
        "From 0, invisible, to 1. Other values are passed to ``opacity_by``.",
        argument="Of all streamlines, from 0, invisible, to 1; the theme's by default. Or a value of "
        '``actor.opacity_by`` takes: ``"linear"``, ``"sigmoid"`` and the like, opacities along the colour map; '
        "numbers from 0 to 1, or the name of an array with them, one per streamline or per point.",
        kind=shared.OPACITIES,
        header="float, str or array_like, optional",
        where=OWN,
        check=shared.number_or_more,
        row=Row("Opacity", "From 0, invisible, to 1.", type="number", default=1.0, limits=(0.0, 1.0)),
    )
    opacity_by: Setting[Any] = Setting(
        None,
        "Opacities by numbers, multiplied by ``opacity``.\n\n"
        "``None`` for none; as in :meth:`pyvista.Plotter.add_mesh` the name of a transfer function\n"
        "(``'linear'``, ``'geom'``, ``'sigmoid'``, with ``_r`` reversed) along the colour map, from its first\n"
        "colour to the last, or numbers from 0 to 1 for that; or numbers from 0 to 1, one per streamline\n"
        "or one per point, or the name of an array of them. Opacities per point and colours by another\n"
        "number per point exclude each other.",
        argument=False,
        where=LATER,
        row=Row("Fades by", "Opacity along the colour map.", type="choice", optional=True,
                choices=[(None, "nothing"), ("linear", "value"), ("linear_r", "value, reversed"),
                         ("geom", "value, steep"), ("sigmoid", "value, a step")],
                matters=shared.by_numbers, scale=True),
    )  # fmt: skip
    transparency: Setting[str | int | None] = Setting(
        ALL,
        "Lines that show behind the nearest one where ``opacity`` is below 1.\n\n"
        "``\"all\"``: all lines: the nearest exactly, the others in four slices by distance behind it,\n"
        "mixed within a slice. Costs one more pass over all streamlines in view, and 80 bytes of GPU\n"
        "memory a pixel. ``\"layers\"``: the four nearest, each with its own colour, light and depth,\n"
        "blended in order. A number from 2 to 64: that number of layers. Lines behind the last layer are\n"
        "invisible; a layer costs a pass, and 44 bytes a pixel. ``None``: the nearest alone, over the rest\n"
        "of the scene. Opaque actors pay for neither.",
        kind="str | int | None",
        header='{"all", "layers", None} or int, default: "all"',
        where=LATER,
        row=Row("See-through", "Lines that show behind the nearest one, with opacity below 1.", type="choice",
                choices=[("all", "all lines"), ("layers", "the next lines"), (None, "only the rest of the scene")],
                matters=lambda s: s["opacity"] < 1.0),
    )  # fmt: skip
    line_width: Setting[float] = Setting(
        None,
        "Width of lines, pixels.",
        kind="float | None",
        where=OWN,
        check=_line_width,
        row=Row("Line width", "Pixels.", "Lines", "number", 1.0, limits=(0.25, 64.0),
                matters=lambda s: s["tube_radius"] is None and s["style"] != "ends"),
    )  # fmt: skip
    point_size: Setting[float] = Setting(
        None,
        "Diameter of the discs of ``style='ends'``, pixels from 1 to 64.",
        argument="Diameter of the discs of ``style=\"ends\"``, pixels from 1 to 64; the theme's by default.",
        kind="float | None",
        where=PROPERTY,
        check=lambda name, size: number(name, size, 1.0, LARGEST_DISC, "pixels"),
        row=Row("Point size", "Pixels.", "Lines", "number", 5.0, limits=(1.0, LARGEST_DISC),
                matters=lambda s: s["style"] == "ends"),
    )  # fmt: skip
    style: Setting[str] = Setting(
        STYLES[0],
        "Appearance of lines.\n\n"
        "``'surface'``: lines in their colours. ``'halo'``: black lines in white halos. ``'ink'``: black on a\n"
        "light background and white on a dark one, in halos of the background's colour. ``'density'``: sums\n"
        "of overlapping lines. ``'ends'``: discs at both ends of every streamline, and nothing between.\n\n"
        "``'halo'`` and ``'ink'`` are drawings in ink (Everts et al. 2009), ``'halo'`` best on white:\n"
        "all lines have one colour, no light, and default halos. Colours and ``lighting`` are kept and\n"
        "return with ``'surface'``, which removes the halos.\n\n"
        "``'density'`` adds up light: a pixel has the mean colour of all its streamlines, at a brightness\n"
        "that grows with their number (``density_tone``), over the background. The second number of\n"
        "``clim`` is the number at full brightness, by default that of the fullest pixel. Lines are a pixel\n"
        "wide, without light. With ``scalars=\"density\"`` a colour map and a scalar bar show streamlines per\n"
        "pixel.\n\n"
        "``'ends'`` draws discs of ``point_size`` pixels about the first and the last point. They are coloured,\n"
        "lit, filtered, cut and picked as the lines are; an end shows where the segment at it does. Line\n"
        "widths and tubes are kept for the other styles.",
        argument="``\"density\"`` adds up light where streamlines overlap, ``\"halo\"`` draws black lines in "
        "white halos, ``\"ink\"`` lines and halos in colours that suit the background, ``\"ends\"`` discs of "
        "``point_size`` pixels at both ends of every streamline.",
        choices=STYLES,
        where=LATER,
        row=Row("Style", "Ink: lines of one colour, with halos that show depth.", "Lines",
                choices=[("surface", "coloured lines"), ("halo", "ink and halos"), ("ink", "ink on any ground"),
                         ("density", "density"), ("ends", "end points")]),
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
        "Tubes are exact bodies: each pixel shows its point of the surface, tubes intersect each other and\n"
        "meshes, and ends are round. Tubes thinner than a pixel are a pixel wide.",
        argument=False,
        where=LATER,
        check=_tube_radius,
        row=Row("Tube radius", "mm; empty: lines.", "Lines", "number", optional=True, limits=_radii),
    )
    tube_shading: Setting[bool] = Setting(
        False,
        "Whether lines wider than a pixel are lit as round tubes.\n\n"
        "Only the light changes; the depth stays flat. ``illuminated`` overrides it.\n"
        "It needs ``lighting``. The same as ``prop.render_lines_as_tubes``, which the theme may set.",
        argument=False,
        where=LATER,
        check=truth,
        row=Row("Round lines", "Light lines wider than a pixel as round tubes.", "Lines",
                matters=lambda s: s["line_width"] > 1.0 and s["tube_radius"] is None),
    )  # fmt: skip
    lighting = shared.lighting(
        "Shade the lines by the scene's lights; the theme's by default. Light keeps at least 0.8 of every colour; "
        "colours of a scalar bar stay unchanged and match the bar.",
        None,
    )
    illuminated: Setting[bool] = Setting(
        False,
        "Whether lines reflect every light as thin cylinders.\n\n"
        "Light and shade have their full strength (Zöckler et al. 1996; Mallo et al. 2005), from any side.\n"
        "Off, they are gentle, and colours of a scalar bar stay unchanged. It needs ``lighting``.",
        argument=False,
        where=Switch("pvfiblets.mappers.effects.shading:Illuminated"),
        row=Row("Cylinders", "Reflect lights as thin cylinders do.", "Shading",
                matters=lambda s: s["lighting"]),
    )  # fmt: skip
    ambient_occlusion = shared.AMBIENT_OCCLUSION
    depth_cue = shared.DEPTH_CUE
    halos: Setting[dict[str, Any] | bool] = Setting(
        False,
        "Gaps that lines cut into objects behind them, wider with the distance.\n\n"
        "Depth-dependent halos of Everts et al. 2009.\n\n"
        "``width`` (mm): from a line's edge to its halo's, at most 24 pixels; ``None``, the default,\n"
        "is half the distance between lines, but from 1.25 to 5 pixels. ``depth`` (mm): by how much\n"
        "the halo's edge lies behind its line; lines side by side whose depths differ by less do not\n"
        "cut each other. ``None``, the default, is 8 times the width. ``color`` (``'white'``):\n"
        "``'background'`` for the renderer's.",
        argument=False,
        where=Effect("pvfiblets.mappers.effects.shading:Halos"),
        row=Row("Halos", "Gaps around lines, wider where other objects are farther behind.", "Shading",
                matters=lambda s: s["style"] == STYLES[0]),
    )  # fmt: skip
    detail: Setting[float] = Setting(
        0.0,
        "Error of distant lines in pixels, to draw fewer segments.\n\n"
        "0, the default, draws every point exactly. 0.5 draws fiblets whose points all lie within half a\n"
        "pixel of a straight line as one segment; seen from far, a frame then takes 5 to 30 % less time,\n"
        "and a pixel in fifty shows another streamline.",
        argument=False,
        where=MAPPER,
        check=lambda name, value: number(name, value, 0.0, 64.0),
        row=Row("Detail", "Error of distant lines in pixels; 0: exact, larger: faster.", "Drawing", "number",
                limits=(0.0, 4.0)),
    )  # fmt: skip
    pipeline: Setting[str] = Setting(
        "auto",
        'Rendering method; ``"auto"`` is the fastest of the plotter\'s OpenGL. '
        "``plotter.fiblets.pipelines()`` lists all.",
        kind="str",
        where=OPTIONS,
    )
    culling: Setting[str | None] = Setting(
        "auto",
        'Occlusion culling. ``"two-phase"`` changes no pixel; ``"auto"`` is two-phase where measured frames are '
        'faster with it, otherwise none; ``"coverage"`` may lose lines for a frame after the camera jumped; '
        "``None`` draws all fiblets in the view frustum.",
        kind="str | None",
        choices=("auto", "two-phase", "coverage", None),
        where=OPTIONS,
        row=Row("Culling", "Method that skips occluded lines; only coverage, the paper's, changes the image.",
                "Drawing", choices=[("auto", "auto"), ("two-phase", "two-phase"), ("coverage", "coverage"),
                                    (None, "none")]),
    )  # fmt: skip
    fit: Setting[str | None] = Setting(
        None,
        "Method for sets larger than the GPU memory: ``None`` raises an error, ``\"sample\"`` draws a share "
        "of the streamlines, ``\"stream\"`` all of them, part by part; while the camera moves a share, and the loaded "
        "parts.",
        kind="str | None",
        choices=(None, "sample", "stream"),
        where=OPTIONS,
        row=Row("Too large", "Method for sets larger than the GPU memory.", "Drawing",
                choices=[(None, "show an error"), ("sample", "draw a share"), ("stream", "draw part by part")]),
    )  # fmt: skip
    cluster: Setting[Any] = Setting(
        None,
        "A ``distributed.Client``, or the address of a scheduler. Its workers draw the fiblets, each a part of them, "
        "with their own graphics cards; ``None`` draws here. Each worker reads a mapped ``.fiblets`` file itself, "
        "under the same path.",
        kind="Any",
        where=OPTIONS,
    )
