"""Colours of fiblets and spline tubes, by the rules of ``vtkLookupTable``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.colour_modes import MODES, ColourMode

if TYPE_CHECKING:
    from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource

_GREY = np.repeat(np.arange(256, dtype=np.uint8)[:, None], 4, axis=1) | np.array([0, 0, 0, 255], dtype=np.uint8)


def _rgba(colour: Any, name: str) -> tuple[float, ...]:
    """Return four floats in [0, 1] from three or four."""
    values = tuple(float(channel) for channel in colour)
    if len(values) == 3:
        values = (*values, 1.0)
    if len(values) != 4 or not all(0.0 <= channel <= 1.0 for channel in values):
        raise ValueError(f"{name} is {colour!r}; expected 3 or 4 numbers between 0 and 1")
    return values


@dataclass(frozen=True, eq=False)
class Colouring:
    """The colour of every pixel; of spline tubes, each tube counts as a streamline.

    Instances never change; the arrays in them must not be changed either. Make another one with
    `dataclasses.replace`.
    """

    # One of `pvfiblets.colour_modes.MODES`. `values` holds numbers or colours of lines, `source` names the array of
    # points; `lut` is the table. ``'pixel_count'`` is of fiblets with a `pvfiblets.mappers.effects.density.Density`.
    mode: str = "orientation"
    # RGB between 0 and 1, for ``'solid'``; None for black on a light background and white on a dark one
    color: tuple[float, ...] | None = (1.0, 1.0, 1.0)
    values: npt.NDArray[Any] | None = None  # (n_streamlines, 3 or 4) uint8 or (n_streamlines,) numbers
    # ``'curvature'``, ``'arc_length'``, the name of a stored per-point array, or a volume; of spline tubes
    # ``'radius'``, ``'arc_length'`` or one of their ``values``
    source: str | VolumeSource | None = None
    lut: npt.NDArray[np.uint8] | None = None  # (k, 4) uint8 RGBA, lowest value first. Greys by default.
    # Values of the table's two ends. Needed by ``'point_scalar'`` and ``'pixel_count'``; by default the finite range
    # of `values`.
    clim: tuple[float, float] | None = None
    log_scale: bool = False  # Spread the table over the logarithms; `clim` must be positive
    nan_color: tuple[float, ...] = (0.5, 0.5, 0.5, 1.0)  # For NaN
    below_color: tuple[float, ...] | None = None  # For values outside `clim`; by default the colour of the nearer end
    above_color: tuple[float, ...] | None = None
    has_alpha: bool = False  # Whether some colour of ``'point_rgba'`` or ``'point_packed'`` has an alpha below 1
    opacities: npt.NDArray[Any] | None = None  # (n_streamlines,) numbers from 0 to 1; NaN is 0
    # Name of a stored per-point array of opacities from 0 to 1; of fiblets. With ``'point_scalar'`` it is `source`:
    # one number at points goes with a picture.
    opacity_source: str | None = None

    def __post_init__(self) -> None:
        """Check the fields and bring them into one form."""
        if self.mode not in MODES:
            raise ValueError(f"mode is {self.mode!r}; expected one of {tuple(MODES)}")
        if self.color is not None:
            self._set("color", _rgba(self.color, "color")[:3])
        self._set("nan_color", _rgba(self.nan_color, "nan_color"))
        for name in ("below_color", "above_color"):
            if getattr(self, name) is not None:
                self._set(name, _rgba(getattr(self, name), name))
        if self.kind.numbers == "lines" and not self.kind.table:
            self._check_rgb()
        at_points = self.kind.numbers == "points"
        if at_points and self.kind.table and not self.source:
            raise ValueError(f"mode {self.mode!r} needs source: the name of a per-point array, or a volume")
        if at_points and not self.kind.table and not isinstance(self.source, str):
            raise ValueError(f"mode {self.mode!r} needs source: the name of the points' colours, not {self.source!r}")
        if self.kind.table:
            self._check_table()
        if self.opacity_source is not None and self.kind.reads == "position" and self.source != self.opacity_source:
            raise ValueError(
                f"opacities of points are {self.opacity_source!r}, but {self.source!r} colours points: one number at "
                "points goes with a picture; colour by the same, or by streamline, or give one opacity per streamline"
            )

    def _set(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, value)

    def _check_rgb(self) -> None:
        values = None if self.values is None else np.asarray(self.values)
        if values is None or values.ndim != 2 or values.shape[1] not in (3, 4):
            found = "nothing" if values is None else f"shape {values.shape}"
            raise ValueError(f"{self.mode}: values has {found}; expected (n_streamlines, 3 or 4)")
        if values.dtype != np.uint8:
            raise ValueError(f"{self.mode}: values has dtype {values.dtype}; expected uint8")
        self._set("values", values)

    def _check_table(self) -> None:
        lut = _GREY if self.lut is None else np.asarray(self.lut)
        if lut.ndim != 2 or lut.shape[1] != 4 or len(lut) < 1 or lut.dtype != np.uint8:
            raise ValueError(f"lut has shape {lut.shape} and dtype {lut.dtype}; expected (k, 4) uint8 with k >= 1")
        self._set("lut", lut)
        if self.kind.numbers == "lines":
            values = None if self.values is None else np.asarray(self.values)
            if values is None or values.ndim != 1 or values.dtype.kind not in "biuf":
                found = "nothing" if values is None else f"{values.dtype} of shape {values.shape}"
                raise ValueError(f"{self.mode}: values is {found}; expected (n_streamlines,)")
            self._set("values", values)
            if self.clim is None:
                self._set("clim", _finite_range(values, positive=self.log_scale))
        if self.clim is None:
            raise ValueError(f"mode {self.mode!r} needs clim: the values of the table's two ends")
        low, high = (float(end) for end in self.clim)
        if not (np.isfinite(low) and np.isfinite(high) and low <= high):
            raise ValueError(f"clim is {self.clim!r}; expected two finite numbers in rising order")
        if self.log_scale and low <= 0.0:
            raise ValueError(f"clim starts at {low}; a logarithmic scale needs a positive range")
        self._set("clim", (low, high))

    @property
    def kind(self) -> ColourMode:
        """The mode's properties."""
        return MODES[self.mode]

    def with_ink(self, ink: tuple[float, ...]) -> Colouring:
        """Return this colouring, with the ink for its colour if it has none."""
        return self if self.color is not None else replace(self, color=ink)

    @property
    def maps_on_gpu(self) -> bool:
        """Whether shaders map numbers by the table; numbers of lines are mapped on the CPU."""
        return self.kind.table and self.kind.numbers != "lines"

    @property
    def reads_value(self) -> bool:
        """Whether shaders read a number or a packed colour at points."""
        return self.kind.reads == "position" or self.opacity_source is not None

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve shader that it takes."""
        wanted = {
            f"colour_{self.kind.shader}": True,
            "density_value": self.kind.numbers == "pixels",
            "table_logarithm": self.maps_on_gpu and self.log_scale,
            "point_value": self.reads_value,
            "opacity_streamline": self.opacities is not None,
            "opacity_value": self.opacity_source is not None,
        }
        return frozenset(name for name, on in wanted.items() if on)

    @property
    def point_source(self) -> str | VolumeSource | None:
        """Per-point value or colour that the engine must put into the G-buffer, if any."""
        return self.source if self.kind.numbers == "points" else self.opacity_source

    def table(self) -> npt.NDArray[np.uint8]:
        """Return the look-up table, (k + 3, 4) uint8: the last rows are for values below, above, and NaN."""
        if self.lut is None:
            raise ValueError(f"mode {self.mode!r} has no look-up table")
        below = self.lut[0] if self.below_color is None else _bytes(self.below_color)
        above = self.lut[-1] if self.above_color is None else _bytes(self.above_color)
        return np.concatenate([self.lut, [below, above, _bytes(self.nan_color)]]).astype(np.uint8)

    def scaled_range(
        self, clim: tuple[float, float] | None = None, *, reference: float = 0.0
    ) -> tuple[float, float, float]:
        """Return lo, hi and entries per unit of the table's scale, or of other ends, less a reference of the values."""
        # On a log scale, lo and hi are logarithms, and above 0 the reference's own is subtracted.
        clim = self.clim if clim is None else clim
        if self.lut is None or clim is None:
            raise ValueError(f"mode {self.mode!r} has no look-up table")
        if self.log_scale:
            low, high = np.log10(clim) - (np.log10(reference) if reference > 0.0 else 0.0)
        else:
            low, high = clim[0] - reference, clim[1] - reference
        span = float(high) - float(low)
        return float(low), float(high), len(self.lut) / span if span > 0.0 else 3.0e38

    def map_values(self, values: npt.ArrayLike) -> npt.NDArray[np.uint8]:
        """Return (n, 4) uint8 RGBA of (n,) numbers, as ``vtkLookupTable`` maps them."""
        table = self.table()
        entries = len(table) - 3
        low, high, scale = self.scaled_range()
        numbers = np.asarray(values, dtype=np.float64)
        missing = np.isnan(numbers)
        if self.log_scale:
            positive = numbers > 0.0
            numbers = np.log10(numbers, where=positive, out=np.full(numbers.shape, -np.inf))
        with np.errstate(over="ignore"):
            index = np.minimum(
                np.clip(np.where(missing, low, numbers), low, high) * scale - low * scale,
                entries - 1,
            )
        index = np.clip(index, 0, entries - 1).astype(np.int64)
        index[numbers < low] = entries
        index[numbers > high] = entries + 1
        index[missing] = entries + 2
        mapped: npt.NDArray[np.uint8] = table[index]
        return mapped

    def streamline_colours(self) -> npt.NDArray[np.uint8] | None:
        """Return (n_streamlines, 4) uint8 RGBA, or None where the colour is not per streamline."""
        if self.values is None or self.kind.numbers != "lines":
            return None
        if self.kind.table:
            return self.map_values(self.values)
        if self.values.shape[1] == 4:
            return np.ascontiguousarray(self.values)
        opaque = np.full((len(self.values), 1), 255, dtype=np.uint8)
        return np.hstack([self.values, opaque])

    def streamline_opacities(self) -> npt.NDArray[np.uint8]:
        """Return (n_streamlines, 4) uint8, whose alpha is the opacity."""
        values = np.nan_to_num(np.asarray(self.opacities, np.float64))
        found = np.zeros((len(values), 4), np.uint8)
        found[:, 3] = np.round(255.0 * np.clip(values, 0.0, 1.0))
        return found

    def check_count(self, n_streamlines: int) -> None:
        """Raise a ValueError unless values per streamline are as many as streamlines."""
        if self.opacities is not None and len(self.opacities) != n_streamlines:
            raise ValueError(
                f"there are {len(self.opacities)} opacities for {n_streamlines} streamlines; give one per streamline, "
                "empty ones included"
            )
        if self.kind.numbers != "lines" or self.values is None:
            return
        if len(self.values) != n_streamlines:
            raise ValueError(
                f"{self.mode} has {len(self.values)} values for {n_streamlines} "
                "streamlines; give one per streamline, empty ones included"
            )

    def translucent(self) -> bool:
        """Whether some colour has an alpha below 1, so that VTK must use its translucent pass."""
        if self.opacities is not None or self.opacity_source is not None:
            return True
        if self.kind.table:
            return bool((self.table()[:, 3] < 255).any())
        if self.kind.numbers == "lines" and self.values is not None:
            return self.values.shape[1] == 4 and bool((self.values[:, 3] < 255).any())
        return self.kind.numbers == "points" and self.has_alpha


def _bytes(colour: tuple[float, ...]) -> npt.NDArray[np.uint8]:
    """Round a colour to bytes as VTK does."""
    return (np.asarray(colour) * 255.0 + 0.5).astype(np.uint8)


def _finite_range(values: npt.NDArray[Any], *, positive: bool) -> tuple[float, float]:
    """Return least and greatest drawable value, (0, 1) where there is none ((1, 10) for logarithms)."""
    kept = values[np.isfinite(values)] if values.dtype.kind == "f" else values
    if positive:
        kept = kept[kept > 0]
    if len(kept) == 0:
        return (1.0, 10.0) if positive else (0.0, 1.0)
    return float(kept.min()), float(kept.max())
