"""Settings of volumes: properties of the actor, arguments of ``add_raycast_volume``, rows of the page."""

from __future__ import annotations

from dataclasses import replace
from numbers import Real
from typing import Any

from pvfiblets.plotting.settings import shared
from pvfiblets.plotting.settings.places import OWN, Effect, Own, Place, Stored
from pvfiblets.plotting.settings.settings import NoSetting, Row, Setting, Settings, truth
from pvfiblets.volumes.raycast_options import INTEGRATORS, MODES, PROJECTIONS, REFINEMENTS
from pvfiblets.volumes.volume import FILTERS

_MODES_SHOWN = ("light", "surface", "greatest value", "first peak", "least value", "mean value")
_MISSING = "ray-cast volumes have no {name}: "
_CURVES = ("linear", "linear_r", "geom", "geom_r", "sigmoid", "sigmoid_3", "sigmoid_5", "sigmoid_7", "sigmoid_10",
           "sigmoid_20", "foreground")  # fmt: skip


SURFACE, LIGHT = "isosurface", "composite"  # modes


class _Casting(Place):
    """A field of the actor's `RaycastOptions`, which checks it."""

    def read(self, actor: Any, setting: Stored) -> Any:
        return getattr(actor.casting, setting.field)

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        actor._cast({setting.field: value})  # noqa: SLF001 - of the class that it is part of


class _Chosen(Own):
    """A source of the ray casting options: stored as given, read as the resulting value."""

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        actor._choose(setting.field, value)  # noqa: SLF001

    def value_for_copy(self, actor: Any, one: Stored) -> Any:
        return actor._choices[one.field]  # noqa: SLF001


class _Reflection(Place):
    """A number of the actor's ``prop``; ``None`` leaves it to the theme."""

    made_with = False

    def read(self, actor: Any, setting: Stored) -> Any:
        return getattr(actor.prop, setting.field)

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        if value is not None:
            setattr(actor.prop, setting.field, float(value))


CASTING, CHOSEN, REFLECTION = _Casting(), _Chosen(), _Reflection()


def _up_to(most: float) -> Any:
    def check(name: str, value: Any) -> float | None:
        if value is not None and not (isinstance(value, Real) and 0.0 <= float(value) <= most):
            raise ValueError(f"{name} is {value!r}; give a number from 0 to {most:g}, or None for the theme's")
        return None if value is None else float(value)

    return check


def _mode(*modes: str) -> Any:
    return lambda settings: settings["mode"] in modes


def _values_span(actor: Any) -> tuple[float, float]:
    return actor.volume.value_range


def _unit_limits(volume: Any) -> tuple[float, float]:
    size = shared.bounds_size(volume)
    return 1e-4 * size, 10.0 * size


class VolumeSettings(Settings):
    """Settings of :class:`~pvfiblets.plotting.volumes.actor.VolumeActor`, in the order of the page."""

    nan_color = NoSetting(_MISSING + "missing voxels count as the least value")
    below_color = NoSetting(_MISSING + "opacity=[0, ...] or thresholds hide values below others")
    above_color = NoSetting(_MISSING + "opacity=[..., 0] or thresholds hide values above others")

    mode: Setting[str] = Setting(
        "composite",
        "Result of a ray: the first surface, all light, or an extremum or mean of the values.\n\n"
        '``"isosurface"``: the first surface of ``values``. ``"composite"``: all light on the ray.\n'
        '``"mip"``: the greatest value. ``"local-mip"``: the first peak of at\n'
        'least ``peak``, or the greatest value where there is none. ``"minimum"``: the least value.\n'
        '``"average"``: the mean of all. ``add_volume`` calls them ``blending``.',
        kind="str",
        choices=MODES,
        where=CASTING,
        row=Row("Mode", "Mode of the rays through the volume.", default="isosurface",
                choices=list(zip(MODES, _MODES_SHOWN, strict=True))),
    )  # fmt: skip
    values: Setting[Any] = Setting(
        None,
        "Values of surfaces, up to eight; ``None`` sets the middle of the volume's values.",
        kind="float | Any",
        header="float or list of float, optional",
        where=CHOSEN,
        row=Row("Surface at", "Values of surfaces; empty: the middle.", type="numbers", optional=True,
                read=lambda actor: list(actor.values), span=_values_span, matters=_mode("isosurface")),
    )  # fmt: skip
    surface_opacities: Setting[Any] = Setting(
        None,
        "Opacity of each surface of ``values``, 0 to 1; rays pass through translucent surfaces.\n\n"
        "One number for all of them. ``None`` shows the first surface of each ray, which ``opacity``\n"
        "makes translucent if it is one number.",
        kind="float | Any",
        header="float or list of float, optional",
        where=CHOSEN,
        row=Row("Surfaces' opacity", "Opacity of each surface, 0 to 1; empty: rays end at the first.", type="numbers",
                optional=True, span=lambda _actor: (0.0, 1.0), read=lambda actor: list(actor.surface_opacities or ()),
                matters=_mode("isosurface")),
    )  # fmt: skip
    surface_colors: Setting[Any] = Setting(
        None,
        "A colour for each surface of ``values``; ``None`` uses the map, or ``color``.",
        kind="Sequence[ColorLike] | None",
        header="list of color-like, optional",
        where=CHOSEN,
    )
    closed: Setting[bool] = Setting(
        False,
        "Whether surfaces around values above theirs are closed where the volume or its ``box`` ends.",
        kind="bool",
        where=CASTING,
        row=Row("Closed", "Close surfaces at the volume's border.", matters=_mode("isosurface")),
    )
    color: Setting[Any] = Setting(
        None,
        "One colour for all in place of the map; ``None`` for the map. Where no colours are given, one surface has the "
        "theme's colour, as a mesh without scalars.",
        kind=shared.COLOR_LIKE,
        header="color-like, optional",
        where=OWN,
        row=Row("Colour", "One colour for all, in place of the map.", type="colour", optional=True),
    )
    cmap = shared.CMAP.but(
        argument_doc="Colour map; the theme's by default. Surfaces have the colour of their value in it.",
        row=Row("Map", "Colours from the low to the high end of the range.", type="choice", default="gray",
                choices=shared.MAPS, matters=lambda s: s["color"] is None),
    )  # fmt: skip
    clim = shared.CLIM.but(row=replace(shared.CLIM_ROW, span=_values_span, matters=None))
    n_colors = shared.N_COLORS.but(argument_doc="Number of colours in the map, between which light is linear.")
    log_scale = shared.LOG_SCALE.but(
        __doc__="Whether colours, but not opacities, spread over the logarithm of the values, as in ``add_volume``.",
        argument_doc="Spread colours, and not opacities, over the logarithm of the values, as ``add_volume`` does.",
        row=Row(
            "Logarithmic", "Spread the colours over the logarithm of the values.", matters=lambda s: s["color"] is None
        ),
    )
    annotations = shared.ANNOTATIONS
    flip_scalars = shared.FLIP_SCALARS
    opacity: Setting[Any] = Setting(
        "linear",
        "Opacity of values, from the low to the high end of ``clim``.\n\n"
        'A name as for :meth:`pyvista.Plotter.add_volume` (``"linear"``, ``"sigmoid"``, ...), numbers\n'
        "from 0 to 1, or one number for all. For light it is the opacity of ``opacity_unit_distance``\n"
        "mm, for peaks the opacity of the pixel. One number makes surfaces translucent; lists and\n"
        "names do not affect them. Own opacities of a :class:`pyvista.LookupTable` as ``cmap``\n"
        "replace ``\"linear\"``.",
        kind="float | str | Sequence[float] | np.ndarray",
        header='str, float or list of float, default: "linear"',
        where=CHOSEN,
        row=Row("Opacity", "Opacity of values, from the low to the high end of the range.", type="choice",
                choices=[(name, name.replace("_", " ")) for name in _CURVES],
                matters=_mode("composite", *PROJECTIONS)),
    )  # fmt: skip
    opacity_unit_distance: Setting[float] = Setting(
        None,
        "Length, mm, that ``opacity`` refers to; ``None`` sets the volume's mean spacing.",
        kind="float | None",
        where=CHOSEN,
        row=Row("Opaque over", "Length of the opacity, mm; empty: a voxel.", optional=True, limits=_unit_limits,
                read=lambda actor: actor.opacity_unit_distance, matters=_mode("composite")),
    )  # fmt: skip
    thresholds: Setting[Any] = Setting(
        None,
        '(low, high): range of visible values, in all modes but ``"isosurface"``; either may be ``None``.',
        header="(float, float), optional",
        where=CHOSEN,
        row=Row("Only values", "Range of visible values; empty: all.", type="range", optional=True, span=_values_span,
                matters=_mode("composite", *PROJECTIONS)),
    )  # fmt: skip
    peak: Setting[float] = Setting(
        None,
        'The least value of a peak, for ``"local-mip"``; ``None`` sets the middle of the volume\'s values.',
        kind="float | None",
        where=CHOSEN,
        row=Row("Peaks from", "The least value of a peak; empty: the middle.", optional=True,
                read=lambda actor: actor.peak, matters=_mode("local-mip")),
    )  # fmt: skip
    smooth: Setting[Any] = Setting(
        None,
        "Standard deviation of a Gaussian that first smooths the volume, voxels; ``None`` for none.",
        kind="float | Any",
        header="float or (float, float, float), optional",
        where=OWN,
        row=Row("Smooth", "Standard deviation of a Gaussian, voxels; empty: none.", "Rays", "number", optional=True,
                limits=(0.1, 8.0)),
    )  # fmt: skip
    step: Setting[float] = Setting(
        0.5,
        "Distance of samples on a ray, in mean voxel spacings; opacity does not depend on it, and exact surfaces and "
        "peaks need none.",
        kind="float",
        where=CASTING,
        row=Row("Step", "Distance of samples on a ray, voxels.", "Rays", limits=(0.05, 8.0)),
    )
    filter: Setting[str] = Setting(
        "trilinear",
        "Reconstruction between voxels.",
        kind="str",
        choices=FILTERS,
        where=CASTING,
        row=Row("Between voxels", "Reconstruction between voxels.", "Rays"),
    )
    refine: Setting[str] = Setting(
        "exact",
        'Search for surfaces and peaks. ``"exact"``, the default, solves for the crossings and the peaks of the cubic '
        'that the values of a cell make along a ray, where the filter is ``"trilinear"``; with other filters it is '
        '``"regula-falsi"``. The others search between samples, and peaks at samples, as the paper does.',
        kind="str",
        choices=REFINEMENTS,
        where=CASTING,
        row=Row("Refine", "Search for surfaces and peaks.", "Rays",
                matters=_mode("isosurface", "mip", "local-mip", "minimum")),
    )
    iterations: Setting[int] = Setting(5, "Steps of the refinement, 1 to 64.", kind="int", where=CASTING)
    integrator: Setting[str] = Setting(
        "adaptive",
        'Integration of light over a step. ``"adaptive"``, the default, keeps the error of light below a '
        "hundredth, except in a few pixels of noise: each step is computed as by "
        '``"preintegrated"``, in parts if values bend, or halved until its halves agree.',
        kind="str",
        choices=INTEGRATORS,
        where=CASTING,
        row=Row("Integrator", "Integration of light over a step.", "Rays", matters=_mode("composite")),
    )
    jitter: Setting[bool] = Setting(
        False,
        "Whether each ray starts at a random place in its first step: noise instead of rings.",
        kind="bool",
        where=CASTING,
        row=Row("Jitter", "Noise in place of rings.", "Rays"),
    )
    octree: Setting[bool] = Setting(
        True,
        "Whether invisible parts are skipped; the image is the same.",
        kind="bool",
        where=CASTING,
    )
    homogeneous: Setting[float] = Setting(
        0.0,
        "Difference of values up to which a part of the volume counts as its mean; 0 for none.",
        kind="float",
        where=CASTING,
    )
    recon: Setting[bool] = Setting(
        True,
        "Whether parts of one colour and opacity are taken in one step, if there are enough of them to be faster.",
        kind="bool",
        where=CASTING,
    )
    sparse: Setting[int] = Setting(
        1,
        "Distance of the first rays, pixels along each axis. Pixels between them have rays only where the first "
        "ones differ, so thin objects may be missed.",
        kind="int",
        choices=(1, 2, 4),
        where=CASTING,
    )
    sparse_threshold: Setting[float] = Setting(
        0.05,
        "Difference of rays above which pixels between them have their own, 0 to 1.",
        kind="float",
        where=CASTING,
    )
    stop: Setting[float] = Setting(
        0.999,
        "Opacity at which a ray ends, up to 1.",
        kind="float",
        where=CASTING,
    )
    interactive_quality: Setting[float | dict[str, Any]] = Setting(
        0.5,
        'Quality while the camera moves, 0 to 1, or ``{"step": factor, "sparse": pixels}``.\n\n'
        "1: as when idle. 0.5: steps twice as long, and a ray for every second pixel at first; light\n"
        "whose steps are integrated beforehand keeps its step, and peaks are those of samples. When the\n"
        "camera stops, there is one more frame, at full quality. It counts as moving while the window requests the\n"
        "update rate of an active interactor.",
        kind="float | dict[str, Any]",
        header="float or dict, default: 0.5",
        where=OWN,
    )
    box: Setting[Any] = Setting(
        None,
        "(xmin, xmax, ymin, ymax, zmin, zmax) of the visible part, in voxels; ``None`` for all.",
        header="(float, float, float, float, float, float), optional",
        where=CASTING,
    )
    lighting = shared.lighting("Shade surfaces by the scene's lights; the theme's by default.", None).but(
        __doc__="Whether the scene's lights shade surfaces; ``shade`` is for light, and peaks are not shaded.",
        where=OWN,
    )
    shade: Setting[bool] = Setting(
        False,
        "Whether the scene's lights shade light by the gradient of the values, as ``add_volume``'s ``shade``.\n\n"
        "Both sides of a gradient are lit. Where values hardly change, by less than a 50th of ``clim``\n"
        "from voxel to voxel, light keeps its own colours, so noise has no shading. It takes six more\n"
        "samples of the volume for each step.",
        kind="bool",
        where=OWN,
        check=truth,
        row=Row("Shade", "Shade light by the scene's lights.", "Shading", "bool", matters=_mode("composite")),
    )
    ambient: Setting[float] = Setting(
        None,
        "Share of the colour of surfaces, and of light with ``shade``, without any lamp; the theme's by default.",
        kind="float | None", where=REFLECTION, check=_up_to(1.0),
    )  # fmt: skip
    diffuse: Setting[float] = Setting(
        None,
        "Share of the colour in full light; the theme's by default, 1.",
        kind="float | None", where=REFLECTION, check=_up_to(1.0),
    )  # fmt: skip
    specular: Setting[float] = Setting(
        None,
        "Strength of highlights; the theme's by default, 0.",
        kind="float | None", where=REFLECTION, check=_up_to(1.0),
    )  # fmt: skip
    specular_power: Setting[float] = Setting(
        None,
        "Sharpness of highlights, 0 to 128; the theme's by default.",
        kind="float | None", where=REFLECTION, check=_up_to(128.0),
    )  # fmt: skip
    ambient_occlusion = shared.AMBIENT_OCCLUSION
    depth_cue = shared.DEPTH_CUE
    ray_occlusion: Setting[dict[str, Any] | bool] = Setting(
        False,
        "Darkness where the volume occludes its own surfaces, by rays through it (Lesar 2015, equation 10).\n\n"
        "Unlike ``ambient_occlusion``, which reads only pixels, it includes hidden surfaces and those outside\n"
        "the frame, and does not change as the camera turns; it costs ``samples`` rays a pixel.\n\n"
        "``samples`` (32): rays of each pixel, 1 to 2048. ``radius`` (mm): farther geometry does not\n"
        "darken; ``None``, the default, is a 20th of the data's diagonal. ``strength`` (1.0): 0 to 1.\n"
        "``seed`` (0): equal seeds give equal frames, to the last bit. ``smooth``\n"
        "(``True``): mean over neighbouring pixels of the same surface, in place of grain.",
        kind="bool | dict[str, Any]",
        header="bool or dict, default: False",
        where=Effect("pvfiblets.mappers.effects.ray_occlusion:RayOcclusion"),
    )
