"""The study of queries: what it measures by is the definition, and answers of compressed sets are right by it."""

import numpy as np
import pytest

from pvfiblets.report.studies.query import study as query
from pvfiblets.report.studies.query.similar import POINTS, equal_arcs, mdf_distances
from pvfiblets.report.study import Budget
from pvfiblets.streamlines import Streamlines

from .little import little


@pytest.mark.more
def test_results_equal_the_references(monkeypatch):
    monkeypatch.setattr(query, "QUICK_STREAMLINES", (300,))
    left = []
    records = list(query.STUDY.run(little(left_out=left)))
    assert not left
    found = {(record.data, record.method, record.setting): record for record in records}
    for name in ("like 100", "clusters at 20 mm", "clusters at 10 mm"):
        ours, theirs = (found[f"300 streamlines, {name}", method, ""] for method in ("fiblets", "dipy"))
        assert ours.errors["elsewhere"].value == 0.0
        assert ours.times["answer"].items == theirs.times["answer"].items == 300
    assert found["300 streamlines, like 100", "fiblets", ""].errors["apart"].value < 1e-4
    balls = "300 streamlines, balls of 5 mm"
    assert found[balls, "index", "painted"].errors["elsewhere"].value == 0.0
    assert found[balls, "points", "painted"].errors["elsewhere"].value < 10.0
    assert {setting for data, method, setting in found if method == "index"} == {"painted", "erased", "dragged"}
    assert sum(record.default for record in records if record.data == balls) == 1


def test_what_there_was_no_time_for_is_told():
    left = []
    assert not list(query.STUDY.run(little(budget=Budget(0.0), left_out=left)))
    assert [item.what for item in left] == ["2,000 streamlines"]


def test_resampled_lines_and_their_distances_are_the_definition():
    corner = Streamlines([[0, 0, 0], [3, 0, 0], [3, 8, 0]], [0, 3])  # 11 mm: a point for each
    (found,) = equal_arcs(corner)
    np.testing.assert_allclose(found[:4], [[n, 0, 0] for n in range(4)], atol=1e-12)
    np.testing.assert_allclose(found[4:], [[3, n, 0] for n in range(1, 9)], atol=1e-12)
    along = np.zeros((POINTS, 3))
    along[:, 0] = np.arange(POINTS)
    aside = along + [0.0, 2.0, 0.0]
    np.testing.assert_allclose(mdf_distances(np.array([along, along[::-1]]), np.array([aside, aside + 5.0])), 2.0)
