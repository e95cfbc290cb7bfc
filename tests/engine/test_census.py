"""What `explain` counts: fiblets in the view, drawn and visible, against the same counted from the records."""

import numpy as np
import pytest

from pvfiblets import compress
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.synthetic import brain_streamlines
from tests.drivers import MESH

from .pictures import SIZE, read
from .test_coverage import capsules
from .visibility_bits import planned

PLANES = [(0.3, -0.9, 0.1, 12.0), (0.0, 0.0, 1.0, -10.0)]


@pytest.fixture(scope="module")
def brain():
    return compress(brain_streamlines(1000, step=0.5, seed=3))


def in_view(fiblets, view, slack):
    """How many capsules reach into the view volume moved out by ``slack`` mm, and to the planes' kept side."""
    a, b, r = capsules(fiblets)
    m = view.model_view_projection
    sides = [m[3] + sign * m[axis] for axis in range(3) for sign in (1, -1)]
    planes = [*sides, *map(np.asarray, view.clip_planes)]
    inside = np.ones(len(a), bool)
    for plane in planes:
        n = plane / np.linalg.norm(plane[:3])
        heights = np.maximum(a @ n[:3] + n[3], b @ n[:3] + n[3])
        inside &= heights > -(r + slack)
    return int(inside.sum())


@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["compute", "tessellation", "geometry", *MESH])
@pytest.mark.parametrize("planes", [[], PLANES], ids=["no planes", "planes"])
def test_counts_are_those_of_the_records(gl, brain, camera, name, planes):
    made = FibletRenderer(gl, brain, pipeline=name, culling="two-phase")
    n = brain.n_fiblets
    assert made.explain()["fiblets"] == {"total": n, "in_frustum": None, "drawn": None, "visible": None}
    for eye, target in (((0, -260, 40), (0, -10, 20)), ((0, -60, 10), (30, 0, 30)), ((0, -60, 10), (0, -200, 10))):
        view = View(SIZE, camera(SIZE, eye=eye, target=target), planes)
        picture = read(made.render(view, FibletStyle()))
        counts = made.explain()["fiblets"]
        assert counts["total"] == n
        assert counts["visible"] == len(set(picture.owner[picture.drawn].tolist()))
        # a plane of the caller's is tested with a sphere about the capsule, not with the capsule
        more = brain.parameters.largest_radius if planes else 0.05
        assert in_view(brain, view, 0.0) <= counts["in_frustum"] <= in_view(brain, view, more)
        if name == "compute":
            assert counts["visible"] <= counts["drawn"] <= counts["in_frustum"]
            assert counts["drawn"] == planned(made).sum()
        else:
            assert counts["drawn"] is None
        assert made.explain(counts=False)["fiblets"] == {"total": n, "in_frustum": None, "drawn": None, "visible": None}
    made.release()


def test_pipelines_count_alike_and_without_culling_all_in_view_is_drawn(gl, brain, camera):
    view = View(SIZE, camera(SIZE, eye=(0, -60, 10), target=(30, 0, 30)))
    found = []
    for name in ("compute", "tessellation", "geometry"):
        made = FibletRenderer(gl, brain, pipeline=name, culling=None)
        made.render(view)
        found.append(made.explain()["fiblets"])
        made.release()
    assert found[0]["drawn"] == found[0]["in_frustum"] < brain.n_fiblets
    for counts in found[1:]:
        assert counts["in_frustum"] == counts["drawn"] == found[0]["in_frustum"]
        assert counts["visible"] == pytest.approx(found[0]["visible"], rel=0.01)


@pytest.mark.more
def test_counting_changes_nothing(gl, fabricate, random_lines, camera):
    """Chunks, other renderers between, values measured with another frame: the next pictures are as without."""
    fiblets = fabricate(random_lines(700, seed=12, longest=230), kind=2, per_fiblet=2)
    quiet, asked = FibletRenderer(gl, fiblets), FibletRenderer(gl, fiblets, max_buffer_bytes=12 * (16384 + 2))
    for k in range(4):
        view = View(SIZE, camera(SIZE, eye=(40 * k, -250, 60)), PLANES if k == 2 else [])
        expected = read(quiet.render(view, FibletStyle(tolerance=0.0)))
        picture = read(asked.render(view, FibletStyle(tolerance=0.0)))
        assert (picture.owner == expected.owner).all()
        for made in (asked, quiet):
            if made is quiet:
                asked.value_range("arc_length")
            counts = asked.explain()["fiblets"]
        assert counts["drawn"] == planned(asked).sum()
        assert counts["visible"] == len(np.unique(expected.owner[expected.drawn]))
        assert counts["in_frustum"] == quiet.explain()["fiblets"]["in_frustum"]
    quiet.release()
    asked.release()
