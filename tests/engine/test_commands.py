"""How many commands a picture takes: as many whatever the data, and so many more a chunk."""

import moderngl
import numpy as np
import pytest

from pvfiblets import Streamlines, compress
from pvfiblets.codec import layout
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.culling.two_phase_items import LEAST_SEGMENTS
from pvfiblets.engine.fiblets.pipelines import compute, textured
from pvfiblets.engine.halos import HaloRenderer
from pvfiblets.engine.tubes import TubeRenderer, TubeStyle
from tests.gl_calls import possible, recording

from .halos import of_lines, styled
from .tubes import bundle

pytestmark = pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")
SIZE = (160, 120)


@pytest.fixture
def recorded(gl, monkeypatch):
    """A context whose calls are recorded, and what records them; of a card, for which no call is cut short."""
    for module in (compute, textured):
        monkeypatch.setattr(module, "is_software", lambda ctx: False)
    with recording() as calls:
        moderngl.init_context()
        ctx = moderngl.get_context()
        ctx.clear_errors()
        yield ctx, calls


def commands(calls, renderer, camera, style):
    """Calls of a steady picture, which is not drawn any more."""
    for turn in range(4):
        calls.silent = turn > 1
        calls.forget()
        matrix = camera(SIZE, eye=(-250 - turn, 120, 90), target=(0, -18, 8), angle=35.0)
        renderer.render(View(SIZE, matrix), style)
    calls.silent = False
    return calls.counts


@pytest.fixture(scope="module")
def sets():
    """Fiblets of two points, in one page and in four."""
    rng = np.random.default_rng(4)
    found = []
    for n in (1000, 2000, 3 * layout.PAGE + 1000):
        starts = rng.uniform(-40.0, 40.0, (n, 1, 3))
        points = np.concatenate([starts, starts + rng.normal(0.0, 1.0, (n, 1, 3))], axis=1).reshape(-1, 3)
        found.append(compress(Streamlines(points.astype("f4"), 2 * np.arange(n + 1))))
    return found


STYLES = {"thin": FibletStyle(), "wide": FibletStyle(4.0, values="arc_length", tolerance=0.0)}
CASES = [
    ("compute", "two-phase", "thin"),
    ("compute", "coverage", "wide"),
    ("tessellation", None, "wide"),
    ("geometry", "two-phase", "thin"),
]


@pytest.mark.few(1)
@pytest.mark.parametrize(("pipeline", "culling", "style"), CASES)
def test_fiblets_take_so_many_a_chunk(recorded, camera, sets, pipeline, culling, style):
    """As many for one page as for another; for 1, 2, 3 and more chunks a number that grows evenly.

    Uniforms are set by round, not by chunk: setting one takes Python longer than any other call.
    """
    ctx, calls = recorded
    few, more, pages = sets
    found, uniforms = [], set()
    for fiblets, most in ((few, 9), (more, 9), (pages, 9), (pages, 2), (pages, 1)):
        how = {"pipeline": pipeline, "culling": culling, "max_buffer_bytes": most * 12 * layout.PAGE + 12}
        renderer = FibletRenderer(ctx, fiblets, **how)
        counts = commands(calls, renderer, camera, STYLES[style])
        found.append((len(renderer._chunks), sum(counts.values())))
        uniforms.add(sum(count for name, count in counts.items() if "Uniform" in name))
        assert calls.waits == []
        renderer.release()
    (one, least), *others = found
    assert one == 1
    assert len(uniforms) == 1
    chunks = [n for n, _ in found]
    assert chunks[2] == 1
    assert set(chunks) == {1, 2, 4}
    each = (found[-1][1] - least) / (chunks[-1] - 1)
    assert [count for _, count in others] == [least + each * (n - 1) for n, _ in others]


@pytest.mark.few(1)
@pytest.mark.parametrize("culling", [None, "two-phase"])
def test_tubes_and_halos_take_as_many_whatever_the_data(recorded, camera, culling):
    ctx, calls = recorded
    rng = np.random.default_rng(3)
    for make in (_tubes, _halos):
        counts = []
        for n in (LEAST_SEGMENTS + 1000, 3 * LEAST_SEGMENTS):
            renderer, style = make(ctx, rng, n, culling)
            counts.append(commands(calls, renderer, camera, style))
            renderer.release()
        assert counts[0] == counts[1]


def _tubes(ctx, rng, n, culling):
    return TubeRenderer(ctx, bundle(n // 50 + 1, 51, seed=5, radius=0.5, step=1.2), culling=culling), TubeStyle()


def _halos(ctx, rng, n, culling):
    lines = [rng.normal(0.0, 30.0, (101, 3)) for _ in range(n // 100 + 1)]
    return HaloRenderer(ctx, of_lines(*lines), culling=culling), styled()
