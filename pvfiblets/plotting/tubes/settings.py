"""What can be set of spline tubes: properties of the actor, arguments of ``add_spline_tubes``, rows of the page."""

from __future__ import annotations

from typing import Any

from pvfiblets.plotting import shared_settings as shared
from pvfiblets.plotting.setting_places import LATER, OPTIONS
from pvfiblets.plotting.settings import NoSetting, Row, Setting, Settings

_OF_LINES = "{name} is for lines, and spline tubes are surfaces; "


class TubeSettings(Settings):
    """Settings of :class:`~pvfiblets.plotting.tubes.actor.TubeActor`, in the order of the page."""

    illuminated = NoSetting(_OF_LINES + "lighting, and prop.specular, shade them")
    tube_shading = NoSetting(_OF_LINES + "lighting shades them as the round bodies that they are")
    tube_radius = NoSetting(_OF_LINES + "every node has its radius: set tubes to others")
    line_width = NoSetting(_OF_LINES + "min_width is the width in pixels that they take at least")
    halos = NoSetting(_OF_LINES + "silhouette draws a line around them")

    color = shared.color("One colour for all, the theme's by default. ``scalars`` go before it.")
    cmap = shared.CMAP
    clim = shared.CLIM
    n_colors = shared.N_COLORS
    log_scale = shared.LOG_SCALE
    nan_color = shared.NAN_COLOR.but(row=None)
    below_color = shared.BELOW_COLOR
    above_color = shared.ABOVE_COLOR
    annotations = shared.ANNOTATIONS
    flip_scalars = shared.FLIP_SCALARS
    opacity = shared.opacity("Of all tubes; what lies behind the nearest surface of the tubes does not show through.")
    opacity_by = shared.opacity_by()
    lighting = shared.lighting("Shade the tubes by the scene's lights; the theme's by default.", None)
    ambient_occlusion = shared.AMBIENT_OCCLUSION
    depth_cue = shared.DEPTH_CUE
    silhouette: Setting[dict[str, Any] | bool] = Setting(
        False,
        "An outline around tubes: ``True`` for all in white, a dict of what shall differ, or ``False``.\n\n"
        '``color`` (``"white"``); ``width`` (2.0): pixels, 1 to 16; ``tubes`` (``None``): numbers of\n'
        "those around which it goes, or a mask ``(n_tubes,)``; all where it is ``None``.",
        argument=False,
        where=LATER,
        row=Row("Outline", "A white line around each tube.", "Shading"),
    )
    min_width: Setting[float] = Setting(
        1.0,
        "Pixels that a tube takes at least, however thin and far it is; 0 leaves thin ones as they are.",
        kind="float",
        where=OPTIONS,
        row=Row("Least width", "Pixels that a tube takes at least.", "Drawing", limits=(0.0, 16.0)),
    )
    silhouettes: Setting[str] = Setting(
        "auto",
        "What covers the pixels whose rays are tried; the picture is the same.",
        kind="str",
        choices=("auto", "rectangles", "boxes", "pulled-boxes"),
        where=OPTIONS,
    )
    solver: Setting[str] = Setting(
        "auto",
        "How the first point on a ray is searched; the paper bisects.",
        kind="str",
        choices=("auto", "illinois", "newton", "itp", "bisection"),
        where=OPTIONS,
        row=Row("Solver", "How rays find the surface.", "Drawing"),
    )
    iterations: Setting[int | None] = Setting(
        None,
        "Steps of one search at most; ``None`` for the solver's own number.",
        kind="int | None",
        where=OPTIONS,
    )
    culling: Setting[str | None] = Setting(
        "two-phase",
        "How segments behind others are found out, where there are many; the picture is the same.",
        kind="str | None",
        choices=("two-phase", None),
        where=OPTIONS,
        row=Row("Culling", "How hidden segments are left out. Two-phase: same picture.", "Drawing",
                choices=[("two-phase", "two-phase"), (None, "none")]),
    )
