"""The properties of tractograms, tubes, volumes and meshes."""

from __future__ import annotations

from typing import Any

from pvfiblets.web.properties import Choices, Limits, Property

__all__ = ["CMAPS", "MESH", "TRACTOGRAM", "TUBES", "VOLUME", "bounds_size", "value_names"]

CMAPS = (
    "viridis", "plasma", "inferno", "magma", "cividis", "turbo", "gray", "bone", "hot", "afmhot", "copper", "pink",
    "coolwarm", "RdBu", "RdYlBu", "Spectral", "PuOr", "bwr", "seismic", "twilight", "hsv", "rainbow", "jet", "Blues",
    "Greens", "Reds", "YlOrRd", "YlGnBu", "tab10", "tab20", "Set1", "Set2", "Paired",
)  # fmt: skip
"""Colour maps that a panel offers; each also reversed, with ``_r``."""

_CURVES = ("linear", "linear_r", "geom", "geom_r", "sigmoid", "sigmoid_3", "sigmoid_5", "sigmoid_7", "sigmoid_10",
           "sigmoid_20", "foreground")  # fmt: skip


def _named(*names: str) -> Choices:
    return [(name, name.replace("-", " ").replace("_", " ")) for name in names]


def bounds_size(data: Any) -> float:
    """Return the diagonal of some data's bounds, mm; 1 where they have none."""
    b = data.bounds
    found = float(sum((b[k + 1] - b[k]) ** 2 for k in (0, 2, 4)) ** 0.5)
    return found if 0.0 < found < float("inf") else 1.0


def _radii(data: Any) -> Limits:
    size = bounds_size(data)
    return 1e-5 * size, 0.1 * size


def value_names(fiblets: Any) -> list[str]:
    """Names of numbers that fiblets have, per streamline or per point."""
    from pvfiblets.query.measures import measure_names

    return [name for name in measure_names(fiblets) if name != "coding_error" or name in fiblets.per_point]


def _line_scalars(fiblets: Any) -> Choices:
    from pvfiblets.plotting.fiblets.scalars import GROUP, ORIENTATION, UNITS

    found: list[tuple[Any, str]] = [(ORIENTATION, "orientation"), (None, "one colour")]
    colours = [
        name
        for name, rows in fiblets.per_streamline.items()
        if rows.ndim == 2 and rows.shape[1] in (3, 4) and rows.dtype.kind in "uf"
    ]
    found += [(name, UNITS.get(name, name)) for name in [*value_names(fiblets), *colours]]
    return [*found, (GROUP, "group")] if fiblets.groups else found


def _tube_scalars(tubes: Any) -> Choices:
    from pvfiblets.plotting.fiblets.scalars import UNITS
    from pvfiblets.plotting.tubes.scalars import BUILT_IN

    names = dict.fromkeys([*BUILT_IN, *tubes.values, *tubes.tube_values])
    return [(None, "one colour"), *((name, UNITS.get(name, name)) for name in names)]


def _mesh_scalars(mesh: Any) -> Choices:
    arrays = [(name, data[name]) for data in (mesh.point_data, mesh.cell_data) for name in data]
    names = dict.fromkeys(name for name, array in arrays if array.dtype.kind in "buif" and array.ndim <= 2)
    return [(None, "one colour"), *((name, name) for name in names)]


def _clim_span(actor: Any) -> Limits:
    scalars = actor.active_scalars
    return scalars.range if scalars is not None and scalars.mapped else actor.clim


def _by_numbers(settings: Any) -> bool:
    return settings["scalars"] not in (None, "orientation")


def _colours(scalars: Any, default: Any, *, span: Any = None, volumes: bool = False) -> tuple[Property, ...]:
    """Properties of what is coloured by numbers or has one colour."""
    return (
        Property("scalars", "choice", "Colour by", "What the colours stand for.", default=default, choices=scalars,
                 resets=("clim", "log_scale"), volumes=volumes),
        Property("color", "colour", "Colour", "Of all, where nothing else colours it.", default="#ffffff",
                 matters=lambda s: s["scalars"] is None),
        Property("cmap", "choice", "Map", "Colours from the low end of the range to the high one.",
                 choices=[(None, "usual"), *_named(*CMAPS, *(f"{name}_r" for name in CMAPS))], matters=_by_numbers),
        Property("clim", "range", "Range", "Values of the first and the last colour; empty: all of the data's.",
                 optional=True, read=lambda actor: list(actor.clim), span=span, matters=_by_numbers),
        Property("log_scale", "bool", "Logarithmic", "Spread the colours over the logarithm of the values.",
                 default=False, matters=_by_numbers),
        Property("show_bar", "bool", "Colour bar", "Show which colour stands for which value.", default=True,
                 matters=_by_numbers),
    )  # fmt: skip


_OPACITY = Property("opacity", "number", "Opacity", "From 0, not to be seen, to 1.", "Colours", 1.0, limits=(0.0, 1.0))
_LIGHTING = Property("lighting", "bool", "Light", "Shade by the scene's lights.", "Shading", True)
_OCCLUSION = Property("ambient_occlusion", "bool", "Ambient occlusion", "Darken what others stand over.", "Shading",
                      False)  # fmt: skip
_CUE = Property("depth_cue", "bool", "Depth cue", "Let what is far away fade.", "Shading", False)


def _surface_style(settings: Any) -> bool:
    return settings["style"] == "surface"


TRACTOGRAM: tuple[Property, ...] = (
    *_colours(_line_scalars, "orientation", span=_clim_span, volumes=True),
    Property("nan_color", "colour", "Without a value", "Colour of what has no value.", optional=True,
             read=lambda actor: actor.nan_color.hex_rgb, matters=_by_numbers),
    _OPACITY,
    Property("transparency", "choice", "Seen through", "What shows behind the nearest line, with opacity below 1.",
             "Colours", None, choices=[(None, "what is behind all lines"), ("layers", "the next lines")],
             matters=lambda s: s["opacity"] < 1.0),
    Property("line_width", "number", "Line width", "Pixels.", "Lines", 1.0, limits=(0.25, 64.0),
             matters=lambda s: s["tube_radius"] is None),
    Property("style", "choice", "Style", "Halo: black lines in white halos, best on a white background.", "Lines",
             "surface", choices=[("surface", "coloured lines"), ("halo", "ink and halos")]),
    Property("tube_radius", "number", "Tube radius", "mm; empty: lines.", "Lines", None, optional=True, limits=_radii),
    Property("tube_shading", "bool", "Round lines", "Light lines wider than a pixel as round tubes.", "Lines", False,
             matters=lambda s: s["line_width"] > 1.0 and s["tube_radius"] is None),
    _LIGHTING,
    Property("illuminated", "bool", "Cylinders", "Reflect lights as thin cylinders do, from whichever side.",
             "Shading", False, matters=lambda s: s["lighting"]),
    _OCCLUSION,
    _CUE,
    Property("halos", "bool", "Halos", "Gaps around lines, the wider the farther behind things are.", "Shading", False,
             matters=_surface_style),
    Property("selection_color", "colour", "Selected", "Colour of what is selected; empty: its own.", "Selection",
             optional=True),
    Property("selection_dim", "number", "Dim the others", "How much of the others' colours gives way.", "Selection",
             0.8, limits=(0.0, 1.0)),
    Property("selection_as_tubes", "bool", "As tubes", "Draw what is selected as tubes.", "Selection", False),
    Property("selection_radius", "number", "Radius", "Of these tubes, mm.", "Selection", 0.5, limits=(1e-6, 1e6),
             matters=lambda s: s["selection_as_tubes"]),
    Property("culling", "choice", "Culling",
             "How hidden lines are left out. Two-phase: same picture; coverage: as in the paper.", "Drawing",
             "two-phase", choices=[("two-phase", "two-phase"), ("coverage", "coverage"),
                                   (None, "none")]),
    Property("fit", "choice", "Too large", "What to do where GPU memory does not suffice for all.", "Drawing", None,
             choices=[(None, "say so"), ("sample", "draw a share")]),
    Property("share", "text", "Drawn", "How many of the streamlines that are shown fit the GPU's memory.", "Drawing",
             read_only=True, read=lambda actor: "" if actor.share is None else f"{actor.share:.1%}"),
    Property("promise", "text", "Error promise", "No point is drawn farther than this from where it was.", "Drawing",
             read_only=True, read=lambda actor: f"{actor.fiblets.promise:.3g} mm"),
)  # fmt: skip

TUBES: tuple[Property, ...] = (
    *_colours(_tube_scalars, None),
    _OPACITY,
    Property("radius_scale", "number", "Radius", "Times the radius that the file gives.", "Tubes", 1.0,
             limits=(0.01, 100.0)),
    _LIGHTING,
    _OCCLUSION,
    _CUE,
    Property("silhouette", "bool", "Outline", "A white line around each tube.", "Shading", False),
    Property("min_width", "number", "Least width", "Pixels that a tube takes at least.", "Drawing", 1.0,
             limits=(0.0, 16.0)),
    Property("solver", "choice", "Solver", "How rays find the surface.", "Drawing", "auto",
             choices=_named("auto", "illinois", "newton", "itp", "bisection")),
    Property("culling", "choice", "Culling", "How hidden segments are left out. Two-phase: same picture.", "Drawing",
             "two-phase", choices=[("two-phase", "two-phase"), (None, "none")]),
)  # fmt: skip


def _mode(*modes: str) -> Any:
    return lambda settings: settings["mode"] in modes


def _values_span(actor: Any) -> Limits:
    return actor.volume.value_range


VOLUME: tuple[Property, ...] = (
    Property("mode", "choice", "Mode", "What a ray through the volume shows.", default="isosurface",
             choices=[("composite", "light"), ("isosurface", "surface"), ("mip", "greatest value"),
                      ("local-mip", "first peak")]),
    Property("values", "numbers", "Surface at", "Values of surfaces; empty: the middle.", optional=True,
             read=lambda actor: list(actor.values), span=_values_span, matters=_mode("isosurface")),
    Property("color", "colour", "Colour", "One for all, in place of the map.", optional=True),
    Property("cmap", "choice", "Map", "Colours from the low end of the range to the high one.", default="gray",
             choices=_named(*CMAPS, *(f"{name}_r" for name in CMAPS)), matters=lambda s: s["color"] is None),
    Property("clim", "range", "Range", "Values of the first and the last colour; empty: all of the data's.",
             optional=True, read=lambda actor: list(actor.clim), span=_values_span),
    Property("opacity", "choice", "Opacity", "How opaque values are, from the low end of the range to the high one.",
             default="linear", choices=_named(*_CURVES), matters=_mode("composite", "mip", "local-mip")),
    Property("surface_opacity", "number", "Opacity of surfaces", "From 0, not to be seen, to 1.", default=0.4,
             limits=(0.0, 1.0), matters=_mode("isosurface")),
    Property("opacity_unit_distance", "number", "Opaque over", "mm of which the opacity is; empty: a voxel.",
             optional=True, limits=lambda volume: (1e-4 * bounds_size(volume), 10.0 * bounds_size(volume)),
             read=lambda actor: actor.opacity_unit_distance, matters=_mode("composite")),
    Property("show_bar", "bool", "Colour bar", "Show which colour stands for which value.", default=False,
             matters=lambda s: s["color"] is None),
    Property("thresholds", "range", "Only values", "Values that are there; empty: all.", optional=True,
             span=_values_span, matters=_mode("composite", "mip", "local-mip")),
    Property("peak", "number", "Peaks from", "The least value of a peak; empty: the middle.", optional=True,
             read=lambda actor: actor.peak, matters=_mode("local-mip")),
    Property("smooth", "number", "Smooth", "Standard deviation of a Gaussian, voxels; empty: none.", "Rays",
             optional=True, limits=(0.1, 8.0)),
    Property("step", "number", "Step", "Between two looks at the volume, voxels.", "Rays", 0.5, limits=(0.05, 8.0)),
    Property("filter", "choice", "Between voxels", "Reconstruction between voxels.", "Rays", "trilinear",
             choices=_named("nearest", "trilinear", "tricubic")),
    Property("refine", "choice", "Refine surfaces", "How a surface's place is found.", "Rays", "regula-falsi",
             choices=_named("regula-falsi", "newton", "none"), matters=_mode("isosurface")),
    Property("integrator", "choice", "Integrator", "How light is added up over a step.", "Rays", "adaptive",
             choices=_named("adaptive", "preintegrated", "exponential", "riemann", "simpson", "romberg", "rk4"),
             matters=_mode("composite")),
    Property("jitter", "bool", "Jitter", "Noise in place of rings.", "Rays", False),
    _LIGHTING,
    _OCCLUSION,
    _CUE,
)  # fmt: skip


MESH: tuple[Property, ...] = (
    *(
        Property("color", "colour", prop.label, prop.help, default="#d3d3d3", matters=prop.matters)
        if prop.name == "color"
        else prop
        for prop in _colours(_mesh_scalars, None)
        if prop.name != "clim"
    ),
    Property("clim", "range", "Range", "Values of the first and the last colour; empty: all of the data's.",
             optional=True, read=lambda actor: list(actor.mapper.scalar_range), matters=_by_numbers),
    _OPACITY,
    Property("representation", "choice", "Show", "Faces, edges or corners.", "Surface", "surface",
             choices=[("surface", "surface"), ("wireframe", "edges alone"), ("points", "points")]),
    Property("show_edges", "bool", "Edges", "Draw edges over faces.", "Surface", False,
             matters=lambda s: s["representation"] == "surface"),
    Property("line_width", "number", "Edge width", "Pixels.", "Surface", 1.0, limits=(0.25, 64.0),
             matters=lambda s: s["show_edges"] or s["representation"] == "wireframe"),
    Property("point_size", "number", "Point size", "Pixels.", "Surface", 5.0, limits=(1.0, 64.0),
             matters=lambda s: s["representation"] == "points"),
    Property("culling", "choice", "Leave out", "Which faces are not drawn.", "Surface", None,
             choices=[(None, "none"), ("back", "those seen from behind"), ("front", "those seen from the front")]),
    Property("smooth_shading", "bool", "Smooth", "Shade as if the surface were curved.", "Shading", True),
    Property("specular", "number", "Gloss", "How much it shines.", "Shading", 0.0, limits=(0.0, 1.0)),
    _LIGHTING,
)  # fmt: skip
