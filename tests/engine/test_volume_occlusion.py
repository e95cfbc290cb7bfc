"""Ambient occlusion by rays through a volume: closed forms, and a float64 reference that marches nothing."""

import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine import EngineError, View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.engine.volumes.ray_occlusion import LIFT, RayOcclusionPass, turns_of_ray
from pvfiblets.report.studies.volumes import reference
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

SIZE = (32, 28)
EMPTY = 0xFFFFFFFF
SIDE = 49
AFFINE = np.array([[0.9, 0.1, 0.0, 20.0], [-0.1, 1.1, 0.0, -7.0], [0.0, 0.2, 1.4, 3.0], [0.0, 0.0, 0.0, 1.0]])


class Shown:
    """Openness, which pixels show a surface, and where that lies."""

    def __init__(self, buffer, texture, samples, matrix):
        width, height = buffer.size
        key = np.frombuffer(buffer.depth.read(), "u4").reshape(height, width)
        self.there = key != EMPTY
        free = np.frombuffer(texture.read(), "f2").reshape(height, width).astype(np.float64)
        assert (free[~self.there] == 0.0).all()
        self.open = np.where(self.there, free / samples, 1.0)
        y, x = np.mgrid[:height, :width] + 0.5
        clip = np.stack([2 * x / width - 1, 2 * y / height - 1, 1 - 2 * ((EMPTY - key) / 2.0**32), np.ones_like(x)], -1)
        place = clip @ np.linalg.inv(matrix).T
        self.place = place[..., :3] / place[..., 3:]


@pytest.fixture
def occluded(gl):
    """Return a function that draws a volume and its occlusion."""
    kept = []

    def draw(volume, casting, matrix, *, to_data=None, planes=(), region=None, **settings):
        renderer, occlusion = VolumeRenderer(gl, volume), RayOcclusionPass(gl)
        kept.extend([renderer, occlusion])
        view = View(SIZE, matrix, planes, region)
        buffer = renderer.render(view, VolumeStyle(casting=casting))
        texture = occlusion.draw(renderer, buffer, casting, view, to_data, **settings)
        return Shown(buffer, texture, settings.get("samples", 32), matrix)

    yield draw
    for one in kept:
        one.release()
        one.release()


def places(n=SIDE):
    """x, y and z of the voxels of a cube around the origin, 1 mm apart."""
    x = np.arange(n) - (n - 1) / 2
    return np.meshgrid(x, x, x, indexing="ij")


def cube(field):
    affine = np.eye(4)
    affine[:3, 3] = -(len(field) - 1) / 2
    return RaycastVolume(np.asarray(field, np.float32), affine)


def corner():
    """Nothing where x > -10.3 and z > -10.3, and a body elsewhere: a floor and a wall."""
    x, _, z = places()
    return cube(np.minimum(x, z))


def caves(affine=AFFINE):
    """A labyrinth of rounded walls, with much that stands over everything."""
    x, y, z = np.meshgrid(*[np.arange(n) for n in (27, 22, 19)], indexing="ij")
    field = (
        np.sin(x / 1.9 + 0.4) * np.cos(y / 2.3) + np.sin(y / 2.1) * np.cos(z / 1.8 + 0.3) + np.cos(x / 2.6 + z / 5.0)
    )
    return RaycastVolume((field / field.max()).astype(np.float32), affine)


def around(camera, volume, how="perspective", *, near=0.02):
    bounds = np.array(volume.bounds).reshape(3, 2)
    middle, reach = bounds.mean(axis=1), float(np.ptp(bounds, axis=1).max())
    eye = middle + np.array([1.1, -1.7, 0.8]) * reach * (0.1 if how == "inside" else 0.55)
    height = {"height": 0.75 * reach} if how == "parallel" else {}
    return camera(SIZE, eye=eye, target=middle, near=near * reach, far=6.0 * reach, **height)


# ------------------------------------------------------------------------------------------------------- closed forms


@pytest.mark.few(2)
@pytest.mark.parametrize("filter", ["trilinear", "tricubic"])
@pytest.mark.parametrize("affine", [np.eye(4), AFFINE], ids=["plain", "oblique"])
def test_nothing_stands_over_a_half_space(occluded, camera, affine, filter):  # noqa: A002
    at = np.stack(np.meshgrid(*[np.arange(20.0)] * 3, indexing="ij"), axis=-1)
    volume = RaycastVolume((at @ [0.3, 0.2, 0.9] - 13.0).astype(np.float32), affine)
    shown = occluded(
        volume, RaycastOptions(values=(0.4,), filter=filter), around(camera, volume), radius=50.0, samples=128
    )
    assert shown.there.mean() > 0.1
    assert shown.open[shown.there].min() >= 1 - 1 / 128  # one ray in 128 may be flat to float32's last digit
    assert (shown.open[shown.there] == 1.0).mean() > 0.99


def wall(distance, radius):
    """Share of the hemisphere's cosine weight under which a wall is nearer than a radius: 1/2 of a wall near by."""
    u = np.clip(distance / radius, 0.0, 1.0)
    return (np.arccos(u) - u * np.sqrt(1.0 - u * u)) / np.pi


def on_the_floor(shown, radius):
    """Pixels of a floor whose rays meet nothing but the wall, and their distances from it."""
    x, y, z = np.moveaxis(shown.place, -1, 0)
    half = (SIDE - 1) / 2
    chosen = shown.there & (abs(z + 10.3) < 1e-2) & (x > -8) & (x + radius < half) & (abs(y) + radius < half)
    return chosen, x + 10.3


@pytest.mark.parametrize("radius", [6.0, 20.0])
def test_a_wall_takes_half_the_light_of_a_floor(occluded, camera, radius):
    assert wall(0.0, 1.0) == 0.5
    matrix = camera(SIZE, eye=(30, -25, 40), target=(-5, 0, -10), near=5, far=200, angle=30)
    shown = occluded(corner(), RaycastOptions(values=(-10.3,), step=0.2), matrix, radius=radius, samples=256)
    chosen, distance = on_the_floor(shown, radius)
    assert chosen.sum() > 40
    assert distance[chosen].min() < 4.0
    assert shown.open[chosen] == pytest.approx(1.0 - wall(distance[chosen], radius), abs=0.025)


@pytest.mark.parametrize("radius", [5.0, 14.0, 23.0, 40.0])
def test_inside_a_ball(occluded, camera, radius):
    """Chords of a ball of radius r are shorter than R for a share (R / 2r)^2 of the cosine weight."""
    x, y, z = places()
    matrix = camera(SIZE, eye=(3, -4, 1), target=(0, 9, 2), near=0.1, far=100, angle=70)
    field = cube(-np.sqrt(x * x + y * y + z * z))
    shown = occluded(field, RaycastOptions(values=(-12.0,), step=0.2), matrix, radius=radius, samples=128)
    assert shown.there.all()
    start = 12.0 - LIFT
    least = np.clip((radius**2 - 12.0**2 + start**2) / (2 * radius * start), 0.0, 1.0)
    assert least**2 == pytest.approx(min(1.0, (radius / 24.0) ** 2), abs=0.03)
    assert shown.open.mean() == pytest.approx(1.0 - least**2, abs=0.004)
    assert np.abs(shown.open - (1.0 - least**2)).max() < 0.04  # of a field that is linear between voxels


def test_more_rays_err_less_than_by_chance(occluded, camera):
    """Of independent rays the error falls with the root of their number: these are more even."""
    matrix = camera(SIZE, eye=(30, -25, 40), target=(-5, 0, -10), near=5, far=200, angle=30)
    errors = {}
    for samples in (4, 16, 64):
        shown = occluded(corner(), RaycastOptions(values=(-10.3,), step=0.2), matrix, radius=14.0, samples=samples)
        chosen, distance = on_the_floor(shown, 14.0)
        right = wall(distance[chosen], 14.0)
        errors[samples] = float(np.sqrt(np.mean((1.0 - shown.open[chosen] - right) ** 2)))
        by_chance = float(np.sqrt(np.mean(right * (1.0 - right)) / samples))
        assert errors[samples] < (0.8 if samples < 16 else 0.6) * by_chance
    assert np.polyfit(np.log(list(errors)), np.log(list(errors.values())), 1)[0] < -0.6


def test_the_mean_over_a_surface_errs_less(occluded, camera, monkeypatch):
    """And no more where rays are many, nor across the edge between floor and wall."""
    monkeypatch.setattr(f"{__name__}.SIZE", (64, 56))
    matrix = camera((64, 56), eye=(20, -12, 20), target=(-4, 0, -10), near=5, far=200, angle=25)
    off = {}
    for samples in (8, 128):
        for smooth in (False, True):
            shown = occluded(
                corner(), RaycastOptions(values=(-10.3,)), matrix, radius=14.0, samples=samples, smooth=smooth
            )
            chosen, distance = on_the_floor(shown, 14.0)
            off[samples, smooth] = 1.0 - wall(distance[chosen], 14.0) - shown.open[chosen]
    assert chosen.sum() > 200
    rms = {key: float(np.sqrt(np.mean(value**2))) for key, value in off.items()}
    assert rms[8, True] < 0.5 * rms[8, False]
    assert rms[128, True] < rms[128, False]
    assert abs(off[8, True].mean()) < 0.005


# ------------------------------------------------------------------------------------------------ float64 reference


def right_openness(volume, values, matrix, pixels, radius, *, filter="trilinear", planes=(), box=None, n=16):  # noqa: A002
    """Equation 10 at some pixels by a rule of n x n stratified directions, whose crossings are exact roots."""
    through = reference.rays(matrix, SIZE, volume, clip_planes=planes, box=box)[pixels]
    hits = reference.isosurface(volume, values, through, filter=filter)
    toward = (hits.gradient * through.directions).sum(axis=-1, keepdims=True)
    normal = -np.sign(toward) * hits.gradient / np.linalg.norm(hits.gradient, axis=-1, keepdims=True)
    turn = volume.inverse[:3, :3]
    start = through.points(hits.t) + LIFT * normal / np.linalg.norm(normal @ turn.T, axis=-1, keepdims=True)
    right = np.cross(normal, np.where(abs(normal[:, :1]) < 0.7, [[1.0, 0, 0]], [[0, 1.0, 0]]))
    right /= np.linalg.norm(right, axis=-1, keepdims=True)
    ahead = np.cross(normal, right)
    u, v = (side.ravel() for side in np.meshgrid(*[(np.arange(n) + 0.5) / n] * 2))
    flat = np.sqrt(u) * np.stack([np.cos(2 * np.pi * v), np.sin(2 * np.pi * v)])
    flat, up = flat[..., None], np.sqrt(1 - u)[:, None]
    ways = right[:, None] * flat[0] + ahead[:, None] * flat[1] + normal[:, None] * up
    origins = np.broadcast_to(start[:, None], ways.shape)
    low, high = np.zeros(3), np.array(volume.shape) - 1.0
    if box is not None:
        low, high = np.maximum(low, box[::2]), np.minimum(high, box[1::2])
    near, far = np.zeros(ways.shape[:2]), np.full(ways.shape[:2], radius)
    voxels, steps = origins @ turn.T + volume.inverse[:3, 3], ways @ turn.T
    bounds = [(voxels[..., k] - low[k], steps[..., k]) for k in range(3)]
    bounds += [(high[k] - voxels[..., k], -steps[..., k]) for k in range(3)]
    bounds += [(origins @ plane[:3] + plane[3], ways @ plane[:3]) for plane in np.reshape(planes, (-1, 4))]
    for at, change in bounds:
        near = np.where(change > 0, np.maximum(near, -at / change), near)
        far = np.where(change < 0, np.minimum(far, -at / change), far)
    gone = ~(near < far)
    rays = reference.Rays(origins, ways, np.where(gone, np.nan, near), np.where(gone, np.nan, far), matrix)
    steep = np.abs(toward[:, 0]) / np.linalg.norm(hits.gradient, axis=-1)
    return (reference.isosurface(volume, values, rays, filter=filter).value < 0).mean(axis=1), steep


CUT = [[1.0, 0.3, -0.2, -24.0]]
CASES = {
    "perspective": {},
    "parallel": {"how": "parallel"},
    "inside": {"how": "inside"},
    "two values": {"values": (0.25, 0.6)},
    "tricubic": {"filter": "tricubic"},
    "nearest": {"filter": "nearest"},
    "sparse": {"sparse": 2},
    "unrefined": {"refine": "none"},
    "box": {"box": (4.0, 15.0, 3.0, 20.0, 2.0, 16.0)},
    "plane": {"planes": CUT},
    "near plane": {"near": 1.1},  # what it hides stands over what shows
    "no octree": {"octree": False},
}


@pytest.mark.few(2)
@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_as_the_reference(occluded, camera, case):
    case = {"how": "perspective", "near": 0.02, "values": (0.35,), "planes": (), "slack": 0.02, **case}
    how, near, values, planes, slack = (case.pop(name) for name in ("how", "near", "values", "planes", "slack"))
    volume = caves()
    matrix = around(camera, volume, how, near=near)
    casting = RaycastOptions(values=values, step=0.25, **case)
    shown = occluded(volume, casting, matrix, planes=planes, radius=9.0, samples=256)
    rng = np.random.default_rng(0)
    through = reference.rays(matrix, SIZE, volume, clip_planes=planes, box=case.get("box"))
    sure = reference.isosurface(volume, values, through, filter=casting.filter).chord > 1.0
    pixels = np.argwhere(shown.there & sure)
    assert len(pixels) > 100
    pixels = tuple(rng.permutation(pixels)[:40].T)
    right, steep = right_openness(
        volume, values, matrix, pixels, 9.0, filter=casting.filter, planes=planes, box=case.get("box")
    )
    off = np.abs(shown.open[pixels] - right)[steep > 0.2]
    assert right.std() > 0.05
    assert np.median(off) < slack
    assert np.quantile(off, 0.9) < 3 * slack


def test_what_a_region_takes_away_does_not_occlude(occluded, camera):
    matrix = camera(SIZE, eye=(30, -25, 40), target=(-5, 0, -10), near=5, far=200, angle=50)
    casting, rays = RaycastOptions(values=(-10.3,)), {"radius": 12.0, "samples": 64}
    whole = occluded(corner(), casting, matrix, **rays)
    floor = whole.there & (np.abs(whole.place[..., 2] + 10.3) < 1e-2) & (whole.place[..., 0] > -5.0)
    assert whole.open[floor].min() < 0.8
    # The wall is where x is below -10.3, and all in the picture, whose pixels are 2 mm.
    cut = occluded(corner(), casting, matrix, region=regions.Slab((1, 0, 0), (10, 0, 0), 34.0), **rays)
    same = floor & cut.there & (np.abs(cut.place - whole.place).max(axis=-1) < 1e-2)
    assert same.sum() > 40
    assert cut.open[same].min() == 1.0
    kept = occluded(corner(), casting, matrix, region=~regions.Sphere((20, 20, 20), 3.0), **rays)
    both = kept.there & whole.there
    assert (kept.open[both] == whole.open[both]).mean() > 0.99


# ---------------------------------------------------------------------------------------------------- the same again


def test_the_same_seed_gives_the_same_picture(occluded, camera):
    volume = caves()
    matrix, casting = around(camera, volume), RaycastOptions(values=(0.35,))
    one, again, other = (
        occluded(volume, casting, matrix, radius=9.0, samples=16, seed=seed).open for seed in (3, 3, 4)
    )
    assert (one == again).all()
    assert (one != other).mean() > 0.1
    assert one.mean() == pytest.approx(other.mean(), abs=3e-3)


def test_what_stretches_the_actor_stretches_the_hemisphere(occluded, camera):
    """A volume in an actor of some matrix is the volume whose affine has that matrix in it."""
    volume = caves()
    change = np.eye(4)
    change[:3, :3] = [[1.6, 0.0, 0.3], [0.0, 0.7, 0.0], [0.0, 0.2, -1.1]]
    change[:3, 3] = 5.0, -3.0, 2.0
    moved = RaycastVolume(volume.values, change @ volume.affine)
    matrix, casting = around(camera, moved), RaycastOptions(values=(0.35,), step=0.2)
    baked = occluded(moved, casting, matrix, radius=9.0, samples=64)
    turn = np.linalg.inv(change[:3, :3])
    placed = occluded(volume, casting, matrix @ change, to_data=turn, radius=9.0, samples=64)
    both = baked.there & placed.there
    assert both.mean() > 0.05
    assert np.abs(baked.open - placed.open)[both].mean() < 2e-3


@pytest.mark.parametrize("far", [1e6, 1e-4])
def test_volumes_far_away_and_tiny(occluded, camera, far):
    volume = caves()
    matrix, casting = around(camera, volume), RaycastOptions(values=(0.35,))
    change = np.eye(4)
    if far > 1:
        change[:3, 3] = far
    else:
        change[:3, :3] *= far
    moved = RaycastVolume(volume.values, change @ volume.affine)
    size = 1.0 if far > 1 else far
    one = occluded(volume, casting, matrix, radius=9.0, samples=64)
    two = occluded(moved, casting, matrix @ np.linalg.inv(change), radius=9.0 * size, samples=64)
    both = one.there & two.there
    assert np.abs(one.open - two.open)[both].mean() < 2e-3
    assert np.isfinite(two.open).all()


def test_portions_are_the_whole(occluded, camera, monkeypatch):
    """Mesa leaves loops that turn too often: that must not darken or brighten anything."""
    volume = caves()
    matrix, casting = around(camera, volume), RaycastOptions(values=(0.35,))
    one = occluded(volume, casting, matrix, radius=9.0, samples=40).open
    monkeypatch.setattr("pvfiblets.engine.volumes.ray_occlusion.MOST_TURNS", 600)
    assert 2 < 600 // turns_of_ray(volume, casting, np.eye(3), 9.0) < 20
    assert (occluded(volume, casting, matrix, radius=9.0, samples=40).open == one).all()


def test_drawn_anew_only_when_something_changed(gl, camera, monkeypatch):
    volume = caves()
    renderer, occlusion = VolumeRenderer(gl, volume), RayOcclusionPass(gl)
    style = VolumeStyle(casting=RaycastOptions(values=(0.35,)))
    runs = []
    bind = renderer.bind_field
    monkeypatch.setattr(renderer, "bind_field", lambda program: (runs.append(1), bind(program)))

    def draw(how="perspective", **settings):
        view = View(SIZE, around(camera, volume, how))
        buffer = renderer.render(view, style)
        return occlusion.draw(renderer, buffer, style.casting, view, **({"radius": 9.0, "samples": 4} | settings))

    assert draw() is draw()
    assert len(runs) == 1
    for number, change in enumerate(({"radius": 8.0}, {"samples": 5}, {"seed": 1}, {"how": "parallel"}), start=2):
        draw(**change)
        assert len(runs) == number
    (buffer,) = occlusion.explain()["buffers"]
    assert buffer == {"name": "ray occlusion (effect)", "bytes": 2 * SIZE[0] * SIZE[1]}
    assert "occlusion" not in str(renderer.explain())
    occlusion.release()
    occlusion.release()
    renderer.release()


def test_only_surfaces_have_it(occluded, camera):
    volume = caves()
    fog = RaycastOptions("composite", transfer=Transfer(np.full((2, 4), 0.5, np.float32), (0.0, 1.0)))
    with pytest.raises(EngineError, match="'composite'"):
        occluded(volume, fog, around(camera, volume), radius=1.0)
