"""Streamlines chosen by regions: what NumPy finds on the decompressed points, whatever is decoded for it.

What lies between points is the subject of :mod:`.test_segments`.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets import regions
from pvfiblets.query.selection import passing, point_flags
from pvfiblets.query.selection.passing import region_flags
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic import brain_streamlines
from tests.codec.samples import extremes, smooth, wandering
from tests.codec.test_restrict import every_kind, many_pages
from tests.engine.region_shapes import torus

EXTREMES = {**extremes(), "one fiblet": smooth(1, 60)}


def expected_flags(points, offsets, inside):
    """Flags by NumPy, of all points at once."""
    flags = np.zeros(len(offsets) - 1, np.uint8)
    filled = np.flatnonzero(np.diff(offsets))
    if not filled.size:
        return flags
    each, starts = inside(points), offsets[filled]
    flags[filled] = np.logical_or.reduceat(each, starts) + 2 * np.logical_and.reduceat(each, starts)
    flags[filled] += (4 * each[starts] + 8 * each[offsets[filled + 1] - 1]).astype(np.uint8)
    return flags


def some_regions(scale=1.0, at=(0.0, 0.0, 0.0)):
    """Every primitive and expressions of them, about a position."""
    c = np.array(at)
    box = regions.Box(center=c + scale * np.array([4.0, -3.0, 5.0]), size=scale * np.array([40.0, 30.0, 50.0]))
    ball = regions.Sphere(c + scale * np.array([10.0, 0.0, 0.0]), 18.0 * scale)
    plane = regions.Plane((1.0, 2.0, -0.5), c)
    slab = regions.Slab((0.0, 1.0, 1.0), c + scale * 2.0, 11.0 * scale)
    stretched = np.diag([1.5, 0.7, 1.0, 1.0])
    stretched[0, 1] = 0.4
    return {
        "box": box, "ball": ball, "plane": plane, "slab": slab,
        "box and plane": box & plane, "ball or slab": ball | slab, "not box": ~box, "ball without slab": ball - slab,
        "ellipsoid": regions.Sphere((0.0, 0.0, 0.0), 20.0 * scale).moved(stretched).moved(_shift(c)),
        "everything": plane | ~plane, "nothing": ball & ~ball,
        "a speck": regions.Sphere(c + scale * 3.0, 0.3 * scale),
    }  # fmt: skip


def _shift(c):
    matrix = np.eye(4)
    matrix[:3, 3] = c
    return matrix


def assert_flags(whole, region):
    decoded = whole.decompress(dtype=np.float64)
    wanted = expected_flags(decoded.points, decoded.offsets, region.contains)
    found = region_flags(whole, region, "points")
    assert found.dtype == np.uint8
    np.testing.assert_array_equal(found, wanted)
    lines = region_flags(whole, region)
    assert (lines & 13 | wanted & 13 == lines & 13).all(), "what has a point in the region passes it"
    assert (lines & 14 & wanted & 14 == lines & 14).all(), "what leaves it with a point does not stay in it"
    flags = point_flags
    for bits in (flags.ANY, flags.ALL, flags.FIRST, flags.LAST, flags.FIRST | flags.LAST):
        np.testing.assert_array_equal(region_flags(whole, region, "points", bits=bits) & bits, wanted & bits)
        np.testing.assert_array_equal(region_flags(whole, region, bits=bits) & bits, lines & bits)
    return found


@pytest.fixture(scope="module")
def brain():
    return brain_streamlines(600)


@pytest.fixture(scope="module")
def brains(brain):
    return {
        "input": pf.compress(brain),
        "hilbert": pf.compress(brain, order="hilbert"),
        "fine": pf.compress(brain, max_error=2e-5),
    }


@pytest.mark.every("value")
@pytest.mark.parametrize("name", some_regions())
@pytest.mark.parametrize("how", ["input", "hilbert", "fine"])
def test_flags_are_those_of_the_decoded_points(brains, how, name):
    whole = brains[how]
    assert (whole.anchors_low is not None) == (how == "fine")
    found = assert_flags(whole, some_regions()[name])
    if name not in ("everything", "nothing", "a speck"):
        assert len(np.unique(found)) > 1, "the region tells streamlines apart"


def test_a_box_is_a_box():
    """Against comparisons of coordinates, so that no region's own arithmetic is trusted."""
    whole = pf.compress(every_kind())
    decoded = whole.decompress(dtype=np.float64)
    low, high = np.array([-20.25, -30.0, -10.0]), np.array([25.0, 12.5, 40.0])
    box = regions.Box(np.stack([low, high], axis=1).ravel())
    wanted = expected_flags(
        decoded.points, decoded.offsets, lambda p: ((p >= low) & (p <= high)).all(axis=1)
    )  # no decoded point lies within rounding of a face
    assert np.abs(decoded.points - low).min() > 1e-9
    assert np.abs(decoded.points - high).min() > 1e-9
    np.testing.assert_array_equal(region_flags(whole, box, "points"), wanted)


@pytest.mark.parametrize("order", ["input", "hilbert"])
@pytest.mark.parametrize("mapped", [False, True])
def test_lattices_and_streamlines_without_points(order, mapped, tmp_path):
    whole = pf.compress(every_kind(), order=order)
    if mapped:
        whole.save(tmp_path / "a.fiblets")
        whole = pf.FibletSet.open(tmp_path / "a.fiblets")
    empty = np.diff(whole.offsets()) == 0
    assert empty.any()
    for region in some_regions().values():
        assert (assert_flags(whole, region)[empty] == 0).all()


@pytest.mark.parametrize("name", EXTREMES)
def test_extreme_lines(name):
    lines = EXTREMES[name]
    whole = pf.compress(lines)
    size = float(np.ptp(lines.points, axis=0).max()) / 60.0 if lines.n_points else 1.0
    middle = tuple(lines.points.mean(axis=0)) if lines.n_points else (0.0, 0.0, 0.0)
    if not 1e-150 < size < 1e100:  # squares of shapes are normal numbers
        size = 1.0
    for region in some_regions(size, middle).values():
        assert_flags(whole, region)


def test_points_on_a_face_are_in_as_the_region_says():
    """A lattice of whole numbers, decoded exactly, with a box through its points."""
    rng = np.random.default_rng(4)
    lines = Streamlines.from_list(
        [np.cumsum(rng.integers(-1, 2, (50, 3)), axis=0).astype(float) + [0, 0, 20] for _ in range(50)]
    )
    whole = pf.compress(lines)
    box, plane = regions.Box((-3, 3, -2, 4, 18, 23)), regions.Plane((0, 0, 1), (0, 0, 21))
    for region in (box, plane, regions.Sphere((0, 0, 20), 3)):
        for each in (region, ~region):
            assert_flags(whole, each)
            assert_flags(whole.extract(slice(None, None, -3)), each)


def test_portions_of_few_fiblets_and_segments(monkeypatch):
    whole = pf.compress(wandering(30, 70))
    names = ("box", "a speck", "ball without slab", "not box")
    wanted = [region_flags(whole, some_regions()[name]) for name in names]
    monkeypatch.setattr(passing, "SEGMENTS", 5)
    monkeypatch.setattr(passing, "FIBLETS", 3)
    for name, flags in zip(names, wanted, strict=True):
        assert_flags(whole, some_regions()[name])
        np.testing.assert_array_equal(region_flags(whole, some_regions()[name]), flags)


def test_some_streamlines_only(brains):
    for whole in brains.values():
        every = region_flags(whole, some_regions()["box"])
        for ids in ([3], [-1, 0, 77, 77], np.arange(600) % 7 == 0, []):
            found = region_flags(whole, some_regions()["box"], ids=ids)
            mask = np.zeros(600, bool)
            mask[ids] = True
            np.testing.assert_array_equal(found, np.where(mask, every, 0))
    with pytest.raises(IndexError, match="streamline 600"):
        region_flags(whole, some_regions()["box"], ids=[600])


@pytest.fixture(scope="module")
def paged():
    return many_pages()


@pytest.mark.parametrize("pages", [1, 3, 8])
def test_streamlines_that_run_through_pages(paged, pages, monkeypatch):
    monkeypatch.setattr(passing, "PAGES", pages)
    whole = paged
    decoded = whole.decompress(dtype=np.float64)
    for name in ("box", "not box", "a speck"):
        region = some_regions()[name]
        wanted = expected_flags(decoded.points, decoded.offsets, region.contains)
        np.testing.assert_array_equal(region_flags(whole, region, "points"), wanted)
        few = region_flags(whole, region, "points", ids=[9000, 18000])
        assert few[[9000, 18000]].tolist() == wanted[[9000, 18000]].tolist()
        assert np.count_nonzero(few) <= 2


def test_fiblets_that_lie_clear_are_not_decoded(brains, monkeypatch):
    decoded = []
    real = passing.decode_fiblets

    def counted(fiblets, which, *rest):
        decoded.append(len(which))
        real(fiblets, which, *rest)

    monkeypatch.setattr(passing, "decode_fiblets", counted)
    whole = brains["input"]
    region_flags(whole, regions.Sphere((40.0, 0.0, 0.0), 10.0))
    assert 0 < sum(decoded) < whole.n_fiblets / 3
    decoded.clear()
    region_flags(whole, regions.Sphere((4000.0, 0.0, 0.0), 10.0))
    region_flags(whole, ~regions.Sphere((4000.0, 0.0, 0.0), 10.0))
    assert not decoded


def test_conditions(brains):
    whole = brains["input"]
    box, ball = regions.Box((-90, 20, -90, 90, 0, 120)), some_regions()["ball"]
    b, s = region_flags(whole, box), region_flags(whole, ball)
    for predicate, wanted in (
        (regions.passes(box), b & 1 > 0),
        (regions.stays_in(~ball), region_flags(whole, ~ball) & 2 > 0),
        (regions.ends_in(box), b & 12 > 0),
        (regions.ends_in(box, "both"), b & 12 == 12),
        (regions.ends_in(box, "first"), b & 4 > 0),
        (regions.ends_in(box, which="last"), b & 8 > 0),
        (regions.passes(box) & ~regions.passes(ball), (b & 1 > 0) & (s & 1 == 0)),
        ((regions.ends_in(box) | regions.stays_in(box)) & ~regions.ends_in(ball), (b & 14 > 0) & (s & 12 == 0)),
    ):
        found = whole.select(predicate)
        assert found.dtype == bool
        np.testing.assert_array_equal(found, wanted)
        assert 0 < found.sum() < len(whole)
    assert regions.passes(box) == regions.passes(regions.Box(box.bounds))
    assert len({regions.passes(box), regions.ends_in(box), regions.passes(regions.Box(box.bounds))}) == 2


def test_each_region_is_gone_through_once(brains):
    whole, asked = brains["input"], []
    box, ball = some_regions()["box"], some_regions()["ball"]

    def flags(region, sampling):
        asked.append((region, sampling))
        return region_flags(whole, region, sampling)

    wanted = regions.ends_in(box) & regions.passes(regions.Box(box.bounds), sampling="points") & ~regions.stays_in(ball)
    np.testing.assert_array_equal(whole.select(wanted, flags=flags), whole.select(wanted))
    assert sorted(asked, key=str) == sorted([(box, "points"), (ball, "lines")], key=str)


def test_streamlines_without_points_satisfy_nothing():
    whole = pf.compress(Streamlines(np.zeros((1, 3)), [0, 0, 1, 1]))
    everywhere = regions.Sphere((0, 0, 0), 5.0)
    for predicate in (regions.passes(everywhere), regions.ends_in(everywhere), regions.stays_in(everywhere)):
        assert whole.select(predicate).tolist() == [False, True, False]
        assert whole.select(~predicate).tolist() == [True, False, True]
    none = pf.compress(Streamlines(np.zeros((0, 3)), [0]))
    assert none.select(regions.passes(everywhere)).shape == (0,)


def test_what_is_refused(brains):
    whole, box = brains["input"], some_regions()["box"]
    with pytest.raises(TypeError, match=r"a Box is no condition on streamlines; ask passes\(region\)"):
        whole.select(box)
    with pytest.raises(TypeError, match="passes needs a region"):
        regions.passes((1, 2, 3))
    with pytest.raises(ValueError, match="which is 'either'"):
        regions.ends_in(box, "either")
    for bad in (0.5, None, "segments"):
        with pytest.raises(ValueError, match=rf"sampling is {bad!r}; give 'lines' .* or 'points'"):
            regions.passes(box, sampling=bad)
    with pytest.raises(TypeError, match="join conditions with &"):
        regions.passes(box) and regions.ends_in(box)
    words = whole.anchors.copy()
    words[20:40, 1] ^= np.uint32(0x3FFF0000)
    with pytest.raises(pf.FormatError):
        region_flags(replace(whole, anchors=words), box)


def some_volumes():
    rng = np.random.default_rng(5)
    affine = np.array([[3.0, 0.4, 0, -60], [0, 2.5, 0, -75], [0, 0, 4, -40], [0, 0, 0, 1]])
    blobs = rng.random((40, 60, 30))
    for axis in range(3):
        blobs = sum(np.roll(blobs, k, axis) for k in range(-3, 4))
    labels = (blobs > np.quantile(blobs, 0.6)).astype(np.int16) + (blobs > np.quantile(blobs, 0.9))
    ring = regions.Surface(*torus(30.0, 14.0, 48, 24))
    every = regions.Labels(labels, affine)
    return {
        "torus": ring, "labels": every, "label": regions.Labels(labels, affine, labels=[2]),
        "torus and labels": ring & every, "labels without torus or plane": every - ring | some_regions()["plane"],
    }  # fmt: skip


@pytest.mark.few(4)
@pytest.mark.parametrize("name", some_volumes())
@pytest.mark.parametrize("how", ["input", "hilbert", "fine"])
def test_surfaces_and_labels(brains, how, name):
    found = assert_flags(brains[how], some_volumes()[name])
    assert len(np.unique(found)) > 2, "the region tells streamlines apart"


def test_a_torus_is_a_torus_and_labels_are_voxels(brains):
    """Against closed forms: a torus, but for what lies within the coarseness of its mesh; and a slab of voxels."""
    whole = brains["input"]
    decoded = whole.decompress(dtype=np.float64)
    p = decoded.points
    depth = 14 - np.hypot(np.hypot(p[:, 0], p[:, 1]) - 30, p[:, 2])
    clear = [np.abs(depth[a:b]).min() > 0.4 for a, b in pairwise(decoded.offsets)]  # sagitta of 1/24 of a circle: 0.4
    wanted = expected_flags(
        decoded.points, decoded.offsets, lambda q: 14 > np.hypot(np.hypot(q[:, 0], q[:, 1]) - 30, q[:, 2])
    )
    found = region_flags(whole, regions.Surface(*torus(30.0, 14.0, 48, 24)), "points")
    assert sum(clear) > 50
    np.testing.assert_array_equal(found[clear], wanted[clear])
    volume = np.zeros((200, 200, 200), bool)
    volume[90:120, :, 60:99] = True
    slabs = regions.Labels(volume, np.array([[1.0, 0, 0, -100], [0, 1, 0, -100], [0, 0, 1, -80], [0, 0, 0, 1]]))
    voxels = np.floor(p + [100.5, 100.5, 80.5]).astype(int)
    inside = (voxels[:, 0] >= 90) & (voxels[:, 0] < 120) & (voxels[:, 2] >= 60) & (voxels[:, 2] < 99)
    each = np.logical_or.reduceat(inside, decoded.offsets[:-1])
    np.testing.assert_array_equal(whole.select(regions.passes(slabs, sampling="points")), each)
