"""`RaycastOptions`: how rays are cast through a volume, as one value that a redraw is decided on."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .volume import FILTERS

if TYPE_CHECKING:
    from .transfer import Transfer

MODES = ("composite", "isosurface", "mip", "local-mip", "minimum", "average")
"""What a ray shows: all that it passes through, a surface, the greatest value, the first peak above a threshold,
the least value, or the mean one."""

PROJECTIONS = ("mip", "local-mip", "minimum", "average")  # modes that show one value of a ray

REFINEMENTS = ("exact", "regula-falsi", "newton", "none")
"""Searches for surfaces: in each cell of eight voxels, or between two steps (paper: equations 3 and 4)."""

INTEGRATORS = ("adaptive", "preintegrated", "exponential", "riemann", "simpson", "romberg", "rk4")
"""Methods of integrating the rendering equation over a step."""

MAX_VALUES = 8  # isosurfaces of one volume

MOST_STEPS = 30_000
"""Steps of a ray up to which flat voxels may shorten them: software OpenGL ends a loop after 65,535 turns."""

DEEPEST, MOST_SHORTER = 16.0, 4.0
"""Optical depth of a step beyond which it is shortened, and to what part of itself at the most."""

LARGEST = (2.0 - 2.0**-23) * 2.0**127  # the largest number that float32 holds


@dataclass(frozen=True)
class RaycastOptions:
    """Options of ray casting.

    Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III.
    """

    mode: str = "isosurface"  # of `MODES`
    # where surfaces are, 1 to `MAX_VALUES` of them, for `'isosurface'`; each ray shows the first that it meets
    values: tuple[float, ...] = ()
    # RGBA from 0 to 1 of each of `values`: then each ray shows all surfaces that it meets, one behind the other
    surfaces: tuple[tuple[float, ...], ...] | None = None
    transfer: Transfer | None = None  # colours and opacities by value, for `'composite'`
    # whether the border of the volume, or of its `box`, closes surfaces about values that are at least theirs
    closed: bool = False
    threshold: float = -math.inf  # the least value of a peak, for `'local-mip'`
    low: float = -math.inf  # range of visible values; lower and higher ones are empty in all modes but `'isosurface'`
    high: float = math.inf
    # of a ray, in mean voxel spacings, above 0; `step_mm` converts it for voxels that are far from cubes. Surfaces and
    # peaks that are found exactly take no steps (`exact`).
    step: float = 0.5
    # whether each ray starts at a place of its own within the first step: noise takes the place of rings
    jitter: bool = False
    filter: str = "trilinear"  # of `pvfiblets.volumes.volume.FILTERS`
    # of `REFINEMENTS`. `'exact'` is `'regula-falsi'` where the filter is another than `'trilinear'`.
    refine: str = "exact"
    iterations: int = 5  # steps of the refinement, 1 to 64
    # of `INTEGRATORS`. `'adaptive'` is `'preintegrated'` for steps where one look-up is enough, takes steps in parts
    # where values bend, as at edges from voxel to voxel, and halves others until their halves agree
    # (`pvfiblets.volumes.steepness`).
    integrator: str = "adaptive"
    octree: bool = True  # whether invisible nodes are skipped. It changes no pixel.
    # nodes whose values differ by no more are taken as their mean, for `'composite'`; 0 for none
    homogeneous: float = 0.0
    # whether nodes in which neither colour nor opacity changes with the value, by their bounds, are not reconstructed
    # at all but taken as one, for `'composite'`. It changes no more than rounding does. These and homogeneous ones must
    # make up at least half of the nodes that rays look into, or none is: testing costs more.
    recon: bool = True
    # A ray is cast for every so many pixels along each axis first, 1, 2 or 4, and for those between only where what the
    # first ones found differs (section III.D). Things thinner than that may be missed.
    sparse: int = 1
    # by how much it may differ: colours and opacities from 0 to 1, values over the range of colours, and the cosine of
    # an angle between normals by its distance from 1
    sparse_threshold: float = 0.05
    stop: float = 0.999  # opacity at which a ray ends, above 0 and at most 1
    # (xmin, xmax, ymin, ymax, zmin, zmax) in voxels: everything outside is cut away
    box: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        for name, known in (
            ("mode", MODES), ("filter", FILTERS), ("refine", REFINEMENTS), ("integrator", INTEGRATORS)
        ):  # fmt: skip
            if getattr(self, name) not in known:
                raise ValueError(f"{name} is {getattr(self, name)!r}; choose one of {known}")
        object.__setattr__(self, "values", tuple(float(value) for value in self.values))
        right = 1 <= len(self.values) <= MAX_VALUES and all(abs(value) <= LARGEST for value in self.values)
        if self.mode == "isosurface" and not right:
            raise ValueError(
                f"values of isosurfaces are {self.values}; give 1 to {MAX_VALUES} finite numbers that float32 holds"
            )
        self._check_surfaces()
        if self.mode == "composite" and self.transfer is None:
            raise ValueError("mode 'composite' needs transfer: colours and opacities by value")
        if math.isnan(self.low) or math.isnan(self.high) or self.low > self.high:
            raise ValueError(f"the thresholds are {self.low} and {self.high}; give the lower one first")
        self._check("step", lambda: 1e-3 <= self.step <= 1e3, "a number of voxels from 0.001 to 1000")
        self._check("stop", lambda: 0.0 < self.stop <= 1.0, "an opacity above 0, at most 1")
        self._check("homogeneous", lambda: 0.0 <= self.homogeneous < math.inf, "a difference of values, 0 or more")
        self._check("sparse", lambda: self.sparse in (1, 2, 4), "1, 2 or 4 pixels")
        self._check("sparse_threshold", lambda: 0.0 <= self.sparse_threshold <= 1.0, "a number from 0 to 1")
        self._check("iterations", lambda: self.iterations in range(1, 65), "a whole number from 1 to 64")
        if math.isnan(self.threshold):
            raise ValueError("threshold is nan; give a number")
        if self.box is not None:
            try:
                box = tuple(float(side) for side in self.box)
            except (TypeError, ValueError):
                box = ()
            if len(box) != 6 or not all(map(math.isfinite, box)) or any(box[k] > box[k + 1] for k in (0, 2, 4)):
                raise ValueError(f"box is {self.box!r}; give (xmin, xmax, ymin, ymax, zmin, zmax) in voxels")
            object.__setattr__(self, "box", box)

    @property
    def exact(self) -> bool:
        """Whether rays go from cell to cell: the field in one is a cubic along a ray where it is trilinear."""
        return self.mode not in ("composite", "average") and self.refine == "exact" and self.filter == "trilinear"

    @property
    def layered(self) -> bool:
        """Whether rays show several surfaces, one behind the other."""
        return self.mode == "isosurface" and self.surfaces is not None

    @property
    def coloured(self) -> bool:
        """Whether what rays find is a colour and an opacity: light, or that of several surfaces."""
        return self.mode == "composite" or self.layered

    def less(self, reference: float) -> RaycastOptions:
        """Return the same rays through values that are less by a reference."""
        if not reference:
            return self
        transfer = self.transfer
        if transfer is not None:
            transfer = replace(transfer, clim=(transfer.clim[0] - reference, transfer.clim[1] - reference))
        return replace(
            self,
            values=tuple(value - reference for value in self.values),
            transfer=transfer,
            threshold=self.threshold - reference,
            low=self.low - reference,
            high=self.high - reference,
        )

    def step_mm(self, spacing: npt.ArrayLike, shape: tuple[int, int, int]) -> float:
        """Return the length of a step, mm."""
        # Of voxels that are much shorter along one axis than along others, the mean spacing would step over things many
        # of the short ones wide: a step is no longer than one of those, or than `step` of them if that is more, unless
        # a ray through the whole volume took more than `MOST_STEPS` then. Light as dense as fog, where `'adaptive'` is
        # to miss no corner, has shorter ones: of an optical depth of `DEEPEST` at most, but no shorter than one by
        # `MOST_SHORTER` of that.
        lengths = np.asarray(spacing, np.float64)
        mean, least = self.step * float(lengths.mean()), max(self.step, 1.0) * float(lengths.min())
        through = float(np.linalg.norm(lengths * shape))
        step = min(mean, max(least, through / MOST_STEPS))
        if self.mode == "composite" and self.integrator == "adaptive" and self.transfer is not None:
            deep = step * self.transfer.largest_extinction
            step /= min(max(deep / DEEPEST, 1.0), MOST_SHORTER)
        return step

    def _check_surfaces(self) -> None:
        if self.surfaces is None:
            return
        rgba = np.array(self.surfaces, np.float64)
        if rgba.shape != (len(self.values), 4) or not ((rgba >= 0.0) & (rgba <= 1.0)).all():
            raise ValueError(
                f"surfaces is {self.surfaces!r}; give RGBA from 0 to 1 for each of the {len(self.values)} values"
            )
        object.__setattr__(self, "surfaces", tuple(tuple(row) for row in rgba.tolist()))

    def _check(self, name: str, right: Callable[[], bool], expected: str) -> None:
        try:
            fine = bool(right())
        except (TypeError, ValueError):  # what cannot be compared
            fine = False
        if not fine:
            raise ValueError(f"{name} is {getattr(self, name)!r}; give {expected}")
