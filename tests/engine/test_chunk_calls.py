"""How many calls of OpenGL a chunk of fiblets costs in every picture, whatever the graphics card."""

from contextlib import contextmanager
from unittest.mock import patch

import moderngl
import numpy as np
import pytest

from pvfiblets import Streamlines, compress
from pvfiblets.codec import layout
from pvfiblets.engine import FibletRenderer
from pvfiblets.engine.fiblets.pipelines import compute, limits, textured
from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.engine.gl.work_limits import WorkLimits
from pvfiblets.report.studies.culling.pictures import views
from tests.gl_calls import possible, recording

ONE_PAGE = 12 * layout.PAGE + 16  # bytes of the largest buffer of a chunk of one page of short fiblets
WARM, FRAMES = 4, 2  # frames that compile and allocate, and those that count


def tiny_fiblets(pages):
    """Return a set of so many pages, of fiblets of three points each."""
    rng = np.random.default_rng(4)
    n = pages * layout.PAGE
    start, steps = rng.uniform(-60.0, 60.0, (n, 1, 3)), rng.normal(size=(n, 1, 3))
    steps = np.concatenate([steps, steps + 0.1 * rng.normal(size=(n, 1, 3))], axis=1)
    steps *= 0.5 / np.linalg.norm(steps, axis=2, keepdims=True)
    points = np.concatenate([start, start + np.cumsum(steps, axis=1)], axis=1).reshape(-1, 3)
    return compress(Streamlines(points.astype("f4"), 3 * np.arange(n + 1)), exact=False)


@contextmanager
def as_on_a_card():
    """Cut nothing that is cut for software OpenGL only, and draw no more than a page by one call."""
    with (
        patch.object(compute, "is_software", lambda _: False),
        patch.object(textured, "is_software", lambda _: False),
        patch.object(limits.WorkLimits, "from_context", lambda _: WorkLimits(layout.PAGE, 1 << 62, 1 << 23)),
    ):
        yield


def calls_of_a_frame(chunks, pipeline):
    """Return the calls of a frame of a moving camera; once it is compiled they do nothing."""
    fiblets = tiny_fiblets(chunks)
    with as_on_a_card(), recording() as calls:
        below = bare_context()  # a window that VTK closes takes the display of older ones along
        moderngl.init_context()
        ctx = moderngl.get_context()
        ctx.clear_errors()
        renderer = FibletRenderer(ctx, fiblets, pipeline=pipeline, culling="two-phase", max_buffer_bytes=ONE_PAGE)
        assert len(renderer._chunks) == chunks
        path = views(fiblets.bounds, "far", 0.5, WARM + 1 + FRAMES, (640, 360))
        try:
            for view in path[:WARM]:
                renderer.render(view)
            calls.silent = True
            renderer.render(path[WARM])
            calls.forget()
            for view in path[WARM + 1 :]:
                renderer.render(view)
            return sum(calls.counts.values()) / FRAMES
        finally:
            calls.silent = False
            renderer.release()
            below.release()


@pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")
@pytest.mark.more
@pytest.mark.parametrize(("pipeline", "most"), [("compute", 105), ("geometry", 15)])
def test_a_chunk_more_asks_little_of_opengl(gl, pipeline, most):
    """Whatever the graphics card, the processor makes these calls in every picture for each chunk."""
    few, many = (calls_of_a_frame(chunks, pipeline) for chunks in (1, 3))
    assert 0 < (many - few) / 2 <= most
