"""Rays on the GPU see what the float64 reference sees: surfaces, peaks and light, however they are cast."""

from dataclasses import replace

import numpy as np
import pytest

from pvfiblets.engine import EngineError, FibletStyle, View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle, nodes
from pvfiblets.report.studies.volumes import reference
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

SIZE = (72, 56)
EMPTY = 0xFFFFFFFF
AFFINE = np.array([[0.9, 0.1, 0.0, 20.0], [-0.1, 1.1, 0.0, -7.0], [0.0, 0.2, 1.4, 3.0], [0.0, 0.0, 0.0, 1.0]])


def blobs(shape=(27, 22, 19), dtype=np.float32, *, empty=True):
    """A smooth field of some bumps, most of it nothing."""
    rng = np.random.default_rng(3)
    at = np.stack(np.meshgrid(*[np.arange(n) for n in shape], indexing="ij"), axis=-1).astype(float)
    field = np.zeros(shape)
    for _ in range(5):
        centre, width = rng.uniform(0.25, 0.75, 3) * shape, rng.uniform(2.0, 4.0)
        field += rng.uniform(0.5, 1.0) * np.exp(-((at - centre) ** 2).sum(axis=-1) / (2 * width**2))
    field /= field.max()
    if empty:
        field = np.where(field < 0.05, 0.0, field)
    affine = AFFINE.copy()
    affine[:3, :3] *= (np.array([27, 22, 19]) - 1.0) / (np.array(shape) - 1.0)  # the same box, of more voxels
    return RaycastVolume((field * (1.0 if dtype is np.float32 else 250)).astype(dtype), affine)


def top(volume):
    return float(volume.value_range[1])


@pytest.fixture(params=["perspective", "parallel", "inside"])
def matrix(request, camera):
    volume = blobs()
    bounds = np.array(volume.bounds).reshape(3, 2)
    middle, reach = bounds.mean(axis=1), float(np.ptp(bounds, axis=1).max())
    eye = middle + np.array([1.1, -1.7, 0.8]) * reach * (0.12 if request.param == "inside" else 1.0)
    height = {"height": 1.3 * reach} if request.param == "parallel" else {}
    return camera(SIZE, eye=eye, target=middle, near=0.02 * reach, far=6.0 * reach, **height)


@pytest.fixture
def cast(gl):
    renderers = []

    def draw(volume, casting, matrix, **of_view):
        renderer = VolumeRenderer(gl, volume)
        renderers.append(renderer)
        buffer = renderer.render(View(SIZE, matrix, **of_view), VolumeStyle(casting=casting))
        return read(buffer), renderer

    yield draw
    for renderer in renderers:
        renderer.release()
        renderer.release()


class Shown:
    """What a G-buffer holds."""

    def __init__(self, buffer):
        width, height = buffer.size
        self.key = np.frombuffer(buffer.depth.read(), "u4").reshape(height, width)
        self.there = self.key != EMPTY
        self.depth = np.where(self.there, self.key / 4294967295.0, 1.0)
        self.value = np.frombuffer(buffer.position.read(), "f4").reshape(height, width, 2)[..., 1]
        self.light = np.zeros((height, width, 4))
        if buffer.colours is not None:
            rgba = np.frombuffer(buffer.colours.read(), "u1").reshape(height, width, 4) / 255.0
            rgba[..., :3] *= rgba[..., 3:]
            self.light = np.where(self.there[..., None], rgba, 0.0)


def read(buffer):
    return Shown(buffer)


@pytest.mark.few(9)
@pytest.mark.every("pair")
@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.uint16, np.float32])
@pytest.mark.parametrize("refine", ["regula-falsi", "newton"])
def test_surfaces(cast, matrix, dtype, refine):
    volume = blobs(dtype=dtype)
    values = tuple(share * top(volume) + 0.3e-3 * top(volume) for share in (0.3, 0.6))
    shown, _ = cast(volume, RaycastOptions(values=values, step=0.25, refine=refine, iterations=8), matrix)
    through = reference.rays(matrix, SIZE, volume)
    wanted = reference.isosurface(volume, values, through)
    sure = ~(wanted.chord < 0.5)  # what is thinner than two steps may be stepped over
    assert (wanted.value >= 0).sum() > 200
    assert (shown.there == (wanted.value >= 0))[sure].mean() > 0.998
    both = shown.there & (wanted.value >= 0) & sure
    right = np.isclose(shown.value[both], np.array(values)[wanted.value[both]], rtol=1e-6)
    assert right.mean() > (0.94 if dtype is np.uint8 else 0.998)
    off = np.abs(shown.depth - wanted.depth)[both]
    per_mm = np.abs(through.depth(wanted.t + 1e-3) - wanted.depth)[both] / 1e-3
    # Of rounded numbers the field is rough: steps may pass a dip of it.
    assert np.quantile(off / per_mm, 0.9 if dtype is np.uint8 else 0.98) < 5e-3  # mm


def thin(shape, dtype):
    """Numbers of no order: surfaces in nearly all cells, several times in many."""
    numbers = np.random.default_rng(5).random(shape)
    return RaycastVolume((numbers * (1.0 if dtype is np.float32 else 250)).astype(dtype), AFFINE)


@pytest.mark.few(6)
@pytest.mark.every("pair")
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
@pytest.mark.parametrize("made", [blobs, thin])
@pytest.mark.parametrize("octree", [True, False])
def test_cells_hide_no_surface(cast, matrix, dtype, made, octree):
    volume = made((17, 12, 14), dtype)
    values = tuple(share * top(volume) + 0.3e-3 * top(volume) for share in (0.62, 0.3, 0.94))
    shown, _ = cast(volume, RaycastOptions(values=values, step=100.0, octree=octree), matrix)
    through = reference.rays(matrix, SIZE, volume)
    wanted = reference.isosurface(volume, values, through)
    there = wanted.value >= 0
    assert there.sum() > 200
    per_mm = np.abs(through.depth(wanted.t + 1e-3) - wanted.depth) / 1e-3
    off = np.abs(shown.depth - wanted.depth)
    same = shown.there & there & (off <= 2e-3 * per_mm)
    same &= np.isclose(shown.value, np.array(values)[wanted.value], rtol=1e-6)
    # A ray may touch a surface, or a value that is a voxel's own.
    assert (same | ~(shown.there | there)).mean() > 0.999


@pytest.mark.few(4)
@pytest.mark.every("pair")
@pytest.mark.parametrize("more", [{}, {"octree": False}, {"step": 0.02, "refine": "regula-falsi"}])
@pytest.mark.parametrize("made", [blobs, thin])
def test_the_border_closes_surfaces_as_low_voxels_around_the_volume_do(cast, matrix, made, more):
    volume = made((13, 11, 12), np.float32)
    value = 0.3 * top(volume)
    low, high = ((2, 2, 0), (8, 8, 11)) if made is blobs else ((0, 0, 0), (12, 10, 11))
    box = tuple(float(end) for ends in zip(low, high, strict=True) for end in ends) if made is blobs else None
    shown, _ = cast(volume, RaycastOptions(values=(value,), closed=True, box=box, **more), matrix)
    inside = volume.values[tuple(slice(first, last + 1) for first, last in zip(low, high, strict=True))]
    affine = volume.affine.copy()
    affine[:3, 3] += affine[:3, :3] @ low
    affine[:3, 3] -= affine[:3, :3] @ [1.0, 1.0, 1.0]
    padded = RaycastVolume(np.pad(inside, 1, constant_values=-1e4 * top(volume)), affine)
    through = reference.rays(matrix, SIZE, padded)
    wanted = reference.isosurface(padded, (value,), through)
    there = wanted.value >= 0
    assert there.sum() > 200
    per_mm = np.abs(through.depth(wanted.t + 1e-3) - wanted.depth) / 1e-3
    same = shown.there & there & (np.abs(shown.depth - wanted.depth) <= 4e-3 * per_mm)
    assert (same | ~(shown.there | there)).mean() > (0.999 if not more.get("step") else 0.99)
    opened, _ = cast(volume, RaycastOptions(values=(value,), **more), matrix)
    assert (np.abs(opened.depth - shown.depth) > 1e-3).sum() > 100


@pytest.mark.parametrize("half", [None, (0.0, 24.0, 12.0, 24.0, 0.0, 24.0), (0.0, 24.0, 0.0, 12.0, 0.0, 24.0)])
def test_cells_show_translucent_surfaces_one_behind_the_other(cast, camera, half):
    """A ball whose value falls from its middle: each ray through it, or through a closed half, meets surfaces twice."""
    at = np.stack(np.meshgrid(*[np.arange(25.0) - 12.0] * 3, indexing="ij"), axis=-1)
    volume = RaycastVolume((20.0 - np.linalg.norm(at, axis=-1)).astype(np.float32), np.eye(4))
    matrix = camera(SIZE, eye=(12.0, -200.0, 12.0), target=(12.0, 12.0, 12.0), near=10, far=400, height=30.0)
    surfaces = ((1.0, 0.0, 0.0, 0.25), (0.0, 1.0, 0.0, 0.5))
    casting = RaycastOptions(values=(11.0, 16.0), surfaces=surfaces, step=100.0, box=half, closed=half is not None)
    shown, _ = cast(volume, casting, matrix)
    y, x = (np.indices(SIZE[::-1]) + 0.5 - np.array(SIZE[::-1]).reshape(2, 1, 1) / 2) * 30.0 / SIZE[1]
    beside = np.hypot(x, y)
    inner, outer = beside < 3.5, (beside > 4.5) & (beside < 8.5)
    assert inner.sum() > 20
    np.testing.assert_allclose(shown.light[outer][:, 3], 1 - 0.75**2, atol=0.006)
    np.testing.assert_allclose(shown.light[inner][:, 3], 1 - 0.75**2 * 0.5**2, atol=0.006)
    assert not shown.there[beside > 9.5].any()


@pytest.mark.parametrize("filter", ["nearest", "trilinear", "tricubic"])
def test_filters(cast, camera, filter):  # noqa: A002
    volume = blobs()
    matrix = camera(SIZE, eye=(60, -60, 40), target=np.array(volume.bounds).reshape(3, 2).mean(axis=1), near=5, far=300)
    shown, _ = cast(volume, RaycastOptions(values=(0.4,), step=0.1, filter=filter, iterations=12), matrix)
    through = reference.rays(matrix, SIZE, volume)
    wanted = reference.isosurface(volume, 0.4, through, filter=filter)
    sure = ~(wanted.chord < 0.3)
    assert (shown.there == (wanted.value >= 0))[sure].mean() > 0.995
    both = shown.there & (wanted.value >= 0) & sure
    per_mm = np.abs(through.depth(wanted.t + 1e-3) - wanted.depth)[both] / 1e-3
    assert np.median(np.abs(shown.depth - wanted.depth)[both] / per_mm) < 0.01


@pytest.mark.few(1)
def test_peaks(cast, matrix):
    volume = blobs()
    shown, _ = cast(volume, RaycastOptions("mip", step=0.1), matrix)
    wanted = reference.mip(volume, reference.rays(matrix, SIZE, volume))
    there = ~np.isnan(wanted.value)
    assert (shown.there == there).mean() > 0.995
    both = shown.there & there
    assert np.abs(shown.value - wanted.value)[both].max() < 5e-3


@pytest.mark.few(6)
@pytest.mark.every("pair")
@pytest.mark.parametrize("limits", [(-np.inf, np.inf), (0.2, 0.55)])
@pytest.mark.parametrize(("mode", "threshold"), [("mip", None), ("local-mip", 0.4), ("minimum", None)])
@pytest.mark.parametrize("made", [blobs, thin])
@pytest.mark.parametrize("octree", [True, False])
def test_cells_hide_no_peak(cast, matrix, mode, threshold, made, limits, octree):
    volume = made((17, 12, 14), np.float32)
    low, high = (limit * top(volume) for limit in limits)
    casting = RaycastOptions(
        mode, step=100.0, low=low, high=high, octree=octree, threshold=(threshold or 0.0) * top(volume)
    )
    shown, _ = cast(volume, casting, matrix)
    through = reference.rays(matrix, SIZE, volume)
    sign = 1.0
    if mode == "minimum":  # the greatest of what is turned over
        sign, low, high = -1.0, -high, -low
    turned = RaycastVolume((sign * volume.values).astype(np.float32), volume.affine)
    wanted = reference.mip(
        turned, through, low=low, high=high, threshold=None if threshold is None else threshold * top(volume)
    )
    there = ~np.isnan(wanted.value)
    assert there.sum() > 200
    assert (shown.there == there).mean() > 0.999
    both = shown.there & there
    apart = np.abs(sign * shown.value - wanted.value)[both]
    # A dip that float32 does not tell from a level ends no peak there.
    assert (apart < 2e-5 * top(volume)).mean() > (0.999 if threshold is None else 0.99)


@pytest.mark.parametrize("octree", [True, False])
@pytest.mark.parametrize(
    ("dtype", "threshold", "low"),
    [*((kind, least, 0.0) for kind in (np.uint8, np.float32) for least in (50.0, 150.0)), (np.float32, 50.0, 1e6)],
)
def test_local_peaks_do_not_end_on_plateaus(cast, camera, dtype, threshold, low, octree):
    """Cubes within cubes, level between their faces: what is level has not fallen, whole nodes of it neither."""
    field = np.zeros((64, 64, 64), dtype)
    field[8:56, 8:56, 8:56] = 100.1 if dtype is np.float32 else 100
    field[24:40, 24:40, 24:40] = 250.3 if dtype is np.float32 else 250
    field += dtype(low)
    threshold += low
    volume = RaycastVolume(field, np.eye(4))
    matrix = camera(SIZE, eye=(110, -120, 90), target=(32, 32, 32), near=5, far=400, height=90.0)
    through = reference.rays(matrix, SIZE, volume)
    wanted = reference.mip(volume, through, threshold=threshold).value
    shown, _ = cast(volume, RaycastOptions("local-mip", step=0.25, threshold=threshold, octree=octree), matrix)
    there = shown.there & ~np.isnan(wanted)
    assert (wanted[there] > low + 240).sum() > 50
    assert (np.abs(shown.value - wanted)[there] > 12.0).mean() < 0.01  # steps miss some of an edge's top
    assert abs(shown.value[SIZE[1] // 2, SIZE[0] // 2] - float(field.max())) < (0.2 if low else 0.01)


def ramp(k=64, most=0.4):
    table = np.linspace(0.0, 1.0, k)[:, None] * np.array([1.0, 0.7, 0.3, most])
    return table.astype(np.float32)


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize(
    ("integrator", "bound"),
    [("preintegrated", 0.012), ("exponential", 0.012), ("simpson", 0.012), ("rk4", 0.012), ("riemann", 0.05)],
)
def test_light(cast, matrix, integrator, bound):
    volume = blobs()
    transfer = Transfer(ramp(), (0.0, 1.0))
    shown, _ = cast(
        volume, RaycastOptions("composite", transfer=transfer, step=0.25, integrator=integrator, stop=1.0), matrix
    )
    wanted = np.nan_to_num(reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume), tolerance=1e-5))
    assert wanted[..., 3].max() > 0.5
    assert np.abs(shown.light - wanted).max() < bound


@pytest.mark.every("value")
@pytest.mark.parametrize("mode", ["isosurface", "composite", "mip", "local-mip"])
def test_without_skipping_there_is_no_octree(cast, matrix, monkeypatch, mode):
    made = []
    build = nodes.build_octree
    monkeypatch.setattr(nodes, "build_octree", lambda *given: made.append(given) or build(*given))
    volume = blobs()
    given = {"values": (0.5 * top(volume),), "transfer": Transfer(np.eye(4)[[3, 0]], (0.0, 1.0)), "threshold": 0.1}
    casting = RaycastOptions(mode, **given, octree=False)
    _, renderer = cast(volume, casting, matrix)
    assert not made
    told = renderer.explain()
    assert told["octree"] == {"bytes": 0, "share": 0.0, "ms": 0.0}
    assert (told["nodes"], told["skipped"]) == (0, 0.0)
    assert not {"nodes", "means"} & {buffer["name"] for buffer in told["buffers"]}
    view = View(SIZE, matrix)
    renderer.render(view, VolumeStyle(casting=replace(casting, octree=True)))
    assert len(made) == 1
    assert renderer.explain()["octree"]["bytes"] > 0
    renderer.render(view, VolumeStyle(casting=casting))  # and what is no longer asked for is given back
    assert renderer.explain()["octree"]["bytes"] == 0


@pytest.mark.few(2)
@pytest.mark.every("value")
@pytest.mark.parametrize(
    "casting",
    [
        RaycastOptions(values=(0.3, 0.7), step=0.5),
        RaycastOptions(values=(0.3,), step=0.5, filter="tricubic"),
        RaycastOptions("mip", step=0.5),
        RaycastOptions("local-mip", step=0.5, threshold=0.3),
        RaycastOptions("composite", transfer=Transfer(ramp(), (0.0, 1.0)), step=0.5),
        RaycastOptions(
            "composite", transfer=Transfer(ramp(), (0, 1)), step=0.5, integrator="exponential", low=0.2, high=0.8
        ),
    ],
    ids=lambda casting: f"{casting.mode}-{casting.filter}-{casting.integrator}",
)
def test_the_octree_changes_no_pixel(cast, matrix, casting):
    volume = blobs((61, 35, 47))
    quick, renderer = cast(volume, casting, matrix)
    plain, _ = cast(volume, replace(casting, octree=False), matrix)
    assert plain.there.any()
    # Steps over what is skipped are added at once, and so round otherwise.
    differ = (quick.there != plain.there) | (np.abs(quick.depth - plain.depth) > 1e-5)
    assert differ.mean() < 0.004
    assert np.abs(quick.light - plain.light).max() < 0.012
    if casting.mode in ("isosurface", "composite"):
        assert renderer.explain()["skipped"] > 0.2


def test_nodes_that_hardly_change_may_be_taken_as_their_mean(cast, matrix):
    volume = blobs((61, 35, 47))
    transfer = Transfer(ramp(), (0.0, 1.0))
    plain, _ = cast(volume, RaycastOptions("composite", transfer=transfer), matrix)
    quick, _ = cast(volume, RaycastOptions("composite", transfer=transfer, homogeneous=0.02), matrix)
    assert np.abs(quick.light - plain.light).max() < 0.03


@pytest.mark.parametrize("stride", [2, 4])
def test_a_plane_is_as_deep_at_the_pictures_edges_as_without_sparse_rays(cast, camera, stride):
    volume = RaycastVolume(np.indices((20, 20, 20)).astype(np.float32).sum(axis=0))
    matrix = camera(SIZE, eye=(30, 22, 18), target=(9.5, 9.5, 9.5), height=5.0, near=5, far=100)
    plain, _ = cast(volume, RaycastOptions(values=(28.5,)), matrix)
    sparse, _ = cast(volume, RaycastOptions(values=(28.5,), sparse=stride), matrix)
    assert plain.there.all()
    np.testing.assert_allclose(sparse.depth, plain.depth, atol=2e-6)


@pytest.mark.few(4)
@pytest.mark.every("pair")
@pytest.mark.parametrize("stride", [2, 4])
@pytest.mark.parametrize("mode", ["isosurface", "mip", "composite"])
def test_sparse_casting(cast, matrix, mode, stride):
    volume = blobs()
    more = {"isosurface": {"values": (0.4,)}, "composite": {"transfer": Transfer(ramp(), (0.0, 1.0))}, "mip": {}}[mode]
    plain, _ = cast(volume, RaycastOptions(mode, **more), matrix)
    sparse, renderer = cast(volume, RaycastOptions(mode, **more, sparse=stride), matrix)
    assert [p["name"] for p in renderer.explain()["passes"]] == ["sparse rays", "between", "other rays"]
    assert (sparse.there == plain.there).mean() > 0.985
    both = sparse.there & plain.there
    assert np.abs(sparse.value - plain.value)[both].max() < 0.08
    assert np.quantile(np.abs(sparse.light - plain.light), 0.99) < 0.06


def test_planes_and_boxes_cut(cast, matrix):
    volume = blobs()
    middle = np.array(volume.bounds).reshape(3, 2).mean(axis=1)
    planes = [[1.0, 0.3, 0.0, -float(np.array([1.0, 0.3, 0.0]) @ middle)]]
    box = (3.0, 22.0, 4.0, 15.0, 2.0, 17.0)
    shown, _ = cast(volume, RaycastOptions("mip", step=0.1, box=box), matrix, clip_planes=planes)
    wanted = reference.mip(volume, reference.rays(matrix, SIZE, volume, clip_planes=planes, box=box))
    there = ~np.isnan(wanted.value)
    assert (shown.there == there).mean() > 0.99
    both = shown.there & there
    assert np.quantile(np.abs(shown.value - wanted.value)[both], 0.99) < 0.02  # the first sample lies where rays enter


def test_rays_end_at_what_is_opaque(gl, camera):
    volume = blobs()
    middle = np.array(volume.bounds).reshape(3, 2).mean(axis=1)
    matrix = camera(SIZE, eye=(60, -60, 40), target=middle, near=5, far=300)
    depth = float((matrix @ [*middle, 1.0])[2] / (matrix @ [*middle, 1.0])[3]) / 2 + 0.5
    outside = gl.texture(SIZE, 1, np.full(SIZE[::-1], int(depth * 4294967295.0), "u4"), dtype="u4")
    outside.filter = gl.NEAREST, gl.NEAREST
    renderer = VolumeRenderer(gl, volume)
    style = VolumeStyle(casting=RaycastOptions("mip", step=0.1))
    shown = Shown(renderer.render(View(SIZE, matrix), style, outside=outside))
    wanted = reference.mip(volume, reference.rays(matrix, SIZE, volume, depths=np.full(SIZE[::-1], depth)))
    both = shown.there & ~np.isnan(wanted.value)
    assert both.sum() > 200
    assert np.quantile(np.abs(shown.value - wanted.value)[both], 0.99) < 5e-3
    renderer.release()
    outside.release()


@pytest.mark.parametrize("far", [1e6, 1e-3])
def test_volumes_far_away_and_tiny_look_the_same(cast, camera, far):
    plain, moved = blobs(), None
    middle = np.array(plain.bounds).reshape(3, 2).mean(axis=1)
    matrix = camera(SIZE, eye=middle + [60, -60, 40], target=middle, near=5, far=300)
    change = np.eye(4)
    if far > 1:
        change[:3, 3] = far
    else:
        change[:3, :3] *= far
    moved = RaycastVolume(plain.values, change @ plain.affine)
    one, _ = cast(plain, RaycastOptions(values=(0.4,)), matrix)
    other, _ = cast(moved, RaycastOptions(values=(0.4,)), matrix @ np.linalg.inv(change))
    assert (one.there == other.there).mean() > 0.999
    assert np.quantile(np.abs(one.depth - other.depth), 0.999) < 1e-5


def test_redraws_only_when_something_changed(gl, camera):
    renderer = VolumeRenderer(gl, blobs())
    view = View(SIZE, camera(SIZE, eye=(60, -60, 40), target=(30, 0, 15), near=5, far=300))
    style = VolumeStyle(casting=RaycastOptions(values=(0.4,)))
    first = renderer.render(view, style)
    generation = first.generation
    assert renderer.render(view, style) is first
    assert first.generation == generation
    renderer.render(view, VolumeStyle(casting=RaycastOptions(values=(0.5,))))
    assert first.generation == generation + 1
    assert not renderer.needs_outside(view, style)
    assert renderer.needs_outside(view, VolumeStyle(casting=RaycastOptions("mip")))
    with pytest.raises(TypeError, match="VolumeStyle"):
        renderer.render(view, FibletStyle())
    renderer.release()
    renderer.release()
    with pytest.raises(EngineError, match="released"):
        renderer.render(view, style)


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ({"mode": "fog"}, "mode is 'fog'"),
        ({"values": ()}, "values of isosurfaces"),
        ({"values": (float("nan"),)}, "values of isosurfaces"),
        ({"mode": "composite"}, "needs transfer"),
        ({"mode": "mip", "low": 2.0, "high": 1.0}, "thresholds"),
        ({"mode": "mip", "step": 0.0}, "step is 0.0"),
        ({"mode": "mip", "sparse": 3}, "sparse is 3"),
        ({"mode": "mip", "filter": "sinc"}, "filter is 'sinc'"),
        ({"mode": "mip", "box": (1, 0, 0, 1, 0, 1)}, "box is"),
    ],
)
def test_bad_choices_are_refused(bad, message):
    with pytest.raises(ValueError, match=message):
        RaycastOptions(**bad)
