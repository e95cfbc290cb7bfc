"""Two-phase culling changes no bit of any picture, however the camera jumps, and does leave work out."""

import numpy as np
import pytest

from pvfiblets import Streamlines, compress
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.culling import DepthPyramid
from pvfiblets.engine.fiblets.pipelines import compute
from pvfiblets.engine.gl import shaders
from pvfiblets.synthetic import brain_streamlines

from .pictures import differences, read
from .visibility_bits import owning, planned

SMALL = (160, 120)


class Both:
    """The same set drawn with two-phase culling and without culling, each renderer with its own past."""

    def __init__(self, gl, fiblets, **options):
        self.culled = FibletRenderer(gl, fiblets, culling="two-phase", **options)
        self.whole = FibletRenderer(gl, fiblets, culling=None, **options)
        self.tested = self.hidden = self.pixels = 0

    def draw(self, view, style=None):
        """Draw one picture with both; they must be the same."""
        style = style or FibletStyle()
        picture, expected = read(self.culled.render(view, style)), read(self.whole.render(view, style))
        assert not differences(picture, expected), f"picture {self.culled._buffer.generation}"
        assert (owning(self.culled) == owning(self.whole)).all()
        wanted, left = planned(self.whole), planned(self.culled)
        assert not (left & ~wanted).any()
        if self.culled._buffer.generation == 1:
            return picture  # nothing was seen before, and nothing can be hidden
        self.tested += int(planned(self.whole, seen=False).sum())
        self.hidden += int((wanted & ~left).sum())
        self.pixels += int(picture.drawn.sum())
        return picture

    def release(self):
        self.culled.release()
        self.whole.release()


@pytest.fixture
def both(gl):
    """Return a maker of pairs of renderers."""
    made = []

    def make(fiblets, **options):
        made.append(Both(gl, fiblets, **options))
        return made[-1]

    yield make
    for pair in made:
        pair.release()


@pytest.fixture(scope="module")
def brain():
    """Return 4,000 streamlines, 27,000 fiblets."""
    return compress(brain_streamlines(4000, step=0.25))


def shells(step):
    """Return fiblets in shells around shells, their lines so many mm apart, rough enough to reach into neighbours."""
    rng = np.random.default_rng(2)
    lines = []
    for radius in np.arange(8.0, 36.0, 2.0):
        for height in np.arange(-radius + 0.2, radius, step):
            around = np.sqrt(radius**2 - height**2)
            n = int(2 * np.pi * around / 0.1) + 2
            t = rng.uniform(0, 2 * np.pi) + 2 * np.pi * np.arange(n) / (n - 1)
            waves, phases = rng.integers(2, 9, 4)[:, None], rng.uniform(0, 2 * np.pi, 4)[:, None]
            rough = around * (1.0 + 0.015 * np.sin(waves * t + phases).sum(0))
            lines.append(np.c_[rough * np.cos(t), rough * np.sin(t), np.full(n, height)])
    return compress(Streamlines.from_list(lines), max_error=1e-3)


@pytest.fixture(scope="module")
def onion():
    """Return 42,000 fiblets, dense enough to hide what is behind thin lines."""
    return shells(0.45)


@pytest.fixture(scope="module")
def loose_onion():
    """Return a quarter of them, which hide enough where lines are wide: wide ones take long to draw."""
    return shells(1.8)


def changed(monkeypatch, name, right, wrong):
    """Let a shader do something else."""
    before = shaders.read_shader
    assert right in before(name)
    monkeypatch.setattr(shaders, "read_shader", lambda n: before(n).replace(right, wrong) if n == name else before(n))


@pytest.fixture
def unpredicted(monkeypatch):
    """Let nothing be drawn early that was not seen in the last picture: all of it is tested, the harder case."""
    monkeypatch.setattr(DepthPyramid, "before", lambda *_: None)


STYLES = {
    "thin": FibletStyle(),
    "every point": FibletStyle(tolerance=0.0),
    "three pixels": FibletStyle(3.0),
    "with values": FibletStyle(1.0, values="arc_length"),
}
CLOSE = {"eye": (0, -110, 30), "near": 30.0, "far": 200.0}


def orbit(angle, radius=200.0, height=60.0):
    """Return the keyword arguments of a camera somewhere around the data, degrees from the front."""
    angle = np.radians(angle)
    return {"eye": (radius * np.sin(angle), -radius * np.cos(angle), height)}


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
def test_turns(both, brain, camera, style, parallel):
    """A little, half a view's width, 60 degrees, to the other side, and back to what was seen before."""
    pair, height = both(brain), 170.0 if parallel else None
    for angle in (0.0, 1.14, 2.28, 12.0, 72.0, 132.0, 312.0, 0.0, 180.0, 2.28):
        pair.draw(View(SMALL, camera(SMALL, **orbit(angle), height=height)), STYLES[style])
    assert pair.hidden > 0.02 * pair.tested


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.parametrize("guess", [True, False])
@pytest.mark.parametrize("style", STYLES)
def test_much_is_hidden(both, onion, camera, request, style, guess):
    """Of an onion of wide lines most of what is not seen is left out, of thin ones a part; still no bit is another."""
    if not guess:
        request.getfixturevalue("unpredicted")
    pair, size = both(onion), (400, 300)
    for angle in (0.0, 1.14, 67.0, 68.14):
        pair.draw(View(size, camera(size, **orbit(angle, 110.0, 30.0))), STYLES[style])
    assert pair.hidden > (0.6 if style == "three pixels" else 0.15) * pair.tested


@pytest.mark.few(1)
@pytest.mark.usefixtures("unpredicted")
@pytest.mark.parametrize("tolerance", [0.0, 0.5])
def test_dollies_through_the_data(both, brain, camera, tolerance):
    pair = both(brain)
    for distance in (250.0, 200.0, 120.0, 60.0, 30.0, 10.0, -5.0, -30.0, -70.0, 100.0):
        target = np.array([3.0, 1.0 - distance + 10.0, 2.0])
        matrix = camera(SMALL, eye=(3.0, -distance, 2.0), target=target, near=1.0, far=400.0, angle=60.0)
        pair.draw(View(SMALL, matrix), FibletStyle(tolerance=tolerance))
    assert pair.hidden > 0


@pytest.mark.more
@pytest.mark.usefixtures("unpredicted")
@pytest.mark.parametrize("near_plane", [0.01, 1.0])
def test_teleports(both, brain, onion, camera, near_plane):
    """From anywhere to anywhere, mostly inside the data, looking anywhere."""
    rng = np.random.default_rng(7)
    for fiblets in (brain, onion):
        pair = both(fiblets)
        for _ in range(10):
            eye = rng.uniform(-60, 60, 3)
            matrix = camera(SMALL, eye=eye, target=eye + rng.normal(0, 1, 3), near=near_plane, far=300.0, angle=70.0)
            pair.draw(View(SMALL, matrix))
        assert pair.hidden > 0


@pytest.mark.more
@pytest.mark.usefixtures("unpredicted")
def test_clipping_ranges(both, loose_onion, camera):
    """Near and far planes that cut the data, down to slices of a millimetre, where depth is coarse in float32."""
    pair = both(loose_onion)
    for near_plane, far in ((30, 200), (100, 105), (20, 101), (110, 110.2), (1e-3, 1e4)):
        for height in (None, 70.0):
            matrix = camera(SMALL, eye=(60, -80, 45), near=near_plane, far=far, height=height)
            pair.draw(View(SMALL, matrix))
            pair.draw(View(SMALL, matrix), FibletStyle(4.0))
    assert pair.hidden > 0.2 * pair.tested


@pytest.mark.more
@pytest.mark.usefixtures("unpredicted")
def test_sizes(both, onion, camera):
    """Windows of any shape, of one pixel, and of powers of two and one more."""
    pair = both(onion)
    for size in ((160, 120), (161, 121), (64, 64), (65, 129), (1, 1), (300, 7), (3, 200), (257, 33), (160, 120)):
        pair.draw(View(size, camera(size, **CLOSE)))
        pair.draw(View(size, camera(size, **CLOSE, angle=30.0)))
    assert pair.hidden > 0.2 * pair.tested


@pytest.mark.more
@pytest.mark.usefixtures("unpredicted")
def test_line_widths(both, loose_onion, camera):
    pair = both(loose_onion)
    for i, width in enumerate((1.0, 9.0, 1.0, 1.5, 2.0, 30.0, 3.0, 1.0)):
        pair.draw(View(SMALL, camera(SMALL, **orbit(7.0 * i, 110.0))), FibletStyle(width))
    assert pair.hidden > 0.3 * pair.tested


@pytest.mark.more
@pytest.mark.usefixtures("unpredicted")
@pytest.mark.parametrize(("width", "shape"), [(1.0, "onion"), (4.0, "loose_onion")])
def test_clip_planes(both, camera, request, width, shape):
    """A plane dragged through what was hidden, and taken away again."""
    pair = both(request.getfixturevalue(shape))
    for i, height in enumerate((40.0, 20.0, 5.0, 0.0, -10.0, None, -20.0, 10.0)):
        planes = [] if height is None else [(0.1, 1.0, 0.2, height), (1.0, 0.0, 0.0, 20.0)]
        pair.draw(View(SMALL, camera(SMALL, **orbit(4.0 * i, 110.0)), planes), FibletStyle(width))
    assert pair.hidden > 0.01 * pair.tested


@pytest.mark.more
def test_data_swapped(both, brain, onion, camera):
    """A renderer that has seen nothing yet draws the same picture as one with a past."""
    view = View(SMALL, camera(SMALL, **orbit(20.0)))
    first, other = both(brain), both(onion)
    for pair in (first, other):
        pair.draw(View(SMALL, camera(SMALL, **orbit(0.0))))
    pictures = [first.draw(view), both(onion).draw(view), other.draw(view), both(brain).draw(view)]
    assert not differences(pictures[0], pictures[3])
    assert not differences(pictures[1], pictures[2])
    assert differences(pictures[0], pictures[1])


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.usefixtures("unpredicted")
@pytest.mark.parametrize("low", [False, True], ids=["anchors16", "anchors32"])
@pytest.mark.parametrize("kind", [1, 2, 3, 4])
def test_lattices_and_duplicates(both, fabricate, random_lines, camera, kind, low):
    """Every line five times: exact ties in every pixel, with copies that were seen last time and some that were not."""
    lines = random_lines(60, seed=5, spread=25.0)
    fiblets = fabricate(lines * 5, kind=kind, low=low, per_fiblet=7)
    pair = both(fiblets)
    for i in range(4):
        picture = pair.draw(View(SMALL, camera(SMALL, **orbit(80.0 * i, 120.0))), FibletStyle(1.0 + 3.0 * (i % 2)))
        assert (picture.ids[picture.drawn][:, 0] < len(lines)).all()


@pytest.mark.more
@pytest.mark.usefixtures("unpredicted")
def test_several_chunks(both, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(700, seed=12, longest=230), kind=2, per_fiblet=2)
    pair = both(fiblets, max_buffer_bytes=12 * (16384 + 1), max_groups=16)
    assert len(pair.culled._chunks) == 3
    for angle in (0.0, 1.14, 60.0, 180.0):
        pair.draw(View(SMALL, camera(SMALL, **orbit(angle, 180.0))), FibletStyle(4.0))
    assert pair.hidden > 0.03 * pair.tested


def random_views(rng, count, camera):
    """Views from all around and inside, of any size, range and projection; of each three, moved a little or not."""
    for _ in range(count):
        size = tuple(int(n) for n in rng.integers(20, 220, 2))
        inside = rng.uniform() < 0.4
        eye = rng.normal(0, 1, 3)
        eye *= (rng.uniform(0, 35) if inside else rng.uniform(40, 200)) / np.linalg.norm(eye)
        target = eye + rng.normal(0, 1, 3) if inside else rng.uniform(-15, 15, 3)
        near_plane = 10.0 ** rng.uniform(-2, 1) if inside else max(np.linalg.norm(eye) - rng.uniform(0, 50), 0.1)
        far = near_plane + 10.0 ** rng.uniform(0.5, 2.5)
        height = rng.uniform(10, 150) if rng.uniform() < 0.3 else None
        angle, width = rng.uniform(10, 100), 1.0 if rng.uniform() < 0.6 else rng.uniform(1.0, 12.0)
        tolerance = rng.choice([0.0, 0.5, 0.5, 2.0])
        for _ in range(3):
            eye = eye + rng.choice([0.0, 0.3, 2.0]) * rng.normal(0, 1, 3)
            matrix = camera(size, eye=eye, target=target, near=near_plane, far=far, height=height, angle=angle)
            yield View(size, matrix), FibletStyle(width, tolerance=tolerance)
            far += rng.choice([0.0, 10.0])


@pytest.mark.more
@pytest.mark.usefixtures("unpredicted")
@pytest.mark.parametrize(("seed", "count"), [(0, 3), pytest.param(1, 24, marks=pytest.mark.exhaustive)])
def test_random_cameras(both, brain, onion, camera, seed, count):
    rng = np.random.default_rng(seed)
    for fiblets in (brain, onion):
        pair = both(fiblets)
        for view, style in random_views(rng, count, camera):
            pair.draw(view, style)
        assert pair.hidden > 0.02 * pair.tested
        assert pair.pixels > 1500 * count


MUTATIONS = {
    "the nearest depth instead of the farthest": (
        "culling/pyramid_lookup.glsl",
        "key = max(key, texelFetch",
        "key = min(key - 1u, texelFetch",
    ),
    "rectangles too small": ("culling/hidden.glsl", "+ half_line_width + MARGIN", "- 3.0"),
}


@pytest.mark.exhaustive
@pytest.mark.usefixtures("unpredicted")
@pytest.mark.parametrize("mutation", MUTATIONS)
def test_a_wrong_test_would_be_noticed(both, onion, camera, monkeypatch, mutation):
    """The pictures above tell a broken hidden() from a right one."""
    changed(monkeypatch, *MUTATIONS[mutation])
    pair = both(onion)
    different = 0
    for view, style in random_views(np.random.default_rng(0), 8, camera):
        a, b = read(pair.culled.render(view, style)), read(pair.whole.render(view, style))
        different += sum(differences(a, b).values())
    assert different > 0


@pytest.mark.usefixtures("unpredicted")
@pytest.mark.parametrize("honest", [True, False])
def test_a_line_seen_from_its_end(both, fabricate, camera, monkeypatch, honest):
    """Its first pixel shows a place a little before its start, which may be nearer than a wall in front of it."""
    if not honest:
        changed(monkeypatch, "culling/hidden.glsl", "m += overshoot;", "")
    x = np.linspace(-50, 50, 500)
    wall = [np.c_[[a, a], [0.0, 0.0], [-40.0, 40.0]] for a in x]
    away = [np.array([[i, 0.3, 5.0 * j], [i + 0.6, 39.0, 5.0 * j]]) for i in range(-20, 20, 2) for j in range(-4, 5)]
    pair = both(fabricate(wall + away, kind=3))
    # first the wall alone, by the far plane
    views = [View(SMALL, camera(SMALL, eye=(0, -260, 0), height=70.0, far=far)) for far in (260.2, 600.0)]
    pictures = [[read(r.render(view)) for r in (pair.culled, pair.whole)] for view in views]
    assert pictures[0][1].drawn.mean() > 0.95
    assert (pictures[0][1].ids[pictures[0][1].drawn][:, 0] < len(wall)).all()
    assert (pictures[1][1].ids[pictures[1][1].drawn][:, 0] >= len(wall)).any()
    assert bool(differences(*pictures[1])) is not honest


@pytest.mark.parametrize("several", [1, 4])
def test_the_first_picture_begins_with_an_even_share(both, onion, camera, monkeypatch, several):
    """Nothing is known of a last picture; a share of all is drawn first, and hides much of the others."""
    monkeypatch.setattr(compute, "SEED_OF", onion.n_fiblets // several)
    pair, size = both(onion), (80, 60)
    pair.draw(View(size, camera(size, **orbit(0.0, 110.0, 30.0))), FibletStyle(3.0))
    everything, first = planned(pair.whole), planned(pair.culled, unseen=False)
    assert everything.sum() == onion.n_fiblets
    assert first.sum() == pytest.approx(onion.n_fiblets / 8 / several, rel=0.3)
    assert planned(pair.culled).sum() < (0.6 if several == 1 else 0.85) * onion.n_fiblets
    pair.draw(View(size, camera(size, **orbit(90.0, 110.0, 30.0))), FibletStyle(3.0))
    assert planned(pair.culled, unseen=False).sum() < first.sum()


def test_what_an_empty_square_of_the_last_picture_shows_is_not_all_drawn_early(gl, camera):
    """Behind a silhouette, finer squares predict: of a ball of lines most is hidden, and is not drawn."""
    renderer = FibletRenderer(gl, shells(0.45), culling="two-phase")
    for angle in (0.0, 1.14, 2.28):
        renderer.render(View((400, 300), camera((400, 300), **orbit(angle, 110.0, 30.0))), FibletStyle(3.0))
    assert planned(renderer).sum() < 3.5 * owning(renderer).sum()
    renderer.release()
