"""Measures, bits, ends and profiles: against NumPy on the decompressed points, streamline by streamline."""

from dataclasses import replace

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets import regions
from pvfiblets.query.measures import measures
from pvfiblets.query.measures.measures import Distance, Values, measure, measure_names
from pvfiblets.query.measures.profile import mean_profile
from pvfiblets.query.selection.bits import Criterion, point_words, rank_words, streamline_mask
from pvfiblets.query.selection.endpoints import end_points, similar_ends
from pvfiblets.streamlines import Streamlines
from tests.codec.samples import extremes, smooth
from tests.codec.test_restrict import every_kind, many_pages


def lines_with_values():
    lines = every_kind()
    fa = np.sin(np.arange(lines.n_points) * 0.01)
    fa[5:9] = np.nan
    return Streamlines(
        lines.points, lines.offsets, {"fa": fa, "height": lines.points[:, 2]},
        {
            "number": np.arange(73), "column": np.arange(73.0)[:, None], "colour": np.ones((73, 3)),
            "text": np.array(["a"] * 73),
        },
        lines.groups,
    )  # fmt: skip


LINES = lines_with_values()
NAN = np.isnan(LINES.per_point["fa"])


@pytest.fixture(scope="module", params=["input", "hilbert", "mapped"])
def whole(request, tmp_path_factory):
    order = "input" if request.param == "input" else "hilbert"
    made = pf.compress(LINES, per_point=["fa", "height"], order=order)
    if request.param != "mapped":
        return made
    path = tmp_path_factory.mktemp("measures") / "a.fiblets"
    made.save(path)
    return pf.FibletSet.open(path)


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch):
    monkeypatch.setattr(measures, "CHUNK", 300)


def curvature(p: np.ndarray, error: float) -> np.ndarray:
    """By the angle between chords, from its cosine and sine; chords as long as the error asks for."""
    n, s, along = len(p), 1, arc_length(p)
    if n < 3:
        return np.zeros(n)
    while True:
        k = np.zeros(n)
        for i in range(s, n - s):
            a, b, whole = p[i] - p[i - s], p[i + s] - p[i], along[i + s] - along[i - s]
            if a.any() and b.any():
                k[i] = 2 * np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b) / whole
        chord, most = s * along[-1] / (n - 1), (n - 1) // 2
        turn = k[s : n - s].mean() * chord
        if turn * chord >= 4 * error or turn > 1 or s == most:
            break
        s = min(max(s + 1, s * 5 // 4), most)
    k[:s], k[n - s :] = k[s], k[n - s - 1]
    return k


def arc_length(p):
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])[: len(p)]


def by_line(whole):
    return whole.decompress(dtype=np.float64).to_list()


def coded(whole, lines):
    return whole.in_coded_order(np.concatenate(lines))


# ------------------------------------------------------------------------------------------------------------ measures


def test_measures_of_points(whole: pf.FibletSet) -> None:
    lines, error = by_line(whole), max(whole.step / 10, whole.points_promise)
    original = [np.asarray(p, np.float64) for p in LINES]
    for name, unit, wanted in (
        ("curvature", "1/mm", [curvature(p, error) for p in lines]),
        ("arc_length", "mm", [arc_length(p) for p in lines]),
        ("coding_error", "mm", [np.linalg.norm(p - q, axis=1) for p, q in zip(lines, original, strict=True)]),
        (Distance((1, 2, 3), "point"), "mm", [np.linalg.norm(p - [1, 2, 3], axis=1) for p in lines]),
    ):
        found = measure(whole, name, original=LINES)
        assert (found.kind, found.unit, found.values.dtype) == ("point", unit, np.float32)
        np.testing.assert_allclose(found.array(), coded(whole, wanted), rtol=1e-5, atol=1e-6)
        assert found.range() == (found.array().min(), found.array().max())
    errors = measure(whole, "coding_error", original=LINES)
    assert errors.array().max() == pytest.approx(pf.measure_error(LINES, whole).max_mm, rel=1e-3)


def test_measures_of_streamlines(whole: pf.FibletSet) -> None:
    lines, error = by_line(whole), max(whole.step / 10, whole.points_promise)
    full = [i for i, p in enumerate(lines) if len(p)]
    for name, unit, make, without in (
        ("length", "mm", lambda p: arc_length(p)[-1], 0.0),
        ("n_points", "", len, 0.0),
        ("mean_curvature", "1/mm", lambda p: curvature(p, error).mean(), np.nan),
        ("end_distance", "mm", lambda p: np.linalg.norm(p[-1] - p[0]), np.nan),
        (Distance((1, 2, 3)), "mm", lambda p: np.linalg.norm(p - [1, 2, 3], axis=1).min(), np.nan),
    ):
        found = measure(whole, name)
        assert (found.kind, found.unit, found.values.dtype) == ("streamline", unit, np.float64)
        wanted = np.full(73, without)
        wanted[full] = [make(lines[i]) for i in full]
        np.testing.assert_allclose(found.array(), wanted, rtol=1e-5, atol=1e-9)
    assert 73 - len(full) == 3
    np.testing.assert_allclose(whole.lengths(), measure(whole, "length").array(), rtol=1e-5, atol=1e-4)


def test_distances_to_regions_are_the_regions_own(whole):
    box = regions.Box((-20, 10, -5, 25, 0, 40))
    decoded = whole.decompress(dtype=np.float64)
    low, high = np.array([-20, -5, 0]), np.array([10, 25, 40])
    wanted = np.linalg.norm(np.maximum(np.maximum(low - decoded.points, decoded.points - high), 0), axis=1)
    found = measure(whole, Distance(box, "point")).array()
    np.testing.assert_allclose(found, whole.in_coded_order(wanted), rtol=1e-6, atol=1e-6)
    least = measure(whole, Distance(box)).array()
    for i, (a, b) in enumerate(zip(decoded.offsets[:-1], decoded.offsets[1:], strict=True)):
        assert least[i] == pytest.approx(wanted[a:b].min(), abs=1e-9) if b > a else np.isnan(least[i])
    with pytest.raises(NotImplementedError, match="no distance"):
        measure(whole, Distance(~box))


def test_stored_arrays_and_ones_own(whole):
    fa = measure(whole, "fa")
    assert fa.kind == "point"
    assert fa.values is whole.per_point["fa"], "no copy is made"
    assert fa.range() == (whole.per_point["fa"].lo, whole.per_point["fa"].hi)
    np.testing.assert_array_equal(measure(whole, "number").values, np.arange(73.0))
    np.testing.assert_array_equal(measure(whole, "column").values, np.arange(73.0))
    given = np.arange(whole.n_points)
    own = measure(whole, given)
    np.testing.assert_array_equal(own.values, whole.in_coded_order(given))
    mine = measure(whole, np.arange(73) > 5)
    assert mine.kind == "streamline"
    np.testing.assert_array_equal(mine.values, np.arange(73) > 5)
    assert measure(whole, mine) is mine
    assert measure_names(whole, "streamline") == [
        "length", "n_points", "mean_curvature", "end_distance", "number", "column",
    ]  # fmt: skip
    assert measure_names(whole, "point") == ["curvature", "arc_length", "coding_error", "fa", "height"]
    assert measure_names(whole) == measure_names(whole, "streamline") + measure_names(whole, "point")


def test_stored_arrays_come_before_measures_of_their_name():
    given = {"curvature": np.array([1.0, 2.0, 3.0])}, {"length": np.array([7.0, 8.0])}
    lines = Streamlines(np.eye(3), [0, 2, 3], *given)
    made = pf.compress(lines, per_point=["curvature"])
    assert measure(made, "length").array().tolist() == [7.0, 8.0]
    assert measure(made, "curvature").range() == (1.0, 3.0)
    assert measure(made, "curvature").unit == measure(made, "length").unit == ""


def test_what_is_refused(whole):
    for name in ("FA", "colour", "text"):
        with pytest.raises(KeyError, match=f"no measure '{name}'; there are length, n_points, .*curvature.*fa"):
            measure(whole, name)
    with pytest.raises(ValueError, match="one number for each of the 73 streamlines"):
        measure(whole, np.zeros(72))
    with pytest.raises(ValueError, match="one number for each of the 73 streamlines"):
        measure(whole, np.zeros((73, 3)))
    with pytest.raises(ValueError, match="pass these as original="):
        measure(whole, "coding_error")
    with pytest.raises(ValueError, match="the original has 72 streamlines"):
        measure(whole, "coding_error", original=LINES[:72])
    with pytest.raises(ValueError, match="per is 'fiblet'"):
        Distance((0, 0, 0), "fiblet")
    for bad in ((0, 0), (0, np.nan, 1)):
        with pytest.raises(ValueError, match="a position as three finite numbers"):
            Distance(bad)


@pytest.mark.parametrize("name", extremes())
def test_extreme_lines(name):
    whole = pf.compress(extremes()[name])
    lines = by_line(whole)
    if whole.n_points == 0:
        for each in ("curvature", "arc_length", Distance((0, 0, 0), "point")):
            assert measure(whole, each).array().shape == (0,)
        assert measure(whole, "length").array().tolist() == [0.0] * len(whole)
        assert np.isnan(measure(whole, "end_distance").array()).all()
        assert measure(whole, "curvature").range() == (0.0, 0.0)
        return
    ends = end_points(whole)
    for i, p in enumerate(lines):
        np.testing.assert_array_equal(ends[i], p[[0, -1]] if len(p) else np.full((2, 3), np.nan))
    if name in ("denormal coordinates", "huge coordinates"):  # float32 holds neither curvatures nor lengths
        return
    wanted = coded(whole, [arc_length(p) for p in lines])
    np.testing.assert_allclose(measure(whole, "arc_length").array(), wanted, rtol=1e-6)
    scale = np.median(measure(whole, "curvature").array())
    wanted = coded(whole, [curvature(p, max(whole.step / 10, whole.points_promise)) for p in lines])
    np.testing.assert_allclose(measure(whole, "curvature").array(), wanted, rtol=1e-4, atol=1e-6 * scale + 1e-12)


# ---------------------------------------------------------------------------------------------------------------- bits


def unpacked(words, n):
    bits = (words[:, None] >> np.arange(32, dtype=np.uint32) & 1).astype(bool).ravel()
    assert not bits[n:].any(), "bits behind the last are 0"
    return bits[:n]


def test_bits_of_points(whole):
    n = whole.n_points
    arc, fa = measure(whole, "arc_length"), measure(whole, "fa")
    number = whole.per_point["fa"].values().astype(np.float64)
    missing = np.isnan(number)
    assert missing.sum() == 4
    length = arc.array().astype(np.float64)
    edge = float(length[7])  # an end of a range that is a value belongs to it
    code = float(number[~missing][11])
    for criteria, wanted in (
        ([], np.ones(n, bool)),
        ([(arc, 0.3, edge)], (length >= 0.3) & (length <= edge)),
        ([(fa, code, code)], number == code),
        ([(fa, -0.2, 0.7, True)], (number >= -0.2) & (number <= 0.7) | missing),
        ([(fa, -np.inf, np.inf)], ~missing),
        ([Criterion(number.astype(np.float32), -np.inf, np.inf, keep_nan=True)], np.ones(n, bool)),
        ([(number.astype(np.float32), 0.1, 2.0, True)], (number >= 0.1) | missing),
        ([(whole.per_point["fa"], 0.0, np.inf), (arc, -np.inf, 9.0)], (number >= 0) & (length <= 9)),
        ([(fa, 5.0, 6.0)], np.zeros(n, bool)),
    ):
        words = point_words(whole, criteria)
        assert (words.dtype, words.shape) == (np.uint32, ((n + 31) // 32 + 1,))
        np.testing.assert_array_equal(unpacked(words, n), wanted)


@pytest.mark.parametrize("n", [0, 1, 31, 32, 33, 64, 100])
def test_bits_of_any_number_of_points(n):
    whole = pf.compress(Streamlines(np.random.default_rng(n).normal(size=(n, 3)), [0, n]))
    values = np.arange(n, dtype=np.float32)
    words = point_words(whole, [(values, 3.0, n - 2.0)] if n > 5 else [])
    assert len(words) == (n + 31) // 32 + 1
    assert unpacked(words, n).sum() == (n - 4 if n > 5 else n)


def test_sixteen_bit_codes_compare_as_their_values():
    whole = pf.compress(LINES, per_point=["fa"], per_point_bits=16)
    number = whole.per_point["fa"].values().astype(np.float64)
    for lo, hi in ((-0.3, 0.25), (float(number[20]), float(number[20])), (0.9, np.inf)):
        found = unpacked(point_words(whole, [(measure(whole, "fa"), lo, hi)]), whole.n_points)
        np.testing.assert_array_equal(found, (number >= lo) & (number <= hi))


def test_bits_of_ranks(whole):
    mask = np.random.default_rng(3).random(73) < 0.5
    words = rank_words(whole, mask)
    assert (words.dtype, words.shape) == (np.uint32, (3,))
    np.testing.assert_array_equal(unpacked(words, 70), mask[whole.rank_to_id])
    plain = pf.compress(smooth(32, 20))
    assert rank_words(plain, np.arange(32) == 31).tolist() == [1 << 31]
    for bad in (mask[:5], mask.astype(int)):
        with pytest.raises(ValueError, match="one bool for each"):
            rank_words(whole, bad)


def test_masks_of_streamlines(whole):
    length, number = measure(whole, "length"), measure(whole, "number")
    found = streamline_mask(whole, [(length, 20.0, np.inf), (number, 3, 40)])
    np.testing.assert_array_equal(found, (length.array() >= 20) & (np.arange(73) >= 3) & (np.arange(73) <= 40))
    assert streamline_mask(whole, []).all()
    gaps = measure(whole, "end_distance")
    assert streamline_mask(whole, [(gaps, 0, np.inf, True)]).all()
    assert streamline_mask(whole, [(gaps, 0, np.inf)]).sum() == 70
    with pytest.raises(ValueError, match="'fa' has a value per point"):
        streamline_mask(whole, [(measure(whole, "fa"), 0, 1)])
    with pytest.raises(ValueError, match="'length' has a value per streamline"):
        point_words(whole, [(length, 0, 1)])
    for lo, hi in ((1.0, 0.0), (np.nan, 1.0), (0.0, np.nan)):
        with pytest.raises(ValueError, match="give lo <= hi"):
            point_words(whole, [(measure(whole, "fa"), lo, hi)])
    with pytest.raises(ValueError, match=r"values of shape \(3,\)"):
        point_words(whole, [(np.zeros(3, np.float32), 0, 1)])


# ---------------------------------------------------------------------------------------------------------------- ends


def test_end_points_are_those_of_the_decoded_streamlines(whole):
    ends = end_points(whole)
    assert (ends.shape, ends.dtype) == ((73, 2, 3), np.float64)
    for found, line in zip(ends, by_line(whole), strict=True):
        np.testing.assert_array_equal(found, line[[0, -1]] if len(line) else np.full((2, 3), np.nan))


def test_end_points_across_pages():
    whole = many_pages()
    decoded = whole.decompress(dtype=np.float64)
    wanted = np.stack([decoded.points[decoded.offsets[:-1]], decoded.points[decoded.offsets[1:] - 1]], axis=1)
    np.testing.assert_array_equal(end_points(whole), wanted)


@pytest.mark.parametrize("distance", [0.01, 4.0, 12.0, 1e6])
def test_similar_ends(distance):
    rng = np.random.default_rng(6)
    lines = [np.linspace(a, b, 9) for a, b in rng.uniform(-20, 20, (400, 2, 3))]
    lines += [line[::-1] + 1.0 for line in lines[:50]] + [np.zeros((0, 3)), np.array([[1.0, 2, 3]])]
    whole = pf.compress(Streamlines.from_list(lines))
    ends = end_points(whole)
    ids = np.array([3, 17, 17, 120, -1, -2])
    wanted = np.zeros(len(lines), bool)
    for i in ids:
        for other in (ends[i], ends[i][::-1]):
            wanted |= (np.linalg.norm(ends - other, axis=2) <= distance).all(axis=1)
    found = similar_ends(whole, ids, distance)
    np.testing.assert_array_equal(found, wanted)
    assert found[[3, 17, 120, -1]].all()
    assert not found[-2], "a streamline without points ends nowhere"
    assert found[403] == (distance >= 4.0), "the other way round"


def test_similar_ends_of_bad_or_no_questions():
    whole = pf.compress(every_kind())
    assert not similar_ends(whole, [], 1.0).any()
    assert not similar_ends(whole, [0], 1.0).any()  # without points
    for bad in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="distance is"):
            similar_ends(whole, [1], bad)
    with pytest.raises(IndexError):
        similar_ends(whole, [73], 1.0)


# ------------------------------------------------------------------------------------------------------------- profiles


def test_profile_of_a_bundle_stored_in_both_directions():
    """A value that is a function of place, along parallel arcs that run to and fro with different steps."""
    arcs = []
    for i in range(40):
        t = np.linspace(0, np.pi, 30 + 7 * (i % 5))
        arc = np.stack([30 * np.cos(t), 30 * np.sin(t), np.full(len(t), 0.1 * i)], axis=1)
        arcs.append(arc[::-1] if i % 3 == 0 and i else arc)
    lines = Streamlines.from_list([*arcs, np.zeros((0, 3)), np.full((50, 3), 500.0)])
    for order in ("input", "hilbert"):
        whole = pf.compress(lines, order=order)
        mean, std = mean_profile(whole, np.append(np.arange(41), 40), lines.points[:, 0], n=21)
        wanted = 30 * np.cos(np.linspace(0, np.pi, 21))
        np.testing.assert_allclose(mean, wanted, atol=0.3)
        assert std.max() < 0.3
        mean, std = mean_profile(whole, [3, *range(40)], lines.points[:, 0], n=21)
        np.testing.assert_allclose(mean, -wanted, atol=0.3)  # the first runs the other way


def test_profile_is_the_mean_and_deviation_of_interpolated_values(whole):
    fa = np.arange(whole.n_points, dtype=np.float32) % 17
    ids = np.array([5, 9, 30, 45, 45, 60])
    rows, decoded = [], whole.decompress(dtype=np.float64)
    first = None
    for i in ids:
        a, b = decoded.offsets[i], decoded.offsets[i + 1]
        s = arc_length(decoded.points[a:b])
        at = np.linspace(0, s[-1], 30)
        place = np.stack([np.interp(at, s, decoded.points[a:b, axis]) for axis in range(3)], axis=1)
        row = np.interp(at, s, fa[a:b])
        first = place if first is None else first
        flip = np.linalg.norm(place[::-1] - first, axis=1).mean() < np.linalg.norm(place - first, axis=1).mean()
        rows.append(row[::-1] if flip else row)
    mean, std = mean_profile(whole, ids, fa, n=30)
    np.testing.assert_allclose(mean, np.mean(rows, axis=0), rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(std, np.std(rows, axis=0), rtol=1e-6, atol=1e-6)


def test_profile_leaves_out_what_has_no_value(monkeypatch):
    line = np.stack([np.arange(41.0), np.zeros(41), np.zeros(41)], axis=1)
    whole = pf.compress(Streamlines.from_list([line, line + [0, 1, 0], np.zeros((0, 3)), line[:1]]))
    values = np.concatenate([np.full(41, 2.0), np.where(np.arange(41) < 20, 4.0, np.nan), [np.nan]])
    mean, std = mean_profile(whole, [0, 1, 2, 3], values, n=5)
    np.testing.assert_allclose(mean, [3, 3, 2, 2, 2])
    np.testing.assert_allclose(std, [1, 1, 0, 0, 0])
    for nothing in ([], [2], [3]):
        mean, std = mean_profile(whole, nothing, values, n=4)
        assert np.isnan(mean).all()
        assert np.isnan(std).all()
    assert mean_profile(whole, [3], "arc_length", n=3)[0].tolist() == [0.0] * 3
    with pytest.raises(ValueError, match="a profile needs values per point"):
        mean_profile(whole, [0], "length")
    with pytest.raises(ValueError, match="n is 1"):
        mean_profile(whole, [0], values, n=1)


def test_profile_in_portions_is_the_same(monkeypatch):
    from pvfiblets.query.measures import profile

    whole = pf.compress(smooth(30, 90))
    once = mean_profile(whole, slice(None), "curvature", n=12)
    monkeypatch.setattr(profile, "CHUNK", 200)
    np.testing.assert_allclose(mean_profile(whole, slice(None), "curvature", n=12), once, rtol=1e-12)


def test_damaged_sets_say_so(tmp_path):
    whole = pf.compress(every_kind())
    words = whole.anchors.copy()
    words[20:40, 1] ^= np.uint32(0x3FFF0000)
    for ask in (end_points, lambda f: measure(f, "length"), lambda f: measure(f, "curvature")):
        with pytest.raises(pf.FormatError):
            ask(replace(whole, anchors=words))
    assert isinstance(measure(whole, "length"), Values)
