"""Surfaces of nearest voxels are the voxels' sides, and each is shaded by the gradient at its voxel's centre."""

import numpy as np

from pvfiblets.engine import View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.report.studies.volumes import reference
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.volume import RaycastVolume

from .pictures import EMPTY, unpacked_tangent

SIZE = (80, 64)


def test_sides_of_voxels_have_one_normal_each(gl, camera):
    at = np.stack(np.meshgrid(*[np.arange(14)] * 3, indexing="ij"), axis=-1) - 6.5
    values = 8.0 - np.linalg.norm(at * (1.0, 1.2, 0.9) + 0.1, axis=-1)
    affine = np.array([[2.0, 0.3, 0.0, -14.0], [0.0, 1.5, 0.2, -12.0], [0.0, 0.0, 2.5, -18.0], [0.0, 0.0, 0.0, 1.0]])
    volume = RaycastVolume(values.astype(np.float32), affine)
    matrix = camera(SIZE, eye=(30.0, -70.0, 25.0), target=(0.0, 0.0, 0.0), near=5.0, far=200.0)
    renderer = VolumeRenderer(gl, volume)
    casting = RaycastOptions(values=(3.0,), filter="nearest", step=0.02, iterations=8)
    buffer = renderer.render(View(SIZE, matrix), VolumeStyle(casting=casting))
    key = np.frombuffer(buffer.depth.read(), "u4").reshape(SIZE[::-1])
    normal = unpacked_tangent(np.frombuffer(buffer.across.read(), "u4").reshape(SIZE[::-1]))
    owner = np.frombuffer(buffer.owner.read(), "u4").reshape(SIZE[::-1]).astype(np.int64)
    renderer.release()

    through = reference.rays(matrix, SIZE, volume)
    wanted = reference.isosurface(volume, [3.0], through, filter="nearest")
    there = (key != EMPTY) & (wanted.value >= 0)
    assert there.sum() > 500
    assert np.quantile(np.abs(key / 4294967295.0 - wanted.depth)[there], 0.98) < 2e-6  # others graze a corner
    length = np.linalg.norm(wanted.gradient, axis=-1, keepdims=True)
    slant = np.abs((normal * wanted.gradient / length).sum(-1))[there]
    assert (slant > 1.0 - 1e-4).mean() > 0.99  # the others lie at edges, where rounding says which voxel is entered
    x, y, z = np.unravel_index(owner[there], volume.shape, order="F")
    assert (volume.values[x, y, z] >= 3.0).mean() > 0.99
