"""Light is within a hundredth of the float64 reference by default: thin to dense, whatever the transfer function."""

import time

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.engine.gl.passes import is_software
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle, nodes
from pvfiblets.report.studies.volumes import reference
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.steepness import OFF, UNTRUSTED, allowed_bends, largest_bend
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

SIZE = (48, 36)
STEP = 0.5
EMPTY = 0xFFFFFFFF
DENSE = 0.9  # opacity of a unit where tables are densest
X, ENTRY = np.linspace(0.0, 1.0, 256), np.arange(256)
ORANGE, BLUE = np.array([1.0, 0.6, 0.1]), np.array([0.1, 0.3, 1.0])


def table(colours, opacities):
    return np.column_stack([np.broadcast_to(colours, (256, 3)), opacities])


TABLES = {
    "ramp": table(BLUE + X[:, None] * (ORANGE - BLUE), DENSE * X),
    "edge": table(ORANGE, np.where(X > 0.37, DENSE, 0.0)),
    "peak": table(ORANGE, np.where(ENTRY == 97, DENSE, 0.0)),
    "peaks": table(np.where((ENTRY // 16 % 2)[:, None] == 0, ORANGE, BLUE), np.where(ENTRY % 16 == 8, DENSE, 0.0)),
}


def field(name, n=16):
    at = np.stack(np.meshgrid(*[np.linspace(-1, 1, n)] * 3, indexing="ij"), axis=-1)
    far = np.linalg.norm(at, axis=-1)
    if name == "slope":
        values = 0.5 + 0.5 * at @ [0.6, 0.3, 0.1]
    elif name == "ball":
        values = np.clip(1 - far / 1.2, 0, 1)
    elif name == "mask":
        values = far < 0.6
    elif name == "sheets":
        values = np.zeros((n, n, n))
        values[:, :, n // 2] = values[n // 3, :, :] = 1.0
    elif name == "tubes":  # thin ones, that fade
        values = np.exp(-(((at[..., 0] - 0.3 * at[..., 1]) * n / 3) ** 2)) + np.exp(-(((far - 0.7) * n / 3) ** 2))
        values /= values.max()
    else:
        values = np.random.default_rng(0).random((n, n, n))
    return RaycastVolume(values.astype(np.float32), np.eye(4))


def steep_transfer(name, kappa_step):
    """One whose largest extinction times a step is a number."""
    return Transfer(TABLES[name], (0.0, 1.0), -STEP * np.log1p(-DENSE) / kappa_step)


def light(renderer, matrix, casting):
    buffer = renderer.render(View(SIZE, matrix), VolumeStyle(casting=casting))
    there = np.frombuffer(buffer.depth.read(), "u4").reshape(SIZE[::-1]) != EMPTY
    rgba = np.frombuffer(buffer.colours.read(), "u1").reshape(*SIZE[::-1], 4) / 255.0
    rgba[..., :3] *= rgba[..., 3:]
    return np.where(there[..., None], rgba, 0.0)


def matrix_of(camera, volume):
    middle = (np.array(volume.shape) - 1) / 2
    return camera(SIZE, eye=middle + [20, -27, 15], target=middle, near=3, far=120)


@pytest.mark.more
@pytest.mark.parametrize("name", ["slope", "ball"])
def test_light_is_within_a_hundredth_from_thin_to_dense(gl, camera, name):
    volume = field(name)
    matrix = matrix_of(camera, volume)
    through = reference.rays(matrix, SIZE, volume)
    renderer = VolumeRenderer(gl, volume)
    for look in TABLES:
        for kappa_step in (1e-3, 1.0, 10.0, 1e3):
            transfer = steep_transfer(look, kappa_step)
            found = light(renderer, matrix, RaycastOptions("composite", transfer=transfer, step=STEP, stop=0.9999))
            right = reference.composite(volume, transfer, through).reshape(found.shape)
            off = np.abs(found - right).max(axis=-1)  # 8 bits of colours and of opacity are in it
            assert off.max() < 1e-2, (look, kappa_step)
    renderer.release()


@pytest.mark.more
def test_the_same_of_noise_but_for_few_pixels(gl, camera):
    volume = field("noise")
    matrix = matrix_of(camera, volume)
    through = reference.rays(matrix, SIZE, volume)
    renderer = VolumeRenderer(gl, volume)
    for look in ("ramp", "peak"):
        for kappa_step in (1e-2, 1.0, 100.0):
            transfer = steep_transfer(look, kappa_step)
            found = light(renderer, matrix, RaycastOptions("composite", transfer=transfer, step=STEP, stop=0.9999))
            off = np.abs(found - reference.composite(volume, transfer, through).reshape(found.shape)).max(axis=-1)
            assert (off < 1e-2).mean() > 0.997, (look, kappa_step)  # more kinks than show may cancel within a step
            assert off.max() < 0.25, (look, kappa_step)
    renderer.release()


@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["mask", "sheets", "noise"])
@pytest.mark.parametrize("kappa_step", [0.1, 1.0])
def test_light_is_within_a_hundredth_at_edges_from_voxel_to_voxel(gl, camera, name, kappa_step):
    volume = field(name)
    matrix = matrix_of(camera, volume)
    renderer = VolumeRenderer(gl, volume)
    transfer = steep_transfer("ramp", kappa_step)
    found = light(renderer, matrix, RaycastOptions("composite", transfer=transfer, step=STEP, stop=0.9999))
    right = reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume)).reshape(found.shape)
    off = np.abs(found - right).max(axis=-1)
    assert (off < 1e-2).mean() > 0.998  # what a ray passes within a step may be seen by none of its samples
    assert off.max() < 1.5e-2
    assert {"VOLUME_FINER", "VOLUME_PREINTEGRATED"} <= set(renderer.explain()["features"])
    # Once, not in parts, it would not be.
    once = light(
        renderer, matrix, RaycastOptions("composite", transfer=transfer, integrator="preintegrated", stop=0.9999)
    )
    assert np.abs(once - right).max() > 1.1e-2 or name == "noise"
    renderer.release()


def test_rays_along_an_axis_look_as_closely(gl, camera):
    """Of two axes such a ray never leaves its cell."""
    volume = field("ball")
    middle = (np.array(volume.shape) - 1) / 2
    matrix = camera(SIZE, eye=middle + [0, -40, 0], target=middle, near=3, far=120, height=16.0)
    renderer = VolumeRenderer(gl, volume)
    for look in ("peak", "edge"):
        transfer = steep_transfer(look, 10.0)
        found = light(renderer, matrix, RaycastOptions("composite", transfer=transfer, step=STEP, stop=0.9999))
        right = reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume)).reshape(found.shape)
        assert found.max() > 0.5
        assert np.abs(found - right).max() < 1e-2
    renderer.release()


@pytest.mark.few(1)
@pytest.mark.parametrize(("filter", "most"), [("tricubic", 0.01), ("nearest", 0.2)])
def test_the_same_of_other_fields(gl, camera, filter, most):  # noqa: A002
    """That of nearest voxels jumps, within parts as well: what a ray passes of a corner may not be seen at all."""
    volume = field("mask", 12)
    matrix = matrix_of(camera, volume)
    renderer = VolumeRenderer(gl, volume)
    transfer = steep_transfer("ramp", 0.3)
    right = reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume), filter=filter)
    off = []
    for integrator in ("adaptive", "preintegrated"):
        casting = RaycastOptions("composite", transfer=transfer, filter=filter, integrator=integrator, stop=0.9999)
        off.append(light(renderer, matrix, casting) - right.reshape(*SIZE[::-1], 4))
    assert np.abs(off[0]).max() < most
    assert np.square(off[0]).mean() < 0.5 * np.square(off[1]).mean()
    renderer.release()


def test_edges_where_a_step_ends_a_ray_or_lies_beside_what_was_skipped(gl, camera):
    """A slab that reaches to the volume's border and lies across the borders of the octree's nodes."""
    values = np.zeros((40, 17, 17), np.float32)
    values[24:, 3:, :] = 1.0
    volume = RaycastVolume(values, np.eye(4))
    middle = (np.array(volume.shape) - 1) / 2
    renderer = VolumeRenderer(gl, volume)
    transfer = steep_transfer("ramp", 0.5)
    for eye in ([50, -27, 15], [-60, 9, 4], [3, 8, 70]):
        matrix = camera(SIZE, eye=middle + eye, target=middle, near=3, far=160)
        right = reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume)).reshape(*SIZE[::-1], 4)
        for octree in (True, False):
            found = light(renderer, matrix, RaycastOptions("composite", transfer=transfer, octree=octree, stop=0.9999))
            assert np.abs(found - right).max() < 1e-2
    renderer.release()


@pytest.mark.more
def test_lines_between_samples_are_the_nearest_ones(gl, camera):
    """Of thin things in gentle colours, at no sample more, light is as right as by samples in the middles of steps."""
    volume = field("tubes", 32)
    matrix = matrix_of(camera, volume)
    renderer = VolumeRenderer(gl, volume)
    transfer = Transfer(table(ORANGE, np.clip((X - 0.1) / 0.9, 0, 1) * 0.5), (0.0, 1.0))
    right = reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume)).reshape(*SIZE[::-1], 4)
    off = {}
    for integrator in ("preintegrated", "exponential", "adaptive"):
        found = light(
            renderer, matrix, RaycastOptions("composite", transfer=transfer, integrator=integrator, stop=0.9999)
        )
        off[integrator] = float(np.sqrt(((found - right) ** 2).mean()))
    assert off["preintegrated"] < 1.1 * off["exponential"]
    assert off["adaptive"] < 1.1 * off["preintegrated"]
    renderer.release()


def test_values_beyond_thresholds_are_left_out_exactly_and_the_octree_changes_no_pixel(gl, camera):
    volume = field("slope")
    matrix = matrix_of(camera, volume)
    renderer = VolumeRenderer(gl, volume)
    for kappa_step in (0.1, 100.0):
        transfer = steep_transfer("ramp", kappa_step)
        casting = RaycastOptions("composite", transfer=transfer, low=0.4, high=0.6, step=STEP, stop=0.9999)
        right = reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume), low=0.4, high=0.6)
        assert np.abs(light(renderer, matrix, casting) - right.reshape(*SIZE[::-1], 4)).max() < 1e-2
    renderer.release()
    volume = field("ball", 24)
    renderer = VolumeRenderer(gl, volume)
    transfer = steep_transfer("peak", 3.0)
    pictures = [
        light(renderer, matrix, RaycastOptions("composite", transfer=transfer, octree=octree)) for octree in (0, 1)
    ]
    assert np.abs(pictures[0] - pictures[1]).max() < 5e-3  # rays are cut to cells at other places
    assert pictures[0].max() > 0.5
    renderer.release()


def test_only_what_is_steep_pays_for_it(gl, camera):
    volume = field("slope")
    matrix = matrix_of(camera, volume)
    renderer = VolumeRenderer(gl, volume)
    gentle = Transfer(np.linspace(0, 1, 256)[:, None] * [1, 1, 1, 0.9], (0, 1), 1.0)
    light(renderer, matrix, RaycastOptions("composite", transfer=gentle))
    assert "VOLUME_PREINTEGRATED" in renderer.explain()["features"]
    assert "VOLUME_FINER" not in renderer.explain()["features"]
    sizes = {buffer["name"]: buffer["bytes"] for buffer in renderer.explain()["buffers"]}
    assert "media" not in sizes
    assert sizes["segments"] == 256 * 256 * 16
    light(renderer, matrix, RaycastOptions("composite", transfer=steep_transfer("peak", 1.0)))
    assert "VOLUME_EXACT" in renderer.explain()["features"]
    light(
        renderer, matrix, RaycastOptions("composite", transfer=steep_transfer("peak", 1.0), integrator="preintegrated")
    )
    assert "VOLUME_EXACT" not in renderer.explain()["features"]
    renderer.release()


@pytest.mark.more
def test_no_table_costs_much_more_than_its_neighbour(gl, camera):
    """One entry of a table makes no volume dense: each ray looks closer where its own values ask for it."""
    if not is_software(gl):
        pytest.skip("what rays cost is measured as the processor's time, which a card does not take")
    values = field("ball", 40).values + 0.05 * field("noise", 40).values
    volume = RaycastVolume(values, np.eye(4))
    middle = (np.array(volume.shape) - 1) / 2
    view = View((120, 90), camera((120, 90), eye=middle + [50, -67, 37], target=middle, near=7, far=200))
    renderer = VolumeRenderer(gl, volume)
    colours = X[:, None] * np.ones(3)
    ramp, edge = np.column_stack([colours, X]), np.column_stack([colours, X > 0.4])
    late = np.column_stack([colours, np.clip(2.0 * X - 1.0, 0.0, 1.0)])
    dear = []
    for rgba, unit, step in ((ramp, 1, 0.5), (ramp, 0.9, 0.5), (ramp, 1, 0.7), (late, 1, 0.5), (edge, 1, 0.5)):
        took = dict.fromkeys(("preintegrated", "adaptive"), np.inf)
        for integrator in took:
            for turn in range(4):  # the first compiles
                casting = RaycastOptions("composite", transfer=Transfer(rgba, (0.0, 1.0), unit), integrator=integrator,
                                         step=step, sparse_threshold=0.05 + 1e-6 * turn)  # fmt: skip
                start = time.process_time()
                renderer.render(view, VolumeStyle(casting=casting))
                gl.finish()
                took[integrator] = min(took[integrator], time.process_time() - start)
        dear.append(took["adaptive"] / took["preintegrated"])
    assert max(dear) < 2.5 * min(dear), dear  # it was 8 to 12 times
    renderer.release()


@pytest.mark.parametrize("integrator", ["simpson", "romberg", "rk4"])
def test_rules_of_higher_order_are_right_where_light_is_smooth(gl, camera, integrator):
    volume = field("ball")
    matrix = matrix_of(camera, volume)
    renderer = VolumeRenderer(gl, volume)
    transfer = steep_transfer("ramp", 0.3)
    found = light(renderer, matrix, RaycastOptions("composite", transfer=transfer, integrator=integrator, stop=0.9999))
    right = reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume))
    assert np.abs(found - right.reshape(found.shape)).max() < 1e-2
    renderer.release()


def test_between_which_values_a_look_up_is_off():
    def untrusted(name, kappa_step, **limits):
        return (allowed_bends(steep_transfer(name, kappa_step), STEP, **limits) == UNTRUSTED).mean()

    assert untrusted("ramp", 1.0) == untrusted("ramp", 1.0, low=-1.0) == 0.0
    for name in ("edge", "peak", "peaks"):
        assert untrusted(name, 1.0) > 0.0
        assert untrusted(name, 1e3) > 0.0
    cut = allowed_bends(steep_transfer("ramp", 1.0), STEP, low=0.5) == UNTRUSTED
    assert cut[:127, 128:].all()
    assert cut[128:, :127].all()
    assert not cut[:126, :126].any()
    assert not cut[129:, 129:].any()


@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.float32])
def test_the_largest_bend(dtype):
    values = (np.random.default_rng(1).random((7, 5, 2)) * 200).astype(dtype)
    bends = [np.abs(np.diff(values.astype(float), 2, axis=axis)).max(initial=0.0) for axis in range(3)]
    for order in ((0, 1, 2), (2, 0, 1), (1, 2, 0)):
        for turned in (values.transpose(order), np.asfortranarray(values.transpose(order))):
            assert largest_bend(RaycastVolume(turned)) == pytest.approx(max(bends), rel=1e-6)
    assert largest_bend(field("slope")) < 1e-6


def test_the_bend_that_is_allowed():
    """Of a tent so high over a step's chord, light differs by a quarter of `OFF`, as NumPy finds of its two slopes."""
    thin = Transfer(np.linspace(0, 1, 256)[:, None] * [0, 0, 0, 1e-3], (-3.0, 5.0))
    assert (allowed_bends(thin, 1.0) == 8.0).all()  # nothing is too much
    steep = steep_transfer("ramp", 3.0)
    allowed = allowed_bends(steep, STEP)
    half = steep.preintegrated(STEP / 2).astype(np.float64)

    def light_by(front, middle, back):
        first, second = half[front, middle], half[middle, back]
        return first + (1.0 - first[3]) * second

    for front, back in ((20, 30), (100, 100), (40, 200), (250, 130)):
        middle, height = (front + back) // 2, round(allowed[front, back] * 255)
        off = max(
            np.abs(light_by(front, middle + side * height, back) - light_by(front, middle, back)).max()
            for side in (-1, 1)
        )
        assert 0.6 * OFF / 4 < off < 1.6 * OFF / 4, (front, back)  # heights are found of half as long a step's table


def test_between_which_values_anything_is_opaque_or_even():
    def ends(*opacities):
        return Transfer(np.array(opacities)[:, None] * [0, 0, 0, 1], (10.0, 14.0)).opaque_range

    assert ends(0, 0, 1, 0, 0) == (11.0, 13.0)
    assert ends(0, 0, 0, 0, 1) == (13.0, np.inf)
    assert ends(1, 0, 0, 0, 0) == (-np.inf, 11.0)
    assert ends(0, 0, 0, 0, 0) == (np.inf, -np.inf)
    rgba = table(ORANGE, np.select([X < 0.3, X < 0.9], [0.0, 0.02], 0.9))
    transfer = Transfer(rgba, (0.0, 1.0))
    even = transfer.even_range([0.4, 0.2, 0.4, 0.92, 0.0], [0.8, 0.4, 0.95, 2.0, 0.1])
    assert even.tolist() == [True, False, False, True, True]
    assert not transfer.even_range(0.88, 0.8999)  # the opacity rises within the entry


@pytest.mark.parametrize("integrator", ["adaptive", "exponential"])
def test_parts_of_one_colour_and_opacity_need_no_reconstruction(gl, camera, integrator, monkeypatch):
    """A ball whose inside is even for the eye, though its values are not; with a thin sheet of another colour in it."""
    volume = field("ball", 40)
    values = volume.values.copy()
    values[:, :, 19] = np.where(values[:, :, 19] > 0.4, 0.97, values[:, :, 19])
    volume = RaycastVolume(values, volume.affine)
    matrix = camera(SIZE, eye=[45, -40, 60], target=[19.5] * 3, near=10, far=300)
    rgba = table(np.where(X[:, None] < 0.9, ORANGE, BLUE), np.select([X < 0.3, X < 0.9], [0.0, 0.02], 0.9))
    renderer = VolumeRenderer(gl, volume)
    transfer = Transfer(rgba, (0.0, 1.0))
    plain = RaycastOptions("composite", transfer=transfer, integrator=integrator, step=0.25, recon=False)
    before = light(renderer, matrix, plain)
    assert "VOLUME_HOMOGENEOUS" not in renderer.explain()["features"]
    monkeypatch.setattr(nodes, "WORTH", 0.0)
    marked = RaycastOptions("composite", transfer=transfer, integrator=integrator, step=0.25)
    after = light(renderer, matrix, marked)
    assert "VOLUME_HOMOGENEOUS" in renderer.explain()["features"]
    assert np.abs(after - before).max() < (6e-3 if integrator == "adaptive" else 3e-2)  # rays are cut at other places
    assert (before[..., 2] > 0.3).sum() > 30  # the sheet
    renderer.release()


def test_a_step_is_no_longer_than_a_voxel_is_short_unless_it_is_asked_to_be():
    half, four = RaycastOptions(values=(0.5,), step=0.5), RaycastOptions(values=(0.5,), step=4.0)
    cube = (20, 20, 20)
    assert half.step_mm((2.0, 2.0, 2.0), cube) == 1.0
    assert half.step_mm((1.0, 1.0, 1.6), cube) == pytest.approx(0.6)
    assert half.step_mm((1.0, 1000.0, 1.0), cube) == 1.0
    assert four.step_mm((1.0, 1000.0, 1.0), cube) == 4.0
    assert four.step_mm((3.0, 3.0, 3.0), cube) == 12.0
    assert half.step_mm((1.0, 1000.0, 1.0), (20, 90, 20)) == pytest.approx(3.0, rel=1e-3)  # no more than 30,000 steps
    assert half.step_mm((1.0, 1.0, 1.0), (2, 2, 60_000)) == 0.5


@pytest.mark.parametrize("integrator", ["adaptive", "exponential"])
@pytest.mark.parametrize("option", [{"recon": True}, {"homogeneous": 0.01}])
def test_even_parts_end_where_rays_do(gl, camera, integrator, option, monkeypatch):
    """Nodes reach beyond the volume, and beyond planes: what is beyond gives no light."""
    monkeypatch.setattr(nodes, "WORTH", 0.0)
    values = np.digitize(field("ball", 30).values, [0.1, 0.5]) / 2.0
    volume = RaycastVolume(values.astype(np.float32), np.eye(4))
    middle = (np.array(volume.shape) - 1) / 2
    matrix = camera(SIZE, eye=middle + [35, -47, 25], target=middle, near=3, far=160)
    transfer = Transfer(np.array([[1.0, 0.6, 0.1, 0.02], [0.3, 0.6, 0.1, 0.03], [0.1, 0.3, 1.0, 0.05]]), (0.0, 1.0))
    right = reference.composite(volume, transfer, reference.rays(matrix, SIZE, volume)).reshape(*SIZE[::-1], 4)
    renderer = VolumeRenderer(gl, volume)
    found = light(renderer, matrix, RaycastOptions("composite", transfer=transfer, integrator=integrator, **option))
    assert "VOLUME_HOMOGENEOUS" in renderer.explain()["features"]
    assert np.abs(found - right).max() < 1e-2
    renderer.release()


def test_even_parts_count_only_where_there_are_enough(gl, camera):
    """Rays that ask every node, and find few even ones, would be slower."""
    transfer = Transfer(np.array([[1.0, 0.6, 0.1, 0.02], [1.0, 0.6, 0.1, 0.02], [0.1, 0.3, 1.0, 0.5]]), (0.0, 1.0))
    for values, expected in ((np.zeros((32, 32, 32)), True), (field("noise", 32).values, False)):
        volume = RaycastVolume(np.asarray(values, np.float32), np.eye(4))
        renderer = VolumeRenderer(gl, volume)
        light(renderer, matrix_of(camera, volume), RaycastOptions("composite", transfer=transfer))
        assert ("VOLUME_HOMOGENEOUS" in renderer.explain()["features"]) == expected
        renderer.release()
