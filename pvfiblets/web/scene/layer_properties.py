"""The properties of tractograms, tubes, volumes, meshes and images of slices, in the order of a panel.

Settings of actors are found in their declarations (`pvfiblets.plotting.settings.settings`); this module adds the page's
own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pvfiblets.plotting.fiblets.looks import LOOKS
from pvfiblets.plotting.fiblets.settings import FibletSettings
from pvfiblets.plotting.settings import shared
from pvfiblets.plotting.settings.settings import Setting, Settings
from pvfiblets.plotting.slices.settings import MEANING, SliceSettings
from pvfiblets.plotting.tubes.settings import TubeSettings
from pvfiblets.plotting.volumes.settings import VolumeSettings
from pvfiblets.web.scene.properties import Choices, Property
from pvfiblets.web.scene.slices.glyph_layers import GLYPHS, VECTORS
from pvfiblets.web.scene.slices.glyph_layers import ROWS as GLYPH_ROWS

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet


def value_names(fiblets: FibletSet) -> list[str]:
    """Names of numbers that fiblets have, per streamline or per point."""
    from pvfiblets.query.measures.measures import measure_names

    return [name for name in measure_names(fiblets) if name != "coding_error" or name in fiblets.per_point]


def _line_scalars(fiblets: FibletSet) -> Choices:
    from pvfiblets.plotting.colours.scalars import COUNTED, ORIENTATION, UNITS
    from pvfiblets.plotting.fiblets.scalars import DENSITY, ENDS, GROUP, ID, RANDOM

    usual: list[tuple[Any, str]] = [(ORIENTATION, "orientation"), (None, "one colour"), (RANDOM, "a colour each")]
    ends = (ENDS, "direction from end to end")
    # The fourth of the usual ones, which stand before the scene's images.
    found: list[tuple[Any, str]] = [*usual, (GROUP, "group"), ends] if fiblets.groups else [*usual, ends]
    colours = [
        name
        for name, rows in fiblets.per_streamline.items()
        if rows.ndim == 2 and rows.shape[1] in (3, 4) and rows.dtype.kind in "uf"
    ]
    found += [(name, UNITS.get(name, name)) for name in [*value_names(fiblets), *colours]]
    return [*found, (ID, "number"), (DENSITY, COUNTED)]


def _tube_scalars(tubes: Any) -> Choices:
    from pvfiblets.plotting.colours.scalars import UNITS
    from pvfiblets.plotting.tubes.sources import BUILT_IN

    names = dict.fromkeys([*BUILT_IN, *tubes.values, *tubes.tube_values])
    return [(None, "one colour"), *((name, UNITS.get(name, name)) for name in names)]


def _mesh_scalars(mesh: Any) -> Choices:
    arrays = [(name, data[name]) for data in (mesh.point_data, mesh.cell_data) for name in data]
    names = dict.fromkeys(name for name, array in arrays if array.dtype.kind in "buif" and array.ndim <= 2)
    return [(None, "one colour"), *((name, name) for name in names)]


def _meanings(image: Any) -> Choices:
    found: list[tuple[Any, str]] = [("scalars", "values")]
    found += [("labels", "labels")] if image.n_volumes == 1 or image.is_labels else []
    found += [("rgb", "colours")] if image.n_volumes in (3, 4) else []
    return [*found, ("direction", "directions")] if image.n_volumes == 3 else found


def _table(
    settings: type[Settings], first: Sequence[Property], after: Mapping[str, Sequence[Property]]
) -> tuple[Property, ...]:
    """Return all rows of a drawable's settings in their order, with the page's own in their places."""
    found = list(first)
    for name, one in settings.DECLARED.items():
        if isinstance(one, Setting) and one.row is not None:
            found.append(Property.from_setting(one))
        found += after.get(name, ())
    return tuple(found)


def _scalars(choices: Any, default: Any, *, volumes: bool = False) -> Property:
    """Return the row of what colours."""
    return own("scalars", "choice", "Colour by", "Data shown as colours.", default=default, choices=choices,
               resets=("clim", "log_scale"), volumes=volumes)  # fmt: skip


own = Property.own
_BAR = own("show_bar", "bool", "Colour bar", "Show the values of the colours.", default=True,
           matters=shared.by_numbers)  # fmt: skip

TRACTOGRAM = _table(
    FibletSettings,
    [
        own("look", "choice", "Look", "Preset of widths, light and shading.", "Look",
            "plain",
            choices=[(None, "custom"), *((name, name) for name in LOOKS)]),
        _scalars(_line_scalars, "orientation", volumes=True),
    ],
    {
        "log_scale": [_BAR],
        "halos": [
            own("selection_color", "colour", "Selected", "Colour of the selection; empty: unchanged.", "Selection",
                optional=True),
            own("selection_dim", "number", "Dim the others", "Dimming of all other streamlines.", "Selection",
                0.8, limits=(0.0, 1.0)),
            own("selection_as_tubes", "bool", "As tubes", "Draw the selection as tubes.", "Selection", False),
            own("selection_radius", "number", "Radius", "Radius of selected tubes, mm.", "Selection", 0.5,
                limits=(1e-6, 1e6), matters=lambda s: s["selection_as_tubes"]),
        ],
        "fit": [
            own("share", "text", "Drawn", "Share of the visible streamlines that fit into GPU memory.", "Drawing",
                read_only=True, read=lambda actor: "" if actor.share is None else f"{actor.share:.1%}"),
            own("promise", "text", "Error bound", "Largest distance of a drawn point from its original.", "Drawing",
                read_only=True, read=lambda actor: f"{actor.fiblets.promise:.3g} mm"),
        ],
    },
)  # fmt: skip

TUBES = _table(
    TubeSettings,
    [_scalars(_tube_scalars, None)],
    {
        "log_scale": [_BAR],
        "opacity": [own("radius_scale", "number", "Radius", "Factor of the file's radius.", "Tubes", 1.0,
                        limits=(0.01, 100.0))],
    },
)  # fmt: skip

VOLUME = _table(
    VolumeSettings,
    [],
    {
        "opacity": [own("surface_opacity", "number", "Opacity of surfaces", "0 is invisible.",
                        default=0.4, limits=(0.0, 1.0), matters=lambda s: s["mode"] == "isosurface")],
        "opacity_unit_distance": [replace(_BAR, default=False, matters=lambda s: s["color"] is None)],
    },
)  # fmt: skip

IMAGE = _table(
    SliceSettings,
    [],
    {
        "interpolation": [own(MEANING, "choice", "Numbers are", "What the numbers of the image mean.", "Drawing",
                              "scalars", choices=_meanings, resets=("clim", "below", "above", "index"))],
        "outline": list(GLYPH_ROWS),
        "cmap": [own(VECTORS, "choice", "Axes", "Axes of vectors: right, front and up, or FSL's.", "Drawing",
                     "scanner", choices=[("scanner", "scanner's"), ("fsl", "FSL's")],
                     matters=lambda settings: settings[MEANING] == "direction" or settings[GLYPHS] == "peaks"),
                 own("modulate", "choice", "Bright by", "Image that sets the brightness, such as FA.",
                     choices=[(None, "nothing")], volumes=True, resets=("clim",),
                     matters=lambda settings: settings[MEANING] == "direction")],
    },
)  # fmt: skip

MESH: tuple[Property, ...] = (
    _scalars(_mesh_scalars, None),
    replace(Property.from_setting(TubeSettings.color), default="#d3d3d3"),
    Property.from_setting(shared.CMAP),
    Property.from_setting(shared.LOG_SCALE),
    _BAR,
    replace(Property.from_setting(shared.CLIM), read=lambda actor: list(actor.mapper.scalar_range)),
    Property.from_setting(TubeSettings.opacity),
    own("representation", "choice", "Show", "Faces, edges or corners.", "Surface", "surface",
             choices=[("surface", "surface"), ("wireframe", "edges only"), ("points", "points")]),
    own("show_edges", "bool", "Edges", "Draw edges over faces.", "Surface", False,
             matters=lambda s: s["representation"] == "surface"),
    own("line_width", "number", "Edge width", "Pixels.", "Surface", 1.0, limits=(0.25, 64.0),
             matters=lambda s: s["show_edges"] or s["representation"] == "wireframe"),
    own("point_size", "number", "Point size", "Pixels.", "Surface", 5.0, limits=(1.0, 64.0),
             matters=lambda s: s["representation"] == "points"),
    own("culling", "choice", "Hide", "Hidden faces.", "Surface", None,
             choices=[(None, "none"), ("back", "back faces"), ("front", "front faces")]),
    own("smooth_shading", "bool", "Smooth", "Smooth shading.", "Shading", True),
    own("specular", "number", "Gloss", "Strength of highlights.", "Shading", 0.0, limits=(0.0, 1.0)),
    Property.from_setting(TubeSettings.lighting),
)  # fmt: skip
