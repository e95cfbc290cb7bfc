"""The float64 reference of rays: maxima and light, against closed forms, and plain NumPy on noise."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.report.studies.volumes.reference import composite, mip, rays, sample
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import FILTERS, RaycastVolume

from .analytic import GRIDS, Ball, Gaussian, Layers, camera, middle
from .noise import SHAPE, SIZE, along, haze, noise, straight, view
from .profiles import profiles

# ----------------------------------------------------------------------------------------------------------- maxima


@pytest.mark.parametrize("grid", GRIDS)
def test_the_greatest_value_of_a_ball_is_where_the_ray_is_nearest_to_its_centre(grid):
    affine = GRIDS[grid]
    field = Ball(tuple(middle(SHAPE, affine)), 3.0)
    volume = field.volume(SHAPE, affine)
    inner = (1, SHAPE[0] - 2, 1, SHAPE[1] - 2, 1, SHAPE[2] - 2)  # where the cubic has all its voxels
    through = rays(view(affine, near=28.0), SIZE, volume, box=inner)
    found, (t, value) = mip(volume, through, filter="tricubic"), field.greatest(through)
    seen = ~np.isnan(t)
    assert (seen == ~np.isnan(found.value)).all()
    assert np.abs(found.value - value)[seen].max() < 1e-9
    assert np.abs(found.t - t)[seen].max() < 1e-5


@pytest.mark.few(1)
@pytest.mark.parametrize("how", FILTERS)
def test_the_greatest_value_in_noise(how):
    volume = noise(seed=3, affine=GRIDS["oblique"])
    through = rays(view(volume.affine, volume.shape, height=8.0), SIZE, volume)
    found = mip(volume, through, filter=how)
    some, t, values = along(volume, through, how, 3000 if how != "tricubic" else 600)
    greatest = found.value[~np.isnan(through.near)]
    assert (values.max(axis=1) <= greatest + 1e-12).all()
    if how == "nearest":
        assert np.isin(greatest, volume.values).all()
        assert np.mean(values.max(axis=1) == greatest) > 0.99
    else:
        assert np.abs(values.max(axis=1) - greatest).max() < 2e-3
        at = found.t[~np.isnan(through.near)]
        assert np.abs(sample(volume, some.points(at), how) - greatest).max() < 1e-12
    kept = mip(volume, through, filter=how, low=0.7, high=0.8).value[~np.isnan(through.near)]
    inside = (values >= 0.7) & (values <= 0.8)
    if how == "nearest":
        inside = np.where(inside, values, -1).max(axis=1)
        assert np.mean(np.where(inside < 0, np.isnan(kept), kept == inside)) > 0.99
    else:
        # The field is continuous: where it passes 0.8, that is the greatest.
        passes = (values > 0.8).any(axis=1) & (values < 0.8).any(axis=1)
        assert (kept[passes] == 0.8).all()
        assert np.isnan(kept[greatest < 0.7]).all()
        between = (greatest >= 0.7) & (greatest < 0.8)
        assert (kept == greatest)[between].all()


@pytest.mark.parametrize("how", FILTERS)
@pytest.mark.parametrize(
    ("threshold", "value", "t"),
    [(-1.0, 3.0, 1.0), (2.5, 3.0, 1.0), (3.5, 7.0, 3.0), (7.9, 9.0, 7.0), (9.5, 9.0, 7.0), (None, 9.0, 7.0)],
)
def test_the_first_local_maximum_above_a_threshold(how, threshold, value, t):
    volume = Layers((1, 3, 2, 7, 7, 0, 5, 9, 8)).volume()
    found = mip(volume, straight((4, 4, 0), (0, 0, 1), 8.0), filter=how, threshold=threshold)
    if how == "tricubic" and value == 7.0:  # it bulges between two voxels alike
        assert 7.0 < found.value[0] < 8.0
        assert 3.0 < found.t[0] < 4.0
    elif how == "tricubic":  # it turns a little beside the voxel
        assert value <= found.value[0] < value + 0.5
        assert abs(found.t[0] - t) < 0.3
    else:
        assert found.value[0] == value
        assert found.t[0] == (t if how == "trilinear" else t - 0.5)


def test_bad_thresholds_are_named():
    ray = straight((0, 0, 0), (1, 1, 1), 1.0)
    with pytest.raises(ValueError, match="lower one first"):
        mip(noise(), ray, low=2.0, high=1.0)
    with pytest.raises(ValueError, match="threshold is nan"):
        mip(noise(), ray, threshold=float("nan"))
    with pytest.raises(ValueError, match="lower one first"):
        composite(noise(), haze(), ray, low=float("nan"))
    with pytest.raises(ValueError, match="tolerance"):
        composite(noise(), haze(), ray, 0.0)


# ---------------------------------------------------------------------------------------------------------- composite


@pytest.mark.parametrize("how", FILTERS)
@pytest.mark.parametrize("alpha", [0.0, 1e-6, 0.3, 0.999, 1.0])
def test_an_even_block(how, alpha):
    """Its opacity is that of as many units as the ray is long."""
    volume = RaycastVolume(np.full((5, 6, 7), 3, np.uint8), GRIDS["oblique"])
    transfer = Transfer([[0, 0, 0, 0], [0.8, 0.4, 0.2, alpha]], (0, 3), 2.5)
    through = rays(view(volume.affine, volume.shape, height=9.0), SIZE, volume)
    found = composite(volume, transfer, through, filter=how)
    left = 1 - min(float(np.float32(alpha)), 1 - 2.0**-24)
    opacity = np.nan_to_num(1 - left ** ((through.far - through.near) / 2.5))
    # What comes from behind an opacity of 1 - 1e-11 is left out.
    assert np.abs(found[..., 3] - opacity).max() < 2e-11
    assert np.abs(found[..., :3] - opacity[..., None] * transfer.table[1, :3]).max() < 2e-11


@pytest.mark.few(10)
@pytest.mark.parametrize("depth", [0.01, 1.0, 30.0])
@pytest.mark.parametrize("name", ["constant", "fade", "ramp", "edge", "peak", "haze", "teeth"])
def test_the_closed_forms_are_the_integral(name, depth):
    """By very many steps of the equation as it stands, from the profile's own functions."""
    profile = next(p for p in profiles([depth]) if p.name == name)
    assert abs(profile.densest * profile.length - depth) < 1e-5 * depth
    start, end, n = 3.0, 61.0, 400_000
    s = np.linspace(start, end, n + 1)
    s = (s[1:] + s[:-1]) / 2
    kappa, colour = profile.transfer.extinction(profile.value(s)), profile.transfer.colour(profile.value(s))
    passed = np.cumsum(kappa) * (end - start) / n
    weights = kappa * (end - start) / n * np.exp(-passed + kappa * (end - start) / n / 2)
    expected = np.append(weights @ colour, -np.expm1(-passed[-1]))
    assert np.abs(profile.light(start, end) - expected).max() < 2e-6


@pytest.mark.parametrize("depth", [1e-3, 1.0, 1e3, 1e6])
@pytest.mark.parametrize("name", ["constant", "fade", "ramp", "edge", "peak", "haze", "teeth"])
def test_layers_of_which_a_closed_form_is_known(name, depth):
    """Thin to stiff, smooth and steep, from both sides and aslant."""
    profile = next(p for p in profiles([depth], 17.0) if p.name == name)
    layers = Layers(tuple(np.float32(profile.value(np.linspace(0, 17, 18)))))
    volume = layers.volume()
    for away in ((3, 2, 40), (40, 5, -20)):
        matrix = camera(np.array([4, 4, 8.5]) + away, (4, 4, 8.5), height=14.0, size=(6, 5))
        through = rays(matrix, (6, 5), volume)
        assert (~np.isnan(through.near)).any()
        expected = layers.light(through, profile.transfer)
        assert np.abs(composite(volume, profile.transfer, through) - expected).max() < 1e-8


def test_layers_of_nearest_voxels():
    layers = Layers((0, 3, 1, 2, 2, 0, 3))
    volume = layers.volume(dtype=np.int16)
    transfer = Transfer([[1, 0, 0, 0.1], [0, 1, 0, 0.3], [0, 0, 1, 0.0], [1, 1, 1, 0.6]], (0, 3), 0.7)
    for away in ((3, 2, 40), (40, 5, -20)):
        through = rays(camera(np.array([4, 4, 3]) + away, (4, 4, 3), height=14.0, size=(8, 6)), (8, 6), volume)
        found = composite(volume, transfer, through, filter="nearest")
        assert np.abs(found - layers.light(through, transfer, "nearest")).max() < 1e-10


@pytest.mark.parametrize("how", ["trilinear", "tricubic"])
def test_a_gaussian(how):
    """The filters' own error is what is left: of the trilinear one (spacing / radius)^2 / 8 in each axis."""
    field = Gaussian((10.0, 10.0, 10.0), 2.5)
    volume = field.volume((41, 41, 41), np.diag([0.5, 0.5, 0.5, 1.0]))
    transfer = field.transfer(0.9, (1.0, 0.5, 0.25), 1.5)
    through = rays(camera((30, 25, 20), (10, 10, 10), size=(12, 9)), (12, 9), volume)
    error = np.abs(composite(volume, transfer, through, filter=how) - field.light(through, transfer))
    assert field.light(through, transfer).max() > 0.95
    assert error.max() < (6e-3 if how == "trilinear" else 2e-4)


@pytest.mark.parametrize("how", ["trilinear", "tricubic"])
def test_noise_against_very_many_samples(how):
    volume = noise(seed=5)
    through = rays(view(np.eye(4), volume.shape, size=(8, 6)), (8, 6), volume)
    found = composite(volume, haze(), through, filter=how)
    some, t, values = along(volume, through, how, 20000)
    kappa, colour = haze().extinction(values), haze().colour(values)
    depth = (kappa[:, 1:] + kappa[:, :-1]) / 2 * np.diff(t)
    left = np.exp(-np.cumsum(np.insert(depth, 0, 0.0, axis=1), axis=1))
    light = ((left[:, :-1] - left[:, 1:])[..., None] * (colour[:, 1:] + colour[:, :-1]) / 2).sum(axis=1)
    seen = ~np.isnan(through.near)
    assert np.abs(found[seen][:, :3] - light).max() < 1e-6
    assert np.abs(found[seen][:, 3] - 1 + left[:, -1]).max() < 1e-6
    assert (found[~seen] == 0).all()
    rough = composite(volume, haze(), through, 1e-3, filter=how)
    assert np.abs(rough - found).max() < 1e-3
