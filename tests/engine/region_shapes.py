"""Regions of all kinds, made up, for the engine's tests."""

import numpy as np

from pvfiblets import regions


def torus(ring, tube, n=24, m=12):
    """Points and triangles of a closed torus about the z axis, facing outwards."""
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    across = ring + tube * np.cos(v)
    points = np.stack([across * np.cos(u), across * np.sin(u), tube * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    a, b = (i * m + j).ravel(), ((i + 1) % n * m + j).ravel()
    c, d = ((i + 1) % n * m + (j + 1) % m).ravel(), (i * m + (j + 1) % m).ravel()
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def blob(shape=(14, 11, 9), seed=0):
    """A label volume of a few lumps, 0 to 3."""
    rng = np.random.default_rng(seed)
    at = np.stack(np.meshgrid(*(np.arange(n) for n in shape), indexing="ij"), axis=-1)
    volume = np.zeros(shape, np.int16)
    for label in (1, 2, 3):
        centre = rng.uniform(0.2, 0.8, 3) * shape
        volume[np.linalg.norm(at - centre, axis=-1) < 3.0] = label
    return volume


def turn(axis, degrees):
    """4 x 4 rotation."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    k = np.cross(np.eye(3), -axis)
    found = np.eye(4)
    radians = np.radians(degrees)
    found[:3, :3] += np.sin(radians) * k + (1 - np.cos(radians)) * k @ k
    return found


def made(centre=(0.0, 0.0, 0.0), size=1.0):
    """Regions by name, about a centre; ``size`` is that of what they are for."""
    c, s = np.asarray(centre, float), float(size)
    place = np.eye(4)
    place[:3, 3] = c
    grow = np.diag([s, s, s, 1.0])
    shear = np.eye(4)
    shear[:3, :3] += [[0.0, 0.4, 0.0], [0.0, 0.3, 0.2], [0.1, 0.0, 0.0]]
    voxels = place @ grow @ turn((1, 2, 3), 25) @ np.diag([0.05, 0.06, 0.07, 1.0])
    voxels[:3, 3] -= voxels[:3, :3] @ [6.5, 5.0, 4.0]
    points, triangles = torus(0.3 * s, 0.12 * s)
    found = {
        "plane": regions.Plane((1, 2, -0.5), c),
        "slab": regions.Slab((0, 1, 1), c + 0.05 * s, 0.15 * s),
        "box": regions.Box(center=c, size=(0.5 * s, 0.3 * s, 0.4 * s)),
        "turned box": regions.Box(center=c, size=0.4 * s, rotation=turn((1, 1, 0), 30)[:3, :3]),
        "sphere": regions.Sphere(c + 0.1 * s, 0.25 * s),
    }
    about = place @ shear @ np.linalg.inv(place)
    found["sheared box"] = found["box"].moved(about)
    found["ellipsoid"] = found["sphere"].moved(about)
    found["torus"] = regions.Surface(points + c, triangles)
    found["moved torus"] = regions.Surface(points, triangles).moved(place @ turn((1, 0, 0), 70) @ shear)
    found["labels"] = regions.Labels(blob(), voxels)
    found["some labels"] = regions.Labels(blob(), voxels, labels=[1, 3])
    found["sheared labels"] = regions.Labels(blob(seed=3), voxels @ shear).moved(about)
    found["expression"] = (found["sphere"] | found["box"]) & ~found["plane"] - found["slab"]
    found["expression of meshes"] = (found["torus"] - found["box"]) | (found["labels"] & ~found["moved torus"])
    return found


NAMES = (
    "plane", "slab", "box", "turned box", "sphere", "sheared box", "ellipsoid", "torus", "moved torus", "labels",
    "some labels", "sheared labels", "expression", "expression of meshes",
)  # fmt: skip
