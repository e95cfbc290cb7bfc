"""Synthetic tractograms with the turns of four tracking algorithms, at any step.

All follow the streamlines of :mod:`.tracking`, whose steps are constant. What differs is how directions change from
point to point, which is what a codec of directions meets:

==========  ============================================================================================================
algorithm   directions
==========  ============================================================================================================
iFOD1       a random turn at every step, 4 degrees per axis at 0.2 mm and in proportion to the step's root otherwise
iFOD2       the same turns taken along arcs: a point's tangent is shared by the arcs at both sides, chords are shorter
            than their arcs, and so steps vary a little
SD_STREAM   a smooth field's turns: no noise, only bends
EuDX        four fifths of a direction constant within a voxel of 2 mm: its peak counts until the next voxel's does
==========  ============================================================================================================

Source: Tournier et al., "MRtrix: diffusion tractography in crossing fiber regions" (2012), "Improved probabilistic
streamlines tractography by 2nd order integration" (2010); Garyfallidis et al., "Quickbundles" (2012), on EuDX.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pvfiblets.streamlines import Streamlines

from .tracking import brain_streamlines

ALGORITHMS = ("iFOD1", "iFOD2", "SD_STREAM", "EuDX")

NOISE, NOISE_STEP = 4.0, 0.2  # degrees per axis of a probabilistic tracker's turns, at a step in mm

VOXEL = 2.0  # mm
HELD = 0.8  # share of a direction that is that of the voxel; turns are then as sharp as in EuDX of a real brain

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def tracked_streamlines(algorithm: str, n_streamlines: int, step: float, seed: int = 0) -> Streamlines:
    """Make a whole-brain-like tractogram that turns as one of an algorithm does."""
    if algorithm not in ALGORITHMS:
        raise ValueError(f"algorithm is {algorithm!r}; choose one of {', '.join(ALGORITHMS)}")
    noise = NOISE * (step / NOISE_STEP) ** 0.5 if algorithm.startswith("iFOD") else 0.0
    made = brain_streamlines(n_streamlines, step, seed, noise=noise)
    if algorithm == "iFOD2":
        return _integrated(made)
    if algorithm == "EuDX":
        return _integrated(made, VOXEL)
    return Streamlines(made.points, made.offsets)


def _integrated(made: Streamlines, voxel: float | None = None) -> Streamlines:
    """Walk the streamlines anew, from their first points, by arcs, or by directions of voxels."""
    points, offsets = np.asarray(made.points, np.float64), np.asarray(made.offsets, np.int64)
    lengths = np.diff(offsets)
    lasts = offsets[1:] - 1
    tangents = np.diff(points, axis=0, append=points[-1:])
    tangents[lasts] = tangents[np.maximum(lasts - 1, offsets[:-1])]  # of a last point, the run before
    runs = _chords(tangents, lasts) if voxel is None else _held(points, tangents, lasts, voxel)
    walked = np.zeros_like(points)
    np.cumsum(runs[:-1], axis=0, out=walked[1:])
    first = offsets[:-1]
    return Streamlines((walked - np.repeat(walked[first] - points[first], lengths, axis=0)).astype(np.float32), offsets)


def _chords(tangents: Array, lasts: Ints) -> Array:
    """Chords of arcs as long as the steps, from each point's tangent to the next one's."""
    step = np.linalg.norm(tangents, axis=1, keepdims=True)
    here = tangents / np.maximum(step, 1e-12)
    after = np.roll(here, -1, axis=0)
    after[lasts] = here[lasts]
    middle = here + after
    half = np.arctan2(np.linalg.norm(after - here, axis=1), np.linalg.norm(middle, axis=1))[:, None]
    return step * np.sinc(half / np.pi) * middle / np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-12)


def _held(points: Array, tangents: Array, lasts: Ints, voxel: float) -> Array:
    """Runs whose direction is mostly the direction in which the point's voxel was entered."""
    voxels = np.floor(points / voxel).astype(np.int64)
    enters = np.ones(len(points), bool)
    enters[1:] = (voxels[1:] != voxels[:-1]).any(axis=1)
    enters[lasts[:-1] + 1] = True
    entered = np.flatnonzero(enters)
    held = tangents[entered[np.cumsum(enters) - 1]]
    mixed = HELD * held + (1.0 - HELD) * tangents
    step = np.linalg.norm(tangents, axis=1, keepdims=True)
    return step * mixed / np.maximum(np.linalg.norm(mixed, axis=1, keepdims=True), 1e-12)
