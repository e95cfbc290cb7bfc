"""Effects in screen space against their formulas in NumPy, on G-buffers made by hand."""

from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
import pytest

from pvfiblets.engine.effects import AmbientOcclusionPass, HaloPass, OutlinePass, Projection
from pvfiblets.engine.effects.ambient_occlusion import BIAS, GAIN
from pvfiblets.engine.effects.halos import WIDEST

from . import lenses

EMPTY = 0xFFFFFFFF
FAR = np.inf


def projection(size, *, parallel=False, height=60.0, shift=0.0):
    """OpenGL's matrices, float64; a shift is a stereo eye's off-axis frustum."""
    matrix = lenses.parallel(size, height, 50.0, 400.0) if parallel else lenses.perspective(size, 30.0, 50.0, 400.0)
    matrix[0, 2] = shift
    return matrix


LENSES = {
    "perspective": lambda size: Projection(size, projection(size)),
    "parallel": lambda size: Projection(size, projection(size, parallel=True)),
    "off axis": lambda size: Projection(size, projection(size, shift=0.2)),
}


@pytest.fixture(params=LENSES)
def make_lens(request):
    return LENSES[request.param]


@dataclass(eq=False)
class Buffer:
    """What effects read of a G-buffer."""

    depth: Any
    ids: Any
    generation: int = 1

    def release(self):
        self.depth.release()
        self.ids.release()


def pixel_grid(size):
    """NDC of pixel centres, (h, w, 2)."""
    x, y = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    return np.stack([2 * x / size[0] - 1, 2 * y / size[1] - 1], axis=-1)


def keys_of(lens, distance):
    """Keys of distances (h, w), inf for nothing."""
    z = -np.where(np.isfinite(distance), distance, 100.0)
    p = lens.projection
    depth = 0.5 + 0.5 * (p[2, 2] * z + p[2, 3]) / (p[3, 2] * z + p[3, 3])
    return np.where(np.isfinite(distance), np.round(depth * EMPTY), EMPTY).astype(np.uint32)


def places_of(lens, keys):
    """View coordinates of keys, (h, w, 3) float64."""
    ndc = np.concatenate(
        [pixel_grid(lens.size), (2 * (keys / EMPTY) - 1)[..., None], np.ones((*keys.shape, 1))], axis=-1
    )
    places = ndc @ np.linalg.inv(lens.projection).T
    return places[..., :3] / places[..., 3:]


def octahedral(directions):
    d = directions / np.abs(directions).sum(-1, keepdims=True)
    sign = lambda v: np.where(v < 0, -1.0, 1.0)  # noqa: E731
    folded = np.where(d[..., :1] < 0, (1 - np.abs(d[..., 2:0:-1])) * sign(d[..., 1:]), d[..., 1:])
    s = np.round(folded * 32767).astype(np.int64)
    return ((s[..., 0] & 0xFFFF) | ((s[..., 1] & 0xFFFF) << 16)).astype(np.uint32)


@pytest.fixture
def make_buffer(gl):
    made = []

    def make(keys, tangents=(1.0, 0.0, 0.0), streamlines=0):
        h, w = keys.shape
        ids = np.zeros((h, w, 2), np.uint32)
        ids[..., 0] = streamlines
        ids[..., 1] = octahedral(np.broadcast_to(np.asarray(tangents, float), (h, w, 3)))
        buffer = Buffer(
            gl.texture((w, h), 1, keys.tobytes(), dtype="u4"), gl.texture((w, h), 2, ids.tobytes(), dtype="u4")
        )
        for texture in (buffer.depth, buffer.ids):
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
        made.append(buffer)
        return buffer

    yield make
    for buffer in made:
        buffer.release()


@pytest.fixture
def effect(gl):
    made = []

    def make(kind):
        made.append(kind(gl))
        return made[-1]

    yield make
    for thing in made:
        thing.release()
        thing.release()


def read(texture, dtype="<u4"):
    w, h = texture.size
    return np.frombuffer(texture.read(alignment=1), dtype).reshape(h, w)


def scattered_lines(size, seed=0, count=14, low=120.0, high=160.0):
    """Distances of slanted lines at random, the nearest of each pixel."""
    random = np.random.default_rng(seed)
    distance = np.full(size[::-1], FAR)
    for _ in range(count):
        a, b = random.uniform(0, 1, (2, 2)) * size
        z = random.uniform(low, high, 2)
        t = np.linspace(0, 1, 4 * max(size))
        x, y = np.clip((a + (b - a) * t[:, None]).astype(int), 0, np.array(size) - 1).T
        np.minimum.at(distance, (y, x), z[0] + (z[1] - z[0]) * t)
    return distance


# The lens


def test_pixels_per_mm_is_what_the_projection_makes_of_a_mm(make_lens):
    lens = make_lens((200, 120))
    for distance in (60.0, 150.0, 390.0):
        ends = np.array([[0, 0, -distance, 1], [0, 1, -distance, 1]]) @ lens.projection.T
        ends = ends[:, 1] / ends[:, 3]
        assert np.isclose(lens.pixels_per_mm(distance), (ends[1] - ends[0]) * 60)
    with pytest.raises(ValueError, match="inverse"):
        Projection((10, 10), np.zeros((4, 4)))
    with pytest.raises(ValueError, match="finite"):
        Projection((10, 10), np.full((4, 4), np.nan))


# Halos


def halos_by_force(lens, distance, width, depth):
    """Equation (3) over all pairs of pixels: the nearest halo of each pixel, (h, w) distances."""
    h, w = distance.shape
    best = np.full((h, w), FAR)
    y, x = np.mgrid[:h, :w]
    for qy, qx in np.argwhere(np.isfinite(distance)):
        there = distance[qy, qx]
        reach = min(width * lens.pixels_per_mm(there), WIDEST)
        away = np.hypot(y - qy, x - qx)
        best = np.where(away <= reach, np.minimum(best, there + depth * away / reach), best)
    return best


@pytest.mark.parametrize(("width", "depth"), [(2.0, 8.0), (5.0, 2.0), (40.0, 30.0)], ids=["thin", "wide", "widest"])
def test_halos_are_those_of_all_pairs_of_pixels(effect, make_buffer, make_lens, width, depth):
    lens = make_lens((75, 58))
    keys = keys_of(lens, scattered_lines(lens.size))
    distance = np.where(keys == EMPTY, FAR, -places_of(lens, keys)[..., 2])
    expected = halos_by_force(lens, distance, width, depth)
    found = read(effect(HaloPass).draw(make_buffer(keys), lens, width=width, depth=depth, nearest=119.0))
    sure = ~np.isclose(expected, distance, rtol=0, atol=2e-3)  # float32, 160 mm away
    shows = expected < distance
    assert 0.02 < shows.mean() < 0.98
    # A disc's rim may fall on a pixel's centre.
    assert ((found != EMPTY) != shows)[sure].mean() < 0.002
    both = (found != EMPTY) & shows
    assert np.quantile(np.abs(-places_of(lens, found)[both][:, 2] - expected[both]), 0.995) < 5e-3
    assert (found[both] < keys[both]).all()


def crossing(size, gap):
    """A horizontal line at 150 mm before a vertical one that lies ``gap`` mm behind."""
    distance = np.full(size[::-1], FAR)
    distance[:, size[0] // 2] = 150.0 + gap
    distance[size[1] // 2] = 150.0
    return distance


@pytest.mark.parametrize("gap", [0.5, 2.0, 4.0, 7.0, 20.0])
def test_the_gap_widens_with_the_distance_in_depth_as_in_the_papers_appendix(effect, make_buffer, gap):
    """Appendix A: a halo w wide and d deep cuts w min(1, gap / d) on either side."""
    size = (61, 81)
    lens = Projection(size, projection(size, parallel=True, height=40.5))  # 2 pixels per mm
    buffer = make_buffer(keys_of(lens, crossing(size, gap)))
    halo = read(effect(HaloPass).draw(buffer, lens, width=5.25, depth=8.0)) != EMPTY
    column = halo[:, 30]
    cut = int(10.5 * min(1.0, gap / 8.0) - 1e-3)
    assert column[40 - cut : 40].all()
    assert not column[40]
    assert column[41 : 41 + cut].all()
    assert column.sum() == 2 * cut


def test_there_are_no_halos_of_nothing_thinner_than_a_pixel_or_at_one_depth(effect, make_buffer, make_lens):
    lens = make_lens((64, 48))
    distance = np.full((48, 64), FAR)
    distance[::2] = 140.0 + np.arange(24)[:, None] * 0.05
    buffer = make_buffer(keys_of(lens, distance))
    halo = read(effect(HaloPass).draw(buffer, lens, width=2.0, depth=5.0)) != EMPTY
    assert not halo[::2].any()
    assert halo[1::2].all()
    lens = make_lens((33, 17))
    buffer = make_buffer(np.full((17, 33), EMPTY, np.uint32))
    assert (read(effect(HaloPass).draw(buffer, lens, width=5.0, depth=5.0)) == EMPTY).all()
    lens = make_lens((64, 48))
    buffer = make_buffer(keys_of(lens, scattered_lines(lens.size)))
    assert (read(effect(HaloPass).draw(buffer, lens, width=0.01, depth=5.0)) == EMPTY).all()


# Ambient occlusion


def openness(lens, keys, tangent, radius, samples, strength):
    """The formulas of ssao.frag and ssao_blur.frag in float64, (h, w)."""
    h, w = keys.shape
    places, drawn = places_of(lens, keys), keys != EMPTY
    parallel = lens.projection[3, 3] == 1
    viewer = (
        np.broadcast_to([0.0, 0, 1], places.shape) if parallel else -places / np.linalg.norm(places, axis=-1)[..., None]
    )
    normal = viewer - tangent * (viewer @ tangent)[..., None]
    normal /= np.linalg.norm(normal, axis=-1)[..., None]
    k, w0, w1 = lens.scale
    reach = radius * k / (w0 - w1 * places[..., 2])
    y, x = np.mgrid[:h, :w]
    turn = 2 * np.pi * ((x & 3) + 4 * ((y * 3 + x * 2) & 3)) / 16
    total = np.zeros((h, w))
    for i in range(samples):
        angle, far = np.pi * (3 - np.sqrt(5)) * i + turn, reach * np.sqrt((i + 0.5) / samples)
        ox, oy = np.floor(x + 0.5 + far * np.cos(angle)), np.floor(y + 0.5 + far * np.sin(angle))
        inside = (ox >= 0) & (oy >= 0) & (ox < w) & (oy < h)
        ox, oy = (np.where(inside, o, 0).astype(int) for o in (ox, oy))
        v = places[oy, ox] - places
        length = np.maximum(np.linalg.norm(v, axis=-1), 1e-30)
        term = np.maximum(0, 1 - (length / radius) ** 2) * np.maximum(0, (normal * v).sum(-1) / length - BIAS)
        total += np.where(inside & drawn[oy, ox] & ((ox != x) | (oy != y)), term, 0)
    rough = np.round(np.clip(1 - GAIN * total / samples, 0, 1) * 255) / 255
    sums = np.zeros((2, h, w))
    for dy in range(-1, 3):
        for dx in range(-1, 3):
            oy, ox = np.clip(y + dy, 0, h - 1), np.clip(x + dx, 0, w - 1)
            weight = np.maximum(0, 1 - 2 * np.abs(places[oy, ox, 2] - places[..., 2]) / radius) * drawn[oy, ox]
            sums += weight * rough[oy, ox], weight
    mean = sums[0] / np.where(drawn, sums[1], 1)
    return np.where(drawn, 1 + (mean - 1) * strength, 1)


@pytest.mark.parametrize(("radius", "samples", "strength"), [(10.0, 16, 1.0), (25.0, 5, 0.5)])
def test_occlusion_is_its_formula(effect, make_buffer, make_lens, radius, samples, strength):
    lens = make_lens((90, 70))
    distance = np.minimum(scattered_lines(lens.size, count=40, low=140, high=160), 165.0)
    keys = keys_of(lens, distance)
    keys[50:60, 20:40] = EMPTY
    tangent = np.array([0.8, 0.0, 0.6])
    expected = openness(lens, keys, tangent, radius, samples, strength)
    assert np.ptp(expected) > 0.2
    found = read(
        effect(AmbientOcclusionPass).draw(
            make_buffer(keys, tangent), lens, np.eye(3), radius=radius, samples=samples, strength=strength
        ),
        np.uint8,
    )
    off = np.abs(found / 255 - expected)
    # A sample that falls on the edge of two pixels takes either.
    assert np.quantile(off, 0.97) < 2.5 / 255
    assert off.mean() < 1 / 255


def test_tangents_are_turned_into_view_coordinates(effect, make_buffer, make_lens):
    lens = make_lens((64, 48))
    keys = keys_of(lens, np.minimum(scattered_lines(lens.size, low=150, high=155), 158.0))
    turn = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])
    drawn = []
    for tangent, matrix in (([0, 0.6, 0.8], turn * 1e-3), (turn @ [0, 0.6, 0.8], np.eye(3))):
        buffer = make_buffer(keys, tangent)
        texture = effect(AmbientOcclusionPass).draw(buffer, lens, matrix, radius=9.0, samples=16, strength=1.0)
        drawn.append(read(texture, np.uint8).astype(int))
    assert np.abs(drawn[0] - drawn[1]).max() <= 1
    assert np.ptp(drawn[0]) > 20


def bar_before_a_wall(lens, gap):
    """A vertical bar 4 mm wide, ``gap`` mm before a wall of lines that is 150 mm away."""
    wall = np.full(lens.size[::-1], 150.0)
    x = places_of(lens, keys_of(lens, wall))[..., 0]
    return np.where(np.abs(x) < 2.0, 150.0 - gap, wall), x


def occlusion(effect, make_buffer, lens, distance, radius=10.0):
    texture = effect(AmbientOcclusionPass).draw(
        make_buffer(keys_of(lens, distance)), lens, np.eye(3), radius=radius, samples=32, strength=1.0
    )
    return 1 - read(texture, np.uint8) / 255.0


@pytest.mark.parametrize("kind", ["perspective", "parallel"])
def test_a_wall_is_dark_beside_a_bar_and_lighter_farther_away(effect, make_buffer, kind):
    lens = LENSES[kind]((160, 120))
    distance, x = bar_before_a_wall(lens, 4.0)
    dark = occlusion(effect, make_buffer, lens, distance)
    middle = np.abs(np.arange(120) - 60)[:, None] < 30
    at = [dark[middle & (np.abs(np.abs(x) - far) < 0.7)].mean() for far in (3.5, 6.0, 8.5)]
    assert at[0] > at[1] + 0.05 > at[2] + 0.08
    # At the edge of a perspective view a wall is seen aslant: little more than the bias.
    assert dark[middle & (np.abs(x) > 12.6)].max() < 0.02
    assert dark[middle & (np.abs(x) < 2.0)].max() < 0.1


def test_what_is_beyond_the_radius_and_the_background_do_not_darken(effect, make_buffer, make_lens):
    lens = LENSES["parallel"]((120, 90))
    distance, _ = bar_before_a_wall(lens, 10.5)
    assert occlusion(effect, make_buffer, lens, distance).max() == 0.0
    lens = make_lens((80, 60))
    distance = np.full((60, 80), FAR)
    distance[30] = 150.0
    assert occlusion(effect, make_buffer, lens, distance).max() == 0.0


def test_the_radius_is_in_mm_at_any_zoom(effect, make_buffer):
    dark = []
    for height, size in ((60.0, (160, 120)), (30.0, (160, 120)), (60.0, (320, 240))):
        lens = Projection(size, projection(size, parallel=True, height=height))
        distance, x = bar_before_a_wall(lens, 4.0)
        found = occlusion(effect, make_buffer, lens, distance)
        middle = np.abs(np.arange(size[1]) - size[1] / 2)[:, None] < 20
        dark.append([found[middle & (np.abs(np.abs(x) - far) < 0.7)].mean() for far in (3.5, 5.0, 7.0)])
    assert np.allclose(dark, dark[0], atol=0.04)


# Outlines


def test_an_outline_is_a_dilation_without_what_is_dilated(effect, make_buffer):
    size = (70, 50)
    lens = LENSES["parallel"](size)
    keys = keys_of(lens, scattered_lines(size))
    ids = np.random.default_rng(3).integers(0, 5000, keys.shape) * (keys != EMPTY)
    chosen = np.random.default_rng(4).random(5000) < 0.1
    width = 3.0
    marked = np.where((keys != EMPTY) & chosen[ids], keys, EMPTY)
    expected = np.full(keys.shape, EMPTY, np.uint32)
    padded = np.pad(marked, 3, constant_values=EMPTY)
    for dy in range(-3, 4):
        for dx in range(-3, 4):
            if dx * dx + dy * dy <= width**2:
                expected = np.minimum(expected, padded[3 + dy : 53 + dy, 3 + dx : 73 + dx])
    expected[marked != EMPTY] = EMPTY
    assert (expected != EMPTY).any()
    found = read(effect(OutlinePass).draw(make_buffer(keys, streamlines=ids), chosen, width=width))
    assert np.array_equal(found, expected)


@pytest.mark.parametrize("count", [0, 1, 4096, 4097])
def test_any_number_of_streamlines_can_be_chosen(effect, make_buffer, count):
    keys = np.full((9, 9), EMPTY, np.uint32)
    keys[4, 4] = 1000
    buffer = make_buffer(keys, streamlines=max(count - 1, 0))
    found = read(effect(OutlinePass).draw(buffer, np.ones(count, bool), width=1.0))
    assert (found != EMPTY).sum() == (4 if count else 0)


# All


def test_a_picture_is_worked_on_once_until_it_or_a_setting_changes(effect, make_buffer):
    lens = LENSES["perspective"]((40, 30))
    keys = keys_of(lens, scattered_lines(lens.size))
    buffer, halos = make_buffer(keys), effect(HaloPass)
    first = read(halos.draw(buffer, lens, width=8.0, depth=3.0))
    buffer.depth.write(np.full_like(keys, EMPTY).tobytes())
    assert np.array_equal(read(halos.draw(buffer, lens, width=8.0, depth=3.0)), first)
    assert (first != EMPTY).any()
    buffer.generation += 1
    assert (read(halos.draw(buffer, lens, width=8.0, depth=3.0)) == EMPTY).all()
    buffer.depth.write(keys.tobytes())
    assert np.array_equal(read(halos.draw(buffer, lens, width=8.0, depth=3.0)) != EMPTY, np.zeros_like(keys, bool))
    assert (read(halos.draw(buffer, lens, width=8.0, depth=3.5)) != EMPTY).any()
    # Another buffer may have the same OpenGL name and the same count of redraws.
    other = make_buffer(np.full_like(keys, EMPTY))
    other.generation = buffer.generation
    assert (read(halos.draw(other, lens, width=8.0, depth=3.5)) == EMPTY).all()


def test_textures_follow_the_pictures_size_and_are_reported(effect, make_buffer):
    halos = effect(HaloPass)
    for size in ((40, 30), (17, 65)):
        lens = LENSES["perspective"](size)
        texture = halos.draw(make_buffer(keys_of(lens, scattered_lines(size))), lens, width=2.0, depth=3.0)
        assert texture.size == size
        report = halos.explain()
        tiles = -(-size[0] // 8) * -(-size[1] // 8)
        assert sum(buffer["bytes"] for buffer in report["buffers"]) == 8 * size[0] * size[1] + 4 * tiles
        names = [item["name"] for item in report["passes"]]
        assert names == ["linear_depth (effect)", "tile_min_distance (effect)", "halo (effect)"]
        assert all(item["ms"] >= 0 for item in report["passes"])
