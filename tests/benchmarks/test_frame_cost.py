"""``benchmarks/frame_cost.py``: what it counts, and that a chunk more stays cheap for the processor."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from tests.gl_calls import possible, recording

from .scripts import imported

pytestmark = pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")


@pytest.mark.more
@pytest.mark.parametrize(("pipeline", "most"), [("compute", 90), ("geometry", 12)])
def test_a_chunk_more_asks_little_of_opengl(gl, pipeline, most):
    """Whatever the graphics card, the processor makes these calls in every picture for each chunk."""
    rows = []
    with imported(cost="frame_cost") as modules:
        for chunks in (1, 3):
            fiblets = modules.cost.tiny_fiblets(chunks)
            case = {"pipeline": pipeline, "culling": "two-phase"}
            with modules.cost.as_on_a_card(), recording() as calls:
                rows.append(modules.cost.engine(calls, fiblets, case, SimpleNamespace(frames=2)))
    assert [row["chunks"] for row in rows] == [1, 3]
    assert (rows[1]["calls"] - rows[0]["calls"]) / 2 <= most
    assert rows[0]["ms"] > 0.0
