"""A volume in bricks shows what it shows as one texture: no seam in values, gradients, surfaces, light or peaks."""

import tracemalloc

import numpy as np
import pytest

from pvfiblets.engine import EngineError, View
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle, textures
from pvfiblets.engine.volumes.bricks import MOST_PAGES, lay_out, pieces
from pvfiblets.engine.volumes.ray_occlusion import RayOcclusionPass
from pvfiblets.engine.volumes.shading import Lamp, Shading
from pvfiblets.volumes.octree import build_octree
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

SIZE = (64, 48)
ONE, BRICKS, PAGES = (
    textures.Limits(2048, 16384, 2048),
    textures.Limits(64, 128, 64),
    textures.Limits(64, 64, 64, 1.0e5),
)
SMALL = {"bricks": textures.Limits(16, 128, 8), "pages": textures.Limits(16, 24, 16)}


def smooth(shape, dtype=np.float32):
    """Waves along all axes, none of which ends at a brick."""
    x, y, z = (np.arange(n) / max(n, 20) for n in shape)
    values = np.sin(17 * x)[:, None, None] * np.cos(13 * y + 1)[:, None] + 0.8 * np.sin(11 * z + x[:, None, None] * 5)
    values = (values - values.min()) / np.ptp(values)
    return (values * (1.0 if dtype is np.float32 else 250)).astype(dtype)


def look_at(camera, volume, eye=(1.1, -1.7, 0.8)):
    bounds = np.array(volume.bounds).reshape(3, 2)
    middle, reach = bounds.mean(axis=1), float(np.ptp(bounds, axis=1).max())
    return camera(SIZE, eye=middle + np.array(eye) * reach, target=middle, near=0.02 * reach, far=6.0 * reach)


def drawn(gl, monkeypatch, volume, casting, matrix, limits, shading=None, occlusion=False):
    """Depth keys, values and colours; and how open surfaces are."""
    monkeypatch.setattr(textures.Limits, "from_context", classmethod(lambda cls, ctx: limits))
    renderer = VolumeRenderer(gl, volume)
    try:
        view = View(SIZE, matrix)
        buffer = renderer.render(view, VolumeStyle(casting=casting, shading=shading))
        features = [name for name in renderer.explain()["features"] if name in ("VOLUME_BRICKS", "VOLUME_PAGES")]
        found = {
            "depth": np.frombuffer(buffer.depth.read(), "u4") / 2.0**32,
            "value": np.frombuffer(buffer.position.read(), "f4").reshape(-1, 2)[:, 1].astype(float),
        }
        if buffer.colours is not None:
            found["colours"] = np.frombuffer(buffer.colours.read(), "u1").astype(float) / 255.0
        if buffer.across is not None:
            words = np.frombuffer(buffer.across.read(), "u4")
            found["normals"] = np.stack([words & 0xFFFF, words >> 16]).astype(np.uint16).view(np.int16) / 32767.0
        if occlusion:
            rays = RayOcclusionPass(gl)
            open_ = rays.draw(renderer, buffer, casting, view, radius=6.0, samples=8)
            found["open"] = np.frombuffer(open_.read(), "f2").astype(float) / 8.0
            rays.release()
        return found, features
    finally:
        renderer.release()


def assert_alike(found, right, atol=1e-4, few=0.0):
    for name, numbers in right.items():
        off = np.abs(found[name] - numbers)
        assert np.mean(off > atol) <= few, (name, off.max(), np.mean(off > atol))
    assert np.ptp(right["depth"]) > 0


RAMP = np.column_stack([np.linspace(0, 1, 8), np.full(8, 0.5), np.linspace(1, 0, 8), np.linspace(0, 0.3, 8)])
LOOKS = {
    "light": lambda: RaycastOptions("composite", transfer=Transfer(RAMP, (0.0, 1.0))),
    "surface": lambda: RaycastOptions("isosurface", (0.45, 0.7)),
    "mip": lambda: RaycastOptions("mip"),
    "average": lambda: RaycastOptions("average"),
    "nearest": lambda: RaycastOptions("mip", filter="nearest"),
    "tricubic": lambda: RaycastOptions("isosurface", (0.5,), filter="tricubic"),
    "whole": lambda: RaycastOptions("isosurface", (0.5,), octree=False),
}


@pytest.mark.few(2)
@pytest.mark.parametrize("limits", SMALL)
@pytest.mark.parametrize("look", LOOKS)
def test_bricks_show_what_one_texture_shows(gl, camera, monkeypatch, look, limits):
    volume = RaycastVolume(smooth((43, 37, 29)), np.diag([1.0, 1.2, 0.9, 1.0]))
    matrix, casting = look_at(camera, volume), LOOKS[look]()
    right, none = drawn(gl, monkeypatch, volume, casting, matrix, ONE)
    found, features = drawn(gl, monkeypatch, volume, casting, matrix, SMALL[limits])
    assert none == []
    assert set(features) == {"bricks": {"VOLUME_BRICKS"}, "pages": {"VOLUME_BRICKS", "VOLUME_PAGES"}}[limits]
    assert_alike(found, right)


@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.uint16])
@pytest.mark.parametrize("order", ["C", "F"])
def test_all_types_and_orders_in_memory(gl, camera, monkeypatch, dtype, order):
    volume = RaycastVolume(np.asarray(smooth((40, 33, 21), dtype), order=order))
    matrix, casting = look_at(camera, volume), RaycastOptions("isosurface", (100.0,))
    right, _ = drawn(gl, monkeypatch, volume, casting, matrix, ONE)
    found, _ = drawn(gl, monkeypatch, volume, casting, matrix, SMALL["pages"])
    right["value"] /= 255.0
    found["value"] /= 255.0
    assert_alike(found, right)


def test_gradients_shading_and_occlusion_have_no_seams(gl, camera, monkeypatch):
    volume = RaycastVolume(smooth((43, 37, 29)))
    matrix = look_at(camera, volume)
    lit = Shading((Lamp((0.0, 0.0, 1.0)),), (50.0, -80.0, 30.0, 1.0), ambient=0.1, diffuse=0.9, specular=0.2, power=8.0)
    for casting, shading, occlusion in ((LOOKS["light"](), lit, False), (LOOKS["surface"](), None, True)):
        right, _ = drawn(gl, monkeypatch, volume, casting, matrix, ONE, shading, occlusion)
        found, _ = drawn(gl, monkeypatch, volume, casting, matrix, SMALL["bricks"], shading, occlusion)
        assert_alike(found, right)


@pytest.mark.few(4)
@pytest.mark.parametrize(
    ("shape", "eye"),
    [((200, 5, 5), (0.1, -0.4, 0.2)), ((5, 5, 200), (0.1, -0.4, 0.2)), ((150, 150, 150), (1.1, -1.7, 0.8))],
)
@pytest.mark.parametrize("mode", ["light", "surface", "mip"])
def test_a_limit_of_64(gl, camera, monkeypatch, shape, eye, mode):
    volume = RaycastVolume(smooth(shape))
    matrix, casting = look_at(camera, volume, eye), LOOKS[mode]()
    right, _ = drawn(gl, monkeypatch, volume, casting, matrix, ONE)
    limits = textures.Limits(64, 512, 64) if max(shape) == 150 else BRICKS
    found, features = drawn(gl, monkeypatch, volume, casting, matrix, limits)
    assert features == ["VOLUME_BRICKS"]
    assert_alike(found, right)


def test_an_axis_above_the_real_limit_of_software_opengl(gl, camera):
    limit = int(gl.info["GL_MAX_3D_TEXTURE_SIZE"])
    if limit > 4096:
        pytest.skip(f"3-D textures of {limit} are too many to test with")
    n = limit + 52
    values = np.zeros((n, 4, 4), np.uint8)
    middles = (10, limit - 1, n - 10)
    for middle in middles:
        values[middle - 3 : middle + 4] = 200
    volume = RaycastVolume(values)
    renderer = VolumeRenderer(gl, volume)
    size = (n // 4, 9)
    matrix = camera(
        size,
        eye=((n - 1) / 2, -100.0, 1.5),
        target=((n - 1) / 2, 1.5, 1.5),
        near=1,
        far=200,
        height=n / size[0] * size[1],
    )
    buffer = renderer.render(View(size, matrix), VolumeStyle(casting=RaycastOptions("mip")))
    value = np.frombuffer(buffer.position.read(), "f4").reshape(*size[::-1], 2)[..., 1]
    shown = np.flatnonzero((value > 50).any(axis=0))
    expected = {round((at - (n - 1) / 2) / n * size[0] + (size[0] - 1) / 2) for at in middles}
    assert all(min(abs(at - other) for other in expected) <= 1 for at in shown)
    assert all(min(abs(at - other) for other in shown) <= 1 for at in expected)
    renderer.release()


def test_every_voxel_lies_where_it_is_read():
    rng = np.random.default_rng(0)
    for _ in range(200):
        shape = tuple(rng.integers(2, 40, 3).tolist())
        side, layers = int(rng.integers(3, 30)), int(rng.integers(1, 12))
        laid = lay_out(shape, side, layers, float(rng.choice([1e9, 400, 5000])))
        if laid is None:
            continue
        assert max(laid.page_shape[:2]) <= side
        assert laid.page_shape[2] <= layers
        assert laid.pages <= MOST_PAGES
        places, seen = {}, np.zeros((laid.pages, *laid.page_shape), bool)
        for page, corner, box in laid.bricks():
            for piece in pieces(box, int(rng.integers(3)), 50):
                x, y, z = (slice(p.start - b.start, p.stop - b.start) for p, b in zip(piece, box, strict=True))
                part = seen[page, corner[0] + x.start : corner[0] + x.stop, corner[1] + y.start : corner[1] + y.stop, z]
                assert part.size
                assert not part.any()
                part[:] = True
            places[tuple(part.start for part in box)] = box
        steps = laid.steps
        for cell in rng.integers(0, np.array(shape) - 1, (20, 3)):  # both ends of a cell lie in the brick of its first
            first = tuple(int(min(c // s, n - 1) * s) for c, s, n in zip(cell, steps, laid.counts, strict=True))
            box = places[first]
            assert all(part.start <= c and c + 1 < part.stop for c, part in zip(cell[:2], box[:2], strict=True))
            assert box[2].start <= cell[2] < box[2].stop


def test_what_no_textures_take_is_one_error(gl, monkeypatch):
    volume = RaycastVolume(smooth((40, 40, 40)))
    monkeypatch.setattr(textures.Limits, "from_context", classmethod(lambda cls, ctx: textures.Limits(16, 16, 16)))
    with pytest.raises(EngineError, match=r"40 x 40 x 40 voxels is more than 8 of this OpenGL's textures take"):
        VolumeRenderer(gl, volume)


def test_a_texture_that_driver_refuses_is_dealt_out(gl, camera, monkeypatch):
    """Mesa gives no texture of more than a gigabyte, and says so only if it is asked."""
    volume = RaycastVolume(smooth((43, 37, 29)))
    asked, before = [], textures.VolumeTexture._allocated

    def short_of_memory(self, shape, count, *, layers):
        asked.append(int(np.prod(shape)))
        return np.prod(shape) <= 20_000 and before(self, shape, count, layers=layers)

    right, _ = drawn(gl, monkeypatch, volume, LOOKS["mip"](), look_at(camera, volume), ONE)
    monkeypatch.setattr(textures.VolumeTexture, "_allocated", short_of_memory)
    found, features = drawn(gl, monkeypatch, volume, LOOKS["mip"](), look_at(camera, volume), ONE)
    assert features == ["VOLUME_BRICKS", "VOLUME_PAGES"]
    assert len(asked) > 2
    assert_alike(found, right)


def test_a_memory_map_is_streamed(gl, tmp_path, monkeypatch):
    """Of a volume in a file the host holds a few slices at a time, for the octree and while voxels are handed over."""
    shape = (300, 256, 260)
    path = tmp_path / "large.raw"
    values = np.memmap(path, np.uint8, "w+", 0, shape, "F")
    values[:, :, 100:140] = 200
    values.flush()
    mapped = np.memmap(path, np.uint8, "r", 0, shape, "F")
    monkeypatch.setattr(textures, "pieces", lambda box, axis: pieces(box, axis, 1 << 20))
    monkeypatch.setattr("pvfiblets.volumes.octree.AT_ONCE", 1 << 18)
    tracemalloc.start()
    volume = RaycastVolume(mapped)
    octree = build_octree(volume)
    texture = textures.VolumeTexture(gl, volume, textures.Limits(64, 2048, 2048))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    texture.release()
    assert octree.levels[0].greatest.max() == 200
    assert peak < 0.5 * values.nbytes
