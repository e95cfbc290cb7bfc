"""Queries on the GPU against `contains` on the decoded points, streamline by streamline."""

import numpy as np
import pytest

import pvfiblets
from pvfiblets import regions
from pvfiblets.codec.layout import DIRECTION, LATTICE8, LATTICE16, SPLINE, WIDE, coded_kind
from pvfiblets.engine import EngineError, FibletRenderer, View
from pvfiblets.engine.fiblets.region_query import ALL, ANY, FIRST, LAST, nearest_anchor
from pvfiblets.query.selection.passing import region_flags

from .region_shapes import NAMES, made

PAGE = 16384


def steady(n, *, points=150, step=0.5, turn=0.05, seed=0, spread=30.0):
    """Lines of one step that turn slowly; the first few have one, two and no points."""
    rng = np.random.default_rng(seed)
    d = rng.normal(0, 1, (n, 1, 3)) + np.cumsum(rng.normal(0, turn, (n, points, 3)), axis=1)
    d *= step / np.linalg.norm(d, axis=2, keepdims=True)
    lines = list(rng.uniform(-spread, spread, (n, 1, 3)) + np.cumsum(d, axis=1))
    for i, count in enumerate((1, 2, 0, 1, 61)):
        lines[i] = lines[i][:count]
    return lines


def wandering(n, *, points=90, seed=0, spread=30.0):
    """Random walks whose steps are all unlike: lattice fiblets."""
    rng = np.random.default_rng(seed)
    return [
        rng.uniform(-spread, spread, 3) + np.cumsum(rng.normal(0, 0.6, (points - i % 9, 3)), axis=0) for i in range(n)
    ]


def packed(lines, **options):
    return pvfiblets.compress(pvfiblets.Streamlines.from_list(lines), **options)


def by_numpy(fiblets, region):
    """Flags of every streamline from its decoded points."""
    lines = fiblets.decompress(dtype=np.float64)
    points, offsets = lines.points, np.asarray(lines.offsets)
    inside, some = region.contains(points), np.diff(offsets) > 0
    counts = np.diff(np.concatenate([[0], np.cumsum(inside)])[offsets])
    found = np.zeros(len(fiblets), np.uint8)
    found[some] = np.where(counts > 0, ANY, 0)[some] | np.where(counts == np.diff(offsets), ALL, 0)[some]
    found[some] |= np.where(inside[offsets[:-1][some]], FIRST, 0).astype(np.uint8)
    found[some] |= np.where(inside[offsets[1:][some] - 1], LAST, 0).astype(np.uint8)
    return found


@pytest.fixture(scope="module")
def plain():
    return packed(steady(150))


@pytest.mark.few(1)
@pytest.mark.parametrize("name", NAMES)
def test_every_shape(gl, plain, name):
    renderer = FibletRenderer(gl, plain)
    wanted = 0
    for size in (10.0, 60.0, 200.0):
        region = made((3.0, -2.0, 4.0), size)[name]
        found = renderer.query(region, "points")
        assert (found == by_numpy(plain, region)).all()
        assert renderer._query.unsure < 80
        assert (renderer.query(region) == region_flags(plain, region)).all()
        assert renderer._query.unsure < 80
        wanted |= np.bitwise_or.reduce(found)
    assert wanted & ANY
    renderer.release()


SETS = {
    "lattice": lambda: packed(wandering(80), max_error=0.2),
    "wide lattice": lambda: packed([line * [1, 1, 40] for line in wandering(80)], max_error=0.05),
    "32-bit anchors": lambda: packed([*steady(100), steady(6)[5] + 20000.0]),
    "fine lattice": lambda: packed(steady(100), max_error=1e-4),
    "hilbert": lambda: packed(steady(120), order="hilbert"),
    "turned sharply": lambda: packed(steady(100, turn=1.0)),
    "both kinds": lambda: packed(steady(60) + wandering(60)),
    "splines": lambda: packed(steady(100, step=0.1, turn=0.01) + wandering(30), effort="small"),
}


KINDS = {
    "lattice": {LATTICE16},
    "wide lattice": {WIDE},
    "fine lattice": {WIDE},
    "turned sharply": {DIRECTION, LATTICE8},
    "both kinds": {DIRECTION, LATTICE16, WIDE},
    "splines": {DIRECTION, SPLINE},
}


@pytest.mark.more
@pytest.mark.parametrize("kind", SETS)
def test_every_kind_of_fiblet(gl, kind):
    fiblets = SETS[kind]()
    assert (fiblets.anchors_low is not None) == (kind in ("32-bit anchors", "fine lattice"))
    assert set(np.unique(coded_kind(fiblets.decoding))) >= KINDS.get(kind, {DIRECTION})
    renderer = FibletRenderer(gl, fiblets)
    for name, region in made((3.0, -2.0, 4.0), 50.0).items():
        assert (renderer.query(region, "points") == by_numpy(fiblets, region)).all(), name
        assert (renderer.query(region) == region_flags(fiblets, region)).all(), name
    renderer.release()


@pytest.mark.few(1)
@pytest.mark.parametrize("offset", [1e6, -1e6])
@pytest.mark.parametrize("scale", [1.0, 1e-3, 1e3])
def test_far_away_tiny_and_huge(gl, offset, scale):
    # A coordinate of 1e6 has ten digits behind the point in float64.
    lines = [scale * line + [offset, 0.0, -offset] for line in steady(150)]
    fiblets = packed(lines)
    renderer = FibletRenderer(gl, fiblets)
    for name, region in made((offset, 0.0, -offset), 60.0 * scale).items():
        assert (renderer.query(region, "points") == by_numpy(fiblets, region)).all(), name
        assert renderer._query.unsure < 80
        assert (renderer.query(region) == region_flags(fiblets, region)).all(), name
    renderer.release()


def test_faces_that_touch_points(gl, plain):
    points = plain.decompress(dtype=np.float64).points
    rng = np.random.default_rng(3)
    renderer = FibletRenderer(gl, plain)
    unsure = 0
    for _ in range(4):
        low, high = np.sort(points[rng.integers(0, len(points), 2)], axis=0)
        for region in (
            regions.Box(np.stack([low, high], axis=1).ravel()),
            regions.Plane(rng.normal(0, 1, 3), low),
            regions.Sphere(low, np.linalg.norm(high - low)),
            regions.Slab((0, 0, 1), low / 2 + high / 2, high[2] - low[2]),
        ):
            assert (renderer.query(region, "points") == by_numpy(plain, region)).all()
            unsure += renderer._query.unsure
    assert unsure > 0
    renderer.release()


def test_segments_between_points(gl):
    fiblets = packed(steady(60, step=3.0, turn=0.3) + wandering(40))
    renderer = FibletRenderer(gl, fiblets)
    more = 0
    shapes = [made((3.0, -2.0, 4.0), 8.0)[name] for name in ("sphere", "box", "torus", "labels", "expression")]
    for region in (*shapes, regions.Slab((1, 2, 3), (3.0, -2.0, 4.0), 0.3), ~regions.Slab((1, 2, 3), (0, 0, 0), 0.3)):
        found = renderer.query(region)
        assert (found == region_flags(fiblets, region)).all()
        more += int((found & ANY).sum()) - int((renderer.query(region, "points") & ANY).sum())
    assert more > 10
    renderer.release()


def test_one_long_step(gl):
    line = np.array([[0.0, 0, 0], [0.5, 0, 0], [50000.0, 3.0, 0], [50000.5, 3.0, 0]])
    fiblets = packed([line, line + 1.0])
    renderer = FibletRenderer(gl, fiblets)
    region = regions.Slab((1, 0, 0), (25000.0, 0, 0), 1.0)
    assert (renderer.query(region, "points") == 0).all()
    assert (renderer.query(region) == ANY).all()
    renderer.release()


def test_streamlines_in_many_chunks(gl):
    t = np.linspace(0, 60, 40000)
    long = np.stack([50 * np.cos(t), 50 * np.sin(t * 1.1), t - 30], axis=1)
    lines = [long, *steady(2000, points=60), long[::-1] + 3.0] + [np.zeros((0, 3))]
    lines += [line[:1] for line in steady(3 * PAGE, points=2)]
    fiblets = packed(lines)
    assert fiblets.n_fiblets > 3 * PAGE
    renderer = FibletRenderer(gl, fiblets, max_buffer_bytes=300_000, max_groups=31)
    assert len(renderer._chunks) >= 3
    for name in ("sphere", "expression", "labels"):
        region = made((0.0, 0.0, 0.0), 80.0)[name]
        assert (renderer.query(region, "points") == by_numpy(fiblets, region)).all()
    renderer.release()


@pytest.mark.parametrize("batch", [64, 100, 1 << 20])
def test_batches(gl, plain, monkeypatch, batch):
    monkeypatch.setattr("pvfiblets.engine.fiblets.region_query.BATCH", batch)
    renderer = FibletRenderer(gl, plain)
    region = made(size=60.0)["expression"]
    assert (renderer.query(region, "points") == by_numpy(plain, region)).all()
    renderer.release()


@pytest.mark.parametrize("pipeline", ["tessellation", "geometry"])
def test_other_pipelines(gl, plain, pipeline):
    renderer = FibletRenderer(gl, plain, pipeline=pipeline)
    region = made(size=60.0)["torus"]
    assert (renderer.query(region, "points") == by_numpy(plain, region)).all()
    assert renderer._query.available
    renderer.release()


def test_the_cpu_answers_where_the_gpu_has_a_part(gl):
    fiblets = packed(steady(2000, points=120))
    needed = sum(plan.nbytes + plan.values for plan in (c.plan for c in FibletRenderer(gl, fiblets)._chunks))
    renderer = FibletRenderer(gl, fiblets, fit="sample", max_total_bytes=needed // 2)
    assert renderer.share < 1.0
    region = made(size=60.0)["sphere"]
    found = renderer.query(region, "points")
    assert not renderer._query.available
    assert (found == by_numpy(fiblets, region)).all()
    renderer.release()


def test_the_cpu_answers_where_fields_do_not_fit(gl, plain):
    renderer = FibletRenderer(gl, plain)
    region = made(size=60.0)["labels"]
    expected = renderer.query(region)
    renderer._query._block.release()
    renderer._query._block._textures._largest = 8
    assert (renderer.query(region) == expected).all()
    renderer.release()


def test_nothing_to_ask(gl):
    fiblets = packed([np.zeros((0, 3)), np.zeros((0, 3))])
    renderer = FibletRenderer(gl, fiblets)
    assert renderer.query(regions.Sphere((0, 0, 0), 1.0)).tolist() == [0, 0]
    renderer.release()


@pytest.mark.more
def test_a_picture_is_as_it_was(gl, plain, camera):
    renderer = FibletRenderer(gl, plain)
    view = View((120, 90), camera((120, 90)))
    before = renderer.render(view).depth.read()
    for name in ("torus", "box"):
        renderer.query(made(size=60.0)[name])
        assert renderer.render(view).depth.read() == before
        assert renderer.render(View((120, 90), camera((120, 90), eye=(0, -200, 60)))).depth.read() != before
        assert renderer.render(view).depth.read() == before
    assert renderer.explain()["fiblets"]["in_frustum"] == plain.n_fiblets
    renderer.release()


def test_what_stays_on_the_gpu_is_told_and_no_query_is_answered_after_release(gl, plain):
    renderer = FibletRenderer(gl, plain)
    assert "query" not in {buffer["name"] for buffer in renderer.explain()["buffers"]}
    region = made(size=60.0)["torus"]
    renderer.query(region)
    sizes = {buffer["name"]: buffer["bytes"] for buffer in renderer.explain()["buffers"]}
    assert sizes["query"] >= region.leaves[0].field.values.nbytes
    renderer.release()
    assert "query" not in {buffer["name"] for buffer in renderer.explain(counts=False)["buffers"]}
    renderer = FibletRenderer(gl, plain)
    with pytest.raises(ValueError, match=r"sampling is 0\.5; give 'lines'"):
        renderer.query(regions.Sphere((0, 0, 0), 1), 0.5)
    renderer.release()
    renderer = FibletRenderer(gl, plain)
    renderer.query(regions.Sphere((0, 0, 0), 1))
    renderer.release()
    with pytest.raises(EngineError, match="released"):
        renderer.query(regions.Sphere((0, 0, 0), 1))
    renderer.release()


def test_reference_lies_in_the_region():
    origin, scale = np.array([-10.0, 0.0, 5.0]), np.array([0.001, 0.002, 0.0])
    anchor = nearest_anchor(regions.Box((0, 2, 30, 40, -1, 1)), origin, scale, 65535)
    assert anchor.tolist() == [11000, 17500, 0]
    assert nearest_anchor(regions.Plane((0, 0, 1), (0, 0, 0)), origin, scale, 65535).tolist() == [32767, 32767, 0]
    far = regions.Sphere((1e9, -1e9, 0), 1.0)
    assert nearest_anchor(far, origin, scale, 65535).tolist() == [65535, 0, 0]
    nothing = regions.Box((0, 1, 0, 1, 0, 1)) & regions.Box((5, 6, 5, 6, 5, 6))
    assert ((nearest_anchor(nothing, origin, scale, 65535) >= 0) & (anchor <= 65535)).all()
