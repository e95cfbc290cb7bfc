"""Resampling on the way in: the promise is about the lines that were given, corners and all."""

import itertools
import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets.cli.command import main
from pvfiblets.codec.encoding.resample import resample
from pvfiblets.codec.kernels.line_distance import line_distances
from pvfiblets.formats import write
from pvfiblets.streamlines import Streamlines

from .samples import noisy, smooth, wandering


def from_line(points, line):
    """Distances of points from a poly-line, each from every segment."""
    line = np.asarray(line, float)
    if len(line) == 1:
        return np.linalg.norm(points - line[0], axis=1)
    a, edge = line[:-1], np.diff(line, axis=0)
    squares = np.maximum((edge**2).sum(1), 1e-300)
    t = np.clip(((points[:, None] - a) * edge).sum(-1) / squares, 0.0, 1.0)
    return np.linalg.norm(points[:, None] - a - t[..., None] * edge, axis=-1).min(axis=1)


def along(line, parts=20):
    """Points of a poly-line, close together."""
    line = np.asarray(line, float)
    if len(line) < 2:
        return line
    t = np.arange(parts)[:, None] / parts
    return np.concatenate([*(a + t * (b - a) for a, b in itertools.pairwise(line)), line[-1:]])


def apart(one, other):
    """Largest distance of two sets of lines: of any point of a line from the other line, either way."""
    pairs = [(np.asarray(a, float), np.asarray(b, float)) for a, b in zip(one, other, strict=True) if len(a)]
    return max(max(from_line(along(a), b).max(), from_line(along(b), a).max()) for a, b in pairs)


def zigzag(n=60, edge=3.7):
    """A line that turns by 90 degrees every few mm."""
    steps = np.where(np.arange(n)[:, None] % 2, [edge, 0.0, 0.0], [0.0, 0.8 * edge, 0.3])
    return np.cumsum(steps, axis=0)


CASES = {
    "corners": Streamlines.from_list([zigzag(), zigzag(3), zigzag(1), np.empty((0, 3)), np.zeros((4, 3))]),
    "smooth": smooth(6, 120),
    "noisy": noisy(4, 150),
    "wandering": wandering(10, 40),
    "there and back": Streamlines.from_list([np.array([[0.0, 0, 0], [10, 0, 0], [0, 0.1, 0], [10, 0.2, 0]])]),
    "float32": Streamlines(smooth(3, 90).points.astype(np.float32), smooth(3, 90).offsets),
}


@pytest.mark.few(1)
@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("options", [{"step": 1.0, "max_error": 0.01}, {"step": 2.0}, {"step": 0.3, "max_error": 0.1}])
def test_lines_stay_within_the_promise(name, options):
    lines = CASES[name]
    fiblets = pf.compress(lines, **options)
    if "max_error" in options:
        assert fiblets.promise == options["max_error"]
    fiblets.verify()
    back = fiblets.decompress(dtype=np.float64)
    found = apart(lines, back)
    assert found <= fiblets.promise * (1.0 + 1e-9)
    error = pf.measure_error(lines, fiblets)
    drawn = [np.asarray(line, float) for line in fiblets.decompress()]
    of_points = [max(from_line(a, b).max(), from_line(b, a).max()) for a, b in zip(lines, drawn, strict=True) if len(a)]
    assert error.max_mm >= max(of_points) - 2e-6
    assert error.max_mm <= fiblets.promise * (1.0 + 1e-9)
    assert 0.0 < error.mean_mm <= error.max_mm
    assert len(error.streamline_max_mm) == len(lines)


def test_steps_are_even_where_lines_are_smooth():
    angle = np.linspace(0.0, 3.0, 400)[:, None]
    helix = np.hstack([np.cos(angle), np.sin(angle), 0.1 * angle])
    arcs = Streamlines.from_list([radius * helix for radius in (30.0, 41.5, 50.0)])
    counts = np.diff(pf.compress(arcs, step=1.0).offsets())
    assert counts.tolist() == (np.ceil(arcs.lengths() - 1e-6) + 1).tolist()  # a step apart, and the end: no corners


def test_errors_beyond_the_bound_are_reported_exactly():
    """Other lines than those that were compressed, farther away than the set promises."""
    lines = smooth(5, 120)
    fiblets = pf.compress(lines, step=2.0, max_error=0.05)
    back = fiblets.decompress(dtype=np.float64)
    moved = Streamlines(lines.points + [0.0, 0.7, 0.0], lines.offsets)
    error = pf.measure_error(moved, fiblets)
    wanted = [max(from_line(a, b).max(), from_line(b, a).max()) for a, b in zip(moved, back, strict=True)]
    np.testing.assert_allclose(error.streamline_max_mm, wanted, rtol=1e-5)
    with pytest.raises(ValueError, match="hold 5 streamlines"):
        pf.measure_error(smooth(4, 120), fiblets)


def test_files_are_compared_with_what_they_were_made_of(tmp_path, capsys):
    lines = CASES["corners"]
    write(tmp_path / "a.tck", lines)
    words = ["--step", "1", "--max-error", "0.01", "--json"]
    assert main(["convert", str(tmp_path / "a.tck"), str(tmp_path / "a.fiblets"), *words]) == 0
    result = json.loads(capsys.readouterr().out)
    opened = pf.FibletSet.open(tmp_path / "a.fiblets")
    assert opened.promise == result["promise_mm"] == 0.01
    assert opened.parameters.resampled == 1.0
    assert 0.0 < result["error_mm"]["max"] <= 0.01
    made = pf.compress(pf.read(tmp_path / "a.tck"), step=1.0, max_error=0.01)
    np.testing.assert_array_equal(opened.decompress().points, made.decompress().points)
    assert main(["verify", str(tmp_path / "a.fiblets"), str(tmp_path / "a.tck"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["kept"]


def test_values_go_along_with_corners():
    line = zigzag(20)
    lines = Streamlines.from_list([line], per_point={"x": line[:, 0]})
    fresh = resample(lines, 1.0, 0.01)
    np.testing.assert_allclose(fresh.per_point["x"], fresh.points[:, 0], atol=1e-6)
    assert set(map(tuple, line.tolist())) <= set(map(tuple, fresh.points.tolist()))


@given(st.data())
def test_distances_are_those_from_every_segment(data):
    rng = np.random.default_rng(data.draw(st.integers(0, 999)))
    n = data.draw(st.integers(1, 4))
    one, other = (
        Streamlines.from_list([np.cumsum(rng.normal(size=(int(rng.integers(1, 60)), 3)), axis=0) for _ in range(n)])
        for _ in range(2)
    )
    found = line_distances(one.points, one.offsets, other.points, other.offsets, 0.0)
    wanted = np.concatenate([from_line(a, b) for a, b in zip(one, other, strict=True)])
    np.testing.assert_allclose(found, wanted, atol=1e-9)
