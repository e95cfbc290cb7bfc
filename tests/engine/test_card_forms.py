"""Forms of passes that graphics cards run and software OpenGL does not: forced here, they draw the same bits."""

import numpy as np
import pytest

from pvfiblets import compress, regions
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data import chunks
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.pipelines import compute
from pvfiblets.synthetic import brain_streamlines

from .test_two_phase import orbit, shells

SIZE = (300, 200)
STYLES = {"thin": FibletStyle(), "wide": FibletStyle(3.0), "detail": FibletStyle(tolerance=2.0),
          "valued": FibletStyle(values="arc_length")}  # fmt: skip
PLANES = [(0.3, 1.0, 0.0, 20.0)]
CUTS = {"whole": {}, "planes": {"clip_planes": PLANES}, "region": {"region": ~regions.Sphere((0.0, -18.0, 8.0), 45.0)}}


@pytest.fixture(scope="module")
def brain():
    return compress(brain_streamlines(1500, step=0.25))


@pytest.fixture(scope="module")
def onion():
    return shells(0.7)


def frames(gl, fiblets, camera, style, cut, culling, **options):
    """Yield the words of some frames: a first, its neighbour, one from inside, and one of chosen streamlines."""
    renderer = FibletRenderer(gl, fiblets, pipeline="compute", culling=culling, **options)
    near = {"eye": (3.0, -20.0, 10.0), "target": (60.0, 10.0, 10.0), "near": 0.2, "far": 300.0, "angle": 80.0}
    try:
        for number, place in enumerate((orbit(0.0, 190.0), orbit(1.5, 190.0), near, orbit(80.0, 190.0))):
            if number == 3:
                renderer.filtering = Filter(streamlines=np.arange(fiblets.n_streamlines) % 3 != 0)
            target = renderer.render(View(SIZE, camera(SIZE, **place), **cut), style)
            drawn = np.frombuffer(target.owner.read(), "<u4") != 0xFFFFFFFF
            textures = target.depth, target.owner, target.ids, target.position
            yield [np.frombuffer(one.read(), "<u4").reshape(len(drawn), -1)[drawn] for one in textures]
        yield renderer.explain()["features"]
    finally:
        renderer.release()


def compare(gl, fiblets, camera, monkeypatch, form, style, cut, culling, **options):
    usual = list(frames(gl, fiblets, camera, STYLES[style], CUTS[cut], culling, **options))
    monkeypatch.setattr(compute, "SOFTWARE_FORMS", (form,))
    other = list(frames(gl, fiblets, camera, STYLES[style], CUTS[cut], culling, **options))
    assert form in other.pop()
    assert form not in usual.pop()
    for one, same in zip(usual, other, strict=True):
        assert len(one[0]) > 300
        for words, there in zip(one, same, strict=True):
            np.testing.assert_array_equal(words, there)


CASES = [("two-phase", "whole", "thin"), (None, "planes", "detail"), ("two-phase", "region", "valued"),
         ("coverage", "whole", "wide"), ("two-phase", "planes", "wide"), (None, "region", "thin")]  # fmt: skip


@pytest.mark.few(3)
@pytest.mark.parametrize(("culling", "cut", "style"), CASES)
@pytest.mark.parametrize("form", compute.CARD_FORMS)
def test_a_form_draws_the_same_bits(gl, brain, camera, monkeypatch, form, culling, cut, style):
    compare(gl, brain, camera, monkeypatch, form, style, cut, culling)


@pytest.mark.more
@pytest.mark.parametrize("form", compute.CARD_FORMS)
def test_of_clusters_and_chunks(gl, onion, camera, monkeypatch, form):
    monkeypatch.setattr(chunks, "CLUSTERED", 0)
    compare(gl, onion, camera, monkeypatch, form, "thin", "whole", "two-phase")
    monkeypatch.setattr(compute, "SOFTWARE_FORMS", ())
    options = {"max_buffer_bytes": 700_000, "max_groups": 16}
    compare(gl, onion, camera, monkeypatch, form, "detail", "planes", "two-phase", **options)
