"""Settings of spline tubes: properties of the actor, arguments of ``add_spline_tubes``, rows of the page."""

from __future__ import annotations

from typing import Any

from pvfiblets.plotting.settings import shared
from pvfiblets.plotting.settings.places import LATER, OPTIONS
from pvfiblets.plotting.settings.settings import NoSetting, Row, Setting, Settings

_OF_LINES = "{name} is for lines, and spline tubes are surfaces; "


class TubeSettings(Settings):
    """Settings of :class:`~pvfiblets.plotting.tubes.actor.TubeActor`, in the order of the page."""

    illuminated = NoSetting(_OF_LINES + "lighting, and prop.specular, shade them")
    tube_shading = NoSetting(_OF_LINES + "lighting shades them as round bodies")
    tube_radius = NoSetting(_OF_LINES + "every node has a radius: assign new tubes")
    line_width = NoSetting(_OF_LINES + "min_width sets their least width in pixels")
    halos = NoSetting(_OF_LINES + "silhouette draws a line around them")

    color = shared.color("One colour for all, the theme's by default. ``scalars`` override it.")
    cmap = shared.CMAP
    clim = shared.CLIM
    n_colors = shared.N_COLORS
    log_scale = shared.LOG_SCALE
    nan_color = shared.NAN_COLOR.but(row=None)
    below_color = shared.BELOW_COLOR
    above_color = shared.ABOVE_COLOR
    annotations = shared.ANNOTATIONS
    flip_scalars = shared.FLIP_SCALARS
    opacity = shared.opacity("Of all tubes; only the nearest surface of the tubes is visible.")
    opacity_by = shared.opacity_by()
    lighting = shared.lighting("Shade the tubes by the scene's lights; the theme's by default.", None)
    ambient_occlusion = shared.AMBIENT_OCCLUSION
    depth_cue = shared.DEPTH_CUE
    silhouette: Setting[dict[str, Any] | bool] = Setting(
        False,
        "An outline around tubes: ``True`` for all in white, ``False`` for none, or a dict.\n\n"
        '``color`` (``"white"``); ``width`` (2.0): pixels, 1 to 16; ``tubes`` (``None``): numbers of the\n'
        "outlined tubes, or a mask ``(n_tubes,)``; ``None`` for all.",
        argument=False,
        where=LATER,
        row=Row("Outline", "A white line around each tube.", "Shading"),
    )
    min_width: Setting[float] = Setting(
        1.0,
        "Least width of a tube in pixels; 0 for no minimum.",
        kind="float",
        where=OPTIONS,
        row=Row("Least width", "Least width of a tube in pixels.", "Drawing", limits=(0.0, 16.0)),
    )
    silhouettes: Setting[str] = Setting(
        "auto",
        "Shapes that bound the tubes on the screen: their pixels cast rays. The image is the same.",
        kind="str",
        choices=("auto", "rectangles", "boxes", "pulled-boxes"),
        where=OPTIONS,
    )
    solver: Setting[str] = Setting(
        "auto",
        "Root finder for the first hit on a ray. The paper uses bisection.",
        kind="str",
        choices=("auto", "illinois", "newton", "itp", "bisection"),
        where=OPTIONS,
        row=Row("Solver", "Search for the surface on a ray.", "Drawing"),
    )
    iterations: Setting[int | None] = Setting(
        None,
        "Most steps of the solver per ray; ``None`` for the solver's default.",
        kind="int | None",
        where=OPTIONS,
    )
    culling: Setting[str | None] = Setting(
        "two-phase",
        "Occlusion culling of large sets; the image is the same.",
        kind="str | None",
        choices=("two-phase", None),
        where=OPTIONS,
        row=Row("Culling", "Occlusion culling. Two-phase: same image.", "Drawing",
                choices=[("two-phase", "two-phase"), (None, "none")]),
    )
