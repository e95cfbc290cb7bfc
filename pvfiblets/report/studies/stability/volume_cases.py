"""Volumes that are hardly any, steep transfer functions and odd cameras: rays see what float64 sees."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pvfiblets.engine import View
from pvfiblets.engine.gbuffer import EMPTY
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

from ..volumes import reference
from ..volumes.fields import DENSE, field, tables
from ..volumes.pictures import light_of
from ..volumes.reference_rays import rays
from .case import Cases, Outcome, Setting, refused, worst
from .render_checks import Array, camera

__all__ = ["CASES"]

CASES = Cases("volumes", draws=True)
SIZE = (48, 36)
STEP = 0.5  # voxels
HUNDREDTH = 1e-2  # what 'adaptive' keeps to by default, 8 bits of colour and opacity included
LIGHT = "of full light"
DEPTH = "voxels"
ON_SURFACE = "surfaces within 0.02 voxels of those in float64, wherever a ray is surely on one"
AS_DEEP = "surfaces where they are in float64, as deep as 24 bits of depth can tell"
NEAR = 0.02


@dataclass(frozen=True, eq=False)
class Cast:
    """Contents of a volume's picture, ``(height, width, …)``."""

    there: npt.NDArray[np.bool_]
    depth: Array
    value: Array
    light: Array

    @property
    def sound(self) -> bool:
        """Whether all numbers are finite and light is within its range."""
        return bool(np.isfinite(self.value[self.there]).all() and (self.light >= 0).all() and (self.light <= 1).all())


def cast(
    setting: Setting, volume: RaycastVolume, casting: RaycastOptions, matrix: Array, size: tuple[int, int] = SIZE
) -> Cast:
    """Draw one picture."""
    renderer = VolumeRenderer(setting.gl, volume)
    try:
        buffer = renderer.render(View(size, matrix), VolumeStyle(casting=casting))
        key = np.frombuffer(buffer.depth.read(), "<u4").reshape(size[::-1])
        there = key != EMPTY
        value = np.frombuffer(buffer.position.read(), "<f4").reshape(*size[::-1], 2)[..., 1].astype(np.float64)
        light = np.zeros((*size[::-1], 4)) if buffer.colours is None else light_of(buffer)
        return Cast(there, np.where(there, key / 4294967295.0, 1.0), value, light)
    finally:
        renderer.release()


def ball(n: int = 16, affine: npt.ArrayLike | None = None) -> RaycastVolume:
    """A field that falls from the middle to the corners, from 1 to 0."""
    return RaycastVolume(field("ball", n).values, np.eye(4) if affine is None else np.asarray(affine, np.float64))


def looking_at(volume: RaycastVolume) -> Array:
    """Return a camera that has all of a volume in view."""
    bounds = np.array(volume.bounds).reshape(3, 2)
    middle, reach = bounds.mean(axis=1), float(np.ptp(bounds, axis=1).max())
    eye = middle + 1.9 * reach * np.array([0.53, -0.71, 0.40]) / np.linalg.norm([0.53, -0.71, 0.40])
    return camera(SIZE, eye=eye, target=middle, near=0.02 * reach, far=6.0 * reach)


def surface(
    setting: Setting, volume: RaycastVolume, value: float, matrix: Array, size: tuple[int, int] = SIZE
) -> Outcome:
    """Compare an isosurface with float64: depths in the least voxel spacings; missed or invented surfaces are inf."""
    shown = cast(setting, volume, RaycastOptions(values=(value,), step=0.25, iterations=8), matrix, size)
    through = rays(matrix, size, volume)
    wanted = reference.isosurface(volume, value, through)
    voxel = float(volume.spacing.min())
    there = wanted.value >= 0
    sure = ~(wanted.chord < 0.5 * voxel)  # parts thinner than two steps may be stepped over
    wrong = (shown.there != there) & sure
    if not shown.sound or wrong.mean() > 0.002 or not (there & sure).any():
        return Outcome(np.inf, NEAR, DEPTH, f"{int(wrong.sum())} pixels are wrong")
    both = shown.there & there & sure
    per_voxel = np.abs(through.depth(wanted.t + 1e-3 * voxel) - wanted.depth)[both] * 1e3
    rounding = 2.0**-24 * np.maximum(1.0, wanted.depth[both])
    off = np.maximum(np.abs(shown.depth - wanted.depth)[both] - rounding, 0.0) / per_voxel
    return Outcome(float(np.quantile(off, 0.98)), NEAR, DEPTH, f"{int(both.sum())} pixels")


def steep(name: str, kappa_step: float) -> Transfer:
    """Return a table whose largest extinction times a step is a number."""
    return Transfer(tables()[name].astype(np.float32), (0.0, 1.0), -STEP * np.log1p(-DENSE) / kappa_step)


@CASES.add(
    "κΔ from 1e-3 to 1e3",
    "a ramp, an edge, a one-entry peak and sixteen of them, from thin to dense",
    "light within a hundredth of the integral in float64, in every pixel",
    long=True,
)
def _steep(setting: Setting) -> Outcome:
    volume = ball()
    matrix = looking_at(volume)
    through, found = rays(matrix, SIZE, volume), []
    for name in tables():
        for kappa_step in (1e-3, 0.1, 10.0, 1e3):
            transfer = steep(name, kappa_step)
            shown = cast(
                setting, volume, RaycastOptions("composite", transfer=transfer, step=STEP, stop=0.9999), matrix
            )
            off = float(np.abs(shown.light - reference.composite(volume, transfer, through)).max())
            found.append(Outcome(off if shown.sound else np.inf, HUNDREDTH, LIGHT, f"{name}, κΔ {kappa_step:g}"))
    return worst(found)


@CASES.add(
    "one-entry peaks on noise",
    "voxels at random, κΔ of 0.01, 1 and 100",
    "light within a hundredth of the integral in float64, but for 2 pixels in 1,000",
)
def _noise(setting: Setting) -> Outcome:
    volume = RaycastVolume(np.random.default_rng(0).random((16, 16, 16)).astype(np.float32), np.eye(4))
    matrix = looking_at(volume)
    through, found = rays(matrix, SIZE, volume), []
    for kappa_step in (1e-2, 1.0, 100.0):
        transfer = steep("peak", kappa_step)
        shown = cast(setting, volume, RaycastOptions("composite", transfer=transfer, step=STEP, stop=0.9999), matrix)
        off = np.abs(shown.light - reference.composite(volume, transfer, through)).max(axis=-1)
        found.append(Outcome(1e3 * float((off > HUNDREDTH).mean()), 2.0, "pixels in 1,000", f"κΔ {kappa_step:g}"))
    return worst(found)


@CASES.add(
    "edges within a volume",
    "voxels of 0 and 1 alone, a ramp, κΔ of 0.1 and 1",
    "light within a hundredth of the integral in float64, in every pixel",
)
def _edges(setting: Setting) -> Outcome:
    volume = RaycastVolume((np.asarray(ball().values) > 0.5).astype(np.float32), np.eye(4))
    matrix = looking_at(volume)
    through, found = rays(matrix, SIZE, volume), []
    for kappa_step in (0.1, 1.0):
        transfer = steep("ramp", kappa_step)
        shown = cast(setting, volume, RaycastOptions("composite", transfer=transfer, step=STEP, stop=0.9999), matrix)
        off = float(np.abs(shown.light - reference.composite(volume, transfer, through)).max())
        found.append(Outcome(off, HUNDREDTH, LIGHT, f"κΔ {kappa_step:g}"))
    return worst(found)


@CASES.add("2 × 2 × 2 voxels", "one cell; the fewest voxels that there may be", ON_SURFACE)
def _cell(setting: Setting) -> Outcome:
    values = np.array([[[0.0, 1.0], [0.2, 0.9]], [[0.1, 0.8], [0.4, 0.7]]], np.float32)
    volume = RaycastVolume(values, np.eye(4))
    return surface(setting, volume, 0.5, looking_at(volume))


@CASES.add("one voxel", "1 × 1 × 1, 1 × 9 × 9 and no voxels", "an error that asks for two along each axis", draws=False)
def _one(_: Setting) -> Outcome:
    calls = [
        lambda shape=shape: RaycastVolume(np.zeros(shape, np.float32)) for shape in ((1, 1, 1), (1, 9, 9), (0, 4, 4))
    ]
    return refused(ValueError, "two|2|no voxels; give some", *calls)


@CASES.add("voxels of 1 : 1000", "spacings of 1 × 1 × 1000 mm, and of 1000 × 1 × 1 mm, across and along", ON_SURFACE)
def _anisotropic(setting: Setting) -> Outcome:
    found = []
    for spacing in ((1.0, 1.0, 1000.0), (1000.0, 1.0, 1.0)):
        volume = ball(16, np.diag([*spacing, 1.0]))
        middle = np.array(volume.bounds).reshape(3, 2).mean(axis=1)
        # Across the long axis, so near that the short ones fill the picture.
        eye = middle + (np.array([30.0, -40.0, 200.0]) if spacing[2] > 1.0 else np.array([200.0, -40.0, 30.0]))
        found.append(surface(setting, volume, 0.5, camera(SIZE, eye=eye, target=middle, near=1.0, far=3e4)))
    # All along 90 voxels of 1000 mm: 90,000 of the shortest, more than software OpenGL's loops turn.
    values = np.broadcast_to(np.linspace(0.0, 1.0, 90)[:, None, None], (90, 5, 5)).astype(np.float32)
    volume = RaycastVolume(values, np.diag([1000.0, 1.0, 1.0, 1.0]))
    few = (8, 6)
    aim = camera(few, eye=(-2e4, 2.0, 2.0), target=(0.0, 2.0, 2.0), near=1e4, far=2e5, height=6.0)
    return worst([*found, surface(setting, volume, 0.9, aim, few)])


@CASES.add(
    "a constant volume", "all voxels 0.5: surfaces at 0.5 and beside it, light, the greatest value", "as formulas say"
)
def _constant(setting: Setting) -> Outcome:
    volume = RaycastVolume(np.full((9, 9, 9), 0.5, np.float32), np.eye(4))
    matrix = looking_at(volume)
    through = rays(matrix, SIZE, volume)
    hit = ~np.isnan(through.near)
    surfaces = [cast(setting, volume, RaycastOptions(values=(v,)), matrix).there.sum() for v in (0.5, 0.4, 0.6)]
    alpha = 0.2  # of a unit, 1 mm
    transfer = Transfer(np.tile([1.0, 0.5, 0.25, alpha], (4, 1)), (0.0, 1.0), 1.0)
    light = cast(setting, volume, RaycastOptions("composite", transfer=transfer, stop=1.0), matrix).light[..., 3]
    chord = np.where(hit, through.far - through.near, 0.0)
    peak = cast(setting, volume, RaycastOptions("mip"), matrix)
    off = max(
        float(np.abs(light - (1.0 - (1.0 - alpha) ** chord)).max()),
        float(np.abs(peak.value[peak.there] - 0.5).max()),
        float((peak.there != hit)[(chord > 0.5) | ~hit].sum()),
        float(sum(surfaces)),
    )
    return Outcome(off, HUNDREDTH, LIGHT)


@CASES.add("offsets of ±1e7 mm", "volume and camera moved by 1e7 mm either way", ON_SURFACE)
def _far_away(setting: Setting) -> Outcome:
    found = []
    for shift in (1e7, -1e7):
        affine = np.eye(4)
        affine[:3, 3] = shift
        volume = ball(16, affine)
        found.append(surface(setting, volume, 0.5, looking_at(volume)))
    return worst(found)


@CASES.add("voxels of 1e-6 and of 1e6 mm", "volume and camera scaled", ON_SURFACE)
def _sizes(setting: Setting) -> Outcome:
    volumes = [ball(16, np.diag([size] * 3 + [1.0])) for size in (1e-6, 1e6)]
    return worst([surface(setting, volume, 0.5, looking_at(volume)) for volume in volumes])


@CASES.add("near plane at a millionth of the far", "the eye outside, inside, and exactly on a voxel", AS_DEEP)
def _near(setting: Setting) -> Outcome:
    volume = ball()
    eyes = (np.array([30.0, -28.0, 20.0]), np.array([2.3, 1.7, 3.1]), np.array([2.0, 2.0, 3.0]))
    return worst(
        [
            surface(setting, volume, 0.5, camera(SIZE, eye=eye, target=(7.5, 7.5, 7.5), near=1e-4, far=100.0))
            for eye in eyes
        ]
    )


@CASES.add("rays along cells' faces", "parallel rays along an axis, on the planes between cells", ON_SURFACE)
def _faces(setting: Setting) -> Outcome:
    volume = ball(17)
    size = (16, 16)
    matrix = camera(size, eye=(8.0, -40.0, 8.0), target=(8.0, 8.0, 8.0), near=1.0, far=100.0, height=16.0)
    shift = np.eye(4)
    shift[:2, 3] = 1.0 / 16.0  # half a pixel: pixel centres come to lie on whole voxels
    return surface(setting, volume, 0.5, shift @ matrix, size)


@CASES.add("windows of 1 × 1 and 1 × 40", "the middle of a ball", ON_SURFACE)
def _small(setting: Setting) -> Outcome:
    volume = ball()
    return worst(
        [
            surface(
                setting,
                volume,
                0.5,
                camera(s, eye=(30, -28, 20), target=(7.5, 7.5, 7.5), near=1, far=99, angle=20.0),
                s,
            )
            for s in ((1, 1), (1, 40))
        ]
    )


@CASES.add("voxels that are no numbers", "NaN and both infinities among voxels", "finite pictures; NaN counted")
def _holes(setting: Setting) -> Outcome:
    values = np.array(ball().values)
    values[::3, ::2, ::5], values[1, 1, 1], values[2, 2, 2] = np.nan, np.inf, -np.inf
    volume = RaycastVolume(values, np.eye(4))
    wrong = abs(volume.n_missing - int(np.isnan(values).sum()))
    matrix = looking_at(volume)
    transfer = steep("ramp", 1.0)
    for casting in (
        RaycastOptions(values=(0.5,)),
        RaycastOptions("mip"),
        RaycastOptions("composite", transfer=transfer),
    ):
        shown = cast(setting, volume, casting, matrix)
        wrong += 0 if shown.sound and shown.there.any() else 1
    return Outcome(float(wrong), 0.0, "wrong pictures and counts")


@CASES.add("values of 1e-20 and 1e30", "the ball's values scaled", ON_SURFACE)
def _values(setting: Setting) -> Outcome:
    found = []
    for scale in (1e-20, 1e30):
        volume = RaycastVolume(ball().values * np.float32(scale), np.eye(4))
        found.append(surface(setting, volume, 0.5 * scale, looking_at(volume)))
    return worst(found)


@CASES.add(
    "values that float32 cannot tell apart",
    "a range of 1e-40, values of 1e39, a singular affine, complex voxels",
    "an error each",
    draws=False,
)
def _no_values(_: Setting) -> Outcome:
    some = np.asarray(ball().values, np.float64)
    flat = np.diag([1.0, 1.0, 0.0, 1.0])
    return refused(
        ValueError,
        "range|float32|invertible|affine|complex|numbers",
        lambda: RaycastVolume((some * 1e-40).astype(np.float32)),
        lambda: RaycastVolume(some * 1e39),
        lambda: RaycastVolume(some, flat),
        lambda: RaycastVolume(some * 1j),
    )


@CASES.add(
    "steps of 1e-2 and of 1e3 voxels", "very short and very long steps, in all modes", "finite, light within 0 to 1"
)
def _long_steps(setting: Setting) -> Outcome:
    volume = ball()
    matrix, wrong = looking_at(volume), 0
    for step in (1e-2, 1e3):
        for casting in (
            RaycastOptions(values=(0.5,), step=step),
            RaycastOptions("mip", step=step),
            RaycastOptions("composite", transfer=steep("ramp", 1.0), step=step),
        ):
            wrong += not cast(setting, volume, casting, matrix).sound
    return Outcome(float(wrong), 0.0, "wrong pictures")


@CASES.add("tables of nothing and of everything", "opacity 0 everywhere; opacity 1 everywhere", "empty; all opaque")
def _opaque(setting: Setting) -> Outcome:
    volume = ball()
    matrix = looking_at(volume)
    through = rays(matrix, SIZE, volume)
    inside = np.nan_to_num(through.far - through.near) > 1.0
    clear, solid = (Transfer(np.full((2, 4), opacity, np.float32), (0.0, 1.0), 1.0) for opacity in (0.0, 1.0))
    none = cast(setting, volume, RaycastOptions("composite", transfer=clear), matrix).light.max()
    full = cast(setting, volume, RaycastOptions("composite", transfer=solid), matrix).light[..., 3][inside]
    return Outcome(float(max(none, (1.0 - full).max())), HUNDREDTH, LIGHT)
