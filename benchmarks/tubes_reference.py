"""What a picture of spline tubes should cover, and how far one is from that.

The reference is a fine mesh of the volume that the spheres sweep, drawn by VTK: the circles in which each sphere
touches the envelope of all (they lie ahead of its middle where the radius shrinks, and behind where it grows), and
spheres where a tube ends. It strays from the surface by less than a twentieth of a pixel of its own picture.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from pvfiblets.report.cameras import VERTICAL_ANGLE, Camera
from pvfiblets.report.studies.codec.baselines.tessellated import across
from pvfiblets.report.studies.tubes.pictures import outline

SIDES = (16, 32, 64, 128)
STEPS = (2, 4, 8, 16)
FINE = 0.05  # pixels of the reference's own picture
BATCH = 6_000_000  # triangles that VTK holds at a time


def covered(plotter: Any) -> np.ndarray:
    """Return where a plotter's picture shows anything: (height, width) bool, the bottom row first."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkFloatArray

    width, height = plotter.render_window.GetSize()
    depth = vtkFloatArray()
    plotter.render_window.GetZbufferData(0, 0, width - 1, height - 1, depth)
    return vtk_to_numpy(depth).reshape(height, width) < 1.0


@dataclass(frozen=True, eq=False)
class Reference:
    """What a picture should cover.

    Attributes
    ----------
    same_size : numpy.ndarray
        ``(height, width)`` bool: pixels whose middle is covered.
    shares : numpy.ndarray
        ``(height, width)`` float32: share of each pixel that is covered, of its supersampled picture.
    length : float
        Of the silhouette, in pixels of the picture.
    """

    same_size: np.ndarray
    shares: np.ndarray
    length: float

    def compare(self, shown: np.ndarray) -> dict[str, float]:
        """Return how far a picture's silhouette is from this one.

        Parameters
        ----------
        shown : numpy.ndarray
            ``(height, width)`` bool: pixels whose middle the picture covers.

        Returns
        -------
        dict
            ``silhouette``: its length in pixels; ``differing``: pixels whose middle lies between the two silhouettes;
            ``off_pixels``: these per pixel of length, which is the mean distance between the silhouettes, for the
            middles are samples of the area between them; ``gross``: per pixel of length, pixels shown that the tubes do
            not touch, or not shown though they fill them.
        """
        differing = int((shown != self.same_size).sum())
        gross = int((shown & (self.shares == 0.0)).sum() + (~shown & (self.shares == 1.0)).sum())
        length = max(self.length, 1.0)
        return {
            "silhouette": self.length, "differing": differing, "off_pixels": differing / length, "gross": gross / length
        }  # fmt: skip


def supersampled(same_size: np.ndarray, fine: np.ndarray) -> Reference:
    """Return the reference of a picture, given at its size and at a multiple of it."""
    height, width = same_size.shape
    times = fine.shape[0] // height
    shares = fine.reshape(height, times, width, times).mean(axis=(1, 3), dtype=np.float32)
    return Reference(same_size, shares, outline(fine) / times)


def fine_coverage(tubes: Any, camera: Camera, times: int) -> Reference:
    """Draw the reference, at the camera's size and ``times`` as large."""
    import pyvista as pv

    plotters = []
    for n in (1, times):
        plotter = pv.Plotter(off_screen=True, window_size=[n * side for side in camera.size], lighting="none")
        plotter.disable_anti_aliasing()
        plotter.show(auto_close=False)
        plotters.append(plotter)
    pictures = [np.zeros([n * side for side in camera.size[::-1]], bool) for n in (1, times)]
    # A mesh that is fine enough for the larger picture is so for the smaller one.
    for mesh in fine_meshes(tubes, camera, times * camera.pixels):
        for plotter, picture in zip(plotters, pictures, strict=True):
            actor = plotter.add_mesh(mesh, color="white", lighting=False, reset_camera=False, render=False)
            camera.aim(plotter)
            plotter.render()
            picture |= covered(plotter)
            plotter.remove_actor(actor, render=False)
    for plotter in plotters:
        plotter.close()
    return supersampled(*pictures)


def fine_meshes(tubes: Any, camera: Camera, pixels: float) -> Iterator[Any]:
    """Yield the reference as meshes of at most about :data:`BATCH` triangles, without what is out of the picture."""
    import pyvista as pv

    from pvfiblets.tubes import curves

    gathered: list[tuple[np.ndarray, np.ndarray]] = []
    triangles = 0

    def mesh() -> Any:
        offsets = np.cumsum([0, *(len(points) for points, _ in gathered)])
        faces = np.concatenate([faces + offset for (_, faces), offset in zip(gathered, offsets, strict=False)])
        return pv.PolyData.from_regular_faces(np.concatenate([points for points, _ in gathered]), faces)

    ends = ~joined(tubes)
    for first in range(0, tubes.n_segments, 1 << 16):
        chosen = np.arange(first, min(first + (1 << 16), tubes.n_segments))
        halves = curves.controls(tubes, chosen)
        spheres = np.concatenate([halves[ends[chosen, 0], 0, 0], halves[ends[chosen, 1], 1, 2]])
        pieces = [(halves.reshape(-1, 3, 4), _strips), (np.repeat(spheres[:, None], 3, axis=1), _spheres)]
        for controls, build in pieces:
            sides, steps = _fineness(controls, camera, pixels)
            for count in SIDES:
                for along in STEPS:
                    some = controls[(sides == count) & (steps == along)]
                    each = 2 * count * (along if build is _strips else count // 2)
                    for start in range(0, len(some), block := max(1, BATCH // each)):
                        part = build(some[start : start + block], count, along)
                        if triangles + len(part[1]) > BATCH and gathered:
                            yield mesh()
                            gathered, triangles = [], 0
                        gathered.append(part)
                        triangles += len(part[1])
    if gathered:
        yield mesh()


def joined(tubes: Any) -> np.ndarray:
    """Return which ends of segments, (n_segments, 2), another segment goes on from smoothly: by its node, onwards."""
    starts = np.bincount(tubes.segments[:, 0], minlength=tubes.n_nodes)
    stops = np.bincount(tubes.segments[:, 1], minlength=tubes.n_nodes)
    # Spheres that swallow their neighbours change the envelope faster than their circles follow.
    slopes = np.linalg.norm(tubes.tangents, axis=1) > 2.0 * np.abs(tubes.radius_slopes)
    return np.stack([(stops > 0) & slopes, (starts > 0) & slopes], axis=1)[tubes.segments, [0, 1]] & (
        tubes.segments[:, :1] != tubes.segments[:, 1:]
    )


def _fineness(controls: np.ndarray, camera: Camera, pixels: float) -> tuple[np.ndarray, np.ndarray]:
    """Return sides and steps that each half needs, (n,); 0 for those outside of the picture."""
    matrix = camera.world_to_camera
    place = controls[..., :3] @ matrix[:3, :3].T + matrix[:3, 3]
    depth, reach = -place[..., 2], controls[..., 3]
    slant = math.tan(math.radians(VERTICAL_ANGLE / 2))
    outside = np.all(depth + reach < camera.near, axis=1)
    for axis, edge in ((0, slant * camera.size[0] / camera.size[1]), (1, slant)):
        for sign in (1.0, -1.0):
            outside |= np.all(edge * depth + sign * place[..., axis] < -reach * math.hypot(1.0, edge), axis=1)
    scale = pixels / np.maximum((depth - reach).min(axis=1), camera.near)
    radius = np.maximum(scale * reach.max(axis=1), FINE)
    sides = np.pi / np.arccos(1.0 - FINE / radius)
    bend = 2.0 * np.linalg.norm(controls[:, 0] - 2.0 * controls[:, 1] + controls[:, 2], axis=1)
    steps = np.sqrt(scale * bend / (8.0 * FINE))
    found = [
        np.array((0, *choices))[1 + np.minimum(np.searchsorted(choices, need), len(choices) - 1)]
        for choices, need in ((SIDES, sides), (STEPS, steps))
    ]
    return tuple(np.where(outside, 0, many) for many in found)


def _strips(controls: np.ndarray, sides: int, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points and triangles of the envelope of halves."""
    from pvfiblets.tubes import curves

    t = np.linspace(0.0, 1.0, steps + 1)
    place, slope = (f(controls[:, None], t) for f in (curves.evaluate, curves.derivative))
    speed = np.linalg.norm(slope[..., :3], axis=2, keepdims=True)
    chord = controls[:, 2, :3] - controls[:, 0, :3]
    length = np.linalg.norm(chord, axis=1, keepdims=True)
    chord = np.where(length > 0.0, chord / np.maximum(length, 1e-300), [1.0, 0.0, 0.0])
    tangent = np.where(speed > 0.0, slope[..., :3] / np.maximum(speed, 1e-300), chord[:, None])
    growth = np.divide(slope[..., 3:], speed, out=np.zeros(speed.shape), where=speed > 0.0).clip(-1.0, 1.0)
    normal = np.empty(tangent.shape)
    normal[:, 0] = across(tangent[:, 0])
    for i in range(1, steps + 1):
        carried = normal[:, i - 1] - tangent[:, i] * np.einsum("ij,ij->i", normal[:, i - 1], tangent[:, i])[:, None]
        size = np.linalg.norm(carried, axis=1, keepdims=True)
        normal[:, i] = np.where(size > 1e-6, carried / np.maximum(size, 1e-300), across(tangent[:, i]))
    binormal = np.cross(tangent, normal)
    middle = place[..., :3] - place[..., 3:] * growth * tangent
    radius = place[..., 3:] * np.sqrt(1.0 - growth**2) * _wider(sides)
    turn = 2.0 * np.pi * np.arange(sides) / sides
    circle = np.cos(turn)[:, None] * normal[:, :, None] + np.sin(turn)[:, None] * binormal[:, :, None]
    points = middle[:, :, None] + radius[:, :, None] * circle
    return _grid(points)


def _spheres(controls: np.ndarray, sides: int, _: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points and triangles of spheres: circles of latitude, the poles included."""
    turn, tilt = 2.0 * np.pi * np.arange(sides) / sides, np.pi * np.arange(sides // 2 + 1) / (sides // 2)
    unit = np.stack(
        np.broadcast_arrays(
            np.sin(tilt)[:, None] * np.cos(turn), np.sin(tilt)[:, None] * np.sin(turn), np.cos(tilt)[:, None]
        ),
        axis=2,
    )
    return _grid(controls[:, 0, None, None, :3] + controls[:, 0, None, None, 3:] * _wider(sides) * unit)


def _wider(sides: int) -> float:
    """Return what a polygon's radius is multiplied with to be as wide as its circle, as a mean of all directions."""
    return (math.pi / sides) / math.sin(math.pi / sides)


def _grid(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return points, (n, rings, sides, 3), as rows, and the triangles between the rings."""
    n, rings, sides, _ = points.shape
    corner = np.arange(rings * sides).reshape(rings, sides)
    beside = np.roll(corner, -1, axis=1)
    low, high, low_beside, high_beside = corner[:-1], corner[1:], beside[:-1], beside[1:]
    quads = np.stack([low, low_beside, high_beside, low, high_beside, high], axis=2).reshape(-1, 3)
    faces = (quads[None] + (np.arange(n) * rings * sides)[:, None, None]).reshape(-1, 3)
    return points.reshape(-1, 3).astype(np.float32), faces
