"""Depth of field and tones of a whole picture, held against NumPy and against closed forms."""

import numpy as np
import pytest

from pvfiblets.engine.effects.depth_of_field import STEPS, Focus, disc_areas, distance_of
from pvfiblets.engine.effects.picture import Attachment, PictureEffects
from pvfiblets.engine.effects.projection import Projection
from pvfiblets.engine.effects.tone import OPERATORS, Tone

from . import lenses

SIZE = 44, 36
SHAPE = SIZE[::-1]


class Film:
    """A picture in OpenGL, as VTK would have drawn it, and one to draw the changed one into."""

    def __init__(self, gl, colours, depths=None, floats=False):
        self._gl = gl
        height, width = colours.shape[:2]
        self.dtype = np.float32 if floats else np.uint8
        self.floats = floats
        data = np.ascontiguousarray(colours, self.dtype)
        self.textures = [gl.texture((width, height), 4, data.tobytes(), dtype="f4" if floats else "f1", alignment=1)]
        if depths is not None:
            self.textures.append(gl.texture((width, height), 1, np.float32(depths).tobytes(), dtype="f4"))
        self.effects = PictureEffects(gl)
        self.viewport = 0, 0, width, height

    def shown(self, **how):
        """Return the picture drawn over itself."""
        colour = Attachment(self.textures[0].glo, 0, self.floats)
        depth = Attachment(self.textures[1].glo, 0) if len(self.textures) > 1 else None
        self.effects.copy(colour, depth, self.viewport)
        self.effects.draw(colour, self.viewport, **{"tone": Tone()} | how)
        data = np.frombuffer(self.textures[0].read(alignment=1), self.dtype)
        return data.reshape(*self.textures[0].size[::-1], 4)

    def close(self):
        self.effects.release()
        self.effects.release()
        for texture in self.textures:
            texture.release()


@pytest.fixture
def film(gl):
    made = []

    def make(*arguments, **options):
        made.append(Film(gl, *arguments, **options))
        return made[-1]

    yield make
    for one in made:
        one.close()


def noise(seed=0):
    return np.random.default_rng(seed).integers(0, 256, (*SHAPE, 4), dtype=np.uint8)


# Tones


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize(
    "changes",
    [
        {"exposure": 1.7},
        {"brightness": -0.2, "contrast": 1.5},
        {"gamma": 2.2, "exposure": 0.6, "contrast": 0.5, "brightness": 0.3},
    ],
    ids=str,
)
def test_tones_are_those_of_the_formulas_and_alpha_is_kept(film, operator, changes):
    before = noise()
    after = film(before).shown(tone=Tone(operator=operator, **changes))
    wanted = lenses.toned(before / 255.0, operator=operator, **changes) * 255.0
    assert np.abs(after - wanted).max() <= 1.0
    assert np.array_equal(after[..., 3], before[..., 3])


@pytest.mark.parametrize("operator", ["reinhard", "hable"])
def test_white_is_where_it_is_put(film, operator):
    before = np.full((*SHAPE, 4), 255, np.uint8)
    assert (film(before).shown(tone=Tone(operator=operator, exposure=3.0, white=3.0)) == 255).all()
    softened = film(before).shown(tone=Tone(operator=operator, exposure=3.0, white=6.0))[0, 0, 0]
    wanted = lenses.toned(np.ones(4), operator=operator, exposure=3.0, white=6.0)[0] * 255
    assert abs(softened - wanted) <= 1
    assert softened < 255


def test_a_tone_that_changes_nothing_changes_nothing(film):
    before = noise()
    assert not Tone().changes
    assert np.array_equal(film(before).shown(tone=Tone()), before)
    # Reinhard's operator leaves the colours alone whose white is 1.
    assert np.abs(film(before).shown(tone=Tone(operator="reinhard")).astype(int) - before).max() <= 1


def test_only_the_viewport_changes(film):
    before = noise()
    one = film(before)
    one.viewport = 5, 7, 20, 11
    after = one.shown(tone=Tone(gamma=2.0))
    inside = np.zeros(SHAPE, bool)
    inside[7:18, 5:25] = True
    assert np.array_equal(after[~inside], before[~inside])
    wanted = lenses.toned(before / 255.0, gamma=2.0)[inside] * 255
    assert np.abs(after[inside] - wanted).max() <= 1


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("operator", "filmic"),
        ("exposure", 0.0),
        ("exposure", np.nan),
        ("gamma", -1.0),
        ("gamma", "bright"),
        ("contrast", -0.1),
        ("brightness", 1.5),
        ("brightness", True),
        ("white", 2.0),
    ],
)
def test_tones_without_a_meaning_are_refused(name, value):
    with pytest.raises(ValueError, match=name):
        Tone(**{name: value})


def test_numbers_of_numpy_are_numbers():
    assert Tone(gamma=np.float32(2), exposure=np.int64(2)).uniforms()["gamma"] == 2.0


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("exposure", [1e20, 1e39])
def test_no_exposure_turns_white_black(film, operator, exposure):
    before = np.full((1, 1, 4), 255, np.uint8)
    assert (film(before).shown(tone=Tone(operator=operator, exposure=exposure)) >= 254).all()


# Depth of field


def focus(distance=100.0, aperture=8.0, max_blur=6.0, darkening=0.0):
    return Focus(distance, aperture, max_blur, darkening)


@pytest.mark.parametrize("kind", [lenses.perspective, lenses.parallel])
def test_discs_are_those_of_a_thin_lens(kind):
    """What the shader evaluates, a line in depth, is the cone of light cut by the plane in focus."""
    lens = Projection(SIZE, kind(SIZE))
    distances = np.array([11.0, 40.0, 99.0, 100.0, 101.0, 250.0, 999.0])
    depths = lenses.depths_of(lens.projection, distances)
    at = focus(aperture=0.7, max_blur=64.0)
    u, v = at.uniforms(lens)["line"]
    s = u + v * (1.0 - depths)
    wanted = lenses.radii_of(lens.projection, distances, rows=SIZE[1], focus=100.0, aperture=0.7, widest=1e9)
    assert np.allclose(np.abs(s), wanted, rtol=1e-9, atol=1e-9)
    assert ((s < -1e-9) == (distances < 100.0)).all()
    for distance, depth in zip(distances, depths, strict=True):
        assert distance_of(lens, depth) == pytest.approx(distance, rel=1e-9)


def test_what_is_infinitely_far_away_has_the_disc_of_the_limit():
    lens = Projection(SIZE, lenses.perspective(SIZE))
    limit = lenses.radii_of(lens.projection, np.inf, rows=SIZE[1], focus=100.0, aperture=4.0, widest=64.0)
    assert focus(aperture=4.0, max_blur=64.0).uniforms(lens)["backdrop"] == pytest.approx(limit)
    assert focus().uniforms(Projection(SIZE, lenses.parallel(SIZE)))["backdrop"] == 6.0
    assert focus(aperture=0.0).uniforms(Projection(SIZE, lenses.parallel(SIZE)))["backdrop"] == 0.0


def test_areas_of_discs_are_counted():
    areas = disc_areas(7.0)
    assert areas[0] == areas[STEPS // 2] == 1.0
    for radius in (0.75, 1.0, 2.0, 3.5, 6.9375, 7.0):
        assert areas[int(radius * STEPS)] == pytest.approx(lenses.area(radius), rel=1e-6)
        assert areas[int(radius * STEPS)] == pytest.approx(np.pi * radius**2, abs=1.5)


@pytest.mark.parametrize("kind", [lenses.perspective, lenses.parallel])
@pytest.mark.parametrize("darkening", [0.0, 0.6])
def test_the_picture_is_numpys(film, kind, darkening):
    rng = np.random.default_rng(3)
    distances = rng.choice([60.0, 95.0, 100.0, 120.0, 300.0, np.inf], (SHAPE[0] // 4, SHAPE[1] // 4))
    distances = np.kron(distances, np.ones((4, 4))) * rng.choice([1.0, 1.02], SHAPE)
    lens = Projection(SIZE, kind(SIZE))
    depths = np.float32(lenses.depths_of(lens.projection, distances))
    aperture = 12.0
    radii = lenses.radii_of(lens.projection, distances, rows=SIZE[1], focus=100.0, aperture=aperture, widest=6.0)
    assert (radii < 0.5).any()
    assert (radii > 4).any()
    shade = np.where(np.isinf(distances), 1.0, 1.0 - darkening * np.maximum(radii - 0.5, 0.0) / 5.5)
    before = noise()
    after = film(before, depths).shown(focus=focus(aperture=aperture, darkening=darkening), lens=lens)
    assert np.abs(after - lenses.gathered(before, depths, radii, shade)).max() <= 1.0
    assert np.abs(after.astype(int) - before).max() > 30


def scene(film, distances, colours, *, floats=False, **how):
    lens = Projection(SIZE, lenses.perspective(SIZE))
    depths = lenses.depths_of(lens.projection, distances)
    one = film(colours, depths, floats=floats)
    return one.shown(focus=focus(**how), lens=lens)


def test_a_plane_in_focus_stays_bit_for_bit(film):
    before = noise()
    assert np.array_equal(scene(film, np.full(SHAPE, 100.0), before), before)
    # Also where something blurred is beside it, farther away.
    distances = np.full(SHAPE, 100.0)
    distances[:, 22:] = 400.0
    after = scene(film, distances, before)
    assert np.array_equal(after[:, :22], before[:, :22])
    assert not np.array_equal(after[:, 22:], before[:, 22:])


@pytest.mark.parametrize("distance", [70.0, 150.0])
def test_a_points_disc_has_the_radius_of_the_closed_form_and_all_its_light(film, distance):
    """One pixel before a black background, nearer and farther than the plane in focus."""
    colours = np.zeros((*SHAPE, 4))
    colours[18, 22] = 100.0
    distances = np.full(SHAPE, np.inf)
    distances[18, 22] = distance
    after = scene(film, distances, colours, floats=True, aperture=30.0, max_blur=16.0)[..., 0]
    lens = Projection(SIZE, lenses.perspective(SIZE))
    radius = lenses.radii_of(lens.projection, distance, rows=SIZE[1], focus=100.0, aperture=30.0, widest=16.0)
    assert radius > 3.0
    assert after.sum() == pytest.approx(100.0, rel=1e-3)
    y, x = np.nonzero(after > 1e-6)
    assert np.hypot(y - 18, x - 22).max() == pytest.approx(radius, abs=1.0)
    inside = np.hypot(*np.mgrid[-18:18, -22:22]) < radius - 0.6
    assert np.ptp(after[inside]) < 1e-3 * after[inside].max()


def test_a_background_of_one_colour_is_passed_over_only_where_nothing_else_is_near(film):
    """The squares of pixels that are left out are those whose light is all the same."""
    distances = np.full(SHAPE, np.inf)
    distances[2:9, 2:7] = 60.0
    distances[25:32, 30:41] = 250.0
    before = np.full((*SHAPE, 4), (90, 120, 150, 255), np.uint8)
    before[np.isfinite(distances)] = (250, 10, 30, 255)
    before[20, 12] = (250, 250, 250, 255)
    lens = Projection(SIZE, lenses.perspective(SIZE))
    depths = np.float32(lenses.depths_of(lens.projection, distances))
    after = film(before, depths).shown(focus=focus(aperture=18.0), lens=lens)
    radii = lenses.radii_of(lens.projection, distances, rows=SIZE[1], focus=100.0, aperture=18.0, widest=6.0)
    assert np.abs(after - lenses.gathered(before, depths, radii)).max() <= 1.0
    assert (after[:6, 30:] == before[0, 40]).all()


def test_a_sharp_foreground_does_not_bleed_into_a_blurred_background(film):
    distances = np.full(SHAPE, np.inf)
    distances[:, :22] = 100.0
    colours = np.zeros((*SHAPE, 4), np.uint8)
    colours[:, :22, 0] = 255
    colours[:, 22:, 2] = 255
    assert np.array_equal(scene(film, distances, colours), colours)


def test_a_blurred_foreground_spreads_over_what_is_sharp_behind_it(film):
    distances = np.full(SHAPE, 100.0)
    distances[:, :22] = 50.0
    colours = np.zeros((*SHAPE, 4), np.uint8)
    colours[:, :22, 0] = 255
    colours[:, 22:, 2] = 255
    row = scene(film, distances, colours)[18].astype(int)
    red, blue = row[:, 0], row[:, 2]
    assert (np.abs(red + blue - 255) <= 1).all()
    assert (np.diff(red) <= 0).all()
    assert red[21] > 127 > red[22] > 64  # half at the edge, from both sides
    assert red[14] == 255
    assert red[30] == 0


def test_the_background_is_not_darkened(film):
    distances = np.full(SHAPE, np.inf)
    distances[:, :8] = 40.0
    colours = np.full((*SHAPE, 4), 200, np.uint8)
    after = scene(film, distances, colours, darkening=0.5)
    assert (after[:, 20:, :3] == 200).all()
    radius = 0.5 * 8.0 * (18.0 / np.tan(np.radians(15.0))) * (1 / 40.0 - 1 / 100.0)
    assert np.abs(after[:, 0, :3] - 200.0 * (1.0 - 0.5 * (radius - 0.5) / 5.5)).max() <= 1.0
    assert (after[..., 3] == 200).all()


def test_memory_for_depths_is_given_back_with_the_focus(film):
    before = noise()
    one = film(before, np.full(SHAPE, 0.5))
    one.shown(focus=focus(), lens=Projection(SIZE, lenses.perspective(SIZE)))
    much = one.effects.nbytes
    one.textures.pop().release()
    one.shown(tone=Tone(gamma=2.0))
    assert one.effects.nbytes == SIZE[0] * SIZE[1] * 4 < much
