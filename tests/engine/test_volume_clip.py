"""Rays see what lies inside a region, and nothing else: closed forms for every pixel, in all modes."""

import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine import View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.report.studies.volumes import reference
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

SIZE = (64, 48)
EMPTY = 0xFFFFFFFF
KAPPA = 0.08
TURN = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])  # the volume's axes; those of the world are mm
ONE, TWO = np.array([-6.0, 5.0, 0.0]), np.array([5.0, -6.0, 3.0])  # balls of 4 and 5 mm


def volume(field, n=25):
    """A cube of 30 mm around the origin, turned, of the numbers of a function of mm."""
    spacing = 30.0 / (n - 1)
    affine = np.eye(4)
    affine[:3, :3] = TURN * spacing * np.array([1.0, -1.0, 1.0])
    affine[:3, 3] = -affine[:3, :3] @ np.full(3, (n - 1) / 2)
    voxels = np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), axis=-1)
    return RaycastVolume(field(voxels @ affine[:3, :3].T + affine[:3, 3]).astype(np.float32), affine)


FOG = volume(lambda p: np.ones(p.shape[:3]), 9)
LIGHT = RaycastOptions("composite", transfer=Transfer([[1, 0.5, 0, 1 - np.exp(-KAPPA)]] * 2, (0.0, 2.0)), stop=1.0)


def icosphere(centre, radius):
    pv = pytest.importorskip("pyvista")
    mesh = pv.Icosphere(radius=radius, center=centre, nsub=5)
    return regions.Surface(np.asarray(mesh.points, float), mesh.regular_faces)


@pytest.fixture(params=["perspective", "parallel", "inside"])
def matrix(request, camera):
    eye = np.array([2.0, -50.0, 8.0]) if request.param != "inside" else np.array([0.3, 0.2, -0.4])
    height = {"height": 36.0} if request.param == "parallel" else {}
    target = (0.0, 0.0, 0.0) if request.param != "inside" else tuple(TWO)
    return camera(SIZE, eye=eye, target=target, near=0.5, far=150.0, **height)


@pytest.fixture
def cast(gl):
    made = []

    def draw(drawn, casting, matrix, region=None, **of_view):
        renderer = VolumeRenderer(gl, drawn)
        made.append(renderer)
        buffer = renderer.render(View(SIZE, matrix, region=region, **of_view), VolumeStyle(casting=casting))
        width, height = SIZE
        there = np.frombuffer(buffer.depth.read(), "u4").reshape(height, width) != EMPTY
        found = {"there": there, "place": np.frombuffer(buffer.position.read(), "f4").reshape(height, width, 2)}
        found["key"] = np.frombuffer(buffer.depth.read(), "u4").reshape(height, width) / 4294967295.0
        if buffer.colours is not None:
            alpha = np.frombuffer(buffer.colours.read(), "u1").reshape(height, width, 4)[..., 3] / 255.0
            found["alpha"] = np.where(there, alpha, 0.0)
        return found, renderer

    yield draw
    for renderer in made:
        renderer.release()
        renderer.release()


def chord(through, centre, radius):
    """From where to where rays are in a ball; nowhere, an empty stretch."""
    to = through.origins - centre
    b = (to * through.directions).sum(-1)
    left = b**2 - (to**2).sum(-1) + radius**2
    root = np.sqrt(np.maximum(left, 0.0))
    return np.where(left > 0.0, -b - root, 1e9), np.where(left > 0.0, -b + root, 1e9)


def overlap(through, span):
    near, far = np.nan_to_num(through.near, nan=0.0), np.nan_to_num(through.far, nan=0.0)
    return np.maximum(np.minimum(span[1], far) - np.maximum(span[0], near), 0.0)


@pytest.mark.few(2)
@pytest.mark.every("value")
@pytest.mark.parametrize("shapes", ["spheres", "meshes"])
@pytest.mark.parametrize("inside", [True, False])
def test_light_is_that_of_all_parts(cast, matrix, shapes, inside):
    ball = regions.Sphere if shapes == "spheres" else icosphere
    region = ball(tuple(ONE), 4.0) | ball(tuple(TWO), 5.0)
    shown, _ = cast(FOG, LIGHT, matrix, region if inside else ~region)
    through = reference.rays(matrix, SIZE, FOG)
    kept = overlap(through, chord(through, ONE, 4.0)) + overlap(through, chord(through, TWO, 5.0))
    if not inside:
        kept = np.nan_to_num(through.far - through.near) - kept
    wanted = 1.0 - np.exp(-KAPPA * kept)
    wrong = np.abs(shown["alpha"] - wanted)
    assert (wanted > 0.1).sum() > 200
    # Half a level of eight bits; a mesh of flat faces is a little smaller than its ball.
    assert np.quantile(wrong, 0.98) < (0.003 if shapes == "spheres" else 0.01)
    assert wrong.max() < (0.01 if shapes == "spheres" else 0.06)


def test_surfaces_are_the_first_inside(cast, matrix):
    """Without what lies before a plane, the far wall of a ball shows, and not where the plane is."""
    ball = volume(lambda p: 10.0 - np.linalg.norm(p, axis=-1), 61)
    through = reference.rays(matrix, SIZE, ball)
    away = np.sign(through.directions[..., 1].mean())
    normal = away * np.array([0.1, 1.0, 0.0]) / np.hypot(0.1, 1.0)
    plane = regions.Plane(tuple(normal), (0.0, away, 0.0))
    shown, _ = cast(ball, RaycastOptions(values=(3.0,), step=0.25), matrix, plane)
    spans = np.array(chord(through, np.zeros(3), 7.0))
    spans = np.where(spans < 1e8, spans, np.nan)
    heights = through.points(spans) @ normal - away * normal[1]
    before = ~(spans > through.near)  # or the eye is beyond it
    first = np.where((heights[0] > 0) & ~before[0], spans[0], np.where((heights[1] > 0) & ~before[1], spans[1], np.nan))
    sure = (np.abs(heights) > 0.2).all(0) | np.isnan(heights).all(0)
    sure &= ~(np.abs(spans[0] - spans[1]) < 1.0)
    there = ~np.isnan(first)
    assert (there & sure).sum() > 100
    assert (shown["there"] == there)[sure].mean() > 0.995
    both = shown["there"] & there & sure
    assert np.quantile(np.abs(shown["key"] - through.depth(first))[both], 0.98) < 2e-4


@pytest.mark.parametrize("mode", ["mip", "local-mip"])
def test_peaks_are_of_what_lies_inside(cast, matrix, mode):
    """Values rise along y, so that the greatest is at the farthest place of all parts along +y."""
    rising = volume(lambda p: p[..., 1])
    region = regions.Sphere(tuple(ONE), 4.0) | regions.Sphere(tuple(TWO), 5.0)
    shown, _ = cast(rising, RaycastOptions(mode, step=0.02, threshold=100.0), matrix, region)
    through = reference.rays(matrix, SIZE, rising)
    greatest = np.full(SIZE[::-1], -np.inf)
    for centre, radius in ((ONE, 4.0), (TWO, 5.0)):
        span = chord(through, centre, radius)
        long = overlap(through, span) > 0.1
        for end in (np.maximum(span[0], through.near), np.minimum(span[1], through.far)):
            y = through.points(np.where(long, end, 0.0))[..., 1]
            greatest = np.where(long, np.maximum(greatest, y), greatest)
    there = np.isfinite(greatest)
    assert (shown["there"] & there).sum() > 150
    assert np.abs(shown["place"][..., 1] - greatest)[shown["there"] & there].max() < 0.06  # a step of 0.025 mm, twice
    assert (shown["there"] | ~there).all()


def test_the_first_peak_may_lie_in_a_later_part(cast, camera):
    """Of two layers the rear one alone has a peak that is high enough; a region ends before it, between, or behind."""
    layers = volume(lambda p: np.exp(-((p[..., 1] + 6) ** 2)) + 2.0 * np.exp(-((p[..., 1] - 6) ** 2)), 121)
    matrix = camera(SIZE, eye=(0, -50, 0), target=(0, 0, 0), near=1, far=150, height=4.0)
    front, rear = regions.Slab((0, 1, 0), (0, -6, 0), 6.0), regions.Slab((0, 1, 0), (0, 6, 0), 6.0)
    for region, threshold, value in (
        (front, 0.5, 1.0), (rear, 0.5, 2.0), (front | rear, 0.5, 1.0), (front | rear, 1.5, 2.0), (None, 1.5, 2.0)
    ):  # fmt: skip
        shown, _ = cast(layers, RaycastOptions("local-mip", step=0.1, threshold=threshold), matrix, region)
        assert np.abs(shown["place"][20:28, 28:36, 1] - value).max() < 0.05


@pytest.mark.few(1)
def test_the_octree_and_sparse_rays_agree(cast, matrix):
    ball = volume(lambda p: np.maximum(10.0 - np.linalg.norm(p, axis=-1), 0.0), 41)
    region = icosphere((3.0, -4.0, 2.0), 8.0) - regions.Sphere((3.0, -4.0, 2.0), 4.0)
    for mode, more in (("isosurface", {"values": (2.0,)}), ("mip", {}), ("composite", {"transfer": LIGHT.transfer})):
        plain, _ = cast(ball, RaycastOptions(mode, octree=False, **more), matrix, region)
        skipped, _ = cast(ball, RaycastOptions(mode, **more), matrix, region)
        sparse, renderer = cast(ball, RaycastOptions(mode, sparse=2, sparse_threshold=0.0, **more), matrix, region)
        assert (plain["there"] == skipped["there"]).all()
        assert np.abs(plain["place"] - skipped["place"])[plain["there"]].max() < 1e-2
        assert (plain["there"] == sparse["there"]).mean() > 0.98
        assert "CLIP_REGION" in renderer.explain()["features"]


def test_planes_boxes_and_regions_add_up(cast, matrix):
    region = regions.Sphere((0.0, 0.0, 0.0), 9.0)
    plane = [[0.0, 0.0, 1.0, -1.0]]
    shown, _ = cast(FOG, LIGHT, matrix, region, clip_planes=plane)
    through = reference.rays(matrix, SIZE, FOG, clip_planes=plane)
    wanted = 1.0 - np.exp(-KAPPA * overlap(through, chord(through, np.zeros(3), 9.0)))
    assert np.abs(shown["alpha"] - wanted).max() < 0.01
    assert (wanted > 0.1).any()


@pytest.mark.parametrize("mode", ["composite", "isosurface"])
def test_planes_that_rays_run_along_keep_what_is_before_them(cast, camera, mode):
    """A parallel camera looks along a plane, so that no ray ever meets it: each is kept whole or not at all."""
    n = 9
    affine = np.diag([3.75, 3.75, 3.75, 1.0])
    affine[:3, 3] = -15.0
    numbers = np.ones((n, n, n), np.float32)
    numbers[:, 0] = 0.0
    fog = RaycastVolume(numbers, affine)
    casting = LIGHT if mode == "composite" else RaycastOptions(values=(0.5,))
    matrix = camera(SIZE, eye=(0, -50, 0), target=(0, 0, 0), near=1, far=150, height=36.0)
    through = reference.rays(matrix, SIZE, fog)
    z = through.points(through.near)[..., 2]
    for sign in (1.0, -1.0):
        shown, _ = cast(fog, casting, matrix, clip_planes=[[0.0, 0.0, sign, -sign * 4.3]])
        wanted = np.isfinite(z) & (sign * (z - 4.3) > 0.0)
        assert wanted.sum() > 200
        np.testing.assert_array_equal(shown["there"], wanted)


@pytest.mark.parametrize("step", [0.5, 0.9])
def test_empty_nodes_are_left_before_what_follows_begins(cast, camera, step):
    """A surface just behind the border of an empty node: rays that skip the node stop short of it."""
    numbers = np.zeros((41, 41, 41), np.float32)
    numbers[17:] = 1.0  # nodes of eight: what lies up to voxel 16 is empty
    affine = np.eye(4)
    affine[:3, 3] = -20.0
    stairs = RaycastVolume(numbers, affine)
    fog = Transfer([[1, 0.5, 0, 0.0], [1, 0.5, 0, 0.9]], (0.0, 1.0))
    matrix = camera(SIZE, eye=(-60, -9, 4), target=(0, 0, 0), near=1, far=150)
    light = ({"mode": "composite", "transfer": fog, "integrator": i} for i in ("riemann", "simpson", "preintegrated"))
    for options in ({"mode": "isosurface", "values": (0.05,)}, {"mode": "mip"}, *light):
        plain, _ = cast(stairs, RaycastOptions(**options, step=step, octree=False), matrix)
        skipped, renderer = cast(stairs, RaycastOptions(**options, step=step), matrix)
        assert plain["there"].sum() > 500
        assert (plain["there"] == skipped["there"]).all()
        # Where on a plateau the peak stands is a matter of the last digit.
        for what in {"place", "alpha"} & set(plain) if options["mode"] != "mip" else ():
            assert np.abs(plain[what] - skipped[what])[plain["there"]].max() < 2e-3, (options, what)


def test_a_scene_without_cuts_has_nothing_of_them_and_labels_cannot_cut(gl, camera):
    matrix = camera(SIZE, eye=(0, -50, 0), target=(0, 0, 0), near=1, far=150)
    renderer = VolumeRenderer(gl, FOG)
    style = VolumeStyle(casting=LIGHT)
    first = renderer.render(View(SIZE, matrix), style).generation
    assert "CLIP_REGION" not in renderer.explain()["features"]
    ball = regions.Sphere((0.0, 0.0, 0.0), 9.0)
    assert renderer.render(View(SIZE, matrix, region=ball), style).generation == first + 1
    assert renderer.render(View(SIZE, matrix, region=ball), style).generation == first + 1
    sizes = {part["name"]: part["bytes"] for part in renderer.explain()["buffers"]}
    assert sizes["region"] >= 16 * SIZE[0] * SIZE[1]
    renderer.render(View(SIZE, matrix), style)
    assert "region" not in {part["name"] for part in renderer.explain()["buffers"]}
    labels = regions.Labels(np.ones((3, 3, 3), np.uint8), np.eye(4))
    with pytest.raises(ValueError, match="label volume cannot cut"):
        renderer.render(View(SIZE, matrix, region=labels), VolumeStyle(casting=LIGHT))
    renderer.release()


def test_regions_that_hold_nothing_or_everything(cast, camera):
    matrix = camera(SIZE, eye=(0, -50, 0), target=(0, 0, 0), near=1, far=150)
    nothing, _ = cast(FOG, LIGHT, matrix, regions.Sphere((0.0, 0.0, 100.0), 3.0))
    assert not nothing["there"].any()
    plain, _ = cast(FOG, LIGHT, matrix)
    for all_of_it in (regions.Sphere((0.0, 0.0, 0.0), 1e4), ~regions.Sphere((0.0, 0.0, 100.0), 3.0)):
        shown, _ = cast(FOG, LIGHT, matrix, all_of_it)
        assert np.abs(shown["alpha"] - plain["alpha"]).max() <= 1.01 / 255.0
