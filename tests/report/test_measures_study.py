"""Measures of coded sets beside those of their points, on very little data."""

import numpy as np
import pytest

from pvfiblets import compress
from pvfiblets.report.studies.codec.measures import STUDY
from pvfiblets.synthetic.trackers import tracked_streamlines

from .little import little


def test_errors_are_those_of_the_decoded_points():
    left_out = []
    records = {(record.data, record.setting): record for record in STUDY.run(little(points=2000, left_out=left_out))}
    assert left_out
    for (data, setting), record in records.items():
        assert record.default == (setting == "default")
        if record.default:
            assert record.errors["ends"].value <= 0.1001 * float(data.split()[-2])
        assert 0.0 <= record.errors["density"].value < 20.0
        assert record.times["table"].items > 0
    lines = tracked_streamlines("SD_STREAM", max(round(2000 * 0.1 / 94.0), 1), 0.1, 0)
    decoded = compress(lines, exact=False).decompress()
    off = np.abs(decoded.lengths() - lines.lengths()) / lines.lengths()
    found = records["SD_STREAM-like, 0.1 mm", "default"]
    assert found.errors["length"].value == pytest.approx(100.0 * off.max(), rel=1e-3)
    ends = [np.linalg.norm(decoded.points[at].astype(float) - lines.points[at], axis=1).max()
            for at in (lines.offsets[:-1], lines.offsets[1:] - 1)]  # fmt: skip
    assert found.errors["ends"].value == pytest.approx(max(ends), rel=1e-3)
