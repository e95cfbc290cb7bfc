"""Surfaces cut by regions: the triangles inside, with the triangles at the region's border cut along it.

A border is followed by straight pieces. Triangles near a shape are first divided until their edges are short beside
it, so that a ball through the middle of a large triangle cuts a round hole. Where an edge crosses the border is found
by halving. Marching over triangles as in Lorensen and Cline 1987, "Marching cubes", one dimension lower.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

PIECES = 16  # edges that a shape's shortest side is divided into; a ball's border is then off by a 500th of its radius
LEAST = 64  # no edge is divided below this part of a shape's longest side, however thin it is
MOST = 2_000_000  # triangles; from there on none is divided further
HALVINGS = 30

Floats = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int64]


def cut_surface(surface: Any, region: Any) -> pv.PolyData:
    """Return the part of a surface that lies in a region."""
    from pvfiblets.plotting.filtering.region_sources import as_region

    region = as_region(region)
    if surface.GetNumberOfPolys() + surface.GetNumberOfStrips() == 0:
        raise ValueError(f"the surface has {surface.n_points} points and no faces, so it cannot be cut")
    whole = surface if surface.is_all_triangles else surface.triangulate()
    names = list(whole.point_data.keys())
    columns = [np.asarray(whole.point_data[name], np.float64).reshape(whole.n_points, -1) for name in names]
    rows = np.column_stack([np.asarray(whole.points, np.float64), *columns])  # interpolated together
    faces = np.asarray(whole.regular_faces, np.int64)
    parents = np.arange(len(faces))
    for leaf in region.leaves:
        rows, faces, parents = _divided(rows, faces, parents, leaf)
    rows, faces, parents = _inside(rows, faces, parents, region)
    used, faces = np.unique(faces, return_inverse=True)
    return _built(whole, rows[used], faces.reshape(-1, 3), parents, names)


def _divided(rows: Floats, faces: Faces, parents: Faces, leaf: Any) -> tuple[Floats, Faces, Faces]:
    """Divide the triangles that the border of a shape may cross, each into four, until they are small beside it."""
    longest = _longest_edge(leaf)
    if not np.isfinite(longest):
        return rows, faces, parents
    while len(faces) < MOST:
        corners = rows[faces][:, :, :3]
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        large = np.flatnonzero(edges > longest)
        apart = leaf.apart(corners[large].reshape(-1, 3)).reshape(-1, 3)
        large = large[apart.min(axis=1) <= edges[large]]
        if not len(large):
            break
        ends, places = _edges(faces[large])
        middle = len(rows) + places.reshape(-1, 3)  # of the edges ab, bc, ca
        rows = np.concatenate([rows, 0.5 * (rows[ends[:, 0]] + rows[ends[:, 1]])])
        (a, b, c), (ab, bc, ca) = faces[large].T, middle.T
        four = [np.stack(part, axis=1) for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        faces = np.concatenate([np.delete(faces, large, axis=0), *four])
        parents = np.concatenate([np.delete(parents, large), np.tile(parents[large], 4)])
    return rows, faces, parents


def _longest_edge(leaf: Any) -> float:
    """Return how long edges near a shape may be, mm; infinite where straight pieces miss nothing."""
    from pvfiblets.regions import Plane, Slab

    if isinstance(leaf, Plane):
        return np.inf
    if isinstance(leaf, Slab):
        return 1.0 / float(np.linalg.norm(leaf.linear[2]))  # half as thick
    low, high = leaf.bounds[::2], leaf.bounds[1::2]
    sides = high - low
    return float(max(sides.min() / PIECES, sides.max() / LEAST))


def _edges(faces: Faces) -> tuple[Faces, Faces]:
    """Return the different edges of triangles, ``(n, 2)``, and of each triangle's ab, bc, ca which one it is, flat."""
    pairs = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    ends, places = np.unique(pairs, axis=0, return_inverse=True)
    return ends, places.reshape(-1)


def _inside(rows: Floats, faces: Faces, parents: Faces, region: Any) -> tuple[Floats, Faces, Faces]:
    """Keep the part in a region, and cut the triangles at its border."""
    held = region.contains(rows[:, :3])
    count = held[faces].sum(axis=1)
    found, owners = [faces[count == 3]], [parents[count == 3]]
    for inside in (1, 2):
        chosen = np.flatnonzero(count == inside)
        if not len(chosen):
            continue
        # Turned until the corner that differs from the other two comes first.
        odd = np.argmax(held[faces[chosen]] == (inside == 1), axis=1)
        a, b, c = np.take_along_axis(faces[chosen], (odd[:, None] + np.arange(3)) % 3, axis=1).T
        pairs = np.sort(np.stack([np.stack([a, b], axis=1), np.stack([a, c], axis=1)]).reshape(-1, 2), axis=1)
        ends, places = np.unique(pairs, axis=0, return_inverse=True)
        ab, ac = len(rows) + places.reshape(2, -1)
        rows = np.concatenate([rows, _crossings(rows, ends, held, region)])
        pieces = [(a, ab, ac)] if inside == 1 else [(b, c, ac), (b, ac, ab)]
        found += [np.stack(piece, axis=1) for piece in pieces]
        owners += [parents[chosen]] * len(pieces)
    return rows, np.concatenate(found), np.concatenate(owners)


def _crossings(rows: Floats, ends: Faces, held: npt.NDArray[np.bool_], region: Any) -> Floats:
    """Return where edges cross a region's border; one of the ends of each is inside."""
    first, last = rows[ends[:, 0]], rows[ends[:, 1]]
    low, high = np.zeros(len(ends)), np.ones(len(ends))
    begins = held[ends[:, 0]]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = region.contains(first[:, :3] + middle[:, None] * (last - first)[:, :3]) == begins
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray(first + (0.5 * (low + high))[:, None] * (last - first))


def _built(whole: pv.PolyData, rows: Floats, faces: Faces, parents: Faces, names: list[str]) -> pv.PolyData:
    if not len(faces):
        return pv.PolyData()
    made = pv.PolyData.from_regular_faces(rows[:, :3].astype(whole.points.dtype), faces)
    at = 3
    for name in names:
        before = np.asarray(whole.point_data[name])
        width = int(np.prod(before.shape[1:]))
        values = rows[:, at : at + width].reshape(len(rows), *before.shape[1:])
        at += width
        made.point_data[name] = (
            values.astype(before.dtype) if before.dtype.kind == "f" else _whole(values, before.dtype)
        )
    for name in whole.cell_data:
        made.cell_data[name] = np.asarray(whole.cell_data[name])[parents]
    for data, old in ((made.point_data, whole.point_data), (made.cell_data, whole.cell_data)):
        data.active_normals_name = old.active_normals_name
    name = whole.active_scalars_name
    if name is not None and name in made.array_names:
        made.set_active_scalars(name, preference=whole.active_scalars_info.association.name.lower())
    return made


def _whole(values: Floats, dtype: Any) -> np.ndarray:
    return np.rint(values).astype(dtype)
