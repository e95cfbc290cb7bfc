"""How alike pictures of different pipelines must be."""

import numpy as np

from .pictures import unpacked_tangent


def assert_like(picture, reference):
    """Coverage, streamlines, depth, place and tangent of two pipelines' pictures."""
    either, both = picture.drawn | reference.drawn, picture.drawn & reference.drawn
    same = both & (picture.ids[..., 0] == reference.ids[..., 0])
    assert either.any()
    assert same.sum() >= 0.998 * either.sum()
    depth = np.abs(picture.window_depth - reference.window_depth)[same]
    assert (depth < 1e-5).mean() >= 0.999
    owned = same & (picture.owner == reference.owner)
    assert owned.sum() >= 0.998 * either.sum()
    place = np.abs(picture.position[owned][:, 0] - reference.position[owned][:, 0])
    assert (place < 1e-3).mean() >= 0.998
    tangents = [unpacked_tangent(p.ids[..., 1][owned]) for p in (picture, reference)]
    assert (np.linalg.norm(tangents[0] - tangents[1], axis=1) < 1e-3).mean() >= 0.998
    values = [p.position[..., 1][owned] for p in (picture, reference)]
    assert (np.isnan(values[0]) == np.isnan(values[1])).mean() >= 0.999
    real = np.isfinite(values[0]) & np.isfinite(values[1])
    span = np.ptp(values[1][real]) if real.any() else 0.0
    assert (np.abs(values[0] - values[1])[real] <= 1e-4 * span).mean() >= 0.998
