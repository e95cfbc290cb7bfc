"""Values of a volume in the G-buffer against trilinear interpolation in float64 at the decoded points."""

import re

import numpy as np
import pytest

from pvfiblets.engine import EngineError, FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource, VolumeTexture

from .emulated import emulated_renderer
from .pictures import SIZE, read

SHAPE = (23, 30, 17)


def affine_of(spread=62.0, shape=SHAPE):
    """Turned, sheared and uneven: covers most of a box of 2 * spread mm around the origin."""
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    matrix = np.eye(4)
    matrix[:3, :3] = turn @ np.diag(2 * spread / np.array(shape)) @ (np.eye(3) + np.triu(np.full((3, 3), 0.1), 1))
    matrix[:3, 3] = -matrix[:3, :3] @ ((np.array(shape) - 1) / 2)
    return matrix


def smooth_volume(shape=SHAPE):
    i, j, k = np.meshgrid(*(np.arange(n) / n for n in shape), indexing="ij")
    return np.sin(5 * i) + 2 * np.cos(4 * j + 3 * k) + i * k


def sampled(volume, affine, points, *, nearest=False):
    """Value at points (n, 3), float64; NaN outside, and where a voxel with a part in it is NaN."""
    at = (points - affine[:3, 3]) @ np.linalg.inv(affine[:3, :3]).T
    top = np.array(volume.shape) - 1
    outside = ((at < -0.5) | (at > top + 0.5)).any(1)
    at = at.clip(0, top)
    if nearest:
        found = volume[tuple(np.floor(at + 0.5).astype(int).clip(0, top).T)].astype(float)
    else:
        low = np.minimum(np.floor(at), np.maximum(top - 1, 0)).astype(int)
        t, found = at - low, np.zeros(len(at))
        for corner in np.ndindex(2, 2, 2):
            weight = np.where(corner, t, 1 - t).prod(1)
            voxel = volume[tuple(np.minimum(low + corner, top).T)]
            found += np.where(weight > 0, weight * np.where(weight > 0, voxel, 0.0), 0.0)
    found[outside] = np.nan
    return found


def expected_at(values, place, *, nearest=False):
    """Between points as the engine interpolates: linear, and the nearer one's next to NaN and of labels."""
    i = np.minimum(place.astype(int), max(len(values) - 2, 0))
    j, t = np.minimum(i + 1, len(values) - 1), place - i
    a, b = values[i], values[j]
    with np.errstate(invalid="ignore"):
        between = a + t * (b - a)
    return np.where(nearest | np.isnan(a) | np.isnan(b), np.where(t < 0.5, a, b), between)


def draw(gl, fiblets, matrix, source, *, tolerance=0.0, width=1.0, renderer=None, **options):
    """Streamline, place and value of every drawn pixel."""
    renderer = renderer or FibletRenderer(gl, fiblets, **options)
    try:
        picture = read(renderer.render(View(SIZE, matrix), FibletStyle(width, values=source, tolerance=tolerance)))
    finally:
        renderer.release()
    place, value = picture.position[picture.drawn].astype(float).T
    return picture.ids[picture.drawn][:, 0], place, value + source.reference


def compare(fiblets, volume, affine, drawn, *, nearest=False, atol=2e-4, unsure=0.0):
    """All pixels agree; `unsure` may differ that lie on an edge between NaN or labels, within float32's rounding."""
    streamline, place, value = drawn
    assert len(value) > 1000
    wrong = 0
    for s in np.unique(streamline):
        here = streamline == s
        truth = expected_at(sampled(volume, affine, fiblets.lines[s], nearest=nearest), place[here], nearest=nearest)
        same = np.isclose(value[here], truth, rtol=0, atol=atol, equal_nan=True)
        wrong += np.count_nonzero(~same)
    assert wrong <= unsure * len(value), f"{wrong} of {len(value)}"


@pytest.fixture
def lines(fabricate, random_lines):
    return fabricate(random_lines(60, seed=31), kind=2, per_fiblet=7)


@pytest.mark.few(1)
@pytest.mark.parametrize("width", [1.0, 3.0])
@pytest.mark.parametrize("pipeline", ["compute", "tessellation", "geometry"])
def test_trilinear_in_every_pipeline(gl, lines, camera, pipeline, width):
    volume, affine = smooth_volume(), affine_of()
    drawn = draw(gl, lines, camera(SIZE), VolumeSource(volume, affine), pipeline=pipeline, width=width)
    assert np.isnan(drawn[2]).any(), "none of the lines leaves the volume"
    compare(lines, volume, affine, drawn, unsure=2e-3)


@pytest.mark.few(1)
@pytest.mark.parametrize("serial", [False, True])
def test_trilinear_by_the_mesh_stages(gl, lines, camera, monkeypatch, serial):
    volume, affine = smooth_volume(), affine_of()
    renderer = emulated_renderer(monkeypatch, gl, lines, serial=serial)
    drawn = draw(gl, lines, camera(SIZE), VolumeSource(volume, affine), renderer=renderer)
    compare(lines, volume, affine, drawn, unsure=2e-3)


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", ["compute", "tessellation", "geometry"])
def test_far_fiblets_take_values_along_their_segment(gl, fabricate, camera, pipeline):
    """A straight line is one segment for a fiblet; points lie evenly on it, so that values are those of all points."""
    line = np.linspace((-50, -20, -30), (50, 30, 20), 240)
    fiblets = fabricate([line, line + (0, 0, 12)], kind=2, per_fiblet=60)
    volume, affine = smooth_volume(), affine_of()
    source = VolumeSource(volume, affine)
    matrix = camera(SIZE, eye=(0, -150, 40))
    drawn = draw(gl, fiblets, matrix, source, tolerance=1.0, width=4.0, pipeline=pipeline)
    # Points of the fabricated line are up to half a lattice cell off the segment.
    compare(fiblets, volume, affine, drawn, atol=5e-3)


def test_far_from_the_origin_nothing_is_lost(gl, fabricate, random_lines, camera):
    shift = np.array([1e6, -2e6, 5e5])
    fiblets = fabricate([line + shift for line in random_lines(30, seed=4)], kind=2, per_fiblet=7)
    volume, affine = smooth_volume(), affine_of()
    affine[:3, 3] += shift
    matrix = camera(SIZE)
    move = np.eye(4)
    move[:3, 3] = -shift
    drawn = draw(gl, fiblets, matrix @ move, VolumeSource(volume, affine))
    compare(fiblets, volume, affine, drawn, unsure=2e-3)


def test_across_chunks(gl, fabricate, camera):
    t = np.linspace(0, 60, 40000)
    fiblets = fabricate([np.stack([50 * np.cos(t), 50 * np.sin(t * 1.1), t - 30], axis=1)], kind=2, per_fiblet=2)
    volume, affine = smooth_volume(), affine_of(70.0)
    drawn = draw(gl, fiblets, camera(SIZE), VolumeSource(volume, affine), max_buffer_bytes=12 * 16385)
    compare(fiblets, volume, affine, drawn, unsure=2e-3)


@pytest.mark.few(3)
@pytest.mark.parametrize(
    ("dtype", "low", "high"),
    [
        (bool, 0, 1), (np.uint8, 0, 255), (np.int8, -128, 127), (np.int16, -30000, 30000), (np.uint16, 0, 65535),
        (np.int32, 1_000_000_000, 1_000_000_040), (np.int32, -70_000, 1_000_000), (np.uint64, 5, 6),
    ],
)  # fmt: skip
def test_labels_are_those_of_the_nearest_voxel(gl, lines, camera, dtype, low, high):
    rng = np.random.default_rng(0)
    volume, affine = rng.integers(low, high, SHAPE, endpoint=True).astype(dtype), affine_of()
    volume.ravel()[:2] = low, high
    source = VolumeSource(volume, affine)
    assert source.nearest
    assert source.range == (float(volume.min()), float(volume.max()))
    drawn = draw(gl, lines, camera(SIZE), source)
    # float32 holds numbers beyond 2^24 with gaps: they are right to the nearest
    compare(lines, volume.astype(float), affine, drawn, nearest=True, atol=1e-7 * abs(float(high)), unsure=2e-3)


@pytest.mark.few(3)
@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64, np.uint8, np.int16])
def test_numbers_of_any_type_can_be_interpolated(gl, lines, camera, dtype):
    volume = np.random.default_rng(3).integers(0, 200, SHAPE).astype(dtype)
    drawn = draw(gl, lines, camera(SIZE), VolumeSource(volume, affine_of(), nearest=False))
    compare(lines, volume.astype(float), affine_of(), drawn, atol=0.05, unsure=2e-3)


def test_nan_voxels_count_only_where_they_have_a_part(gl, fabricate, camera):
    """A line through voxel centres, beside a slab of NaN, knows nothing of it."""
    volume = np.fromfunction(lambda i, j, k: i + 0 * j + 0 * k, (41, 3, 3))
    volume[:, 2] = np.nan
    volume[20, 1, 1] = np.nan
    affine = np.eye(4)
    affine[:3, 3] = -20, -1, -1
    line = np.linspace((-20, 0, 0), (20, 0, 0), 161)
    fiblets = fabricate([line], kind=2, per_fiblet=60)
    _, place, value = draw(gl, fiblets, camera(SIZE, eye=(0, -60, 0)), VolumeSource(volume, affine), width=3.0)
    x = np.interp(place, np.arange(161), fiblets.lines[0][:, 0])
    hole = abs(x) < 1.2
    assert np.isnan(value[abs(x) < 0.8]).all()
    assert np.abs(value[~hole] - (x[~hole] + 20)).max() < 0.01


def test_one_voxel_is_a_volume(gl, fabricate, camera):
    fiblets = fabricate([np.linspace((-30, 0, 0), (30, 0, 0), 61)], kind=2)
    affine = np.diag([20.0, 20.0, 20.0, 1.0])
    _, place, value = draw(gl, fiblets, camera(SIZE), VolumeSource(np.full((1, 1, 1), 7.5), affine), width=3.0)
    x = fiblets.lines[0][np.rint(place).astype(int)][:, 0]
    assert (value[abs(x) < 9.4] == 7.5).all()
    assert np.isnan(value[abs(x) > 10.6]).all()


def test_range_is_that_of_finite_voxels():
    volume = smooth_volume()
    volume[0, 0, :3] = np.nan, np.inf, -np.inf
    source = VolumeSource(volume, np.eye(4))
    finite = volume[np.isfinite(volume)]
    assert source.range == (finite.min(), finite.max())
    assert source.least_positive == finite[finite > 0].min()
    assert VolumeSource(np.full((2, 2, 2), np.nan), np.eye(4)).range == (0.0, 0.0)
    assert VolumeSource(np.arange(8).reshape(2, 2, 2) // 3, np.eye(4)).distinct == 3


def test_the_volume_is_there_only_while_it_is_asked_for(gl, lines, camera):
    renderer = FibletRenderer(gl, lines)
    view, source = View(SIZE, camera(SIZE)), VolumeSource(smooth_volume(), affine_of())

    def names():
        return {entry["name"] for entry in renderer.explain(counts=False)["buffers"]}

    renderer.render(view)
    assert "volume" not in names()
    assert "VALUES_VOLUME" not in renderer.explain(counts=False)["features"]
    first = renderer.render(view, FibletStyle(values=source)).generation
    assert "volume" in names()
    assert renderer.render(view, FibletStyle(values=source)).generation == first, "drawn again for the same source"
    renderer.render(view, FibletStyle(values="arc_length"))
    assert "volume" not in names()
    renderer.render(view, FibletStyle(values=source))
    assert renderer.value_range(source) == source.range
    renderer.release()
    renderer.release()


@pytest.mark.parametrize(
    ("values", "affine", "message"),
    [
        (np.zeros((3, 3, 3, 2)), np.eye(4), "shape (3, 3, 3, 2)"),
        (np.zeros((3, 0, 3)), np.eye(4), "shape (3, 0, 3)"),
        (np.zeros((3, 3, 3), complex), np.eye(4), "type complex128"),
        (np.zeros((3, 3, 3)), np.eye(3), "finite (4, 4) matrix"),
        (np.zeros((3, 3, 3)), np.full((4, 4), np.nan), "finite (4, 4) matrix"),
        (np.zeros((3, 3, 3)), np.diag([1.0, 0.0, 1.0, 1.0]), "flattens space"),
        (np.array([[[0, 2**30]]]), np.eye(4), "number the labels anew"),
    ],
)
def test_nonsense_is_refused(values, affine, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        VolumeSource(values, affine)


def test_a_volume_too_large_for_the_driver_raises(gl):
    side = int(gl.info["GL_MAX_3D_TEXTURE_SIZE"]) + 1
    with pytest.raises(EngineError, match=f"{side} x 1 x 1 voxels"):
        VolumeTexture(gl, VolumeSource(np.zeros((side, 1, 1), np.uint8), np.eye(4)))
