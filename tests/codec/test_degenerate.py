"""Sets at the edge of what numbers can say, from a file to a file and back: sensible words, or one clear error."""

import json
import re

import numpy as np
import pytest
from PIL import Image

import pvfiblets as pf
from pvfiblets import formats
from pvfiblets.cli.command import main
from pvfiblets.streamlines import Streamlines

T = np.linspace(0.0, 1.0, 50)
LINE = np.stack([T, 0.0 * T, 0.0 * T], axis=1)
CURVE = np.stack([np.cos(3.0 * T), np.sin(3.0 * T), T], axis=1)
ALTERNATING = np.tile([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], (25, 1))
NOTHING = np.zeros((0, 3))


def lines_of(kind):
    """Lines by what is odd about them, with the extremes of a type of number."""
    least, most = float(np.finfo(kind).tiny), float(np.finfo(kind).max)
    bad = {name: np.concatenate([CURVE, [[value, 0.0, 0.0]], CURVE]) for name, value in
           (("a NaN", np.nan), ("an infinity", np.inf))}  # fmt: skip
    return {
        "no line": [],
        "a line without points": [NOTHING],
        "lines without points": [NOTHING] * 3,
        "one point": [[[1, 2, 3]]],
        "the origin": [[[0, 0, 0]]],
        "two points": [[[1, 2, 3], [2, 3, 4]]],
        "one place twice": [[[1, 2, 3]] * 2],
        "points, a line and nothing": [[[1, 2, 3]], [[1, 2, 3], [4, 5, 6]], NOTHING],
        "one place": [np.full((100, 3), 7.5)],
        "one place by many": [np.full((10, 3), 1.0)] * 50,
        "two places": [np.full((10, 3), 1.0), np.full((10, 3), 2.0)],
        "straight": [LINE],
        "straight and large": [1e6 * LINE],
        "straight and far": [LINE + 1e6],
        "curve": [CURVE],
        "along z": [LINE[:, [1, 2, 0]]],
        "in a plane": [CURVE * [1, 1, 0]],
        "there and back": [np.concatenate([LINE, LINE[::-1]])],
        "alternating": [ALTERNATING],
        "alternating and small": [1e-6 * ALTERNATING],
        "alternating, far": [1e-3 * ALTERNATING + 1e4],
        "every point thrice": [np.repeat(CURVE, 3, axis=0)],
        "long end": [np.concatenate([CURVE, CURVE[-1:].repeat(40, 0)])],
        "huge": [1e30 * CURVE],
        "beyond": [0.4 * most * CURVE],
        "tiny": [1e-30 * CURVE],
        "least": [least * CURVE],
        "denormal": [1e-4 * least * CURVE],
        "mixed in a line": [np.concatenate([1e-10 * CURVE, 1e10 * CURVE])],
        "mixed lines": [CURVE, 1e-8 * CURVE + 5.0, 1e8 * CURVE],
        "one far point": [CURVE, [[1e15, 0, 0]]],
        "one far point in a line": [np.concatenate([CURVE, [[1e15, 0, 0]], CURVE])],
        "growing": [1.5 ** np.arange(80.0)[:, None] * [1, 0, 0]],
        "shrinking": [0.5 ** np.arange(120.0)[:, None] * [1, 0, 0]],
        "ends of float16": [65504.0 * CURVE],
        "steps of float16": [6e-8 * CURVE],
        "hair": [LINE + 1e-9 * ALTERNATING[:, [1, 0, 2]]],
        **{name: [points] for name, points in bad.items()},
        "all NaN": [np.full((5, 3), np.nan)],
        "a line of infinities": [CURVE, np.full((2, 3), -np.inf)],
    }


def streamlines(name, kind):
    lines = [np.asarray(line, np.float64).reshape(-1, 3) for line in lines_of(kind)[name]]
    with np.errstate(over="ignore"):
        points = np.concatenate([NOTHING, *lines]).astype(kind)
    return Streamlines(points, np.cumsum([0, *map(len, lines)]))


pytestmark = pytest.mark.filterwarnings("ignore:most points lie within")  # which test_far_lines.py expects
NONSENSE = re.compile(r"\bnan\b|\binf\b|\bNone\b|e[-+][0-9]{3}|Traceback")


@pytest.mark.few(4)
@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize("name", lines_of(np.float32))
def test_a_degenerate_set_keeps_its_error_bound_and_reports_it(name, kind, tmp_path, capsys):
    source, target, back = (tmp_path / part for part in ("a.trx", "a.fiblets", "b.trx"))
    formats.write(source, streamlines(name, kind))
    done = main(["convert", str(source), str(target), "--no-exact"])
    if name == "beyond":
        said = capsys.readouterr().err
        assert done == 1
        assert re.fullmatch(r"pvfiblets: a coordinate of \S+ mm is beyond 1e\+35 mm, .*: check the units\n", said)
        assert not target.exists()
        return
    assert done == 0
    for command in (["info", target], ["verify", target, source], ["convert", target, back]):
        assert main([str(word) for word in command]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert not NONSENSE.search(said.out), said.out
    want, found = formats.read(source), formats.read(back)
    np.testing.assert_array_equal(found.offsets, want.offsets)
    lost = np.size(want.points) // 3 - int(np.isfinite(streamlines(name, kind).points).all(axis=1).sum())
    assert lost == 0
    assert ("non-finite points" in said.out) == (name in ("a NaN", "an infinity", "all NaN", "a line of infinities"))
    distance = np.linalg.norm(found.points.astype(float) - want.points.astype(float), axis=1).max(initial=0.0)
    rounding = np.spacing(np.abs(want.points).max(initial=0.0).astype(found.points.dtype))
    assert distance <= pf.FibletSet.open(target).promise * (1.0 + 1e-9) + 2.0 * float(rounding)
    whole = pf.compress(want, exact=True)
    np.testing.assert_array_equal(whole.decompress().points, want.points)


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        ("a line without points", 0, 0), ("one point", 1, 40), ("one place", 1, 40), ("two points", 100, 2000),
        ("straight and far", 100, 2000), ("alternating", 100, 2000), ("one far point", 1, 80), ("denormal", 1, 40),
        ("mixed in a line", 100, 2000), ("a NaN", 100, 2000),
    ],
)  # fmt: skip
@pytest.mark.filterwarnings("default:the source holds no points", "default:.*non-finite points")
def test_a_degenerate_set_is_drawn(name, least, most, tmp_path, capsys):
    """A point is a dot, a line is a line, and what is not there is told."""
    source, picture = tmp_path / "a.trx", tmp_path / "a.png"
    formats.write(source, streamlines(name, np.float64))
    words = ["--size", "100x80", "--color", "white", "--no-lighting", "--line-width", "3"]
    assert main(["screenshot", str(source), "-o", str(picture), *words]) == 0
    drawn = int((np.asarray(Image.open(picture).convert("L")) > 20).sum())
    assert least <= drawn <= most
    assert ("nothing is drawn" in capsys.readouterr().err) == (most == 0)


@pytest.mark.parametrize("how", [["--exact"], ["--no-exact"], ["--shards", "1M"]])
def test_a_set_of_nothing_goes_on_to_every_format(how, tmp_path):
    source, between = tmp_path / "a.trx", tmp_path / "a.fiblets"
    formats.write(source, streamlines("no line", np.float32))
    assert main(["convert", str(source), str(between), *how]) == 0
    for suffix in (".tck", ".trk", ".trx", ".vtk", ".vtp"):
        target = tmp_path / f"b{suffix}"
        assert main(["convert", str(between), str(target)]) == 0
        assert len(formats.read(target)) == 0


@pytest.mark.parametrize("points", [np.zeros((1, 3)), np.zeros((4, 3))])
def test_a_set_at_the_origin_promises_no_error_at_all(points):
    """Not the smallest number that coding divides by, 2.6e-290 mm."""
    whole = Streamlines(points, [0, len(points)])
    fiblets = pf.compress(whole, exact=False)
    assert fiblets.promise == 0.0
    np.testing.assert_array_equal(fiblets.decompress().points, points)


def test_data_about_exact_files_say_that_nothing_is_lost(tmp_path, capsys):
    source, target = tmp_path / "a.tck", tmp_path / "a.fiblets"
    formats.write(source, Streamlines(np.array([[1.0, 2.0, 3.0], [5.0, 4.0, 3.0]]), [0, 1, 2]))
    for command, *files in (("convert", source, target, "--exact"), ("info", target), ("verify", target, source)):
        capsys.readouterr()
        assert main([command, *map(str, files), "--json"]) == 0
        said = json.loads(capsys.readouterr().out)
        assert said["exact"] is True
        assert said["promise_mm"] == 0.0
