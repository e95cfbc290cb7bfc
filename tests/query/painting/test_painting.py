"""Painted regions and their streamlines against every segment and voxel in float64."""

import itertools
from dataclasses import replace

import nibabel
import numpy as np
import pytest

from pvfiblets import FibletSet, FormatError, Streamlines, compress, regions
from pvfiblets.query.painting.fiblet_index import index_of
from pvfiblets.synthetic import brain_streamlines

AFFINE = np.array([[1.5, 0.2, 0.0, -20.0], [0.0, -1.2, 0.1, 22.0], [0.1, 0.0, 2.0, -18.0], [0.0, 0.0, 0.0, 1.0]])
SHAPE = (28, 34, 20)


@pytest.fixture(scope="module")
def fiblets():
    rng = np.random.default_rng(7)
    lines = []
    for k in range(160):
        # Steps of a voxel and of many; lines that leave the grid; single points.
        size = (0.4, 1.5, 9.0)[k % 3]
        course = rng.normal(size=3) * size * 0.7 + rng.normal(size=(rng.integers(1, 130), 3)) * size * 0.4
        lines.append(rng.uniform(-20, 20, 3) + np.cumsum(course, axis=0))
    return compress(Streamlines.from_list([*lines, np.zeros((0, 3))]), exact=False)


def hits(a, b, centres):
    """Whether the segment from a to b (voxels) meets the box of any voxel, by slabs."""
    d = b - a
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = (centres - 0.5 - a) / d, (centres + 0.5 - a) / d
    enter, leave = np.maximum(np.minimum(s, t).max(axis=1), 0.0), np.minimum(np.maximum(s, t).min(axis=1), 1.0)
    return bool((enter <= leave).any())


def brute(fiblets, mask):
    """Passes, stays in, first in, last in: each segment against each voxel."""
    inverse, where = np.linalg.inv(AFFINE), np.argwhere(mask).astype(float)
    out = np.zeros((len(fiblets), 4), bool)
    for row, line in enumerate(fiblets.decompress(dtype=np.float64)):
        v = line @ inverse[:3, :3].T + inverse[:3, 3]
        if not len(v):
            continue

        def inside(p):
            i = np.floor(p + 0.5).astype(int)
            return bool((i >= 0).all() and (i < mask.shape).all() and mask[tuple(i)])

        out[row, 2:] = inside(v[0]), inside(v[-1])
        near = where[(where + 1 >= v.min(axis=0)).all(axis=1) & (where - 1 <= v.max(axis=0)).all(axis=1)]
        out[row, 0] = out[row, 2] or any(len(near) and hits(a, b, near) for a, b in itertools.pairwise(v))
        # It stays where each of very many positions does; corners cut by less than a hundredth of a voxel aside.
        steps = [a + (b - a) * np.linspace(0, 1, 40)[:, None] for a, b in itertools.pairwise(v)] or [v]
        at = np.floor(np.concatenate(steps) + 0.5).astype(int)
        here = ((at >= 0) & (at < mask.shape)).all(axis=1)
        out[row, 1] = here.all() and bool(mask[tuple(at.T)].all())
    return out


def flags_of(live, name):
    found = live.region(name).flags()
    return np.stack([found & bit != 0 for bit in (1, 2, 4, 8)], axis=1)


@pytest.mark.more
def test_the_answer_is_exact_after_each_stroke(fiblets):
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("a", "red")
    painter.add("b")
    live = regions.LiveRegions(fiblets, painter)
    rng = np.random.default_rng(1)
    assert live.count("a") == 0
    for step in range(7):
        at = rng.uniform(-14, 14, (2, 3))
        if step == 4:
            painter.erase(at[0], 9.0)
        elif step == 5:
            painter.undo()
        else:
            painter.paint("ab"[step % 2], at if step % 3 else at[0], (6.0, 9.0)[step % 2])
        for name in "ab":
            expected = brute(fiblets, painter.mask(name))
            found = flags_of(live, name)
            assert np.array_equal(found[:, [0, 2, 3]], expected[:, [0, 2, 3]])
            assert live.count(name) == expected[:, 0].sum()
            if painter.mask(name).any():
                assert np.array_equal(fiblets.select(regions.passes(painter.region(name))), expected[:, 0])
    assert 5 < live.count("b") < 150
    again = regions.LiveRegions(fiblets, painter)
    assert np.array_equal(again.region("a").flags(), live.region("a").flags())


def test_streamlines_that_stay_inside(fiblets):
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("large")
    live = regions.LiveRegions(fiblets, painter)
    painter.sphere("large", (0.0, 0.0, 0.0), 17.0)
    expected = brute(fiblets, painter.mask("large"))
    assert np.array_equal(flags_of(live, "large")[:, 1], expected[:, 1])
    assert 3 < expected[:, 1].sum() < 150
    assert np.array_equal(live.select(stays_in="large"), expected[:, 1])


def test_only_fiblets_near_the_stroke_are_looked_at(fiblets):
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("a")
    live = regions.LiveRegions(fiblets, painter)
    region = live.region("a")
    painter.paint("a", (5.0, 5.0, 5.0), 2.0)
    few = region.looked_at
    assert 0 < few < fiblets.n_fiblets / 4
    painter.paint("a", (5.0, 5.0, 5.0), 1.0)  # nothing new
    assert region.looked_at == few
    live.close()
    painter.paint("a", (-5.0, 5.0, 5.0), 3.0)
    assert region.looked_at == few


def test_waypoints_in_order():
    t = np.linspace(0, 30, 61)[:, None]
    straight = np.hstack([t, 0 * t, 0 * t])
    back = np.hstack([np.r_[t, t[::-1]], np.zeros((122, 2))])
    # 0: a b c; 1: c b a; 2: a c only, b on the way round after c
    away = np.vstack([[0, 0, 0], [0, 9, 0], [20, 9, 0], [20, 0, 0], [10, 0, 0]])
    made = Streamlines.from_list([straight, straight[::-1], away, back, straight[:25]])
    for data in (compress(made), compress(made, exact=False)):
        place = np.array([[1, 0, 0, -4], [0, 1, 0, -5], [0, 0, 1, -3], [0, 0, 0, 1.0]])
        painter = regions.RegionPainter(((40, 20, 6), place))
        for name, x in zip("abc", (0, 10, 20), strict=True):
            painter.add(name)
            painter.sphere(name, (x, 0, 0), 1.6)
        live = regions.LiveRegions(data, painter)
        assert live.select(include=list("abc")).tolist() == [True, True, True, True, False]
        assert live.select(in_order=list("abc")).tolist() == [True, True, False, True, False]
        assert live.select(in_order=list("abc"), direction="forward").tolist() == [True, False, False, True, False]
        assert live.select(in_order=list("acb")).tolist() == [False, False, True, True, False]
        assert live.select(include="a", exclude="c").tolist() == [False, False, False, False, True]
        assert live.select(ends_in="a").tolist() == [True, True, True, True, True]
        assert live.select(in_order=["c", "a"], direction="forward").tolist() == [False, True, False, True, False]


def test_the_index_is_kept_in_files_that_older_programs_read(fiblets, tmp_path):
    plain, indexed = tmp_path / "plain.fiblets", tmp_path / "indexed.fiblets"
    fresh = compress(fiblets.decompress(), exact=False)
    fresh.save(plain)
    index = index_of(fresh)
    assert sorted(index.order.tolist()) == list(range(fresh.n_fiblets))
    assert index.nbytes <= 26 * fresh.n_fiblets + 84
    fresh.save(indexed)
    back = FibletSet.open(indexed)
    assert "_spatial_index" in back.__dict__
    assert "_spatial_index" not in FibletSet.open(plain).__dict__
    assert np.array_equal(index_of(back).order, index.order)
    assert np.array_equal(index_of(back).pieces, index.pieces)
    assert np.array_equal(back.decompress().points, FibletSet.open(plain).decompress().points)
    assert "_spatial_index" not in back[:10].__dict__  # numbers of fiblets are others there
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("a")
    painter.paint("a", (0.0, 0.0, 0.0), 6.0)
    assert regions.LiveRegions(back, painter).count("a") == brute(back, painter.mask("a"))[:, 0].sum()


def test_an_index_of_other_fiblets_is_refused(fiblets, tmp_path):
    fresh = compress(fiblets.decompress(), exact=False)
    order = np.array(index_of(fresh).order)
    order[0] = fresh.n_fiblets
    fresh.__dict__["_spatial_index"] = replace(index_of(fresh), order=order)
    fresh.save(tmp_path / "bad.fiblets")
    with pytest.raises(FormatError, match="spatial index"):
        index_of(FibletSet.open(tmp_path / "bad.fiblets"))


def test_brushes_paint_the_voxels_that_they_should():
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("a")
    painter.add("b")
    i = np.stack(np.meshgrid(*map(np.arange, SHAPE), indexing="ij"), axis=-1)
    centres = i @ AFFINE[:3, :3].T + AFFINE[:3, 3]
    middle = centres[14, 17, 10]
    near = np.linalg.norm(centres - middle, axis=-1) <= 6.0
    painter.paint("a", middle, 6.0)
    assert np.array_equal(painter.mask("a"), near)
    painter.clear("a")
    painter.paint("a", middle, 6.0, plane=2)
    assert np.array_equal(painter.mask("a"), near & (i[..., 2] == 10))
    painter.clear("a")
    stroke = painter.paint("a", [middle, middle + [8.0, 0, 0]], 3.0)
    t = np.clip((centres - middle) @ [8.0, 0, 0] / 64.0, 0, 1)
    apart = np.linalg.norm(centres - middle - t[..., None] * [8.0, 0, 0], axis=-1)
    assert np.array_equal(painter.mask("a"), apart <= 3.0)
    assert len(stroke) == painter.mask("a").sum()
    painter.erase(middle, 2.5)
    painter.sphere("b", middle + [9.0, 0, 0], 4.0)
    assert not (painter.mask("a") & painter.mask("b")).any()
    painter.paint("b", centres[0, 0, 0] - 0.2, 0.001)  # a brush smaller than a voxel paints the one that it is in
    assert painter.mask("b")[0, 0, 0]


def test_polygons_fill_and_growth_are_those_of_scipy_and_matplotlib():
    from matplotlib.path import Path as Polygon
    from scipy import ndimage

    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("a")
    painter.add("b")
    corners = np.array([[3.2, 4.1], [24.3, 6.2], [20.7, 30.3], [12.1, 12.4], [5.4, 28.8]])
    mm = np.column_stack([corners, np.full(5, 7.2)]) @ AFFINE[:3, :3].T + AFFINE[:3, 3]
    painter.polygon("a", mm, 2)
    grid = np.stack(np.meshgrid(np.arange(SHAPE[0]), np.arange(SHAPE[1]), indexing="ij"), axis=-1)
    inside = Polygon(corners).contains_points(grid.reshape(-1, 2)).reshape(SHAPE[:2])
    assert np.array_equal(painter.mask("a")[:, :, 7], inside)
    assert painter.mask("a").sum() == inside.sum()
    image = ndimage.gaussian_filter(np.random.default_rng(3).normal(size=SHAPE), 1.5)
    seed = np.unravel_index(image.argmax(), SHAPE)
    place = np.array(seed) @ AFFINE[:3, :3].T + AFFINE[:3, 3]
    parts, _ = ndimage.label(image >= 0.02)
    painter.grow("b", place, image, 0.02, np.inf)
    assert np.array_equal(painter.mask("b"), parts == parts[seed])
    painter.clear("b")
    painter.grow("b", place, image, 0.02, np.inf, radius=5.0)
    i = np.stack(np.meshgrid(*map(np.arange, SHAPE), indexing="ij"), axis=-1)
    near = np.linalg.norm(i @ AFFINE[:3, :3].T + AFFINE[:3, 3] - place, axis=-1) <= 5.0
    parts, _ = ndimage.label((image >= 0.02) & near)
    assert np.array_equal(painter.mask("b"), parts == parts[seed])
    before = painter.labels.copy()
    parts, _ = ndimage.label(before[:, :, 3] == 0)
    painter.fill("b", AFFINE[:3, :3] @ [0, 0, 3] + AFFINE[:3, 3], plane=2)
    assert np.array_equal(painter.labels[:, :, 3] != before[:, :, 3], parts == parts[0, 0])


def test_strokes_are_undone_and_done_again():
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("a")
    told, states = [], [painter.labels.copy()]
    painter.listeners.append(told.append)
    for x in (0.0, 3.0, -6.0):
        painter.paint("a", (x, 0.0, 0.0), 4.0)
        states.append(painter.labels.copy())
    for state in states[-2::-1]:
        painter.undo()
        assert np.array_equal(painter.labels, state)
    assert painter.undo() is None
    for state in states[1:]:
        painter.redo()
        assert np.array_equal(painter.labels, state)
    assert painter.redo() is None
    assert len(told) == 9


@pytest.mark.parametrize("suffix", [".nii.gz", ".nii", ".mif", ".vti"])
def test_regions_are_saved_with_their_names_and_colours(tmp_path, suffix):
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("corpus callosum", "#ff8000")
    painter.add("other").visible = False
    painter.sphere("other", (0.0, 0.0, 0.0), 5.0)
    painter.rename("other", "seed")
    path = tmp_path / f"regions{suffix}"
    table = painter.save(path)
    assert table.read_text().splitlines()[1] == "1\tcorpus callosum\t#ff8000"
    if ".nii" in suffix:
        image = nibabel.load(path)
        assert np.array_equal(np.asarray(image.dataobj), painter.labels)
        assert np.allclose(image.affine, AFFINE)
    back = regions.RegionPainter.open(path)
    assert np.allclose(back.grid.affine, AFFINE)
    assert list(back.regions) == ["corpus callosum", "seed"]
    assert back.regions["corpus callosum"].color == pytest.approx((1.0, 128 / 255, 0.0))
    assert np.array_equal(back.mask("seed"), painter.mask("seed"))
    assert back.region("seed").contains([[0.0, 0.0, 0.0]])[0]
    table.unlink()
    assert list(regions.RegionPainter.open(path).regions) == ["2"]


@pytest.mark.parametrize(
    ("do", "error", "says"),
    [
        (lambda p: p.add("a"), ValueError, "there already"),
        (lambda p: p.paint("z", (0, 0, 0), 1.0), KeyError, "there are: 'a'"),
        (lambda p: p.paint("a", (0, 0), 1.0), ValueError, "path has the shape"),
        (lambda p: p.paint("a", (0, 0, 0), 0.0), ValueError, "radius is 0"),
        (lambda p: p.paint("a", (0, 0, 0), 1.0, plane=3), ValueError, "plane is 3"),
        (lambda p: p.fill("a", (999, 0, 0)), ValueError, "outside of the grid"),
        (lambda p: p.polygon("a", [(0, 0, 0)], 0), ValueError, "three corners"),
        (lambda p: p.grow("a", (0, 0, 0), np.zeros(3), 0, 1), ValueError, "the grid's is"),
        (lambda p: p.save("regions.png"), ValueError, "let it end in .nii"),
    ],
)
def test_what_cannot_be_painted_is_told(do, error, says):
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("a")
    with pytest.raises(error, match=says):
        do(painter)
    assert not painter.labels.any()


@pytest.mark.few(1)
@pytest.mark.parametrize("step", [0.1, 0.5, 3.0])
def test_what_is_settled_without_decoding_is_what_decoding_says(step):
    """Fiblets in one, two and four parts; voxels of 1 mm, slanted, where discs lie in the region."""
    data = compress(brain_streamlines(400, step, seed=3), exact=False)
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    place = np.eye(4)
    place[:3, :3], place[:3, 3] = turn, -turn @ [90.0, 90.0, 90.0]
    painter = regions.RegionPainter(((180, 180, 180), place))
    painter.add("a")
    painter.add("b")
    live = regions.LiveRegions(data, painter)
    region, rng = live.region("a"), np.random.default_rng(11)
    points, near, decoded = data.decompress(dtype=np.float64).points, 0, 0
    for number in range(8):
        at = points[rng.integers(len(points))]
        if number in (3, 6):
            painter.erase(at, 25.0)
        elif number == 5:
            painter.undo()
        else:
            painter.paint("ab"[number == 4], [at, at + 4.0], 7.0)
        near, decoded = near + region.looked_at, decoded + region.decoded
        full = regions.LiveRegions(data, painter).region("a")
        assert np.array_equal(region.passes(), full.flags() & 1 != 0)
        assert region.count == region.passes().sum() == full.count
    assert 0 < decoded < 0.8 * near
    v = (points - place[:3, 3]) @ turn  # a sample of positions, none of which may be missed
    at = np.floor(v + 0.5).astype(int)
    inside = painter.mask("a")[tuple(np.clip(at, 0, 179).T)] & ((at >= 0) & (at < 180)).all(axis=1)
    owners = np.repeat(np.arange(len(data)), np.diff(data.offsets()))
    assert region.passes()[np.unique(owners[inside])].all()


def test_of_two_places_one_is_erased(fiblets):
    """What passes the other, far or near, still does; the rest is told by leaves, as nothing is left near to them."""
    painter = regions.RegionPainter((SHAPE, AFFINE))
    painter.add("a")
    live = regions.LiveRegions(fiblets, painter)
    region = live.region("a")
    points = fiblets.decompress(dtype=np.float64).points
    points = points[np.abs(points).max(axis=1) < 11.0]
    order = np.argsort(points @ [1.0, 0.3, 0.2])
    for one, other in ((order[20], order[-20]), (order[len(order) // 2], order[len(order) // 2 + 40])):
        painter.paint("a", points[one], 5.0)
        painter.paint("a", points[other], 5.0)
        both = region.count
        painter.erase(points[one], 6.0)
        expected = brute(fiblets, painter.mask("a"))[:, 0]
        assert np.array_equal(region.passes(), expected)
        assert 0 < region.count == expected.sum() < both
        painter.clear("a")
        assert region.count == 0
