"""How rays through a volume are cast and coloured: an actor's settings, live, and what they make together."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
import pyvista as pv

from pvfiblets.plotting.coloured import Coloured
from pvfiblets.plotting.colours import make_colouring, update_table
from pvfiblets.plotting.volumes.opacity import number, opacities, surface_values, value_limits
from pvfiblets.volumes import Transfer
from pvfiblets.volumes.options import RaycastOptions
from pvfiblets.volumes.transfer import LARGEST_PREINTEGRATED

if TYPE_CHECKING:
    from pvfiblets.mappers import Colouring
    from pvfiblets.plotting.fiblets.scalars import Scalars
    from pvfiblets.volumes import RaycastVolume

__all__ = ["RAYS", "SURFACE", "RaySettings"]

SURFACE, LIGHT = "isosurface", "composite"


class _Setting:
    """How rays are cast, as far as it is a field of `RaycastOptions` and nothing else."""

    def __init__(self, doc: str) -> None:
        self.__doc__ = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, actor: Any, kind: type | None = None) -> Any:
        return self if actor is None else getattr(actor.casting, self._name)

    def __set__(self, actor: Any, value: Any) -> None:
        actor._cast({self._name: value})  # noqa: SLF001 - of the class that it is part of


class _OfOthers:
    """A setting that colours of volumes do not have."""

    def __init__(self, why: str) -> None:
        self._why = why

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, actor: Any, kind: type | None = None) -> Any:
        return self if actor is None else self._refuse()

    def __set__(self, actor: Any, value: Any) -> None:
        self._refuse()

    def _refuse(self) -> NoReturn:
        raise AttributeError(f"volumes that rays are cast through have no {self._name}: {self._why}")


class RaySettings(Coloured):
    """The part of :class:`~pvfiblets.plotting.volumes.actor.VolumeActor` that says what a ray shows.

    Every setting may be changed at any time; a value that is refused leaves all as it was. The actor
    brings ``_volume`` and `_look`.
    """

    _volume: RaycastVolume

    log_scale = _OfOthers("colours lie evenly; take the logarithm of the values first")
    nan_color = _OfOthers("missing voxels count as the least value")
    below_color = _OfOthers("opacity=[0, ...] or thresholds hide values below others")
    above_color = _OfOthers("opacity=[..., 0] or thresholds hide values above others")

    step = _Setting("Between two looks at the volume on a ray, in mean voxel spacings; opacity does not depend on it.")
    filter = _Setting("Reconstruction between voxels: ``'nearest'``, ``'trilinear'`` or ``'tricubic'``.")
    refine = _Setting("How a surface is refined: ``'regula-falsi'``, ``'newton'`` or ``'none'``.")
    iterations = _Setting("Steps of that refinement, 1 to 64.")
    integrator = _Setting(
        "How light is added up: ``'adaptive'``, ``'preintegrated'``, ``'exponential'``, ``'riemann'``, ``'simpson'``, "
        "``'romberg'`` or ``'rk4'``."
    )
    jitter = _Setting("Whether each ray starts at a place of its own in its first step: noise instead of rings.")
    octree = _Setting("Whether parts with nothing to see are skipped; the picture is the same.")
    homogeneous = _Setting("Difference of values up to which parts of the volume are taken as their mean; 0 for none.")
    recon = _Setting("Whether parts in which colour and opacity are the same for all values are taken as one.")
    sparse = _Setting("Pixels along each axis for which there is one ray at first: 1, 2 or 4.")
    sparse_threshold = _Setting("Difference between those rays from which on pixels between have their own, 0 to 1.")
    stop = _Setting("Opacity at which a ray ends, up to 1.")
    box = _Setting("(xmin, xmax, ymin, ymax, zmin, zmax) in voxels of what is there; ``None`` for all.")

    def _init_rays(
        self, wanted: dict[str, Any], *, values: Any, thresholds: Any, peak: Any, opacity: Any, unit: Any
    ) -> tuple[RaycastOptions, Colouring | None]:
        """Take the settings, and return what they make of the volume; fields that are None have their defaults."""
        self._values, self._thresholds, self._peak = values, thresholds, peak
        self._opacity_choice, self._unit = opacity, unit
        self._casting = RaycastOptions(SURFACE, (0.0,))
        given = {field: value for field, value in wanted.items() if value is not None}
        made = self._made({"mode": LIGHT, **given})
        self._casting = made[0]
        return made

    def _look(self) -> None:
        """Set what the actor's property knows."""
        raise NotImplementedError

    # What a ray shows ---------------------------------------------------------------------------

    @property
    def casting(self) -> RaycastOptions:
        """All settings of the rays as they are drawn."""
        return self._casting

    @property
    def mode(self) -> str:
        """What a ray shows.

        ``"isosurface"``: the first of the surfaces of ``values``. ``"composite"``: the light of all
        that it passes through. ``"mip"``: the greatest value. ``"local-mip"``: the first peak of at
        least ``peak``, or the greatest value where there is none.
        """
        return self._casting.mode

    @mode.setter
    def mode(self, mode: str) -> None:
        self._cast({"mode": mode})

    @property
    def values(self) -> tuple[float, ...]:
        """Where surfaces are, up to eight; ``None`` sets the middle of the volume's values."""
        return surface_values(self._values, self._volume.value_range)

    @values.setter
    def values(self, values: Any) -> None:
        self._set_own("_values", values)

    @property
    def thresholds(self) -> Any:
        """(low, high): values that are there, in all modes but ``"isosurface"``; either may be ``None``."""
        return self._thresholds

    @thresholds.setter
    def thresholds(self, thresholds: Any) -> None:
        self._set_own("_thresholds", thresholds)

    @property
    def peak(self) -> float:
        """The least value of a peak, for ``"local-mip"``; ``None`` sets the middle of the volume's values."""
        if self._peak is None:
            return surface_values(None, self._volume.value_range)[0]
        return number("peak", self._peak, "the least value of a peak")

    @peak.setter
    def peak(self, peak: float | None) -> None:
        self._set_own("_peak", peak)

    # Colours ------------------------------------------------------------------------------------

    @property
    def opacity(self) -> Any:
        """How opaque values are, from the low end of ``clim`` to the high one.

        A name as for :meth:`pyvista.Plotter.add_volume` (``"linear"``, ``"sigmoid"``, ...), numbers
        from 0 to 1, or one number for all. Of light it is the opacity of ``opacity_unit_distance``
        mm; of peaks, that of the pixel. One number makes surfaces translucent, all else does not
        touch them.
        """
        return self._opacity_choice

    @opacity.setter
    def opacity(self, opacity: Any) -> None:
        self._set_own("_opacity_choice", opacity)

    @property
    def opacity_unit_distance(self) -> float:
        """Length, mm, of which ``opacity`` says how opaque it is; ``None`` sets the volume's mean spacing."""
        if self._unit is None:
            return float(self._volume.spacing.mean())
        return number("opacity_unit_distance", self._unit, "a length above 0, mm")

    @opacity_unit_distance.setter
    def opacity_unit_distance(self, mm: float | None) -> None:
        self._set_own("_unit", mm)

    @property
    def color(self) -> pv.Color | None:
        """One colour for all in place of the map; ``None`` for the map."""
        return None if self._settings.color is None else pv.Color(self._settings.color)

    @color.setter
    def color(self, color: Any) -> None:
        self._set("color", None if color is None else pv.Color(color))
        self._bar()

    @property
    def scalars_title(self) -> str | None:
        """What a scalar bar says; ``None`` where there is one colour."""
        return None if self._settings.color is not None or self._scalars is None else self._scalars.title

    # Inside -------------------------------------------------------------------------------------

    def _cast(self, wanted: dict[str, Any]) -> None:
        """Change fields of the casting; a refused one leaves all as it was."""
        try:
            self._apply(wanted)
        except Exception:
            self._made({})  # brings the table back
            raise

    def _set(self, setting: str, value: Any) -> None:
        """Change one setting of the colours; a refused value leaves all as it was."""
        self._set_own(setting, value, self._settings)

    def _set_own(self, name: str, value: Any, owner: Any = None) -> None:
        """Change what the casting is made from; a refused value leaves all as it was."""
        owner = self if owner is None else owner
        before = getattr(owner, name)
        setattr(owner, name, value)
        try:
            self._apply({})
        except Exception:
            setattr(owner, name, before)
            self._made({})
            raise

    def _apply(self, wanted: dict[str, Any]) -> None:
        """Have the mapper draw by the present settings, with some fields of the casting changed."""
        made, colouring = self._made(wanted)
        self._mapper.show(made, colouring)
        self._casting = made
        self._look()

    def _show(self, scalars: Scalars | None) -> None:
        """Hand the mapper its colours."""
        self._scalars = scalars
        self._cast({})

    def _made(self, wanted: dict[str, Any]) -> tuple[RaycastOptions, Colouring | None]:
        """Return casting and colours of the present settings with some fields changed, and bring the table in step."""
        assert self._scalars is not None
        settings, mode = self._settings, wanted.get("mode", self._casting.mode)
        low, high = value_limits(self._thresholds)
        own = {"values": self.values, "threshold": self.peak, "low": low, "high": high, **wanted}
        update_table(self._table, settings, self._scalars, self._theme, None)
        if mode != SURFACE:
            _widen(self._table, max(int(settings.n_colors), 2))
        alpha = opacities(self._opacity_choice, self._table.n_values)
        if settings.color is not None:
            self._table.values[:, :3] = pv.Color(settings.color).int_rgb
        self._table.values[:, 3] = 255 if mode == SURFACE else np.round(255.0 * alpha)
        if mode == LIGHT:
            own["transfer"] = self._transfer(alpha)
        casting = replace(self._casting, **own)
        if mode == LIGHT:
            if casting.integrator in ("adaptive", "preintegrated") and len(alpha) > LARGEST_PREINTEGRATED:
                raise ValueError(
                    f"n_colors is {len(alpha)}; light that is integrated beforehand has {LARGEST_PREINTEGRATED} "
                    "colours at most: give fewer, or integrator='exponential'"
                )
            return casting, None
        solid = mode == SURFACE and settings.color is not None
        return casting, make_colouring(settings, None if solid else self._scalars, self._table, self._theme)

    def _transfer(self, alpha: np.ndarray) -> Transfer:
        """Return the table as a transfer function, the one that there is if it says the same."""
        table = np.column_stack([np.asarray(self._table.values, np.float32)[:, :3] / 255.0, alpha]).astype(np.float32)
        clim, unit = tuple(self._table.scalar_range), self.opacity_unit_distance
        held = self._casting.transfer
        if held is not None and (held.clim, held.unit) == (clim, unit) and np.array_equal(held.table, table):
            return held
        return Transfer(table, clim, unit)

    def _bar(self) -> None:
        if self._bar_changed is not None:
            self._bar_changed(self)


RAYS = tuple(name for name, value in vars(RaySettings).items() if isinstance(value, _Setting))
"""Fields of `RaycastOptions` that are the actor's settings as they are."""


def _widen(table: pv.LookupTable, count: int) -> None:
    """Give a table so many entries at least, of the same colours: opacities want more than a list of a few colours."""
    before = table.n_values
    if before < count:
        table.values = np.array(table.values)[np.arange(count) * before // count]
