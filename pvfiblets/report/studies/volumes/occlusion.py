"""Ambient occlusion of volumes: rays and their cost, beside exact openness."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes import RaycastVolume
from pvfiblets.volumes.raycast_options import RaycastOptions

from ...record import Figure, Record
from ...study import Options
from ...timing import Comparison, turns_of
from . import reference
from .drawing import sample
from .openness import SETS, exact_openness, seen_from

if TYPE_CHECKING:
    import moderngl

SAMPLES, QUICK_SAMPLES = (4, 8, 16, 32, 64, 128, 256, 512), (4, 16, 64)
PIXELS, QUICK_PIXELS = 150, 40
VOXELS, QUICK_VOXELS = 128, 48
SIZE, QUICK_SIZE = 256, 96
RADIUS = 12.0  # mm of a ray


def openness(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Yield records of ambient occlusion by so many rays, beside a rule of directions whose rays end at exact roots."""
    voxels = QUICK_VOXELS if options.quick else VOXELS
    for number, (name, (make, value, away)) in enumerate(SETS.items()):
        data = f"{voxels}³ {name}, occlusion"
        part = options.share(1.0 / (len(SETS) - number))
        if not part.lasts(data):
            continue
        picture = _Picture(ctx, make(voxels), value, away, QUICK_SIZE if options.quick else SIZE)
        try:
            at, truth = picture.exact(QUICK_PIXELS if options.quick else PIXELS)
            part.budget = part.budget.share()  # the reference is no measurement
            timed = Comparison(data, part, turns_of(ctx))
            for samples in QUICK_SAMPLES if options.quick else SAMPLES:
                for smooth in (False, True):
                    method, setting = "rays, smoothed" if smooth else "rays", f"{samples} rays"
                    if not timed.allows(f"{method}, {setting}"):
                        continue
                    bias = picture.openness(samples, smooth)[at[:, 0], at[:, 1]] - truth
                    off = np.abs(bias)
                    record = Record(
                        data=data,
                        group="occlusion",
                        approximation="ambient occlusion",
                        method=method,
                        setting=setting,
                        errors={
                            "openness rms": Figure(float(np.sqrt((off**2).mean())), "of 1"),
                            "openness p99": Figure(float(np.quantile(off, 0.99)), "of 1"),
                            "openness mean": Figure(float(off.mean()), "of 1"),
                            "openness max": Figure(float(off.max()), "of 1"),
                            "openness bias": Figure(float(bias.mean()), "of 1"),
                        },
                        ours=True,
                    )
                    timed.add(record, occlusion=picture.drawing(samples, smooth))
            yield from timed.finish()
            for samples in QUICK_SAMPLES if options.quick else SAMPLES:
                chance = Figure(float(np.sqrt(np.mean(truth * (1.0 - truth)) / samples)), "of 1")
                yield Record(
                    data, "occlusion", "ambient occlusion", "independent rays, by chance", f"{samples} rays",
                    {"openness rms": chance},
                )  # fmt: skip
        finally:
            picture.release()


class _Picture:
    """A surface in a G-buffer, and the pass that finds how open it is."""

    def __init__(
        self, ctx: moderngl.Context, volume: RaycastVolume, value: float, away: tuple[float, float, float], side: int
    ) -> None:
        from pvfiblets.engine import View
        from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
        from pvfiblets.engine.volumes.ray_occlusion import RayOcclusionPass

        self._ctx, self._volume, self._value = ctx, volume, value
        self._casting = RaycastOptions(values=(value,))
        self._view = View((side, side), seen_from(volume, (side, side), away))
        self._renderer, self._pass = VolumeRenderer(ctx, volume), RayOcclusionPass(ctx)
        self._buffer = self._renderer.render(self._view, VolumeStyle(casting=self._casting))

    def exact(self, count: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float64]]:
        """Return rows and columns, ``(n, 2)``, of so many pixels at most that show the surface, and how open it is."""
        from pvfiblets.engine.gbuffer import EMPTY

        width, height = self._view.size
        shown = np.frombuffer(self._buffer.depth.read(), np.uint32).reshape(height, width) != EMPTY
        through = reference.rays(self._view.model_view_projection, self._view.size, self._volume)
        at = sample(shown, count)
        at = at[np.isfinite(reference.isosurface(self._volume, self._value, through[at[:, 0], at[:, 1]]).t)]
        rays = through[at[:, 0], at[:, 1]]
        hits = reference.isosurface(self._volume, self._value, rays)
        return at, exact_openness(self._volume, self._value, rays, hits.gradient, hits.t, RADIUS)

    def openness(self, samples: int, smooth: bool) -> npt.NDArray[np.float64]:
        """Return the pass's picture, ``(height, width)``, from 0 to 1."""
        width, height = self._view.size
        counts = np.frombuffer(self._draw(samples, smooth).read(), np.float16).reshape(height, width)
        return counts.astype(np.float64) / samples

    def drawing(self, samples: int, smooth: bool) -> Any:
        """Return what runs the pass."""
        return lambda: self._draw(samples, smooth)

    def _draw(self, samples: int, smooth: bool) -> moderngl.Texture:
        texture = self._pass.draw(
            self._renderer, self._buffer, self._casting, self._view,
            radius=RADIUS, samples=samples, seed=0, smooth=smooth,
        )  # fmt: skip
        self._ctx.finish()
        return texture

    def release(self) -> None:
        """Give everything back."""
        self._pass.release()
        self._renderer.release()
